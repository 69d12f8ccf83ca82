# SPDX-License-Identifier: Apache-2.0
"""Waves and vibrations of elastic solids, and the law of central differences' energy: S2b, S3, S12."""
import math

import numpy as np

from . import reference
from .case import at_most, between, case, close, output, run
from .solid import fields, roller

STEEL = dict(density=7800.0, young=206e9, poisson=0.3)


def elastic(density, young, poisson):
    return f'material = {{kind = "neo_hooke", density = {density!r}, young_modulus = {young!r}, poisson_ratio = {poisson!r}}}\n'


def box(upper, cells, lower=(0.0, 0.0, 0.0), name="body"):
    return (f'[[solid.body]]\nname = "{name}"\nmesh = {{kind = "box", lower = {list(lower)!r}, upper = {list(upper)!r}, cells = {list(cells)!r}}}\n')


def node(name, position):
    return f'[[solid.probe]]\nname = "{name}"\nkind = "node"\nposition = {list(position)!r}\n'


def history(result):
    return fields.history(result.directory / "solid_history.csv")


def integral(y, x):
    return np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(x))


def frequency(t, x):
    """Of a signal that is mostly one vibration: the sine (and constant) that leaves least, near the largest line of its spectrum."""
    t, x = np.asarray(t), np.asarray(x)
    grid = np.linspace(t[0], t[-1], 4096)
    signal = np.interp(grid, t, x)
    signal = (signal - signal.mean()) * np.hanning(len(grid))
    first = np.argmax(np.abs(np.fft.rfft(signal))) / (grid[-1] - grid[0])

    def left(f):
        basis = np.stack([np.sin(2 * np.pi * f * t), np.cos(2 * np.pi * f * t), np.ones_like(t)], axis=1)
        return np.sum((x - basis @ np.linalg.lstsq(basis, x, rcond=None)[0]) ** 2)
    width = 1 / (t[-1] - t[0])
    low, high = max(first - width, 0.1 * width), first + width
    for _ in range(4):  # ever finer combs
        comb = np.linspace(low, high, 41)
        best = comb[np.argmin([left(f) for f in comb])]
        low, high = best - (comb[1] - comb[0]), best + (comb[1] - comb[0])
    return best


def uniaxial_strain(length=1.0, cells=100):
    """A column that can't swell sideways."""
    h = length / cells
    return (box((length, h, h), (cells, 1, 1)) + elastic(**STEEL)
            + roller("y_lower", 1) + roller("y_upper", 1) + roller("z_lower", 2) + roller("z_upper", 2))


def driven(body, end, times, factors):
    """A body whose left side moves at given speeds [m/s]."""
    return (f"[time]\nend = {end!r}\n" + output("0 s", "0 s") + body
            + '[[solid.condition]]\nkind = "velocity"\nnodes = "x_lower"\nvalue = [1.0, 0.0, 0.0]\ncomponents = "x"\n'
            + f"factor = {{times = {list(map(float, times))!r}, factors = {list(map(float, factors))!r}}}\n")


def fit_wave(t, v, omega):
    """Amplitude and phase of v = a sin(omega t + phase)."""
    sine, cosine = np.linalg.lstsq(np.stack([np.sin(omega * t), np.cos(omega * t)], axis=1), v, rcond=None)[0]
    return math.hypot(sine, cosine), math.atan2(cosine, sine)


