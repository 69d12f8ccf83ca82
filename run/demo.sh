#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The coupled weapon at demo size, from nothing: packages, build, run, pictures. Safe to run twice.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
started=$SECONDS
bash run/setup.sh
built=$SECONDS
case=run/cases/weapon/case.toml out=run/out/weapon
rm -rf "$out"
echo "demo: TNT inside a steel case, detonated at the top ($case)"
run/breakwave "$case"
ran=$SECONDS
echo "demo: pictures"
/usr/bin/python3 run/pictures.py "$out" > /dev/null
echo "demo: set-up and build $((built - started)) s, run $((ran - built)) s, pictures $((SECONDS - ran)) s"
for program in solid fluid; do
  [[ -f "$out/${program}_summary.json" ]] && echo "demo: totals of the $program: $out/${program}_summary.json"
done
echo "demo: pictures and plots are in $PWD/$out/pictures"
