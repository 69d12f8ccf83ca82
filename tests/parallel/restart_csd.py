#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""csd goes on from a checkpoint with the bits of the run that was never stopped: in the middle of cracks, with other threads and ranks, killed at
any instant, asked by a signal.
    restart_csd.py BUILD_FOLDER [cracks | pieces | rigid | flying | waiting | contact | bar | loaded | static | local | local_rigid | killed | signal | refused ...]   none named: all but waiting and local_rigid"""
import os
import pathlib
import random
import re
import signal as signals
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE), str(HERE.parent / "coupled")]
import csd  # noqa: E402
import runs  # noqa: E402  (csd.py has set the path)
from launch import ENVIRONMENT  # noqa: E402
from verification.case import WORK, run  # noqa: E402

BUILD = pathlib.Path(os.environ["BREAKWAVE_BUILD"])


def begin(name, text, ranks, threads, *words):
    """csd on its own in the folder of the case, which `clean` has made."""
    folder = WORK / name
    (folder / "case.toml").write_text(text, encoding="utf-8")
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(BUILD / "bin" / "csd"), "case.toml", *words]
    return subprocess.Popen(command, cwd=folder, env=ENVIRONMENT | {"OMP_NUM_THREADS": str(threads)}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def finish(process, what):
    said = process.communicate(timeout=600)[0]
    if process.returncode != 0:
        raise RuntimeError(f"{what}: exit code {process.returncode}\n{said}")
    return said


def clean(name):
    out = WORK / name / "out"
    out.mkdir(parents=True, exist_ok=True)
    for path in out.iterdir():
        path.unlink()
    return out


def checkpoints(out):
    return sorted(out.glob("solid_checkpoint_*.h5"))


def limited(text, steps):
    return text.replace("[time]\n", f"[time]\nmax_steps = {steps}\n", 1)


def compare(name, text, stop, starts, layouts, first=2):
    """The run to the end; one that ends after `stop` steps, with checkpoints; from each of these at `starts`, in turn with the layouts."""
    whole = run(f"restart_{name}_whole", text, ranks="1", threads=1, only="solid").directory
    faults = []
    for at, (ranks, threads) in zip(starts, layouts):
        folder = f"restart_{name}"
        out = clean(folder)
        first_ranks = first if ranks == 1 and at == starts[-1] else 1  # also from more ranks to fewer
        finish(begin(folder, limited(text, stop) + f"[checkpoint]\nevery_steps = {at}\nkeep = 1000\n", first_ranks, 1), name)
        file = out / f"solid_checkpoint_{at:08d}.h5"
        finish(begin(folder, text, ranks, threads, "--restart", str(file)), f"{name} from step {at}")
        different = runs.differences(whole, out) + csd.totals_differ(whole, out)
        print(f"{name}: from step {at} of a run that ended after {stop}, {first_ranks} to {ranks} ranks, {threads} threads: "
              f"{'the same bits' if not different else 'DIFFERENT: ' + ', '.join(different[:8])}", flush=True)
        faults += [f"{name} from step {at}: other bits"] if different else []
    return faults


def killed(times=4):
    """Killed at random instants, again and again from where it was; once the latest file is complete the bits are those of the whole run."""
    result = run("restart_killed_whole", csd.CRACKS, ranks="1", threads=1, only="solid")
    whole = result.directory
    name, rules, dice = "restart_killed", "[checkpoint]\nevery_steps = 20\n", random.Random(os.getpid())
    out, faults, deaths = clean(name), [], 0
    for _ in range(times):
        go_on = ["--restart", "out"] if checkpoints(out) else []
        process = begin(name, csd.CRACKS + rules, 1, 1, *go_on)
        try:
            process.wait(timeout=dice.uniform(0.05, 0.7 * result.seconds))
        except subprocess.TimeoutExpired:
            process.kill()
            deaths += 1
        process.communicate()
    finish(begin(name, csd.CRACKS + rules, 1, 2, *(["--restart", "out"] if checkpoints(out) else [])), name)
    different = [d for d in runs.differences(whole, out)]
    faults += [f"killed: {different[:8]}"] if different else []
    faults += [f"killed: {len(checkpoints(out))} checkpoints stay"] if len(checkpoints(out)) != 2 else []
    faults += ["killed: never"] if deaths == 0 else []
    print(f"killed {deaths} times: {'the same bits' if not different else different[:8]}")
    return faults


def signal():
    """USR1 asks for a checkpoint, and nothing else happens."""
    out = clean("restart_signal")
    process = begin("restart_signal", csd.CRACKS.replace('end = "26 us"', 'end = "1 ms"\nmax_steps = 2000'), 1, 1)
    while process.poll() is None and not (out / "solid_history.csv").exists():
        time.sleep(0.005)
    process.send_signal(signals.SIGUSR1)
    said = finish(process, "signal")
    print(f"signal: {len(checkpoints(out))} checkpoint, {re.findall('checkpoint at .*', said)}")
    return [] if len(checkpoints(out)) == 1 else ["signal: no checkpoint, or several"]


def refused():
    """A checkpoint of another case, and one that isn't there."""
    faults = []
    out = clean("restart_refused")
    finish(begin("restart_refused", limited(csd.CRACKS, 20) + "[checkpoint]\nevery_steps = 10\n", 1, 1), "refused")
    for text, words, wanted in ((csd.CRACKS.replace("0.05}", "0.06}"), str(out), "case"), (csd.CRACKS, "nowhere", "nowhere")):
        process = begin("restart_refused", text, 1, 1, "--restart", words)
        said = process.communicate()[0]
        print(f"refused: {said.strip().splitlines()[-1]}")
        faults += [f"refused: exit code {process.returncode}: {said}"] if process.returncode != 2 or wanted not in said else []
    return faults


