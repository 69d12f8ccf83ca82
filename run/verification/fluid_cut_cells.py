# SPDX-License-Identifier: Apache-2.0
"""Conservative moving cut cells (`[fluid.walls] treatment = "cut_cell"`): exact conservation, wall pressure, the default's tests of pistons and wedges."""
import math

import numpy as np

import fields

from . import reference
from .case import at_least, at_most, case, output, run
from .fluid import material, region
from .fluid_pistons import aligned_pistons, oblique_pistons
from .fluid_wedge import wedges

WALLS = '[fluid.walls]\ntreatment = "cut_cell"\n'
NOTE = ", cut cells"
GAS = reference.GAS
EVERYWHERE = '{kind = "everywhere"}'


def block(speed, point, normal=(1.0, 0.0, 0.0)):
    """A piston with a back, far away."""
    n, along, at = np.array(normal[:2]), np.array([-normal[1], normal[0]]), np.array(point[:2])
    corners = [[float(x) for x in at + a * n + b * along] + [0.0] for a, b in ((-4, -5), (0, -5), (0, 5), (-4, 5))]
    velocity = [float(speed * x) for x in normal]
    return f'[[fluid.body]]\nname = "piston"\nshape = {{kind = "prism", points = {corners}}}\nmotion = {{kind = "velocity", value = {velocity}}}\n'


@case("F10cut")
def f10cut():
    """F10 and F11 with cut cells, the default's bands; pistons have a back, wedges rise from the floor"""
    yield from aligned_pistons(WALLS, NOTE, block)
    yield from oblique_pistons(WALLS, NOTE, block)
    yield from wedges(WALLS, NOTE, ramp=True)


def smooth_piston(amplitude, n):
    """rms error of the wall's pressure against the simple wave, off mass, off energy; the wall's impulse by step tells its pressure at mid-step."""
    h, period, end = 2.0 / n, 0.8, 0.7
    text = f"[time]\nend = {end}\n" + output("0 s", "0 s") + f"[fluid]\nlower = [-0.5, 0, 0]\nupper = [1.5, {h}, {h}]\ncells = [{n}, 1, 1]\n"
    text += WALLS + material("gas", GAS) + region(EVERYWHERE, "gas", 1.0, 1.0)
    text += '[[fluid.body]]\nname = "piston"\nshape = {kind = "box", lower = [-5, -1, -1], upper = [0.013, 1, 1]}\n'
    text += f'motion = {{kind = "pulse", velocity = [{amplitude}, 0, 0], duration = {period}}}\n'
    table = fields.history(run(f"F10bcut_{amplitude}_{n}", text, only="fluid", threads=1).directory / "fluid_history.csv")
    t, impulse = np.array(table["t"]), np.array(table["wall impulse x"])
    dt, middle = np.diff(t), 0.5 * (t[1:] + t[:-1])
    pressure = -np.diff(impulse) / dt / h**2
    speed = amplitude * np.sin(math.pi * middle / period) ** 2
    exact = (1 + 0.2 * speed / math.sqrt(1.4)) ** 7
    error = math.sqrt(float(np.sum((pressure / exact - 1) ** 2 * dt)) / end)
    mass, energy = table["mass"], np.array(table["energy"]) + np.array(table["wall energy"])
    return error, mass[-1] / mass[0] - 1, energy[-1] / energy[0] - 1


@case("F10bcut")
def f10bcut():
    """F10b with cut cells: wall pressure of smooth pistons, order from 100 to 400 cells; mass, energy with the work"""
    for amplitude, band in ((-0.5, 5.7e-4), (-0.3, 3.98e-4), (0.3, 1.02e-4)):  # of the one-dimensional prototype; the default's of F10b
        errors, masses, energies = zip(*(smooth_piston(amplitude, n) for n in (100, 200, 400)))
        yield at_most(f"A = {amplitude}: wall pressure, 100 cells", errors[0], 1.2 * band)
        yield at_least(f"A = {amplitude}: order", 0.5 * math.log2(errors[0] / errors[2]), 1.9)
        yield at_most(f"A = {amplitude}: mass", max(map(abs, masses)), 1e-10)
        yield at_most(f"A = {amplitude}: energy with the work", max(map(abs, energies)), 1e-10)
    errors = [leaning_piston(0.3, n) for n in (50, 100, 200)]
    yield at_most("A = 0.3, at 30 deg to the grid: pressure within 6 cells of the wall, 50 cells", errors[0], 2e-3)
    yield at_least("A = 0.3, at 30 deg to the grid: order", 0.5 * math.log2(errors[0] / errors[2]), 1.9)


