#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""csd and cfd fail, in the ways of a table and on either side (wrong versions and messages: fsi-check): both are gone soon, with a code that is not 0, the survivor says why, and the last
checkpoint of the pair is whole.
    failures.py BUILD_FOLDER [--ranks 2+2] [--only WORDS] [--fuzz N] [--seed N]     --fuzz: N runs with two accidents at random instants instead"""
import argparse
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import threading
import time

import h5py

HERE = pathlib.Path(__file__).resolve().parent
parser = argparse.ArgumentParser()
parser.add_argument("build", type=pathlib.Path)
parser.add_argument("--ranks", default="1+1")
parser.add_argument("--only", default="")
parser.add_argument("--fuzz", type=int, default=0)
parser.add_argument("--seed", type=int, default=1)
options = parser.parse_args()
sys.argv = sys.argv[:2]
os.environ["BREAKWAVE_BUILD"] = str(options.build.resolve())
sys.path += [str(HERE.parents[1] / "run"), str(HERE.parent / "regression"), str(HERE)]
import runs  # noqa: E402
from launch import ENVIRONMENT  # noqa: E402
from verification.case import BUILD, WORK  # noqa: E402

LIMIT = 6.0  # s from accident to the end of all processes; below 2 on an idle machine
START = 15  # s, for MPI's own start
SILENCE = 10 if options.fuzz else 20  # s; a window of 2+2 ranks on a busy machine takes seconds
RANKS = [int(n) for n in options.ranks.split("+")]
CASE = (runs.SHELL.replace("cells = [48, 48, 48]", "cells = [32, 32, 32]").replace("around = 32", "around = 16")
        + f"[checkpoint]\nevery_steps = 5\n[coupling]\nsilence_limit = {SILENCE}\njoin_limit = {SILENCE}\n")
SIDES = ("csd", "cfd")
ENVIRONMENT["BREAKWAVE_START_LIMIT"] = str(START)


def pids_of(job, program):
    listed = subprocess.run(["ps", "-e", "-o", "pid=,stat=,sid=,comm="], capture_output=True, text=True).stdout.split("\n")
    rows = [line.split() for line in listed if line.strip()]
    return sorted(int(pid) for pid, state, sid, name, *_ in rows if int(sid) == job.pid and name == program and state[0] != "Z")


def state_of(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return "gone"


def start(folder, words=None, case=None):
    """The pair in a session of its own. words: what stands for a program; case: its own case file's text."""
    out = folder / "out"
    out.mkdir(parents=True, exist_ok=True)
    for path in out.iterdir():
        path.unlink()
    command = ["mpirun"]
    for program, ranks in zip(SIDES, RANKS):
        (folder / f"{program}.toml").write_text((case or {}).get(program, CASE))
        command += ([":"] if program == "cfd" else []) + ["-n", str(ranks)] + (words or {}).get(program, [str(BUILD / "bin" / program), f"{program}.toml"])
    if not words and not case:  # as users do
        command = [str(HERE.parents[1] / "run" / "breakwave"), "csd.toml", "--ranks", "+".join(map(str, RANKS)), "--threads", "1", "--build", str(BUILD)]
    return subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)