@case("S2b")
def s2b():
    """Elastic waves in columns: arrival, height, dispersion, frequencies, reflection at a fixed end; with and without filter"""
    c = math.sqrt(STEEL["young"] * 0.7 / (1.3 * 0.4) / STEEL["density"])
    times = np.linspace(0, 0.2 / c, 101)
    pulse = np.sin(np.pi * times / times[-1])
    for kind in ("off", "plain", "self_adjoint"):
        # 140 elements: what the end reflects comes to the second node after the pulse and the waves behind it have passed
        result = run(f"S2b_{kind}", driven(uniaxial_strain(1.4, 140), 1.4 / c, times, np.maximum(pulse, 0))
                     + (f'[solid.filter]\nkind = "{kind}"\n' if kind != "off" else "")
                     + node("start", (0.05, 0, 0)) + node("end", (0.85, 0, 0)), only="solid", threads=1)
        table = history(result)

        def passing(name, place, before, after):
            """Mean time of the pulse at a node within a window around its middle, and its height."""
            v, t = table[f"{name} vx"], table["t"]
            here = (t > (place + 0.1 - before) / c) & (t < (place + 0.1 + after) / c)
            return integral(t[here] * v[here], t[here]) / integral(v[here], t[here]), v[here].max()
        # a whole linear pulse travels at c, whatever the dispersion; the narrow window leaves the waves behind it out
        for which, before, after in (("of the whole pulse", 1.0, 0.4), ("of its front part", 0.14, 0.14)):
            (t0, _), (t1, peak) = passing("start", 0.05, before, after), passing("end", 0.85, before, after)
            yield close(f"filter {kind}: speed over 80 elements {which} [m/s]", 0.8 / (t1 - t0), c, 0.002, result.seconds)
        yield at_most(f"filter {kind}: height lost over 85 elements", max(0.0, 1 - peak), 0.01)
        yield at_most(f"filter {kind}: height gained by dispersion", max(0.0, peak - 1), 0.06)
    # a train of waves of 20 elements each: how much slower it runs is the method's own dispersion
    period = 0.2 / c
    times = np.linspace(0, 1.8 / c, 1801)
    for kind in ("off", "plain", "self_adjoint"):
        result = run(f"S2b_train_{kind}", driven(uniaxial_strain(1.8, 180), 1.8 / c, times, np.sin(2 * np.pi * times / period))
                     + (f'[solid.filter]\nkind = "{kind}"\n' if kind != "off" else "")
                     + node("start", (0.1, 0, 0)) + node("end", (0.9, 0, 0)), only="solid", threads=1)
        table = history(result)
        late = table["t"] > 1.3 / c
        waves = [fit_wave(table["t"][late], table[f"{name} vx"][late], 2 * np.pi / period) for name in ("start", "end")]
        turns = (waves[0][1] - waves[1][1]) / (2 * np.pi)
        turns += round(4 - turns)  # 0.8 m are 4 waves, and a little
        number = reference.wave_number(2 * np.pi / period, 0.01, c, np.median(np.diff(table["t"])), kind, 0.5)
        yield close(f"waves of 20 elements, filter {kind}: phase speed (dispersion relation) [m/s]", 0.8 / (turns * period), 2 * np.pi / period / number, 0.0005, result.seconds)
        yield at_most(f"waves of 20 elements, filter {kind}: amplitude lost over 80 elements", max(0.0, 1 - waves[1][0] / waves[0][0]), 0.01)
    for name, sides, speed in (("uniaxial strain", True, c), ("bar, nu = 0", False, math.sqrt(STEEL["young"] / STEEL["density"]))):
        body = uniaxial_strain(1.0, 100) if sides else box((1.0, .01, .01), (100, 1, 1)) + elastic(STEEL["density"], STEEL["young"], 0.0)
        text = ("[time]\nend = 6e-3\n" + output("0 s", "0 s") + body
                + roller("x_lower", 0) + node("tip", (1.0, 0, 0))
                + '[[solid.load]]\nkind = "traction"\nfaces = ["x_upper"]\ntraction = [1e5, 0.0, 0.0]\n')
        result = run(f"S2b_end_{'strain' if sides else 'bar'}", text + '[[solid.probe]]\nname = "root"\nkind = "element"\nposition = [0.005, 0.005, 0.005]\n',
                     only="solid", threads=1)
        table = history(result)
        yield close(f"{name}, fixed and free: frequency [Hz]", frequency(table["t"], table["tip x"]), speed / 4, 0.002, result.seconds)
        doubled = (table["t"] > 1.15 / speed) & (table["t"] < 2.85 / speed)
        yield close(f"{name}: stress at the fixed end over the load's, t = L/c .. 3 L/c", table["root sigma_xx"][doubled].mean() / 1e5, 2, 0.02)


