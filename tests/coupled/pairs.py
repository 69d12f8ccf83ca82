#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Starts pairs of dummies and looks at how they end: code, words, processes gone, time.

pairs.py <folder of executables> <group> [scenario]
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from launch import ENVIRONMENT

FOLDER, GROUP = sys.argv[1:3]
ONLY = sys.argv[3] if len(sys.argv) > 3 else None
LIMIT = 5.0  # s from accident to the end of all processes; on an idle machine it is below 2
ENDED = r"ended from outside"


def told(name):
    return rf"dummy {name} \(rank \d+\) FAILED in window [23]"


# group -> scenario, (role, ranks) in the order of the command line, exit code (None: any but 0), [words of the solid], [words of the fluid]
PAIR = [("solid", 1), ("fluid", 1)]
SCENES = {
    "exchange": [
        ("none", PAIR, 0, [r"12 windows, t = 0\.001 s", "dummy fluid ends|"], ["finished after window 11"]),
        ("none", [("fluid", 1), ("solid", 1)], 0, ["12 windows"], ["finished after window 11"]),
        ("none", [("solid", 2), ("fluid", 1)], 0, ["12 windows"], ["finished"]),
        ("none", [("fluid", 2), ("solid", 1)], 0, ["12 windows"], ["finished"]),
        ("none", [("solid", 2)], 0, ["alone with 2 ranks"], []),
        ("none", [("fluid", 1)], 0, [], ["alone with 1 ranks"]),
        ("fluid:stop", PAIR, 0, ["4 windows"], ["finished after window 3"]),
    ],
    "messages": [
        ("fluid:version", PAIR, 65, [r"protocol version 1\.2 here, 2\.2 in the other"], ["protocol version"]),
        ("fluid:old", PAIR, 65, [r"dummy solid needs protocol 1\.1 in this run \(fixed windows.*dummy fluid speaks 1\.0 only"], [r"the other program \(rank 0\) FAILED.*needs protocol 1\.1"]),
        ("fluid:newer", PAIR, 65, [r"dummy fluid needs protocol 1\.3 in this run, dummy solid speaks 1\.2 only"], [r"needs protocol 1\.3"]),
        ("fluid:magic", PAIR, 64, ["does not speak this protocol"], ["does not speak"]),
        ("fluid:endian", PAIR, 64, ["byte order"], ["byte order"]),
        ("fluid:short_hello", PAIR, 68, ["HELLO has 100 bytes"], ["HELLO has 100 bytes"]),
        ("fluid:p_ref", PAIR, 66, ["reference pressure"], ["reference pressure"]),
        ("solid:apart", PAIR, 67, ["outside the fluid's domain"], ["outside the fluid's domain"]),
        ("solid:bad_v", PAIR, 69, [r"SURFACE: v of node 3 is \(1, nan, 3\)"], [told("solid") + ".*v of node 3"]),
        ("fluid:own_bad_p", PAIR, 69, [told("fluid") + ".*P of face 2 is nan"], ["LOAD: P of face 2 is nan"]),
        ("fluid:bad_p", PAIR, 69, ["LOAD: P of face 2 is nan"], [told("solid") + ".*P of face 2 is nan"]),
        ("fluid:short_p", PAIR, 68, ["LOAD: P from dummy fluid has 40 bytes, 48 were expected"], [told("solid")]),
        ("fluid:wrong_window", PAIR, 68, ["LOAD answers window 4.*asked were window 3"], [told("solid")]),
        ("fluid:late_t1", PAIR, 69, ["LOAD: t1 = .* is not in"], [told("solid")]),
        ("fluid:bye", PAIR, 76, [r"said BYE \(had enough\) while LOAD was expected"], [told("solid") + ".*said BYE"]),
        ("solid:lost_impulse", PAIR, 78, ["ledger: in window 3"], [told("solid") + ".*ledger"]),
    ],
    "accidents": [
        ("solid:throw", PAIR, 3, ["element 17 is inverted"], [told("solid") + ".*element 17"]),
        ("fluid:throw", PAIR, 3, [told("fluid") + ".*element 17"], ["element 17 is inverted"]),
        ("both:throw", PAIR, 3, ["element 17"], ["element 17"]),
        ("solid:rank1", [("solid", 2), ("fluid", 1)], 3, ["rank 1 is out of sorts"], [r"dummy solid \(rank 1\) FAILED.*out of sorts"]),
        ("fluid:rank1", [("solid", 1), ("fluid", 2)], 3, [r"dummy fluid \(rank 1\) FAILED.*out of sorts"], ["rank 1 is out of sorts"]),
        ("solid:exit", PAIR, 71, [r"called exit\(\)"], [told("solid") + r".*exit\(\)"]),
        ("fluid:exit", PAIR, 71, [told("fluid") + r".*exit\(\)"], [r"called exit\(\)"]),
        ("fluid:return", PAIR, 71, [told("fluid") + ".*left its run"], ["left its run"]),
        ("solid:terminate", PAIR, None, ["thrown in a thread"], [ENDED]),
        ("solid:kill", PAIR, None, [], [ENDED + " in window 2"]),
        ("fluid:kill", PAIR, None, [ENDED + " in window 3"], []),
        ("fluid:segfault", PAIR, None, [ENDED + " in window 3"], []),
        ("fluid:hang", PAIR, 75, [r"no LOAD from dummy fluid for 2 s \(silence limit\)"], [ENDED]),
    ],
    "starts": [
        ("fluid:bad_input", PAIR, 2, [ENDED + " before the programs had joined"], ["a positive density"]),
        ("solid:bad_input", [("fluid", 1), ("solid", 2)], 2, ["a positive density"], [ENDED]),
        ("both:bad_input", PAIR, 2, ["a positive density|" + ENDED], ["a positive density|" + ENDED], "a positive density"),  # whoever is first says why
        ("fluid:early_exit", PAIR, None, [ENDED], []),
        ("fluid:late", PAIR, 73, ["not joined within 2 s"], [""]),
    ],
}


