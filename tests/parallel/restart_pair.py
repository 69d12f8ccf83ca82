#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The pair goes on from a checkpoint with the bits of the run that was never stopped: a shell full of explosive that cracks; with other threads and
ranks, killed at any instant, asked by a signal.
    restart_pair.py BUILD_FOLDER [from | killed | signal | refused ...] [--deaths N] [--seed N]
    restart_pair.py BUILD_FOLDER schemes   under other coupling schemes
    restart_pair.py BUILD_FOLDER weapon    from the middle of the small weapon's burn, of its cracks, of its flight"""
import os
import pathlib
import random
import re
import signal as signals
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE), str(HERE.parents[1] / "run"), str(HERE.parent / "regression"), str(HERE.parent / "coupled")]
os.environ["BREAKWAVE_BUILD"] = str(pathlib.Path(sys.argv[1]).resolve())


def option(name, default):
    if name not in sys.argv:
        return default
    at = sys.argv.index(name)
    value = int(sys.argv[at + 1])
    del sys.argv[at:at + 2]
    return value


DEATHS, SEED = option("--deaths", 3), option("--seed", os.getpid())
arguments = sys.argv[2:]
sys.argv = sys.argv[:2]
import runs  # noqa: E402
import weapon  # noqa: E402
from fields import history  # noqa: E402
from launch import ENVIRONMENT  # noqa: E402
from verification.case import BUILD, WORK  # noqa: E402

CASE = runs.SHELL.replace("cells = [48, 48, 48]", "cells = [32, 32, 32]").replace("around = 32", "around = 16")


def clean(name):
    out = WORK / name / "out"
    out.mkdir(parents=True, exist_ok=True)
    for path in out.iterdir():
        path.unlink()
    return out


def begin(name, text, ranks=(1, 1), threads=1, *words):
    """The pair in the folder of the case, which `clean` has made; a process group of its own."""
    folder = WORK / name
    (folder / "case.toml").write_text(text, encoding="utf-8")
    command = [str(HERE.parents[1] / "run" / "breakwave"), "case.toml", "--ranks", "+".join(map(str, ranks)), "--threads", str(threads), "--build", str(BUILD), "--", *words]
    return subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)


def finish(process, what, code=0):
    said = process.communicate(timeout=600)[0]
    if process.returncode != code:
        raise RuntimeError(f"{what}: exit code {process.returncode}\n{said}")
    return said


def marks(out):
    return sorted(out.glob("pair_checkpoint_*.txt"))


def whole(name="pair", text=CASE):
    out = clean(f"{name}_whole")
    started = time.monotonic()
    finish(begin(f"{name}_whole", text), "whole")
    solid = history(out / "solid_history.csv")
    if not solid["opened_faces"][-1] > 20:
        raise RuntimeError("nothing cracks")
    return out, time.monotonic() - started


def differ(one, two):
    return [d for d in runs.differences(one, two) if not d.startswith("coupling_history.csv:waited")]


def from_marks(name, text, choice):
    """From several windows of a run with many checkpoints, on other ranks and threads. choice: ((which mark, ranks, threads), ...)."""
    (first, _), faults = whole(name, text), []
    out = clean(f"{name}_from")
    finish(begin(f"{name}_from", text + '[checkpoint]\nevery = "4 us"\nkeep = 1000\n'), "from")
    different = differ(first, out)
    faults += [f"checkpoints change the results: {different[:8]}"] if different else []
    all_marks = marks(out)
    for at, ranks, threads in choice:
        mark = all_marks[at]
        begun = mark.read_text().split("\n")[2]
        finish(begin(f"{name}_from", text, ranks, threads, "--restart", str(mark)), f"from {mark.name}")
        different = differ(first, out)
        print(f"{name}: from {mark.name} of {len(all_marks)}, {begun}, {ranks[0]}+{ranks[1]} ranks x {threads}: {different[:8] or 'the same bits'}", flush=True)
        faults += [f"from {mark.name}: other bits"] if different else []
    return faults


def go_on():
    return from_marks("pair", CASE, ((1, (1, 1), 2), (3, (2, 1), 1), (4, (1, 2), 1), (-1, (1, 1), 1)))


def go_on_weapon():
    return from_marks("weapon", weapon.CASE, ((1, (1, 1), 2), (3, (2, 1), 1), (6, (1, 2), 1), (8, (2, 2), 1), (11, (1, 1), 1), (-1, (2, 2), 1)))


def go_on_schemes():
    faults = []
    for name, keys in {"concurrent": 'scheme = "concurrent"', "box1": 'scheme = "box1"', "window": 'window = "1 us"'}.items():
        faults += from_marks(f"pair_{name}", f"{CASE}[coupling]\n{keys}\n", ((1, (1, 1), 2), (4, (2, 1), 1), (-1, (1, 2), 1)))
    return faults


