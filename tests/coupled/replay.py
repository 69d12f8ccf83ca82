#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A pair that cracks is recorded; each program alone, on other ranks and threads, does the same to the last bit. Runs that died, records that don't
fit, other grids.
    replay.py BUILD_FOLDER FOLDER_FOR_RESULTS"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parents[1] / "run"), str(HERE.parent / "regression")]
BUILD, OUT = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
os.environ["BREAKWAVE_BUILD"] = str(BUILD)
sys.argv = sys.argv[:2]
import runs  # noqa: E402
import launch  # noqa: E402
from launch import ENVIRONMENT, history, mpirun, report  # noqa: E402

CSD, CFD = BUILD / "bin" / "csd", BUILD / "bin" / "cfd"
CASE = runs.SHELL.replace("cells = [48, 48, 48]", "cells = [24, 24, 24]").replace("around = 32", "around = 16").replace('end = "30 us"', 'end = "24 us"')
launch.work_in(OUT)


def case(name, *changes):
    text = CASE
    for old, new in changes:
        if old not in text:
            raise RuntimeError(f"{old} is not in the case")
        text = text.replace(old, new)
    pathlib.Path(f"{name}.toml").write_text(text, encoding="utf-8")
    return f"{name}.toml"


def replay(name, program, ranks, file, record, *words, threads=1, code=0, says=""):
    ENVIRONMENT["OMP_NUM_THREADS"] = str(threads)
    command = [program, file, "--replay", record, "--output", name.replace(" ", "_"), *words]
    if ranks > 1:
        ended, text = mpirun((ranks, *command))
    else:
        done = subprocess.run([str(w) for w in command], env=ENVIRONMENT, capture_output=True, text=True, timeout=60)
        ended, text = done.returncode, done.stdout + done.stderr
    ENVIRONMENT["OMP_NUM_THREADS"] = "1"
    fault = f"exit code {ended}, {code} was expected\n{text}" if ended != code else ""
    if not re.search(says, text):
        fault += f"'{says}' is not said\n{text}"
    return fault, pathlib.Path(name.replace(" ", "_"))


def same(name, program, ranks, threads):
    fault, folder = replay(name, program, ranks, case("case"), "out/record.h5", threads=threads, says="the recorded ones?, to the last bit")
    different = [] if fault else runs.differences(folder, OUT / "out")
    names = {path.name for path in folder.iterdir()}
    lacking = {"solid_000003.vtkhdf", "fragments.h5", "coupling_history.csv"} if program == CSD else {"fluid_000003.vtkhdf", "fluid_history.csv"}
    report(f"{name}: {len(names)} files", fault or "; ".join(different + sorted(lacking - names)))


def died():
    """The fluid is killed on the way: what it was asked last is in the record too."""
    words = ["mpirun", "-n", "1", CSD, case("long", ('directory = "out"', 'directory = "died"')), "--record", "died/record.h5", ":", "-n", "1", CFD, "long.toml"]
    pair = subprocess.Popen([str(w) for w in words], env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    while pair.poll() is None and not (pathlib.Path("died/record.h5").exists() and os.path.getsize("died/record.h5") > 1e6):
        time.sleep(0.01)
    members = subprocess.run(["ps", "-o", "pid=", "-g", str(pair.pid)], capture_output=True, text=True).stdout.split()
    for pid in members:
        os.kill(int(pid), signal.SIGKILL)
    pair.wait()
    fault, _ = replay("died_solid", CSD, 1, "long.toml", "died/record.h5", code=79, says=r"the record ends at t = .*before this run")
    report("a run that was killed, csd", fault)
    fault, folder = replay("died_fluid", CFD, 1, "long.toml", "died/record.h5", code=79, says=r"where its run broke off")
    report("a run that was killed, cfd", fault)
    fault, folder = replay("died_short", CSD, 1, "long.toml", "died/record.h5", "--end", "2 us", says="to the last bit|up to")
    report("the same to an earlier end", fault)


def gone_on():
    """A pair that goes on from a checkpoint goes on with its record, too."""
    rules = '[checkpoint]\nevery_steps = 15\n[[fluid.burn]]'
    file = case("part", ("[[fluid.burn]]", rules), ('directory = "out"', 'directory = "part"'))
    for words in ["--end", "10 us"], ["--restart", "part"]:
        code, text = mpirun((1, CSD, file, "--record", "part/record.h5", *words), (1, CFD, file, *words))
        if code != 0:
            return report("recorded in two parts", f"exit code {code}\n{text}")
    fault, folder = replay("parts", CSD, 1, "part.toml", "part/record.h5", says="(4[0-9]) windows; .* to the last bit")
    report("recorded in two parts", fault or "; ".join(d for d in runs.differences(folder, OUT / "out") if "fluid_" not in d))


code, text = mpirun((1, CSD, case("case"), "--record", "out/record.h5"), (1, CFD, "case.toml"))
opened = history("out/solid_history.csv")["opened_faces"][-1] if code == 0 else 0
report(f"recorded: {opened:.0f} faces open", f"exit code {code}\n{text}" if code != 0 else "" if opened > 20 else "nothing cracks")
same("csd", CSD, 1, 1)
same("csd 2 ranks 2 threads", CSD, 2, 2)
same("cfd", CFD, 1, 2)
same("cfd 2 ranks", CFD, 2, 1)
died()
gone_on()
for name, program, changes, wanted, says in (
        ("another mesh", CSD, [("around = 16", "around = 24")], 79, "wet surface has .* faces .* in the record"),
        ("other cracks", CSD, [("limit = 0.15", "limit = 0.1")], 79, "cracks that opened elsewhere"),
        ("far away", CFD, [("-160 mm", "1000 mm"), ('"160 mm"', '"1300 mm"')], 67, "outside the fluid's domain"),
        ("a stiffer case", CSD, [('hardening = "2.78 GPa"', 'hardening = "2.79 GPa"')], 0, "up to .* m from the recorded one"),
        ("another grid", CFD, [("cells = [24, 24, 24]", "cells = [32, 32, 32]")], 0, "not the recorded ones; in recorded windows")):
    report(name, replay(name, program, 1, case(name.replace(" ", "_"), *changes), "out/record.h5", *(["--end", "8 us"] if wanted == 0 else []), code=wanted, says=says)[0])
code, text = mpirun((1, CSD, "case.toml", "--replay", "out/record.h5"), (1, CFD, "case.toml"))
report("a replay of one beside the other", "" if code == 2 and "each program runs alone" in text else f"exit code {code}\n{text}")
sys.exit(launch.failed)
