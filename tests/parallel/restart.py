#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""cfd killed and restarted, with other ranks and threads: the same bits, and no row of a table lost or doubled.
    restart.py BUILD_FOLDER"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parents[1] / "run"), str(HERE.parent / "regression"), str(HERE.parent / "coupled")]
os.environ["BREAKWAVE_BUILD"] = str(pathlib.Path(sys.argv[1]).resolve())
sys.argv = sys.argv[:2]
import runs  # noqa: E402
from fields import history  # noqa: E402
from launch import ENVIRONMENT  # noqa: E402
from verification.case import BUILD, WORK, output  # noqa: E402

# three materials, levels that change, a burn under way, a body that covers and uncovers cells, one that the flow moves, records of all kinds
CASE = ("[time]\nend = \"30 us\"\n" + output("5 us", "0 s") + "CHECKPOINT"
        + "[fluid]\nlower = [0, 0, 0]\nupper = [0.4, 0.2, 0.2]\ncells = [64, 32, 1]\n"
        + 'boundary = {x_upper = "outflow", y_upper = "outflow"}\n'
        + "[fluid.amr]\nlevels = 1\nblock = 8\nevery = 3\n"
        + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
        + '[[fluid.material]]\nname = "water"\nlibrary = "water"\n'
        + '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
        + '[[fluid.region]]\nshape = {kind = "half_space", point = [0, 0.05, 0], normal = [0, -1, 0]}\nmaterial = "water"\ndensity = 1000.0\npressure = 101325.0\n'
        + '[[fluid.region]]\nshape = {kind = "cylinder", start = [0.08, 0.06, -1], end = [0.08, 0.06, 1], radius = 0.04}\nmaterial = "TNT"\n'
        + 'unburnt = true\npressure = 101325.0\n[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0.08, 0.06, 0.1]]\n'
        + '[[fluid.body]]\nname = "plate"\nshape = {kind = "box", lower = [0.15, 0.03, -0.1], upper = [0.17, 0.1, 0.3]}\n'
        + 'motion = {kind = "velocity", value = [600.0, 0.0, 0.0]}\n'
        + '[[fluid.body]]\nname = "stone"\nturn_angle = 20.0\nturn_point = [0.08, 0.15, 0]\n'
        + 'shape = {kind = "box", lower = [0.06, 0.14, 0], upper = [0.1, 0.16, 0.2]}\nmotion = {kind = "free", density = 100.0, plane = true}\n'
        + '[[fluid.gauge]]\nname = "near"\nposition = [0.12, 0.07, 0.1]\n[[fluid.gauge]]\nname = "swept"\nposition = [0.178, 0.06, 0.1]\n'
        + '[[fluid.plane]]\nname = "cut"\nnormal = "y"\nat = 0.05\nevery = "4 us"\n[fluid.map]\ncells = [40, 20, 1]\n')


def start(folder, checkpoint, ranks=1, threads=1, arguments=()):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "case.toml").write_text(CASE.replace("CHECKPOINT", checkpoint))
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(BUILD / "bin" / "cfd"), "case.toml", *arguments]
    return subprocess.Popen(command, cwd=folder, env=ENVIRONMENT | {"OMP_NUM_THREADS": str(threads)}, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)


def finish(process, expect=0):
    text = process.communicate(timeout=600)[0]
    if process.returncode != expect:
        raise SystemExit(f"ended with {process.returncode}, not {expect}:\n{text[-2000:]}")
    return text


def wait_for(folder, count, process):
    """Until `count` checkpoints were begun; the run must still be under way."""
    seen, deadline = set(), time.monotonic() + 300
    while len(seen) < count and time.monotonic() < deadline and process.poll() is None:
        seen |= {path.name for path in (folder / "out").glob("fluid_checkpoint_*.h5")}
        time.sleep(0.005)
    return process.poll() is None


def same(base, folder, what, faults):
    different = runs.differences(base / "out", folder / "out") + runs.differences(folder / "out", base / "out")
    different = sorted({entry for entry in different if "checkpoint" not in entry})
    for name in ("fluid_gauges.json", "fluid.vtkhdf.series", "plane_cut.vtkhdf.series"):
        if (base / "out" / name).read_bytes() != (folder / "out" / name).read_bytes():
            different.append(name)
    print(f"{what}: {'the same bits' if not different else 'DIFFERENT: ' + ', '.join(different[:6])}", flush=True)
    faults += [what] if different else []


def main():
    root, faults = WORK / "restart", []
    shutil.rmtree(root, ignore_errors=True)
    base = root / "base"
    finish(start(base, ""))
    steps = len(history(base / "out" / "fluid_history.csv")["t"]) - 1

    for ranks, threads in ((2, 1), (1, 2)):  # killed without warning, as soon as its second checkpoint is there
        folder = root / f"killed_{ranks}_{threads}"
        process = start(folder, "[checkpoint]\nevery_steps = 17\nkeep = 2\n")
        alive = wait_for(folder, 2 if ranks == 2 else 3, process)
        process.send_signal(signal.SIGKILL)
        process.wait()
        text = finish(start(folder, "[checkpoint]\nevery = \"20 us\"\n", ranks, threads, ["--restart", "out"]))
        first = int(text.split("goes on from step ")[1].split(",")[0])
        print(f"killed {'under way' if alive else 'AFTER ITS END'} of {steps} steps, goes on from step {first} with {ranks} ranks of {threads} threads")
        faults += [] if alive and 0 < first < steps else ["the run was over before it could be killed"]
        same(base, folder, f"killed, then {ranks} ranks of {threads} threads", faults)

    folder = root / "signalled"  # asked for a checkpoint, on two ranks; goes on undisturbed; then from there on three
    process = start(folder, "", ranks=2)
    while not (folder / "out" / "fluid_history.csv").exists() and process.poll() is None:
        time.sleep(0.01)
    time.sleep(0.3)
    process.send_signal(signal.SIGUSR1)
    text = finish(process)
    faults += [] if "checkpoint at step" in text else ["USR1 wrote no checkpoint"]
    same(base, folder, "signalled, 2 ranks", faults)
    finish(start(folder, "", 3, 1, ["--restart", "out"]))
    same(base, folder, "from the signal's checkpoint, 3 ranks", faults)

    path = sorted((folder / "out").glob("fluid_checkpoint_*.h5"))[-1]
    process = start(folder, "[checkpoint]\nevery_steps = 0\n[fluid.scheme]\ncfl = 0.5\n", arguments=["--restart", str(path)])
    text = finish(process, expect=2)
    print("another case: " + text.strip().split("\n")[-1][:160])
    faults += [] if "another case" in text else ["another case was not refused as such"]
    print("\n".join(faults) or "all as it was")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
