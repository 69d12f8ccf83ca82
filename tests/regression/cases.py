#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Every case under run/cases is read and built by its programs (--check), without a step.
    cases.py BUILD_FOLDER"""
import pathlib
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[1]).resolve()
HUGE = {"paper", "fine"}  # their flows fill more memory than a test should


def main():
    bad = 0
    for file in sorted((ROOT / "run" / "cases").glob("*/*.toml")):
        tables = tomllib.loads(file.read_text())
        for only in ("solid", "fluid"):
            if only not in tables or (only == "fluid" and file.stem in HUGE) or file.stem == "fine":
                continue
            with tempfile.TemporaryDirectory() as folder:
                done = subprocess.run([ROOT / "run" / "breakwave", file, "--only", only, "--build", BUILD, "--", "--check"], cwd=folder,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
            print(f"{'ok  ' if done.returncode == 0 else 'FAIL'} {file.relative_to(ROOT)} {only}")
            if done.returncode:
                bad += 1
                print("    " + "\n    ".join(done.stdout.strip().split("\n")[-4:]))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
