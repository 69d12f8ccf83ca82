#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Small runs of the real programs: the same bits with 1 and 2 threads, a coupled burst from end to end, a few golden numbers.
    runs.py BUILD_FOLDER [solid | fluid | coupled ...]
    runs.py BUILD_FOLDER --accept     writes golden.json anew"""
import json
import pathlib
import sys

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "run"))
arguments = sys.argv[1:]
BUILD = pathlib.Path(arguments.pop(0)).resolve()
import os  # noqa: E402

os.environ["BREAKWAVE_BUILD"] = str(BUILD)
import fields  # noqa: E402
from verification import solid  # noqa: E402
from verification.case import output, run  # noqa: E402

GOLDEN = HERE / "golden.json"
TOLERANCE = 1e-7  # smooth runs: what compilers and vector widths may change

BAR = ("[time]\nend = \"10 us\"\n" + output("10 us", "1 us")
       + '[[solid.body]]\nname = "bar"\nmesh = {kind = "cylinder", radius = "3.2 mm", length = "32.4 mm", across = 3, along = 24}\n'
       + 'velocity = [0.0, 0.0, "-227 m/s"]\n' + solid.COPPER
       + '[[solid.condition]]\nkind = "rigid_wall"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n'
       + '[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\n')
BLAST = ("[time]\nend = \"20 us\"\n" + output("20 us", "1 us")
         + "[fluid]\nlower = [0, 0, 0]\nupper = [0.2, 0.2, 0.2]\ncells = [32, 32, 32]\n"
         + 'boundary = {x_upper = "outflow", y_upper = "outflow", z_upper = "outflow"}\n'
         + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
         + '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
         + '[[fluid.region]]\nshape = {kind = "sphere", centre = [0.0, 0.0, 0.0], radius = 0.06}\nmaterial = "TNT"\nunburnt = true\npressure = 101325.0\n'
         + '[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0.0, 0.0, 0.0]]\n')
SHELL = ("[time]\nend = \"30 us\"\n" + output("10 us", "1 us")
         + '[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\n[solid.fracture]\ncriterion = {kind = "eqps", limit = 0.15}\n'
         + '[[solid.body]]\nname = "shell"\nmesh = {kind = "shell_of_revolution", shape = "sphere", radius = "62 mm", wall = "6 mm", around = 32, through = 2}\n'
         + '[solid.body.material]\nkind = "j2"\ndensity = 7760.0\nyoung_modulus = "206 GPa"\npoisson_ratio = 0.3\n'
         + 'flow = {kind = "linear", yield_stress = "412 MPa", hardening = "2.78 GPa"}\n'
         + '[fluid]\nlower = ["-160 mm", "-160 mm", "-160 mm"]\nupper = ["160 mm", "160 mm", "160 mm"]\ncells = [48, 48, 48]\n'
         + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
         + '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
         + '[[fluid.region]]\nshape = {kind = "cavity", seed = [0.001, 0.001, 0.001]}\nmaterial = "TNT"\nunburnt = true\npressure = 101325.0\n'
         + '[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0.001, 0.001, 0.001]]\n')
CASES = {"solid": (BAR, "solid"), "fluid": (BLAST, "fluid"), "coupled": (SHELL, None)}


def datasets(path):
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None)
    return found


def differences(one, two):
    """Names of files or datasets of the two folders that are not equal bit for bit; timings left out."""
    different = []
    for path in sorted(one.iterdir()):
        other = two / path.name
        if not other.exists():
            different.append(f"{path.name} is missing")
        elif path.suffix == ".vtkhdf":
            a, b = datasets(path), datasets(other)
            different += [f"{path.name}:{name}" for name in sorted(set(a) | set(b))
                          if name not in a or name not in b or a[name].tobytes() != b[name].tobytes()]
        elif path.suffix == ".csv":
            a, b = fields.history(path), fields.history(other)
            timing = ("wait", "wall", "cpu", "rate", "per_second", "per second", "elem/s", "cells/s")
            different += [f"{path.name}:{name}" for name in a
                          if not any(word in name.lower() for word in timing) and not np.array_equal(a[name], b.get(name), equal_nan=a[name].dtype.kind == "f")]
    return different


def measures(name, directory):
    """A few numbers of the run."""
    values = {}
    if name in ("solid", "coupled"):
        last = fields.Solid(fields.series(directory, "solid")[-1][1])
        values |= {"solid x max": last.points.max(), "solid |x| sum": np.abs(last.points).sum(), "eqps max": last.cell["eqps"].max()}
    if name == "fluid":
        last = fields.Fluid(fields.series(directory, "fluid")[-1][1])
        pressure = last.array("pressure")
        values |= {"pressure max": np.nanmax(pressure), "pressure mean": np.nanmean(pressure), "density mean": np.nanmean(last.array("density"))}
    return {key: float(value) for key, value in values.items()}


def main():
    accept = "--accept" in arguments
    names = [argument for argument in arguments if argument in CASES] or list(CASES)
    golden = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {}
    faults = []
    for name in names:
        text, only = CASES[name]
        folders = [run(f"regression_{name}_{threads}", text, threads=threads, only=only).directory for threads in (1, 2)]
        different = differences(*folders)
        print(f"{name}: 1 against 2 threads: {'the same bits' if not different else 'DIFFERENT: ' + ', '.join(different[:6])}")
        faults += [f"{name}: threads change the result"] if different else []
        if name == "coupled":
            table = fields.history(folders[0] / "coupling_history.csv")
            defect = np.nanmax(np.abs(table["impulse_defect"]))
            print(f"coupled: {len(table['window'])} windows, impulse defect {defect:.2g} of the exchanged impulse")
            faults += ["coupled: impulse lost"] if not defect <= 1e-12 else []
            continue  # cracks are thresholds: no golden numbers
        values = measures(name, folders[0])
        for key, value in values.items():
            reference = golden.get(name, {}).get(key)
            if accept:
                golden.setdefault(name, {})[key] = value
            elif reference is None:
                faults.append(f"{name}: no golden number '{key}'")
            elif abs(value - reference) > TOLERANCE * abs(reference):
                faults.append(f"{name}: {key} = {value!r}, golden {reference!r}")
        print(f"{name}: " + ", ".join(f"{key} {value:.9g}" for key, value in values.items()))
    if accept:
        GOLDEN.write_text(json.dumps(golden, indent=1) + "\n")
    print("\n".join(faults) or "all as it was")
    return 1 if faults and not accept else 0


if __name__ == "__main__":
    sys.exit(main())
