# SPDX-License-Identifier: Apache-2.0
"""F13 (c), T8, T9: boxes of no thickness that hold 100 bar, at rest and tumbling; degenerate surfaces; bodies that leave, overlap or are smaller
than a cell."""
import numpy as np

import fields

from . import reference
from .case import at_least, at_most, case, output, run, unit_rows
from .fluid import material, region


def vessel(name, n, motion, end, steps, size, turn, p_in=1e7, every="0"):
    """A closed thin box, turned, with its own gas at p_in in gas at 1 bar; n cells a metre."""
    depth = size[2] if len(size) > 2 else 1 / n
    upper = [size[0], size[1], depth]
    cells = [round(size[0] * n), round(size[1] * n), round(depth * n)]
    centre = [0.4, 0.45, 0.5 * depth]
    low = [centre[0] - 0.21, centre[1] - 0.17, centre[2] - 0.19 if depth > 0.1 else -1.0]
    high = [centre[0] + 0.21, centre[1] + 0.17, centre[2] + 0.19 if depth > 0.1 else 1.0]
    text = f"[time]\nend = {end!r}\nmax_steps = {steps}\n" + output(f"{end!r} s", f"{every} s")
    text += f"[fluid]\nlower = [0, 0, 0]\nupper = {upper}\ncells = {cells}\n"
    text += material("inside", reference.GAS) + material("outside", reference.GAS)
    text += region('{kind = "everywhere"}', "outside", 1.2, 1e5) + region(f'{{kind = "cavity", seed = {centre}}}', "inside", 1.2 * p_in / 1e5, p_in)
    text += (f'[[fluid.body]]\nname = "vessel"\nthin = true\nshape = {{kind = "box", lower = {low}, upper = {high}}}\nturn_angle = {turn[0]}\n'
             f'turn_axis = {list(turn[1])}\nturn_point = {centre}\n{motion}\n')
    result = run(f"F13c_{name}", text, only="fluid")
    return fields.Fluid(fields.series(result.directory, "fluid")[-1][1]), fields.history(result.directory / "fluid_history.csv"), centre, low, high, result


@case("F13c")
def f13c():
    """A closed box of no thickness, inclined, with 100 bar inside and 1 bar outside: 10,000 steps at rest; driven and spun through the gas"""
    for name, size, turn in (("2-D, 33 deg", (1.0, 1.0), (33.0, (0.0, 0.0, 1.0))), ("3-D, 40 deg about (1, 2, 3)", (0.8, 0.9, 0.8), (40.0, (1.0, 2.0, 3.0)))):
        n = 40 if len(size) == 2 else 20
        flow, history, *_, result = vessel(f"rest_{len(size)}", n, 'motion = {kind = "fixed"}', 10.0, 10000, size, turn, every="0.01")
        for gas in ("inside", "outside"):
            mass = history[f"mass {gas}"]
            yield at_most(f"{name}, at rest, {int(history['step'][-1])} steps: change of the mass {gas}", abs(mass[-1] / mass[0] - 1), 1e-12, result.seconds)
        p = flow.array("pressure")
        yield at_most(f"{name}: largest relative change of the pressure", np.minimum(np.abs(p / 1e5 - 1), np.abs(p / 1e7 - 1)).max(), 1e-12)
    for name, size, turn in (("2-D", (1.6, 1.2), (33.0, (0.0, 0.0, 1.0))), ("3-D", (1.2, 1.0, 0.9), (40.0, (1.0, 2.0, 3.0)))):
        n = 40 if len(size) == 2 else 20
        depth = size[2] if len(size) == 3 else 1 / n
        axis = (0.0, 0.0, 1.0) if len(size) == 2 else (0.6, 0.0, 0.8)
        motion = f'motion = {{kind = "rotation", point = [0.4, 0.45, {0.5 * depth!r}], axis = {list(axis)}, rate = 400.0, velocity = [150.0, 60.0, 0.0]}}'
        end = 2.0e-3
        flow, history, centre, low, high, result = vessel(f"moving_{len(size)}", n, motion, end, 100000, size, turn, 1e7)
        alpha = flow.array("alpha_inside")
        x = np.stack(np.meshgrid(*(flow.centres(d) for d in range(3)), indexing="ij"), axis=-1)
        # back to where the box was made: its motion undone, then its turn
        at = np.array([centre[0] + 150.0 * end, centre[1] + 60.0 * end, centre[2]])
        local = rotate(rotate(x - at, axis, -400.0 * end), turn[1], -np.radians(turn[0]))
        half = 0.5 * (np.array(high) - np.array(low))
        depth_in = (half - np.abs(local)).min(axis=-1)
        inner, outer = depth_in > 1e-9, depth_in < -1e-9
        steps = int(history["step"][-1])
        yield at_most(f"{name}, driven and spun, {steps} steps: its gas in cells outside (part)", np.abs(alpha[outer]).max(), 0.0, result.seconds)
        yield at_most(f"{name}: other gas in cells inside (part)", np.abs(1 - alpha[inner]).max(), 0.0)
        yield at_least(f"{name}: cells that changed sides", history["cells fresh"][-1], 100)
        change = history["mass inside"][-1] / history["mass inside"][0] - 1
        yield at_most(f"{name}: change of the mass inside, which covered and uncovered cells make (booked)", abs(change), 0.05)


