# SPDX-License-Identifier: Apache-2.0
"""Cases of the pair."""
import sys

import numpy as np

from . import reference
from .case import ROOT, at_least, at_most, case, close, output, run

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402


def piston(scheme="fluid_first", h=10.0, end=1e-3, mass=1.0, left="outflow", length=640.0, fields_every=None):
    """C1 as a case: gas on the left, (nearly) nothing on the right, a slab of 10 mm of `mass` per area; h in mm."""
    cells = int(round((length + 160) / h))
    rollers = "".join(f'[[solid.condition]]\nkind = "roller"\nnodes = "{d}_{side}"\nnormal = {normal}\n'
                      for d, normal in (("y", [0, 1, 0]), ("z", [0, 0, 1])) for side in ("lower", "upper"))
    text = f"[time]\nend = {end!r}\n" + output(f"{fields_every or end!r} s", "0 s")
    text += ('[[solid.body]]\nname = "piston"\n'
             f'mesh = {{kind = "box", lower = [0, 0, 0], upper = ["10 mm", "{h} mm", "{h} mm"], cells = [1, 1, 1]}}\n'
             f'material = {{kind = "neo_hooke", density = {100.0 * mass!r}, young_modulus = {1e7 * mass!r}, poisson_ratio = 0.0}}\n')
    text += rollers + '[solid.wet]\nfaces = ["x_lower"]\n'
    text += '[[solid.probe]]\nkind = "node"\nname = "wall"\nposition = [0.0, 0.0, 0.0]\n'
    text += (f'[fluid]\nlower = ["-{length} mm", "0 mm", "0 mm"]\nupper = ["160 mm", "{h} mm", "{h} mm"]\ncells = [{cells}, 1, 1]\n'
             f'boundary = {{x_lower = "{left}", x_upper = "outflow"}}\n[[fluid.material]]\nname = "air"\neos = {{kind = "ideal_gas", gamma = 1.4}}\n'
             '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
             '[[fluid.region]]\nshape = {kind = "half_space", point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0]}\nmaterial = "air"\n'
             'density = 1e-4\npressure = 1.0\n')
    return text + f'[coupling]\nscheme = "{scheme}"\nreference_pressure = 0.0\n'


def probe(table, name, what):
    """The column of a probe: its name and the quantity, whatever stands between."""
    for column in table:
        if column.startswith(name) and column[len(name):].strip(" ._:") == what:
            return table[column]
    raise KeyError(f"no column of probe '{name}' for '{what}': {', '.join(table)}")


@case("C1", quick=True)
def c1():
    """Free piston driven by air against the exact simple wave; order of both schemes; energy; ledger"""
    u, x, p = reference.free_piston(1e-3, 1.0)
    errors = {}
    for scheme in ("fluid_first", "box1"):
        for h in (20.0, 10.0, 5.0):
            result = run(f"C1_{scheme}_{h:g}", piston(scheme, h))
            table = fields.history(result.directory / "solid_history.csv")
            # the piston's momentum: its faces ring a little
            measured_u, measured_x = table["momentum x"][-1] / (1.0 * (h * 1e-3) ** 2), probe(table, "wall", "x")[-1]
            errors[scheme, h] = abs(measured_u / u - 1)
            if h == 10.0 or scheme == "fluid_first":
                yield close(f"{scheme}, {h:g} mm: u at 1 ms", measured_u, u, 0.005, result.seconds)
            if h == 10.0:
                yield close(f"{scheme}, 10 mm: x at 1 ms", measured_x, x, 0.005)
                ledger = fields.history(result.directory / "coupling_history.csv")
                yield at_most(f"{scheme}: impulse defect of any window", np.abs(ledger["impulse_defect"]).max(), 1e-12)
                yield close(f"{scheme}: kinetic energy against the gas's work", 0.5 * 1.0 * (h * 1e-3) ** 2 * measured_u ** 2,
                            float(np.sum(ledger["fluid_work"])), 0.01 if scheme == "fluid_first" else 0.05)
    # under fluid_first no error in time is left that could be seen beside the gas's in space and the slab's elasticity
    yield at_least("box1: order of u, 20 to 5 mm (reported)", np.log(errors["box1", 20.0] / errors["box1", 5.0]) / np.log(4), 0.0)


