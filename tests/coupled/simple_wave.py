#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The real csd with a piston of 1 kg/m^2 against an exact fluid (simple_wave.cpp): VALIDATION C1 and the order of both schemes in time.

simple_wave.py <folder of executables> <folder for results>
"""
import csv
import math
import os
import subprocess
import sys

from launch import ENVIRONMENT

FOLDER, OUT = sys.argv[1:3]
CASE = """
[time]
end = "1 ms"
[output]
directory = "{out}"
[[solid.body]]
name = "piston"
mesh = {{kind = "box", lower = [0, 0, 0], upper = ["10 mm", "10 mm", "10 mm"], cells = [1, 1, 1]}}
material = {{kind = "neo_hooke", density = 100, young_modulus = "1 GPa", poisson_ratio = 0.0}}
{rollers}
[solid.wet]
faces = ["x_lower"]
[coupling]
scheme = "{scheme}"
reference_pressure = 0
"""
ROLLERS = "\n".join(f'[[solid.condition]]\nkind = "roller"\nnodes = "{axis}_{end}"\nnormal = {normal}'
                    for axis, normal in (("y", [0, 1, 0]), ("z", [0, 0, 1])) for end in ("lower", "upper"))
AREA, MASS_PER_AREA, P0, RHO0, GAMMA = 1e-4, 1.0, 101325.0, 1.225, 1.4


def exact_velocity(t):
    c0 = math.sqrt(GAMMA * P0 / RHO0)
    y = (1 + (GAMMA + 1) / 2 * P0 * t / (MASS_PER_AREA * c0)) ** (-(GAMMA - 1) / (GAMMA + 1))
    return 2 * c0 / (GAMMA - 1) * (1 - y)


def table(name):
    with open(name) as file:
        rows = list(csv.reader(file))
    return [dict(zip(rows[0], map(float, row))) for row in rows[1:]]


def start(out, scheme, window, *changes, pressure=0):
    """The finished pair; `changes`: texts of the case that are replaced; pressure: the reference."""
    os.makedirs(out, exist_ok=True)
    text = CASE.format(out=out, scheme=scheme, rollers=ROLLERS)
    for change in changes:
        text = text.replace(*change)
    with open(f"{out}/case.toml", "w") as file:
        file.write(text)
    command = f"mpirun -n 1 {FOLDER}/csd {out}/case.toml : -n 1 {FOLDER}/coupled_simple_wave {scheme} {window} {pressure}"
    return subprocess.run(command.split(), env=ENVIRONMENT, capture_output=True, text=True, timeout=60)


def run(scheme, window):
    """Error of the piston's momentum at 1 ms; its ledger must close."""
    out = f"{OUT}/{scheme}_{window:g}"
    done = start(out, scheme, window)
    if done.returncode != 0:
        sys.exit(f"{scheme} {window}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    solid, ledger = table(f"{out}/solid_history.csv"), table(f"{out}/coupling_history.csv")
    if max(row["impulse_defect [1]"] for row in ledger) > 1e-12:
        sys.exit(f"{scheme} {window}: the ledger does not close")
    got = sum(row["impulse_x [N s]"] for row in ledger)
    momentum = solid[-1]["momentum x [kg m/s]"]
    advance = ledger[-1]["advance_x [N s]"]  # of the last window, not given back any more
    if abs(got + advance - momentum) > 1e-9 * got:
        sys.exit(f"{scheme} {window}: impulse received {got}, in advance {advance}, momentum {momentum}")
    u = momentum / (MASS_PER_AREA * AREA)
    return u / exact_velocity(1e-3) - 1


failed = False
# fluid_first: what is left is the piston's own elasticity, 1e-5, whatever the window
for scheme, order_wanted, coarsest_wanted in ("fluid_first", None, 1e-4), ("box1", 0.9, 2e-2):
    errors = [run(scheme, window) for window in (8e-5, 4e-5, 2e-5)]
    order = math.log2(abs(errors[0] / errors[-1])) / 2
    bad = abs(errors[0]) > coarsest_wanted or (order_wanted is not None and order < order_wanted)
    failed |= bad
    print(f"{'FAILED' if bad else 'ok':6} {scheme:12} errors of u(1 ms): {', '.join(f'{e:+.2e}' for e in errors)}; order {order:.2f}")
# slabs of 0.1 kg/m^2 before gas at rest, so soft that their thickness mode (period: a multiple of the window) is aliased by windows of 20 us: after
# 10 ms, 40 times m/(rho c), nothing moves any more
SPEED = 0.1
for scheme, radiation in ("fluid_first", "auto"), ("box1", "always"):
    for ratio in 1.8, 2.0:
        mass, out = 0.1, f"{OUT}/soft_{scheme}_{ratio}"
        young = (2 * math.pi / (ratio * 2e-5)) ** 2 * mass * 10e-3 / 4
        done = start(out, scheme, 2e-5, ("density = 100, young_modulus = \"1 GPa\", poisson_ratio = 0.0}",
                                         f"density = {mass / 10e-3!r}, young_modulus = {young!r}, poisson_ratio = 0.0}}\nvelocity = [{SPEED}, 0, 0]"),
                     ('end = "1 ms"', 'end = "10 ms"'), ("reference_pressure = 0", f'reference_pressure = {P0}\nradiation = "{radiation}"'), pressure=P0)
        rows = table(f"{out}/solid_history.csv") if done.returncode == 0 else []
        energy = [row["kinetic_energy [J]"] + row["elastic_energy [J]"] for row in rows]
        bad = not energy or not energy[-1] < 1e-6 * energy[0]
        failed |= bad
        print(f"{'FAILED' if bad else 'ok':6} {scheme:12} soft slab, {ratio} windows a period: energy {energy[-1] / energy[0] if energy else math.nan:.1e} of the first")
# both programs end with csd's reason and code
for name, change, code, words in (
        ("wrong_key", ("neo_hooke", "neo_hook"), 2, ["case.toml:9", "[gas] error: ended from outside"]),
        ("inverted", ('young_modulus = "1 GPa"', "young_modulus = 1"), 3, ["[csd] error: element 0", "[gas] error: csd (rank 0) FAILED in window"])):
    done = start(f"{OUT}/{name}", "fluid_first", 2e-5, change)
    text = done.stdout + done.stderr
    missing = [w for w in words if w not in text]
    bad = done.returncode != code or bool(missing)
    failed |= bad
    print(f"{'FAILED' if bad else 'ok':6} {name}: exit code {done.returncode}" + (f"; not said: {missing}\n{text}" if bad else ""))
sys.exit(failed)