@case("S3")
def s3():
    """Frequencies: cantilever of 4 x 40 elements (2 % is the element's own stiffness in bending), ball, ring, cylinder, thin sphere"""
    for height, exact in ((0.1, 82.373), (0.05, 41.427)):
        across = 4
        along = round(across / height)
        h = height / across
        text = ("[time]\nend = " + repr(4 / exact) + "\n" + output("0 s", f"{0.01 / exact!r} s") + box((1.0, height, h), (along, across, 1))
                + "motion = {spin = [0.0, 0.0, 0.01]}\n" + elastic(**STEEL)
                + '[[solid.condition]]\nkind = "fixed"\nnodes = "x_lower"\n' + node("tip", (1.0, 0, 0)))
        result = run(f"S3_cantilever_{height:g}", text, only="solid", threads=1)
        table = history(result)
        yield close(f"cantilever h = {height:g} m, plane stress: f1 [Hz] (Timoshenko)", frequency(table["t"], table["tip y"]), exact, 0.02, result.seconds)
    for nu, root in ((0.25, 2.563434), (0.3, 2.670215), (0.49, 3.116224)):
        young, rho = STEEL["young"], STEEL["density"]
        c = math.sqrt(young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / rho)
        exact = root * c / (2 * np.pi * 0.1)
        text = ("[time]\nend = " + repr(4 / exact) + "\n" + output("0 s", f"{0.01 / exact!r} s")
                + '[[solid.body]]\nname = "ball"\nmesh = {kind = "ball", radius = 0.1, across = 5, through = 5}\n'
                + 'motion = {radial = 0.01, away_from = "centre"}\n' + elastic(rho, young, nu)
                + "".join(roller(f"cut_{a}", k) for k, a in enumerate("xyz")) + node("surface", (0.0, 0.0, 0.1)))
        result = run(f"S3_ball_{nu:g}", text, only="solid", threads=1)
        table = history(result)
        yield close(f"ball, nu = {nu:g}: breathing f1 R [Hz m]", 0.1 * frequency(table["t"], table["surface z"]), 0.1 * exact, 0.02, result.seconds)
    thin = 0.002
    for name, exact, free in (("ring", 8179.12, True), ("cylinder, plane strain", 8574.05, False)):
        text = ("[time]\nend = " + repr(4 / exact) + "\n" + output("0 s", f"{0.01 / exact!r} s")
                + f'[[solid.body]]\nname = "ring"\nmesh = {{kind = "tube", inner_radius = {0.1 - thin / 2!r}, outer_radius = {0.1 + thin / 2!r}, '
                + f'length = {thin!r}, around = 128, through = 1, along = 1, sector = "quarter"}}\nmotion = {{radial = 0.01}}\n' + elastic(**STEEL)
                + roller("cut_x", 0) + roller("cut_y", 1) + roller("lower", 2) + ("" if free else roller("upper", 2)) + node("out", (0.1, 0, 0)))
        result = run(f"S3_{name.split(',')[0]}", text, only="solid", threads=1)
        table = history(result)
        yield close(f"thin {name}: breathing f1 [Hz]", frequency(table["t"], table["out x"]), exact, 0.01, result.seconds)
    exact = 13825.2
    text = ("[time]\nend = " + repr(4 / exact) + "\n" + output("0 s", f"{0.01 / exact!r} s")
            + f'[[solid.body]]\nname = "shell"\nmesh = {{kind = "ball", radius = {0.1 + thin / 2!r}, inner_radius = {0.1 - thin / 2!r}, across = 12, through = 1}}\n'
            + 'motion = {radial = 0.01, away_from = "centre"}\n' + elastic(**STEEL)
            + "".join(roller(f"cut_{a}", k) for k, a in enumerate("xyz")) + node("out", (0.0, 0.0, 0.1)))
    result = run("S3_sphere", text, only="solid", threads=1)
    table = history(result)
    yield close("thin sphere: breathing f1 [Hz]", frequency(table["t"], table["out z"]), exact, 0.01, result.seconds)