def kill(process, victim):
    """SIGKILL to one program (None: to all of the job, mpirun included)."""
    children = subprocess.run(["ps", "-o", "pid=,comm=", "-g", str(process.pid)], capture_output=True, text=True).stdout.split("\n")
    pids = [int(line.split()[0]) for line in children if line.strip() and line.split()[1] in (["csd", "cfd", "mpirun"] if victim is None else [victim])]
    for pid in pids:
        try:
            os.kill(pid, signals.SIGKILL)
        except ProcessLookupError:
            pass


def killed():
    """Killed at random instants, again and again from where it was: one program or the whole job."""
    (first, seconds), dice = whole(), random.Random(SEED)
    name, rules = "pair_killed", '[checkpoint]\nevery_steps = 5\n'
    out, deaths, tries, gone_on = clean(name), 0, 0, 0
    while deaths < DEATHS and tries < 3 * DEATHS:
        tries += 1
        words = ["--restart", "out"] if marks(out) else []
        gone_on += bool(words)
        process = begin(name, CASE + rules, (1, 1), 1, *words)
        try:
            process.wait(timeout=dice.uniform(0.05, 0.6 * seconds))
        except subprocess.TimeoutExpired:
            kill(process, dice.choice([None, "csd", "cfd"]))
            deaths += 1
        said = process.communicate()[0]
        if process.returncode == 0:  # it came to its end: from the start again
            different = differ(first, out)
            if different:
                return [f"killed, seed {SEED}: {different[:8]}"]
            clean(name)
        elif process.returncode in (1, 2, 66):
            return [f"killed, seed {SEED}: does not go on: {said[-2000:]}"]
    finish(begin(name, CASE + rules, (1, 1), 1, *(["--restart", "out"] if marks(out) else [])), name)
    different = differ(first, out)
    files = len(list(out.glob("*_checkpoint_*.h5")))
    print(f"killed {deaths} times, {gone_on} of {tries} starts went on from a checkpoint: {different[:8] or 'the same bits'}; {len(marks(out))} marks, {files} files")
    return ([f"killed, seed {SEED}: {different[:8]}"] if different else []) + ([] if files == 2 * len(marks(out)) == 4 else ["killed: checkpoints that no mark names stay"])


def signal():
    """USR1 to mpirun asks for a checkpoint of the pair, once."""
    out = clean("pair_signal")
    process = begin("pair_signal", CASE)
    while process.poll() is None and not (out / "fluid_history.csv").exists():
        time.sleep(0.02)
    time.sleep(0.3)
    process.send_signal(signals.SIGUSR1)
    said = finish(process, "signal")
    print(f"signal: {len(marks(out))} checkpoint, {re.findall('checkpoint of the pair .*', said)}")
    return [] if len(marks(out)) == 1 else ["signal: no checkpoint, or several"]


def refused():
    """Another case; no mark; a file that was cut short; one program from a checkpoint and the other from the start."""
    out, faults = clean("pair_refused"), []
    short = CASE.replace('end = "30 us"', 'end = "3 us"')
    finish(begin("pair_refused", short + "[checkpoint]\nevery_steps = 4\n"), "refused")
    mark = str(marks(out)[-1])
    folder = WORK / "pair_refused"
    programs = [["-n", "1", str(BUILD / "bin" / program), "case.toml"] for program in ("csd", "cfd")]
    (folder / "case.toml").write_text(short)
    for name, text, words, code, wanted in (("another case", CASE.replace("limit = 0.15", "limit = 0.16"), (["--restart", mark],) * 2, 2, "case"),
                                            ("no mark", CASE, (["--restart", "nowhere"],) * 2, 2, "nowhere"),
                                            ("one of the two", CASE, (["--restart", mark], []), 66, "goes on from window"),
                                            ("cut short", CASE, (["--restart", mark],) * 2, 2, "not there as it was written")):
        if name == "cut short":
            os.truncate(sorted(out.glob("fluid_checkpoint_*.h5"))[-1], 1000)
        (folder / "case.toml").write_text(text)
        done = subprocess.run(["mpirun", *programs[0], *words[0], ":", *programs[1], *words[1]], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=60)
        ok = done.returncode == code and wanted in done.stdout + done.stderr
        print(f"refused, {name}: exit code {done.returncode}")
        faults += [] if ok else [f"refused, {name}: exit code {done.returncode}: {done.stdout}{done.stderr}"]
    return faults


GROUPS = {"from": go_on, "killed": killed, "signal": signal, "refused": refused}
LONG = {"weapon": go_on_weapon, "schemes": go_on_schemes}

if __name__ == "__main__":
    failures = [fault for group in arguments or GROUPS for fault in (GROUPS | LONG)[group]()]
    print("\n".join(failures) or "all the same")
    sys.exit(1 if failures else 0)
