#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clang-format over all sources: a report, since versions of the tool differ in detail. `--fix` formats in place.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if ! command -v clang-format > /dev/null; then echo "clang-format is not installed: not checked"; exit 0; fi
mapfile -t files < <(git ls-files '*.h' '*.cpp' 2> /dev/null || find . -name '*.h' -o -name '*.cpp')
if [[ "${1:-}" == --fix ]]; then clang-format -i "${files[@]}"; echo "formatted ${#files[@]} files"; exit 0; fi
different=0
for file in "${files[@]}"; do
  if ! clang-format --dry-run -Werror "$file" > /dev/null 2>&1; then echo "$file: clang-format would change it"; different=$((different + 1)); fi
done
echo "$different of ${#files[@]} files differ from clang-format's own layout (bash tests/style/format.sh --fix)"