def closed_column(scheme, mass, speed, end, length=1000.0, young=None):
    """C2 as a case: C1's slab before a closed column of air at rest [mm], in cells of 20 mm, with a velocity to begin with."""
    text = piston(scheme, h=20.0, end=end, mass=mass, left="wall", length=length)
    if young:
        text = text.replace(f"young_modulus = {1e7 * mass!r}", f"young_modulus = {young!r}")
    text = text.replace("poisson_ratio = 0.0}\n", f"poisson_ratio = 0.0}}\nvelocity = [{speed!r}, 0.0, 0.0]\n", 1)
    text = text.replace("reference_pressure = 0.0", "reference_pressure = 101325.0")
    vacuum = text.index("[[fluid.region]]\nshape = {kind = \"half_space\"")
    return text[:vacuum] + text[text.index("[coupling]"):] + ("radiation = \"always\"\n" if scheme == "box1" else "")


def oscillation(t, x, known):
    """Hz and amplitudes [start, end] of the first mode: least squares of all known modes, the first one's frequency free; then on the first and
    the last third."""
    def fit(part, frequencies):
        columns = [np.ones(part.sum())] + [f(2 * np.pi * value * t[part]) for value in frequencies for f in (np.cos, np.sin)]
        matrix = np.stack(columns, axis=1)
        coefficients, *_ = np.linalg.lstsq(matrix, x[part], rcond=None)
        return np.hypot(coefficients[1], coefficients[2]), np.linalg.norm(matrix @ coefficients - x[part])
    everything = np.ones(len(t), bool)
    low, high = 0.97 * known[0], 1.03 * known[0]
    for _ in range(40):  # golden section
        a, b = high - 0.618 * (high - low), low + 0.618 * (high - low)
        low, high = (low, b) if fit(everything, [a] + known[1:])[1] < fit(everything, [b] + known[1:])[1] else (a, high)
    frequency = 0.5 * (low + high)
    third = t[-1] / 3
    return frequency, [fit(part, [frequency] + known[1:])[0] for part in (t <= third, t >= 2 * third)]


def oscillates(where, result, modes, periods):
    """A run of closed_column() against the lowest mode: frequency, growth of the amplitude."""
    table = fields.history(result.directory / "solid_history.csv")
    frequency, (start, end) = oscillation(table["t"], probe(table, "wall", "x"), modes)
    yield close(f"{where}: frequency [Hz]", frequency, modes[0], 0.01, result.seconds)
    yield at_most(f"{where}: growth of the amplitude, last third of {periods} periods over the first", max(0.0, end / start - 1), 0.02)
    yield at_least(f"{where}: that amplitude over the first (reported)", end / start, 0.0)


@case("C2")
def c2():
    """Piston before a closed column of air, free: frequency and growth of the amplitude over the periods; also a piston lighter than the gas"""
    for mass, periods, schemes in ((0.8, 20, ("fluid_first", "box1")), (0.1, 20, ("fluid_first",)), (10.0, 6, ("fluid_first",))):
        modes = reference.gas_column_modes(mass, 0.0)
        for scheme in schemes:
            result = run(f"C2_{scheme}_{mass:g}", closed_column(scheme, mass, 2 * np.pi * modes[0] * 1e-4, periods / modes[0]))
            yield from oscillates(f"{scheme}, {mass:g} kg/m^2", result, modes, periods)


@case("C2f")
def c2_family():
    """C2 with slabs whose thickness mode is aliased by the windows: masses, stiffnesses, lengths of the column and both schemes; energy of the solid, \
last third over first"""
    window = 43e-6  # s, of cells of 20 mm
    for scheme in ("fluid_first", "box1"):
        worst, seconds = 0.0, 0.0
        for mass in (0.1, 0.8, 10.0):
            for ratio in (0.45, 1.1, 2.0, 3.1):  # windows in a period of the slab
                for length in (300.0, 1000.0):
                    first = reference.gas_column_modes(mass, 0.0, 1, length * 1e-3)[0]
                    young = (2 * np.pi / (ratio * window)) ** 2 * mass * 10e-3 / 4
                    result = run(f"C2f_{scheme}_{mass:g}_{ratio:g}_{length:g}", closed_column(scheme, mass, 0.03, 6 / first if mass < 10 else 3 / first, length, young))
                    table = fields.history(result.directory / "solid_history.csv")
                    energy, t = table["kinetic_energy"] + table["elastic_energy"], table["t"]
                    worst = max(worst, energy[t >= 2 * t[-1] / 3].max() / energy[t <= t[-1] / 3].max())
                    seconds += result.seconds
        yield at_most(f"{scheme}, 24 slabs: worst ratio", worst, 1.04, seconds)