# by the mean force alone, some time after they broke off
WAITING = csd.RIGID.replace("elements = 60", 'elements = 60\nage = "5 us"\nstress = "0.5 GPa"\nmotion = "mean_force"')
# local steps, while the levels change
LOCAL = csd.CRACKS.replace('[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\n', "[solid.time_step]\nlevels = 3\n")
GROUPS = {"cracks": lambda: compare("cracks", csd.CRACKS, 74, [12, 45, 60, 72], [(1, 2), (2, 1), (1, 1), (1, 1)]),
          "pieces": lambda: compare("pieces", csd.PIECES, 76, [66], [(1, 2)]),
          # while the plate is free, after two fragments left the box; rigid pieces spin and meet the wall
          "rigid": lambda: compare("rigid", csd.RIGID, 80, [63, 75], [(2, 1), (1, 1)]),
          "flying": lambda: compare("flying", csd.FLYING, 80, [63], [(2, 1)]),
          "waiting": lambda: compare("waiting", WAITING, 60, [45, 58], [(1, 2), (1, 1)]),
          # lips that have not parted; rigid fragments that meet
          "contact": lambda: compare("contact", csd.CONTACT, 70, [62], [(2, 1)]),
          "bar": lambda: compare("bar", csd.BAR, 40, [7, 31], [(1, 2), (2, 1)]),
          "loaded": lambda: compare("loaded", csd.LOADED.replace("STEP", "0.26 us"), 60, [10, 41], [(1, 2), (2, 2)]),
          "static": lambda: compare("static", csd.STATIC, 100, [51], [(1, 2)]),
          "local": lambda: compare("local", LOCAL, 40, [9, 25], [(1, 2), (1, 1)], first=1),
          "local_rigid": lambda: compare("local_rigid", csd.LOCAL, 30, [9, 16, 23], [(1, 2), (1, 1), (1, 2)], first=1),
          "killed": killed, "signal": signal, "refused": refused}
LONG = ("waiting", "local_rigid")  # only if they are named

if __name__ == "__main__":
    failures = [fault for group in csd.arguments or [name for name in GROUPS if name not in LONG] for fault in GROUPS[group]()]
    print("\n".join(failures) or "all the same")
    sys.exit(1 if failures else 0)