def one_freedom(omega_dt, steps, speed, rows):
    """One element between planes, free to stretch in one direction alone: mass rho A L/2 on the stiffness (kappa + 4/3 mu) A/L.
    A row of the history every `rows` steps (0: every step), so that all steps are alike: their energy is one constant only then."""
    length = 0.01
    c = math.sqrt(STEEL["young"] * 0.7 / (1.3 * 0.4) / STEEL["density"])
    dt = omega_dt / (math.sqrt(2) * c / length)
    sides = "".join(roller(f"{a}_{s}", k) for k, a in enumerate("xyz") for s in ("lower", "upper") if (a, s) != ("x", "upper"))
    return ("[time]\nend = 1.0\nmax_steps = " + str(steps) + "\n" + output("0 s", f"{rows * dt!r} s") + box((length, length, length), (1, 1, 1))
            + elastic(**STEEL) + f"[solid.time_step]\nfixed = {dt * (1 + 1e-9)!r}\n" + sides
            + f'[[solid.velocity]]\nnodes = "x_upper"\nvelocity = [{speed!r}, 0.0, 0.0]\n')


def beam(end, step):
    return (f"[time]\nend = 1.0\n{end}\n" + output("0 s", "0 s") + box((0.2, 0.05, 0.05), (8, 2, 2)) + elastic(**STEEL)
            + f'velocity = [0.0, 0.0, 10.0]\n[solid.time_step]\n{step}\n[[solid.condition]]\nkind = "fixed"\nnodes = "x_lower"\n')


def secular(t, x):
    """Drift of the mean of a bounded oscillation from the first half of the record to the second; a smooth window (Hann) leaves out
    what the oscillation would add by being cut off."""
    half = len(x) // 2
    window = np.hanning(half)
    return np.sum(window * (x[-half:] - x[:half])) / np.sum(window)


@case("S12")
def s12():
    """Energy of central differences: one vibration follows the law 1/(1 - (omega dt)^2/4), a beam's oscillation falls by 4 a halving, no drift"""
    for omega_dt, steps in ((0.5, 4000), (0.1, 4000)):
        result = run(f"S12_law_{omega_dt:g}", one_freedom(omega_dt, steps, 0.1, 0), only="solid", threads=1)
        table = history(result)
        energy = (table["kinetic_energy"] + table["elastic_energy"])[2:]
        yield close(f"one vibration, omega dt = {omega_dt:g}: largest over smallest energy - 1", energy.max() / energy.min() - 1,
                    1 / (1 - omega_dt ** 2 / 4) - 1, 0.005, result.seconds)
    result = run("S12_secular", one_freedom(0.5, 1000000, 5.0, 10), only="solid", threads=1)
    table = history(result)
    start = table["kinetic_energy"][0]
    yield at_most("one vibration of 0.1 % strain, 1,000,000 steps, omega dt = 0.5: drift", secular(table["t"], table["energy_residual"] / start), 1e-9, result.seconds)
    largest = []
    for part in (1, 2):  # the stable step is 3.0 us
        dt, steps = 2.7e-6 / part, 4000 * part
        result = run(f"S12_beam_{part}", beam(f"max_steps = {steps}", f"fixed = {dt!r}"), only="solid", threads=1)
        table = history(result)
        residual = (table["energy_residual"] / table["kinetic_energy"][1])[2:]
        largest.append(np.abs(residual - residual.mean()).max())
        yield at_most(f"beam, {steps} steps of {2.7 / part:g} us: oscillation of the energy", largest[-1], 1e-5, result.seconds)
        yield at_most(f"beam, {steps} steps of {2.7 / part:g} us: drift of the energy", secular(table["t"][2:], residual), 2e-6)
    yield between("beam: the oscillation falls from 2.7 to 1.35 us by (O(dt^2): 4)", largest[0] / largest[1], 3.2, 4.8)
    result = run("S12_beam_varying", beam("max_steps = 10000", "safety = 0.9"), only="solid", threads=1)
    table = history(result)
    residual = (table["energy_residual"] / table["kinetic_energy"][1])[2:]
    yield at_most("beam, 10,000 steps, each 0.9 of the stable one: oscillation of the energy", np.abs(residual - residual.mean()).max(), 1e-4, result.seconds)