def shock_on_slab(scheme, M, h, end, density, young, through, both_sides, gap=0.1):
    """C3 as a case: a shock of M in air runs from 0.1 m away onto a slab of 10 mm, h in mm; behind the slab air as before it, or nothing but the reference pressure."""
    after = reference.shock_state(M)
    text = piston(scheme, h=h, end=end, mass=density * 10e-3, left="outflow", length=600.0)
    text = text.replace(f"young_modulus = {1e7 * density * 10e-3!r}", f"young_modulus = {young!r}").replace("cells = [1, 1, 1]}", f"cells = [{through}, 1, 1]}}")
    text = text.replace("reference_pressure = 0.0", "reference_pressure = 101325.0")
    text = text.replace("[[solid.probe]]", '[[solid.probe]]\nkind = "node"\nname = "back"\nposition = [0.01, 0.0, 0.0]\n[[solid.probe]]', 1)
    if both_sides:
        text = text.replace('faces = ["x_lower"]', 'faces = ["x_lower", "x_upper"]')
    vacuum = text.index('[[fluid.region]]\nshape = {kind = "half_space"')
    return (text[:vacuum] + f'[[fluid.region]]\nshape = {{kind = "half_space", point = [{-gap}, 0.0, 0.0], normal = [-1.0, 0.0, 0.0]}}\nmaterial = "air"\n'
            f'density = {after.rho!r}\npressure = {after.p!r}\nvelocity = [{after.u!r}, 0.0, 0.0]\n' + text[text.index("[coupling]"):])


@case("C3")
def c3():
    """Shocks onto slabs: momentum of steel, the wave in a soft elastic slab, a weak shock on a light plate; both schemes"""
    for scheme in ("fluid_first", "box1"):
        for h in (10.0, 5.0):
            # steel between air and air: a M = 2 shock reflects, and sound leaves on both sides
            hit, wall = 0.1 / (2 * reference.air_sound()), reference.reflected_state(2.0)
            result = run(f"C3_steel_{scheme}_{h:g}", shock_on_slab(scheme, 2.0, h, hit + 1e-3, 7800.0, 206e9, 2, True))
            table = fields.history(result.directory / "solid_history.csv")
            Z = wall.rho * wall.c + 1.225 * reference.air_sound()
            u = (wall.p - 101325.0) / Z * (1 - np.exp(-Z * 1e-3 / 78.0))
            yield close(f"{scheme}, {h:g} mm: steel, u 1 ms after M = 2", table["momentum x"][-1] / 78.0 / (h * 1e-3) ** 2, u, 0.01, result.seconds)
            ledger = fields.history(result.directory / "coupling_history.csv")
            yield close(f"{scheme}, {h:g} mm: its kinetic energy against the gas's work", table["kinetic_energy"][-1], float(ledger["fluid_work"].sum()), 0.02)
        # density 1000, c 100 m/s: the slab is compressed by 12 %, so a shock runs through it, and is back as a fan after 180 us; linear
        # acoustics, p over the sum of the impedances, gives 13.65 m/s
        result = run(f"C3_soft_{scheme}", shock_on_slab(scheme, 2.0, 2.0, hit + 190e-6, 1000.0, 1e7, 40, False))
        table = fields.history(result.directory / "solid_history.csv")
        x, t = probe(table, "wall", "x"), table["t"] - hit
        at = [np.interp(moment, t, x) for moment in (60e-6, 180e-6)]
        u, u_back = reference.neo_hooke_under_shock(wall.p - 101325.0, wall.rho * wall.c, 1000.0, 1e7)
        yield close(f"{scheme}: soft slab, u of the front from 60 to 180 us", (at[1] - at[0]) / 120e-6, u, 0.01, result.seconds)
        x = probe(table, "back", "x")
        at = [np.interp(moment, t, x) for moment in (140e-6, 180e-6)]
        yield close(f"{scheme}: soft slab, u of its free back from 140 to 180 us", (at[1] - at[0]) / 40e-6, u_back, 0.02)
        # the same by a weak shock, compressed by 0.5 %: linear acoustics holds
        weak, weak_hit = reference.reflected_state(1.1), 0.1 / (1.1 * reference.air_sound())
        result = run(f"C3_soft_weak_{scheme}", shock_on_slab(scheme, 1.1, 2.0, weak_hit + 190e-6, 1000.0, 1e7, 40, False))
        table = fields.history(result.directory / "solid_history.csv")
        at = [np.interp(moment + weak_hit, table["t"], probe(table, "wall", "x")) for moment in (60e-6, 180e-6)]
        yield close(f"{scheme}: soft slab, u of the front from 60 to 180 us after M = 1.1, linear", (at[1] - at[0]) / 120e-6,
                    (weak.p - 101325.0) / (1000.0 * 100.0 + weak.rho * weak.c), 0.01, result.seconds)
        # a light plate, air on one side: Taylor's
        hit = 0.1 / (1.01 * reference.air_sound())
        result = run(f"C3_weak_{scheme}", shock_on_slab(scheme, 1.01, 10.0, hit + 1.2e-3, 100.0, 1e8, 1, False))
        table = fields.history(result.directory / "solid_history.csv")
        Z = 1.225 * reference.air_sound()
        wall = reference.reflected_state(1.01)
        yield close(f"{scheme}: plate of 1 kg/m^2, u 1.2 ms after M = 1.01", table["momentum x"][-1] / (10e-3) ** 2,
                    (wall.p - 101325.0) / Z * (1 - np.exp(-Z * 1.2e-3)), 0.02, result.seconds)


