#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""csd and cfd together: the free piston on 1 + 1, 1 + 2 ranks and in either order gives the same bits; both end when one has an accident.

programs.py <folder of executables> <case file of the piston> <folder for results>
"""
import os
import re
import signal
import subprocess
import sys
import threading
import time

import launch
from launch import ENVIRONMENT, report

FOLDER, CASE, OUT = sys.argv[1:4]
LIMIT = 5.0  # s from accident to end; below 2 on an idle machine


def start(name, programs, change=("", ""), accident=None):
    """Exit code, text and seconds since the accident; accident: a program that is killed once windows are running."""
    out = f"{OUT}/{name}"
    os.makedirs(out, exist_ok=True)
    with open(CASE) as file:
        text = re.sub(r'directory = ".*"', f'directory = "{out}"', file.read()).replace(*change)
    with open(f"{out}/case.toml", "w") as file:
        file.write(text)
    words = [f"-n {ranks} {FOLDER}/{program} {out}/case.toml" for program, ranks in programs]
    mpirun = subprocess.Popen(["mpirun"] + " : ".join(words).split(), env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    killed_at = []

    def kill():
        ledger = f"{out}/coupling_history.csv"
        while mpirun.poll() is None and not os.path.exists(ledger):
            time.sleep(0.02)
        time.sleep(0.3)
        found = subprocess.run(["pgrep", "-f", f"^{FOLDER}/{accident} {out}/"], capture_output=True, text=True).stdout.split()
        killed_at.append(time.monotonic())
        for pid in found:
            os.kill(int(pid), signal.SIGKILL)

    if accident:
        if os.path.exists(f"{out}/coupling_history.csv"):
            os.remove(f"{out}/coupling_history.csv")
        threading.Thread(target=kill, daemon=True).start()
    try:
        said = mpirun.communicate(timeout=120)[0]
    except subprocess.TimeoutExpired:
        mpirun.kill()
        return None, "hangs: " + mpirun.communicate()[0], 0
    return mpirun.returncode, said, time.monotonic() - killed_at[0] if killed_at else 0


def history(name):
    with open(f"{OUT}/{name}/solid_history.csv", "rb") as file:
        return file.read()


PAIR = [("csd", 1), ("cfd", 1)]
for name, programs in ("1+1", PAIR), ("1+2", [("csd", 1), ("cfd", 2)]), ("fluid first", [("cfd", 1), ("csd", 1)]):
    code, said, _ = start(name.replace(" ", "_"), programs)
    fault = f"exit code {code}\n{said}" if code != 0 else ""
    if not fault and history(name.replace(" ", "_")) != history("1+1"):
        fault = "other bits than 1+1"
    if not fault and not re.search(r"ledger of \d+ windows: nothing was lost", said):
        fault = f"the ledger does not say that nothing was lost\n{said}"
    report(name, fault)

LONG = ('end = "1 ms"', 'end = "1000 s"')  # until it is killed; the piston soon leaves the gas
for name, change, accident, code_wanted, words in (
        ("wrong key of the solid", ("[solid.wet]", "[solid.wett]"), None, 2, [r"\[csd\] error: .*wett"]),
        ("wrong key of the fluid", ("[[fluid.material]]", "[[fluid.materiel]]"), None, 2, [r"\[cfd\] error: .*fluid.material"]),
        ("empty fluid", ('density = "1.225 kg/m^3"', "density = -1"), None, 2, [r"\[cfd\] error: .*density"]),
        ("apart", ('lower = ["-640 mm"', 'lower = ["40 mm"'), None, 67, [r"\[csd\] error: .*outside the fluid", r"\[cfd\] error: .*outside the fluid"]),
        ("cfd killed", LONG, "cfd", None, [r"\[csd\] error: ended from outside in window"]),
        ("csd killed", LONG, "csd", None, [r"\[cfd\] error: ended from outside in window"])):
    code, said, seconds = start(name.replace(" ", "_"), PAIR, change, accident)
    faults = [f"'{w}' is not said" for w in words if not re.search(w, said)]
    if code == 0 or code is None or (code_wanted is not None and code != code_wanted):
        faults.append(f"exit code {code}")
    if seconds > LIMIT:
        faults.append(f"{seconds:.1f} s from accident to end")
    report(f"{name} (exit code {code}, {seconds:.2f} s)", "; ".join(faults) + "\n" + said if faults else "")
sys.exit(launch.failed)
