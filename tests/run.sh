#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Set-up, build, every test. The last lines are ctest's summary. Arguments go to ctest (-R name, -j 2, ...).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash run/setup.sh --tests
exec ctest --test-dir build --output-on-failure --no-tests=error --timeout 600 "$@"