def kill_all(job):
    """The launcher and what it started; gone already is as good."""
    try:
        os.killpg(job.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def wait_for_mark(job, out, seconds=60):
    deadline = time.monotonic() + seconds
    while job.poll() is None and time.monotonic() < deadline and not list(out.glob("pair_checkpoint_*.txt")):
        time.sleep(0.02)


def without_leaders(silence):
    """s until ranks whose leaders hang end by themselves."""
    return 3 * silence + 5


def end_of(job, accident_at, faults, waits=0.0):
    """Text and seconds since the accident, less those that the programs have to wait."""
    try:
        said = job.communicate(timeout=60 + waits)[0]
    except subprocess.TimeoutExpired:
        faults.append("HANGS")
        kill_all(job)
        said = job.communicate()[0]
    if "MPI has not started" in said:
        waits = max(waits, START)
    if "mpirun hung" in said:  # in itself; run/breakwave makes sure twice
        waits += 6
    seconds = time.monotonic() - accident_at - waits
    if seconds > LIMIT:
        faults.append(f"{seconds:.1f} s from the accident to the end")
    if job.returncode == 0:
        faults.append("exit code 0")
    time.sleep(0.1)
    faults += [f"process {pid} of {program} is still there" for program in SIDES for pid in pids_of(job, program)]
    return said, seconds


def look_at_checkpoint(out, faults):
    """The latest mark's files open, and have the sizes that it says."""
    marks = sorted(out.glob("pair_checkpoint_*.txt"))
    for line in marks[-1].read_text().split("\n")[3:5] if marks else []:
        _, name, size = line.split()
        if (out / name).stat().st_size != int(size):
            faults.append(f"{name} is not as the mark says")
        with h5py.File(out / name, "r") as file:
            if "program" not in file.attrs:
                faults.append(f"{name} is no checkpoint")
    return len(marks)


def struck(side, number, says):
    """A signal to the last rank of a side, once there is a checkpoint."""
    def run(folder):
        faults, job = [], start(folder)
        wait_for_mark(job, folder / "out")
        at = time.monotonic()
        for pid in pids_of(job, side)[-1:]:
            os.kill(pid, number)
        said, seconds = end_of(job, at, faults, SILENCE if number == signal.SIGSTOP else 0)
        if not look_at_checkpoint(folder / "out", faults):
            faults.append("no checkpoint")
        return faults, said, seconds, says
    return run


def leaders_stopped(folder):
    """Nobody is left who waits for the other program: the other ranks end by themselves."""
    short = 8  # s
    faults, job = [], start(folder, case={side: CASE.replace(f"silence_limit = {SILENCE}", f"silence_limit = {short}") for side in SIDES})
    wait_for_mark(job, folder / "out")
    at = time.monotonic()
    for side in SIDES:
        for pid in pids_of(job, side)[:1]:
            os.kill(pid, signal.SIGSTOP)
    said, seconds = end_of(job, at, faults, without_leaders(short))
    if seconds < -short:
        faults.append("ends too early")
    look_at_checkpoint(folder / "out", faults)
    return faults, said, seconds, r"three times the silence limit"


def given(side, says, code=None, words=None, change=None):
    """A program or case of one side that fails by itself: the seconds are those since the first of its error's lines."""
    def run(folder):
        faults, lines, told_at = [], [], None
        case = {name: CASE for name in SIDES}
        if change:
            case[side] = re.sub(*change, case[side])
            assert case[side] != CASE, change
        job = start(folder, {side: words} if words else None, case)
        over = threading.Timer(120, lambda: (faults.append("HANGS"), kill_all(job)))
        over.start()
        for line in job.stdout:
            lines.append(line)
            if told_at is None and "] error: " in line:
                told_at = time.monotonic()
        job.wait()
        over.cancel()
        seconds = time.monotonic() - told_at if told_at else float("nan")
        if seconds > LIMIT:
            faults.append(f"{seconds:.1f} s from the error to the end")
        if job.returncode == 0 or (code is not None and job.returncode != code):
            faults.append(f"exit code {job.returncode}, expected {code or 'not 0'}")
        time.sleep(0.1)
        faults += [f"process {pid} of {program} is still there" for program in SIDES for pid in pids_of(job, program)]
        look_at_checkpoint(folder / "out", faults)
        return faults, "".join(lines), seconds, says
    return run


def other(side):
    return SIDES[1 - SIDES.index(side)]


OUTSIDE = r"\[{}\] error: ended from outside"
TABLE = {}
for side in SIDES:
    TABLE[f"{side}: kill -9"] = struck(side, signal.SIGKILL, OUTSIDE.format(other(side)))
    TABLE[f"{side}: abort"] = struck(side, signal.SIGABRT, OUTSIDE.format(other(side)))
    TABLE[f"{side}: terminated"] = struck(side, signal.SIGTERM, r"ended from outside")
    TABLE[f"{side}: hangs"] = struck(side, signal.SIGSTOP, r"silence limit|has not taken a message|ended from outside")
    TABLE[f"{side}: disk full"] = given(side, r"error: .*(too large|[Nn]o space|[Nn]o room|cannot be written|writing|creating|flush)", words=[
        "bash", "-c", f"trap '' XFSZ; ulimit -f 400; exec {BUILD}/bin/{side} {side}.toml"])
    TABLE[f"{side}: missing executable"] = given(side, r"could not (find|access)|No such file|unable", words=[f"{BUILD}/bin/{side}_is_missing"])
    TABLE[f"{side}: exits at once"] = given(side, r"ended from outside|non-zero|exited", words=["bash", "-c", "exit 9"])
    TABLE[f"{side}: another reference pressure"] = given(side, r"reference pressure", 66, change=(r"\[coupling\]\n", "[coupling]\nreference_pressure = 2e5\n"))
    TABLE[f"{side}: another scheme"] = given(side, r"different coupling schemes", 66, change=(r"\[coupling\]\n", '[coupling]\nscheme = "box1"\n'))
TABLE["csd: wrong unit"] = given("csd", r"csd\.toml:\d+: .*density", 2, change=("density = 7760.0", 'density = "7760 kg/m^2"'))
TABLE["cfd: wrong unit"] = given("cfd", r"cfd\.toml:\d+: .*pressure", 2, change=(r"pressure = 101325\.0", 'pressure = "101325 m"'))
TABLE["csd: inverted element"] = given("csd", r"\[csd\] error: .*(inverted|not numbers)[\s\S]*\[cfd\] error: csd \(rank \d+\) FAILED", 3,
                                       change=('young_modulus = "206 GPa"', 'young_modulus = "2 Pa"'))
if max(RANKS) > 1:
    TABLE["both leaders hang"] = leaders_stopped


def table():
    failed = 0
    for name, run in TABLE.items():
        if options.only not in name:
            continue
        folder = WORK / f"failures_{options.ranks}"
        faults, said, seconds, says = run(folder)
        if not re.search(says, said):
            faults.append(f"nobody says '{says}'")
        failed += bool(faults)
        print(f"{'FAILED' if faults else 'ok':6} {options.ranks} {name:40} {seconds:5.2f} s  {'; '.join(faults)}" + (f"\n{said[-3000:]}" if faults else ""), flush=True)
    return failed


def fuzz():
    """Two accidents, of any kind and side, one after the other at random instants, from before the programs join or, in half of the runs, from the first checkpoint on."""
    failed, dice = 0, random.Random(options.seed)
    folder, slowest, with_marks, launcher_hung = WORK / f"failures_fuzz_{options.seed}", 0.0, 0, 0
    for number in range(options.fuzz):
        RANKS[:] = dice.choice([(1, 1), (2, 1), (1, 2), (2, 2)])
        faults, job = [], start(folder)
        if dice.random() < 0.5:
            wait_for_mark(job, folder / "out")
        plan = sorted((dice.uniform(0.0, 4.0), dice.choice(SIDES), dice.choice((signal.SIGKILL, signal.SIGABRT, signal.SIGTERM, signal.SIGSTOP, signal.SIGSEGV)))
                      for _ in range(2))
        began, done = time.monotonic(), []
        for at, side, what in plan:
            while job.poll() is None and time.monotonic() - began < at:
                time.sleep(0.005)
            pids = pids_of(job, side)
            if job.poll() is None and pids:
                try:
                    os.kill(dice.choice(pids), what)
                    done.append((round(time.monotonic() - began, 3), side, what.name))
                except ProcessLookupError:
                    pass
        if not done:  # nothing was there to be struck
            kill_all(job)
            job.communicate()
            continue
        stopped = {side for _, side, what in done if what == "SIGSTOP"}
        waits = (0, 1.25 * SILENCE + 5, without_leaders(SILENCE))[len(stopped)]  # one side: joining's, a little longer than a window's; both: no leader sees it
        left = [pid for program in SIDES for pid in pids_of(job, program)]
        if left and all(state_of(pid) == "T" for pid in left):  # nobody is left who could see it
            os.kill(left[-1], signal.SIGCONT)
        said, seconds = end_of(job, began + done[-1][0], faults, waits)
        if job.returncode == 0 and all(f"[{side}] finished" in said for side in SIDES):  # struck when both had said BYE
            faults.remove("exit code 0")
        launcher_hung += "mpirun hung" in said
        with_marks += look_at_checkpoint(folder / "out", faults) > 0
        slowest = max(slowest, seconds)
        failed += bool(faults)
        if faults or number % 20 == 19:
            print(f"{'FAILED' if faults else 'ok':6} run {number + 1}, {RANKS[0]}+{RANKS[1]}, {done}: {'; '.join(faults) or f'slowest end so far {slowest:.2f} s'}" + (f"\n{said[-3000:]}" if faults else ""), flush=True)
    print(f"{options.fuzz} runs, seed {options.seed}: {failed} failed; slowest end {slowest:.2f} s after the last accident; {with_marks} had a checkpoint; in {launcher_hung} "
          "mpirun itself hung")
    return failed


sys.exit((fuzz() if options.fuzz else table()) != 0)