@case("C11", quick=True)
def c11():
    """Interface conservation: what the fluid's momentum loses is what the solid gets (closed end on the left, undisturbed)"""
    for h, band in ((10.0, 0.02), (5.0, 0.01)):
        result = run(f"C11_{h:g}", piston(h=h, left="wall", end=5e-4))
        fluid, solid = (fields.history(result.directory / f"{name}_history.csv") for name in ("fluid", "solid"))
        ledger = fields.history(result.directory / "coupling_history.csv")
        area, t = (h * 1e-3) ** 2, ledger["t"][-1]
        impulse = float(np.sum(ledger["impulse_x"]))
        momentum = fluid["momentum x"][-1] - fluid["momentum x"][0]
        # the walls at the ends: p0 on the left, which no wave has reached; 1 Pa on the right
        yield close(f"{h:g} mm: fluid's momentum change + p0 A t at the closed end, against -impulse", 101325.0 * area * t - momentum, impulse,
                    band, result.seconds)
        yield close(f"{h:g} mm: solid's momentum against the impulse and what it has in advance", solid["momentum x"][-1],
                    impulse + ledger["advance_x"][-1], 1e-9)
        yield close(f"{h:g} mm: work of the fluid against the solid's", float(np.sum(ledger["fluid_work"])), float(np.sum(ledger["solid_work"])), 0.01)


@case("replay", quick=True)
def replay():
    """C1 recorded, then each program alone against the record: columns of its history that differ"""
    text = piston(end=2e-4)
    pair = run("replay_pair", text, words=("--record", "out/record.h5"))
    for program, table in (("solid", "solid_history.csv"), ("fluid", "fluid_history.csv")):
        alone = run(f"replay_{program}", text, only=program, words=("--replay", str(pair.directory / "record.h5")))
        was, now = (fields.history(result.directory / table) for result in (pair, alone))
        timing = ("wait", "wall", "cpu", "rate", "per_second", "per second", "elem/s", "cells/s")
        different = [name for name in was if not any(word in name.lower() for word in timing) and not np.array_equal(was[name], now.get(name))]
        yield at_most(f"{program} alone: columns of its history with other bits ({len(was)} columns, {len(was['t'])} rows)", len(different), 0, alone.seconds)


@case("weapon")
def weapon():
    """The demo: ledger, mass, energy of both programs, charge, pieces"""
    text = (ROOT / "run" / "cases" / "weapon" / "case.toml").read_text().replace('directory = "run/out/weapon"', 'directory = "out"')
    result = run("weapon", text)
    ledger = fields.history(result.directory / "coupling_history.csv")
    fluid, solid = (fields.history(result.directory / f"{name}_history.csv") for name in ("fluid", "solid"))
    totals, metal = (fields.summary(result.directory, name) for name in ("fluid", "solid"))
    yield at_most("impulse defect of any window", np.abs(ledger["impulse_defect"]).max(), 1e-12, result.seconds)
    mass = fluid["mass"] + fluid["outflow mass"]
    yield at_most("fluid: mass, largest change over the mass at the start", np.abs(mass - mass[0]).max() / mass[0], 0.01)
    energy = fluid["energy"] + fluid["stored_energy"] + fluid["face work"] + fluid["outflow energy"]
    yield at_most("fluid: energy + work on the body, change over the chemical energy", np.abs(energy - energy[0]).max() / totals["energies"]["chemical"], 0.01)
    yield at_most("solid: energy residual over the work of the loads", np.abs(solid["energy_residual"]).max() / np.abs(solid["external_work"][-1]), 0.01)
    yield at_most("work of the fluid less the solid's, over the kinetic energy",
                  (ledger["fluid_work_sum"][-1] - ledger["solid_work_sum"][-1]) / solid["kinetic_energy"][-1], 0.01)
    yield close("charge [kg] against cavity volume times density", totals["masses"]["explosive"], totals["masses"]["cavity_volume_times_density"], 0.01)
    yield at_least("hexahedra (>= 8000)", metal["counts"]["elements"], 8000)
    yield at_least("pieces at the end (>= 100)", fields.Solid(fields.series(result.directory, "solid")[-1][1]).pieces().max() + 1, 100)
    yield at_most("wall seconds", result.seconds, 600)