def rotate(x, axis, angle):
    a = np.array(axis) / np.linalg.norm(axis)
    c, s = np.cos(angle), np.sin(angle)
    return c * x + s * np.cross(a, x) + (1 - c) * (x @ a)[..., None] * a


@case("T9")
def t9():
    """Bodies that leave the domain, overlap and come apart, or are smaller than a cell: bounds of the pressure, loads that end, mass"""
    n, p0, speed = 32, 101325.0, 300.0

    def bodies(*shapes):
        return "".join(f'[[fluid.body]]\nname = "b{i}"\nshape = {shape}\nmotion = {{kind = "velocity", value = {list(v)}}}\n' for i, (shape, v) in enumerate(shapes))

    def fly(name, text, end, sides="outflow"):
        head = f"[time]\nend = {end!r}\n" + output(f"{end!r} s", "0 s")
        head += f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = [{n}, {n}, {n}]\n"
        head += "boundary = {" + ", ".join(f'{a}_{s} = "{sides}"' for a in "xyz" for s in ("lower", "upper")) + "}\n"
        result = run(f"T9_{name}", head + text + material("air", reference.GAS) + region('{kind = "everywhere"}', "air", 1.225, p0), only="fluid")
        flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
        p = flow.array("pressure")[flow.array("covered") == 0]
        return fields.history(result.directory / "fluid_history.csv"), p, result

    push, pull = reference.driven_piston(speed)[0], reference.driven_piston(-speed)[0]
    ball = '{kind = "sphere", centre = [0.75, 0.5, 0.5], radius = 0.12}'
    history, p, result = fly("leaves", bodies((ball, (speed, 0.0, 0.0))), 2.5e-3)
    yield at_most("a ball leaves: largest pressure over that of a plane piston", history["p_max"].max() / push, 1.0, result.seconds)
    yield at_least("a ball leaves: least pressure at the end over that behind a plane piston", p.min() / pull, 1.0)
    gone = history["t"] > 0.5e-3 + (0.25 + 0.12) / speed
    impulse = history["face impulse x"]
    yield at_most("a ball leaves: impulse on it after it is gone over all of it", np.ptp(impulse[gone]) / np.ptp(impulse), 1e-12)
    steps = np.abs(np.diff(impulse) / np.diff(history["t"]))
    yield at_most("a ball leaves: largest force over piston pressure on its cross section", steps.max() / (np.pi * 0.12**2 * push), 1.0)

    box = '{{kind = "box", lower = [{0}, 0.3, 0.3], upper = [{1}, 0.7, 0.7]}}'
    apart = bodies((box.format(0.36, 0.52), (-speed, 0.0, 0.0)), (box.format(0.48, 0.64), (speed, 0.0, 0.0)))
    history, p, result = fly("apart", apart, 0.8e-3)
    yield at_most("overlapping boxes come apart: largest pressure over that of a plane piston", history["p_max"].max() / push, 1.05, result.seconds)
    yield at_least("overlapping boxes come apart: least pressure at the end", p.min(), 0.0)
    yield at_least("overlapping boxes come apart: cells uncovered", history["cells fresh"][-1], 500)

    small = '{kind = "box", lower = [0.2, 0.512, 0.512], upper = [0.208, 0.52, 0.52]}'  # a quarter of a cell
    history, p, result = fly("small", bodies((small, (speed, 0.0, 0.0))), 1.5e-3, "periodic")
    yield at_most("a cube of a quarter of a cell at 300 m/s: largest pressure over that of a plane piston", history["p_max"].max() / push, 1.0, result.seconds)
    yield at_most("a cube of a quarter of a cell: mass of the gas, change", abs(history["mass"][-1] / history["mass"][0] - 1), 1e-3)


@case("T8", quick=True)
def t8():
    """Degenerate surfaces: vertices on centres, faces on faces, lips that coincide, zero areas, shifts by 1e-12; no net force in uniform gas; slits"""
    yield from unit_rows("cfd", "EmbedScan.*:EmbedPredicates.*:EmbedLips.*:EmbedApertures.*:EmbedOrifice.*:EmbedWalls.NoNetForce*")
