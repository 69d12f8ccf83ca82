#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""cfd with blocks of three levels, and with cut cells, on 1, 2 and 3 ranks and 1 and 2 threads: the same bits in all fields and histories; cut cells also after a restart.
    cfd.py BUILD_FOLDER"""
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parents[1] / "run"), str(HERE.parents[1] / "tests" / "regression"), str(HERE.parent / "coupled")]
os.environ["BREAKWAVE_BUILD"] = str(pathlib.Path(sys.argv[1]).resolve())
sys.argv = sys.argv[:2]  # the regression runs, whose shell is used here, read theirs
import runs  # noqa: E402
from fields import history  # noqa: E402
from launch import ENVIRONMENT  # noqa: E402
from verification.case import BUILD, output, run  # noqa: E402

# a charge off every plane of symmetry beside a plate that flies: levels by flow, burn and wall, moved over the ranks
CHARGE = ("[time]\nend = \"24 us\"\n" + output("8 us", "1 us")
          + "[fluid]\nlower = [0, 0, 0]\nupper = [0.4, 0.2, 0.2]\ncells = [32, 16, 16]\n"
          + 'boundary = {x_upper = "outflow", y_upper = "outflow", z_upper = "outflow"}\n'
          + "[fluid.amr]\nlevels = 2\nblock = 8\nevery = 3\n"
          + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
          + '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
          + '[[fluid.region]]\nshape = {kind = "sphere", centre = [0.07, 0.05, 0.06], radius = 0.03}\nmaterial = "TNT"\nunburnt = true\npressure = 101325.0\n'
          + '[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0.07, 0.05, 0.06]]\n'
          + '[[fluid.body]]\nname = "plate"\nshape = {kind = "box", lower = [0.15, 0.03, 0.02], upper = [0.17, 0.1, 0.12]}\n'
          + 'motion = {kind = "velocity", value = [300.0, 0.0, 0.0]}\n'
          + '[[fluid.gauge]]\nname = "near"\nposition = [0.101, 0.05, 0.06]\n[[fluid.gauge]]\nname = "corner"\nposition = [0.1, 0, 0]\n'
          + '[[fluid.plane]]\nname = "cut"\nnormal = "z"\nat = 0.05\nevery = "6 us"\ncells = [40, 20]\n[fluid.map]\n')
# a box that turns behind a blast, across blocks and a periodic side; one checkpoint on the way
CUT = ("[time]\nend = \"1 ms\"\nLIMIT" + output("0.5 ms", "0 s") + '[checkpoint]\nevery_steps = 20\n'
       + "[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 0.03125]\ncells = [32, 32, 1]\n"
       + 'boundary = {y_lower = "periodic", y_upper = "periodic"}\n[fluid.amr]\nlevels = 1\nblock = 8\nevery = 3\n[fluid.walls]\ntreatment = "cut_cell"\n'
       + '[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
       + '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
       + '[[fluid.region]]\nshape = {kind = "cylinder", start = [0.2, 0.6, -1], end = [0.2, 0.6, 1], radius = 0.12}\nmaterial = "air"\ndensity = 5.0\npressure = 1e6\n'
       + '[[fluid.body]]\nname = "box"\nshape = {kind = "prism", points = [[0.4, 0.3, 0], [0.7, 0.3, 0], [0.7, 0.55, 0], [0.4, 0.55, 0]]}\n'
       + 'motion = {kind = "rotation", point = [0.5, 0.4, 0], axis = [0, 0, 1], rate = 500.0, velocity = [80.0, -90.0, 0.0]}\n')
LAYOUTS = [("1", 1), ("1", 2), ("2", 1), ("3", 1)]


def alike(name, text, faults):
    """The first layout's folder; differences of the others join the faults."""
    base = None
    for ranks, threads in LAYOUTS:
        result = run(f"parallel_{name}_{ranks}_{threads}", text, only="fluid", ranks=ranks, threads=threads)
        base = base or result.directory
        different = runs.differences(base, result.directory)
        print(f"{name}, {ranks} ranks of {threads} threads: {'the same bits' if not different else 'DIFFERENT: ' + ', '.join(different[:6])}")
        faults += different
    return base


def stopped(base, faults):
    """The cut cells' run stopped on the way, and on again on two ranks."""
    folder = run("parallel_cut_stopped", CUT.replace("LIMIT", "max_steps = 23\n"), only="fluid", ranks="1").directory.parent
    (folder / "case.toml").write_text(CUT.replace("LIMIT", ""))
    subprocess.run(["mpirun", "-n", "2", str(BUILD / "bin" / "cfd"), "case.toml", "--restart", "out"], cwd=folder, env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL)
    different = [entry for entry in runs.differences(base, folder / "out") if "checkpoint" not in entry]
    print(f"cut, stopped and on again: {'the same bits' if not different else 'DIFFERENT: ' + ', '.join(different[:6])}")
    faults += different


def main():
    faults = []
    stopped(alike("cut", CUT.replace("LIMIT", ""), faults), faults)
    base = alike("cfd", CHARGE, faults)
    table = history(base / "fluid_history.csv")
    moved = len(set(table["active_share"])) > 3
    print("the grid changed" if moved else "the grid never changed: this shows nothing")
    return 1 if faults or not moved else 0


if __name__ == "__main__":
    sys.exit(main())