def stays(pid):
    """Alive for another second."""
    for _ in range(20):
        if not is_alive(pid):
            return False
        time.sleep(0.05)
    return True


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().split(") ")[-1][0] != "Z"
    except OSError:
        return False


def run(scenario, programs, folder, code, solid, fluid, somebody=""):
    # to files, as mpirun may drop the last words of a job that it ends
    words = [[*f"-n {n} sh -c".split(), f"exec {FOLDER}/coupled_dummy {role} {scenario} >{folder}/{role}.$OMPI_COMM_WORLD_RANK 2>&1"] for role, n in programs]
    command = ["mpirun"] + [word for i, one in enumerate(words) for word in ([":"] if i else []) + one]
    try:
        done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired as hung:
        return "hangs: " + str(hung.stdout) + str(hung.stderr), 0
    end = time.monotonic()
    text = done.stdout + done.stderr + "".join(path.read_text(errors="replace") for path in sorted(folder.iterdir()))
    faults = []
    if (done.returncode == 0) != (code == 0) or (code is not None and done.returncode != code):
        faults.append(f"exit code {done.returncode}, expected {'nonzero' if code is None else code}")
    for role, wanted in ("solid", solid), ("fluid", fluid):
        said = "\n".join(line for line in text.splitlines() if line.startswith(f"[{role}]"))
        faults += [f"[{role}] does not say '{w}'" for w in wanted if not re.search(w, said)]
    if not re.search(somebody, text):
        faults.append(f"nobody says '{somebody}'")
    accidents = [float(t) for t in re.findall(r"accident at ([\d.]+)", text)]
    seconds = end - max(accidents) if accidents else 0
    waits = 2 if scenario in ("fluid:hang", "fluid:late") else 0  # the limit that has to pass first
    if seconds - waits > LIMIT:
        faults.append(f"{seconds:.1f} s from accident to end")
    faults += [f"process {pid} is still there" for pid in re.findall(r"process (\d+)", text) if stays(pid)]
    return ("; ".join(faults) + "\n" + text) if faults else "", seconds - waits


failures = 0
for scenario, programs, *expected in SCENES[GROUP]:
    if ONLY and scenario != ONLY:
        continue
    with tempfile.TemporaryDirectory() as folder:
        fault, seconds = run(scenario, programs, pathlib.Path(folder), *expected)
    ranks = " ".join(f"{role}:{n}" for role, n in programs)
    print(f"{'FAILED' if fault else 'ok':6} {scenario:20} {ranks:20} {seconds:6.2f} s  {fault}", flush=True)
    failures += bool(fault)
sys.exit(failures != 0)