def leaning_piston(amplitude, n):
    """rms error of the pressure beside a smooth piston at 30 degrees to the grid, in whole cells, against the simple wave."""
    h, period, end, c0, angle = 2.0 / n, 0.8, 0.4, math.sqrt(1.4), math.radians(30)
    normal, along, start = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)]), -0.2
    corners = [[float(x) for x in np.array([1.0, 1.0]) + a * normal + b * along] + [0.0] for a, b in ((-4, -5), (start, -5), (start, 5), (-4, 5))]
    text = f"[time]\nend = {end}\n" + output(f"{end} s", "1000 s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [2, 2, {h}]\ncells = [{n}, {n}, 1]\n"
    text += 'boundary = {x_lower = "outflow", x_upper = "outflow", y_lower = "outflow", y_upper = "outflow"}\n'
    text += WALLS + material("gas", GAS) + region(EVERYWHERE, "gas", 1.0, 1.0) + f'[[fluid.body]]\nname = "piston"\nshape = {{kind = "prism", points = {corners}}}\n'
    text += f'motion = {{kind = "pulse", velocity = {[float(amplitude * x) for x in normal] + [0.0]}, duration = {period}}}\n'
    flow = fields.Fluid(fields.series(run(f"F10bcut_30deg_{n}", text, only="fluid").directory, "fluid")[-1][1])
    X, Y = np.meshgrid(flow.centres(0) - 1, flow.centres(1) - 1, indexing="ij")
    way, aside = X * normal[0] + Y * normal[1], X * along[0] + Y * along[1]

    def speed(s):
        return amplitude * np.sin(math.pi * s / period) ** 2

    def place(s):
        return start + amplitude * (s / 2 - period / (4 * math.pi) * np.sin(2 * math.pi * s / period))

    pick = (np.abs(aside) < 0.2) & (way > place(end) + h) & (way < place(end) + 6 * h)
    low, high = np.zeros(pick.sum()), np.full(pick.sum(), end)  # when the wave that is there left the piston
    for _ in range(60):
        middle = 0.5 * (low + high)
        reached = place(middle) + (c0 + 1.2 * speed(middle)) * (end - middle) > way[pick]
        low, high = np.where(reached, middle, low), np.where(reached, high, middle)
    exact = (1 + 0.2 * speed(0.5 * (low + high)) / c0) ** 7
    return float(np.sqrt(np.mean((flow.array("pressure")[:, :, 0][pick] / exact - 1) ** 2)))


BLAST = region(EVERYWHERE, "gas", 1.2, 1e5) + region('{kind = "sphere", centre = [0.2, 0.3, 0.5], radius = 0.12}', "gas", 6.0, 1e6)


def room(name, n, end, body, regions, sides=""):
    text = f"[time]\nend = {end}\n" + output(f"{end} s", f"{end / 20} s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, {1.0 if n[2] > 1 else 1.0 / n[0]}]\ncells = {list(n)}\n{sides}"
    return run(name, text + WALLS + material("gas", GAS) + regions + body, only="fluid").directory


def kept(name, folder, faces=True):
    """Mass, momentum and energy of gas, sides and body together; faces: of a body that stays inside, what its faces got."""
    table = {key: np.array(values) for key, values in fields.history(folder / "fluid_history.csv").items()}
    mass, energy = table["mass"], table["energy"] + table["wall energy"]
    yield at_most(f"{name}: mass", np.abs(mass / mass[0] - 1).max(), 1e-10)
    yield at_most(f"{name}: energy with the work on the body", np.abs(energy / energy[0] - 1).max(), 1e-10)
    yield at_least(f"{name}: that work over the energy", abs(table["wall energy"]).max() / energy[0], 1e-4)
    whole = [table[f"momentum {d}"] + table[f"outflow momentum {d}"] + table[f"wall impulse {d}"] for d in "xyz"]
    size = max(np.abs(table[f"outflow momentum {d}"]).max() for d in "xyz")
    yield at_most(f"{name}: momentum, over that given to the sides", max(np.abs(p - p[0]).max() for p in whole) / size, 1e-10)
    if faces:
        yield at_most(f"{name}: impulse of the faces less that of the gas", max(np.abs(table[f"wall impulse {d}"] - table[f"face impulse {d}"]).max() for d in "xyz") / size, 1e-10)


@case("cut_box")
def cut_box():
    """Closed boxes with a blast and bodies that move and turn, cut cells: mass, momentum, energy to round-off; gas that moves with a body"""
    turning = 'motion = {kind = "rotation", point = [0.5, 0.5, 0.5], axis = [0.0, 0.0, 1.0], rate = 300.0, velocity = [60.0, 30.0, 0.0]}\n'
    box = '[[fluid.body]]\nname = "body"\nturn_angle = 27\nturn_point = [0.5, 0.5, 0]\n'
    flat = 'shape = {kind = "prism", points = [[0.35, 0.4, 0], [0.62, 0.4, 0], [0.62, 0.63, 0], [0.35, 0.63, 0]]}\n'
    plane = BLAST.replace('"sphere", centre = [0.2, 0.3, 0.5]', '"cylinder", start = [0.2, 0.3, -1], end = [0.2, 0.3, 1]')
    yield from kept("turning box in a plane", room("cut_box_plane", (96, 96, 1), 3e-3, box + flat + turning, plane))
    gone = 'motion = {kind = "velocity", value = [0.0, -150.0, 0.0]}\n'
    yield from kept("box that leaves through the floor", room("cut_box_leaves", (64, 64, 1), 4.5e-3, box + flat + gone, plane), faces=False)
    levels = "[fluid.amr]\nlevels = 2\nblock = 8\nevery = 4\n"
    yield from kept("turning box in a plane, two levels", room("cut_box_levels", (32, 32, 1), 3e-3, levels + box + flat + turning, plane))
    askew = turning.replace("[0.0, 0.0, 1.0]", "[0.3, 0.5, 1.0]")
    yield from kept("turning box", room("cut_box_turning", (48, 48, 48), 2e-3, box + 'shape = {kind = "box", lower = [0.35, 0.4, 0.3], upper = [0.62, 0.63, 0.6]}\n' + askew, BLAST))
    ball = 'shape = {kind = "sphere", centre = [0.5, 0.45, 0.5], radius = 0.2}\nmotion = {kind = "sinusoidal", velocity = [120.0, 60.0, 30.0], frequency = 500.0}\n'
    yield from kept("ball", room("cut_box_ball", (48, 48, 48), 2e-3, '[[fluid.body]]\nname = "body"\n' + ball, BLAST))
    sides = ", ".join(f'{d}_{side} = "periodic"' for d in "xyz" for side in ("lower", "upper"))
    for shape in (flat, ball.split("\n")[0] + "\n"):
        n = (64, 64, 1) if shape is flat else (32, 32, 32)
        ride = (box if shape is flat else '[[fluid.body]]\nname = "body"\n') + shape + 'motion = {kind = "velocity", value = [50.0, 20.0, 10.0]}\n'
        folder = room("cut_box_ride", n, 2e-3, ride, region(EVERYWHERE, "gas", 1.2, 1e5, (50.0, 20.0, 10.0)), f"boundary = {{{sides}}}\n")
        flow = fields.Fluid(fields.series(folder, "fluid")[-1][1])
        p = flow.array("pressure")
        p = p[np.isfinite(p) & (p > 0)]
        yield at_most(f"gas that moves with a {'box' if shape is flat else 'ball'}: pressure", np.abs(p / 1e5 - 1).max(), 1e-12)
