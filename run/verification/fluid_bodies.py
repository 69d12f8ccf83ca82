# SPDX-License-Identifier: Apache-2.0
"""Rigid bodies that the flow program moves by itself: a disc lifted by a shock, a piston driven by gas, bodies that nothing pushes."""
import csv
import math

import numpy as np

from . import reference
from .case import at_most, case, close, finest, output, run, unit_tests
from .coupled import piston
from .fluid import AIR_EOS, material, region, tube

import fields  # noqa: E402  (fluid.py adds the folder)

# VALIDATION.md C4 (ghost-cell MUSCL, h = 1/1000): t -> x, y
LIFTED = {0.14085: (0.3143, 0.0785), 0.255: (0.5320, 0.1170), 0.30: (0.6285, 0.1440)}
AFTER_SHOCK = (5.4, 2.2222222, 10.3333333)


def motion_of(directory, name):
    """The columns of fluid_body_<name>.csv by name without unit."""
    with open(directory / f"fluid_body_{name}.csv", newline="") as file:
        rows = list(csv.reader(file))
    return dict(zip((title.split(" [")[0] for title in rows[0]), np.array(rows[1:], dtype=float).T))


def lifted_disc(cells_a_unit, extra="", name="C4"):
    """A run of C4; motion of the disc and the run."""
    n, h = cells_a_unit, 1.0 / cells_a_unit
    text = ("[time]\nend = 0.30\n" + output("0.3 s", "0 s")
            + f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 0.2, {h!r}]\ncells = [{n}, {n // 5}, 1]\n"
            + 'boundary = {x_lower = "inflow", x_upper = "outflow"}\n' + extra
            + f'[[fluid.material]]\nname = "air"\n{AIR_EOS}\n'
            + region('{kind = "everywhere"}', "air", 1.4, 1.0)
            + region('{kind = "box", lower = [-1, -1, -1], upper = [0.08, 1, 1]}', "air", AFTER_SHOCK[0], AFTER_SHOCK[2], (AFTER_SHOCK[1], 0, 0))
            + f'[[fluid.inflow]]\nside = "x_lower"\nmaterial = "air"\ndensity = {AFTER_SHOCK[0]}\npressure = {AFTER_SHOCK[2]}\nvelocity = [{AFTER_SHOCK[1]}, 0, 0]\n'
            + '[coupling]\nreference_pressure = 1\n'
            + f'[[fluid.body]]\nname = "disc"\nshape = {{kind = "cylinder", start = [0.15, 0.05, 0], end = [0.15, 0.05, {h!r}], radius = 0.05}}\n'
            + 'motion = {kind = "free", density = 10.77, plane = true}\n')
    result = run(f"{name}_{n}", text, only="fluid")
    return motion_of(result.directory, "disc"), result


@case("C4")
def c4():
    """A disc lifted off the floor by a shock (Mach 3), moved by the flow program: places against a converged ghost-cell series, 250 and 500 cells (1000 with --all)"""
    for loads in ("pressure", "conservative"):
        for n in (250, 500, 1000) if finest() else (250, 500):
            motion, result = lifted_disc(n, f'[fluid.walls]\nloads = "{loads}"\n', f"C4_{loads}")
            for t, (x, y) in LIFTED.items():
                found = [float(np.interp(t, motion["t"], motion[f"centre {axis}"])) for axis in "xy"]
                yield close(f"{loads} loads, 1/{n}: x at {t:g}", found[0], x, 0.03, result.seconds if t == 0.30 else None)
                yield close(f"{loads} loads, 1/{n}: y at {t:g}", found[1], y, 0.08)


@case("C4b")
def c4b():
    """A free block that gas drives into vacuum, 1 and 10 kg/m2 (C1's exact simple wave, moved by the flow program alone), cells of 10 and 5 mm; bodies that nothing pushes"""
    wall, room = 4.0, 7.0
    for mass, times in ((1.0, (1e-4, 1e-3, 5e-3, 1e-2)), (10.0, (1e-3, 1e-2))):
        for h in (0.01, 0.005):
            text = tube(0.0, room, round(room / h), 0, ("wall", "wall"), times[-1], history_every=1e-4)
            text += material("air", reference.GAS) + region('{kind = "everywhere"}', "air", 1.225, 101325.0) + "[coupling]\nreference_pressure = 0\n"
            text += (f'[[fluid.body]]\nname = "block"\nfacet = 100.0\nshape = {{kind = "box", lower = [{wall}, 0, 0], upper = [{2 * room}, {h!r}, {h!r}]}}\n'
                     f'motion = {{kind = "free", mass = {mass * h * h!r}, fixed = ["y", "z", "turn_x", "turn_y", "turn_z"]}}\n')
            result = run(f"C4b_{mass:g}_{h:g}", text, only="fluid")
            motion = motion_of(result.directory, "block")
            for t in times:
                u, x, p = reference.free_piston(t, mass)
                name = f"{mass:g} kg/m2, {1e3 * h:g} mm, {1e3 * t:g} ms"
                yield close(f"{name}: velocity", np.interp(t, motion["t"], motion["velocity x"]), u, 0.005, result.seconds if t == times[-1] else None)
                way = np.interp(t, motion["t"], motion["centre x"]) - motion["centre x"][0]
                yield close(f"{name}: way", way, x, 0.005)
            yield close(f"{mass:g} kg/m2, {1e3 * h:g} mm: work of the gas against the kinetic energy", motion["work"][-1], motion["kinetic energy"][-1], 0.01)
    yield from light_plates()
    yield from unpushed()


def light_plates():
    """Plates far lighter than the gas that they move, between 10 and 1 bar: they go with the gas between the shock and the fan that they don't hold back."""
    n, t = 200, 2e-4
    u = reference.Riemann((12.25, 0, 1013250.0), (1.225, 0, 101325.0), reference.GAS).u
    for treatment in ("half_riemann", "cut_cell"):
        for mass in (0.01, 0.001):
            text = tube(0.0, 1.0, n, 0, ("wall", "wall"), t, f'[fluid.walls]\ntreatment = "{treatment}"\n') + material("air", reference.GAS)
            text += region('{kind = "everywhere"}', "air", 1.225, 101325.0) + region('{kind = "half_space", point = [0.42, 0, 0], normal = [-1, 0, 0]}', "air", 12.25, 1013250.0)
            text += (f'[[fluid.body]]\nname = "plate"\nshape = {{kind = "box", lower = [0.4, 0, 0], upper = [0.45, {1 / n!r}, {1 / n!r}]}}\n'
                     f'motion = {{kind = "free", mass = {mass / n ** 2!r}, fixed = ["y", "z", "turn_x", "turn_y", "turn_z"]}}\n')
            result = run(f"C4b_light_{treatment}_{mass:g}", text, only="fluid")
            yield close(f"{treatment}: plate of {mass:g} kg/m2 between 10 and 1 bar, velocity after 0.2 ms", motion_of(result.directory, "plate")["velocity x"][-1], u, 0.01, result.seconds)


def unpushed(extra="", note=""):
    """A turned box in gas that moves with it: velocity, spin and place after 40 steps."""
    for name, velocity in (("at rest", (0.0, 0.0, 0.0)), ("moving", (100.0, 50.0, 20.0))):
        boundary = ", ".join(f'{axis}_{side} = "periodic"' for axis in "xyz" for side in ("lower", "upper"))
        text = ("[time]\nend = 1\nmax_steps = 40\n" + output("0 s", "0 s") + "[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = [24, 24, 24]\n"
                + f"boundary = {{{boundary}}}\n" + extra + material("air", reference.GAS)
                + region('{kind = "everywhere"}', "air", 1.225, 101325.0, velocity)
                + '[[fluid.body]]\nname = "box"\nturn_angle = 30.0\nturn_axis = [1, 2, 3]\nturn_point = [0.5, 0.5, 0.5]\n'
                + 'shape = {kind = "box", lower = [0.3, 0.35, 0.4], upper = [0.7, 0.6, 0.65]}\n'
                + f'motion = {{kind = "free", density = 100.0, velocity = {list(velocity)}}}\n')
        result = run(f"C4b_{name}{note}", text, only="fluid")
        motion = motion_of(result.directory, "box")
        push = max(np.abs(motion[f"force {axis}"]).max() for axis in "xyz") / (101325.0 * 0.4 * 0.25)
        twist = max(np.abs(motion[f"moment {axis}"]).max() for axis in "xyz") / (101325.0 * 0.4 * 0.25 * 0.4)
        change = max(np.abs(motion[f"velocity {axis}"] - v).max() for axis, v in zip("xyz", velocity)) / math.sqrt(1.4 * 101325 / 1.225)
        yield at_most(f"box {name}{note}: force over p A", push, 1e-12, result.seconds)
        yield at_most(f"box {name}{note}: moment over p A l", twist, 1e-12)
        yield at_most(f"box {name}{note}: change of velocity over the speed of sound", change, 1e-12)


CONSERVATIVE = '[fluid.walls]\nloads = "conservative"\n'


@case("C11b")
def c11b():
    """Conservative loads (loads = "conservative"): momentum of a closed box of gas and what faces got, a fixed and a free body under a shock; bodies that nothing pushes; noise"""
    n = 48
    for name, motion in (("fixed", '{kind = "fixed"}'), ("free", '{kind = "free", density = 20.0, spin = [0.0, 0.0, 300.0]}')):
        for loads in ("pressure", "conservative"):
            text = ("[time]\nend = 1.5e-3\n" + output("0 s", "0 s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = [{n}, {n}, {n // 2}]\n"
                    + f'[fluid.walls]\nloads = "{loads}"\n' + material("air", reference.GAS)
                    + region('{kind = "everywhere"}', "air", 1.225, 101325.0)
                    + region('{kind = "half_space", point = [0.25, 0, 0], normal = [-1, 0, 0]}', "air", 6.0, 1013250.0)
                    + f'[[fluid.body]]\nname = "box"\nturn_angle = 30.0\nturn_axis = [1, 2, 3]\nturn_point = [0.5, 0.5, 0.5]\nmotion = {motion}\n'
                    + 'shape = {kind = "box", lower = [0.4, 0.35, 0.4], upper = [0.6, 0.65, 0.65]}\n')
            result = run(f"C11b_{name}_{loads}", text, only="fluid")
            table = fields.history(result.directory / "fluid_history.csv")
            booked, given = 0.0, 0.0
            for axis in "xyz":
                rest = table[f"momentum {axis}"] + table[f"outflow momentum {axis}"] - table[f"swept momentum {axis}"]
                booked = max(booked, np.abs(rest + table[f"wall impulse {axis}"] - rest[0]).max())
                given = max(given, np.abs(rest + table[f"face impulse {axis}"] - rest[0]).max())
            scale = 1013250.0 * 1.5e-3  # p A t of the gas at high pressure on its side of the box; the table has 12 digits
            kind = "pressures at the faces" if loads == "pressure" else "conservative"
            exact = loads == "conservative" and name == "fixed"
            yield at_most(f"{name} body, {kind}: gas, sides, links, swept cells: change of the sum over p A t", booked / scale, 1e-12, result.seconds)
            yield at_most(f"{name} body, {kind}: the same by what the faces got", given / scale, 1e-12 if exact else 5e-3)
    yield from unpushed(CONSERVATIVE, " (conservative)")
    u = reference.free_piston(1e-3, 1.0)[0]
    result = run("C11b_pair", piston("fluid_first", 10.0) + CONSERVATIVE)
    found = fields.history(result.directory / "solid_history.csv")["momentum x"][-1] / (1.0 * 0.01 ** 2)
    yield close("pair, C1's piston by conservative loads: u at 1 ms", found, u, 0.005, result.seconds)
    yield at_most("pair: impulse defect of any window", np.abs(fields.history(result.directory / "coupling_history.csv")["impulse_defect"]).max(), 1e-12)
    for size, value in unit_tests("cfd", "EmbedWalls.ConservativeLoads")["EmbedWalls.ConservativeLoads"][1].items():
        yield at_most(f"sphere in gas at rest: rms noise of the force on a face over p A, {size.replace('_', ' ')}", float(value), 3.0)
