# SPDX-License-Identifier: Apache-2.0
"""Three and more materials in one flow: exact Riemann problems, contacts, the order of names, a charge under water; ranks, threads, restarts."""
import math

import numpy as np

import fields

from . import reference
from .case import at_least, at_most, case, close, output, row, run
from .fluid import half_space, material, profile, region, tube

WATER = reference.IdealGas(4.4, 6e8)
AIR = reference.GAS
HEAVY = reference.IdealGas(1.67)
TNT = reference.JWL_SETS["TNT"]


def layers(name, n, end, boundary, parts, order=None, lower=0.0, upper=1.0):
    """parts: (name, eos, from, (rho, u, p)), from left to right; order: of the materials in the case file."""
    kinds = {part[0]: part[1] for part in parts}
    text = tube(lower, upper, n, 0, boundary, end)
    text += "".join(material(kind, kinds[kind]) for kind in (order or kinds))
    for i, (kind, _, start, (rho, u, p)) in enumerate(parts):
        shape = '{kind = "everywhere"}' if i == 0 else half_space(start, 0)
        text += region(shape, kind, float(rho), float(p), (float(u), 0.0, 0.0))
    result = run(name, text, only="fluid")
    return profile(result.directory, 0), result


@case("many")
def many():
    """Two exact Riemann problems on both sides of a middle material that nothing has crossed: L1, order; orders of names; a copy; six materials"""
    products, water, air = (100.0, 0.0, 1e9), (1000.0, 0.0, 1e5), (1.2, 0.0, 5e6)
    first, second = reference.Riemann(products, water, TNT, WATER), reference.Riemann(water, air, WATER, AIR)
    t, x1, x2, errors, resolutions = 6e-5, 0.3, 0.75, [], (100, 200, 400, 800)
    parts = (("products", TNT, 0.0, products), ("water", WATER, x1, water), ("air", AIR, x2, air))

    def error(name, n, some):
        (x, rho, u, p), result = layers(name, n, t, ("outflow", "outflow"), some)
        edges = np.linspace(0, 1, n + 1)
        left, right = (wave.cell_averages(edges, at, t)[0] for wave, at in ((first, x1), (second, x2)))
        return np.abs(rho - np.where(x < 0.55, left, right)), x, p, result
    for n in resolutions:
        wrong, x, p, result = error(f"many_{n}", n, parts)
        left, right = error("many_left", n, parts[:2])[0], error("many_right", n, (("water", WATER, 0.0, water), parts[2]))[0]
        errors.append(float(np.mean(wrong)))
        yield close(f"products, water, air N={n}: L1(density), against each contact in a flow of two", errors[-1], float(np.mean(np.where(x < 0.55, left, right))), 0.01,
                    result.seconds)
    for low, high, wave, name in ((0.31, 0.36, first, "products, water"), (0.7, 0.745, second, "water, air")):
        inside = (x > low) & (x < high)
        yield close(f"{name}: p*, N={n}", np.median(p[inside]), wave.p, 0.01)
    order = math.log(errors[0] / errors[-1]) / math.log(resolutions[-1] / resolutions[0])
    # nearly all of it is the contact of 1 to 10, whose width grows like N^(1/3) cells
    yield at_least(f"order of L1(density), N = {resolutions[0]} to {resolutions[-1]}", order, 0.6)
    base = layers("many_base", 200, 2e-4, ("wall", "wall"), parts)[0]
    for order in (("air", "water", "products"), ("water", "products", "air")):
        other = layers("many_" + "_".join(order), 200, 2e-4, ("wall", "wall"), parts, order)[0]
        yield at_most(f"named {', '.join(order)}: largest difference of p", float(np.max(np.abs(other[3] / base[3] - 1))), 1e-9)
    two = layers("many_two", 200, 2e-4, ("wall", "wall"), parts[:2])[0]
    for start, band in ((0.9, 1e-8), (0.5, 1e-3)):
        copied = parts[:2] + (("other water", WATER, start, water),)
        three = layers(f"many_copy_{start}", 200, 1e-4 if start == 0.9 else 2e-4, ("wall", "wall"), copied)[0]
        same = layers("many_two_short", 200, 1e-4, ("wall", "wall"), parts[:2])[0] if start == 0.9 else two
        yield at_most(f"a copy of the water beyond x = {start}{'' if start == 0.9 else ', crossed by the wave'}: L1(p) over max p",
                      float(np.mean(np.abs(three[3] - same[3])) / np.max(same[3])), band)
    six = [(f"gas {i}", reference.IdealGas(1.2 + 0.1 * i), i / 6, (1.0 + i, 50.0, 1e5)) for i in range(6)]
    (x, rho, u, p), result = layers("many_six", 240, 0.02, ("periodic", "periodic"), six)
    yield at_most("six gases, one period: p", float(np.max(np.abs(p / 1e5 - 1))), 1e-10, result.seconds)
    yield at_most("six gases, one period: u", float(np.max(np.abs(u / 50 - 1))), 1e-10)


def charge(n, end, air_from=0.5):
    """6.8 kg of TNT in a ball of water, air beyond, along a radius; air_from: radius where it begins, None: nowhere."""
    text = (f"[time]\nend = {end!r}\n" + output(f"{end!r} s", f"{end / 20!r} s")
            + f'[fluid]\ngeometry = "spherical"\nradius = 1.0\ncells = [{n}, 1, 1]\nboundary = {{x_upper = "outflow"}}\n')
    text += (material("air", AIR) if air_from else "") + material("water", WATER) + material("TNT", TNT)
    text += region('{kind = "everywhere"}', "water", 1000.0, 101325.0)
    if air_from:
        text += region(f'{{kind = "half_space", point = [{air_from}, 0, 0], normal = [1, 0, 0]}}', "air", 1.225, 101325.0)
    return (text + '[[fluid.region]]\nshape = {kind = "sphere", centre = [0, 0, 0], radius = 0.1}\nmaterial = "TNT"\nunburnt = true\npressure = 101325.0\n'
            + '[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0, 0, 0]]\n'
            + '[[fluid.gauge]]\nname = "near"\nposition = [0.2, 0, 0]\n[[fluid.gauge]]\nname = "far"\nposition = [0.4, 0, 0]\n')


@case("under_water")
def under_water():
    """A charge of TNT in water with air around it, along a radius: masses, peaks between grids, against water alone; how much of it is at the floor of pressure"""
    def gauges(result):
        table = fields.history(result.directory / "fluid_gauges.csv")
        return {name: float(np.max(values)) for name, values in table.items() if name in ("near pressure", "far pressure")}
    peaks, speed = {}, {}
    for n in (500, 1000):
        result = run(f"under_water_{n}", charge(n, 2.2e-4), only="fluid")
        table = fields.history(result.directory / "fluid_history.csv")
        peaks[n] = gauges(result)
        x, rho, u, p = profile(result.directory, 0)
        speed[n] = float(np.max(u))
        for name in ("TNT", "water", "air"):
            mass = table[f"mass {name}"]
            yield at_most(f"N={n}: mass of {name}, change by removed traces", abs(mass[-1] / mass[0] - 1), 1e-4, result.seconds)
        # water behind the wave from the air is pulled apart; nothing here models how it cavitates
        yield row(f"N={n}: cell-steps with p at its floor, of all", table["floors"][-1] / (n * table["step"][-1]), 0, 0, 1)
    alone = gauges(run("under_water_alone", charge(1000, 2.2e-4, None), only="fluid"))
    for name, peak in peaks[1000].items():
        yield close(f"{name}: peak, N=500 against 1000", peaks[500][name], peak, 0.1)
        yield close(f"{name}: peak against the same charge in water alone", peak, alone[name], 1e-2)
    yield row("largest speed, N=500 against 1000", speed[500], speed[1000], abs(speed[500] / speed[1000] - 1), 1)


BLAST = ("""[time]
end = 1.0
max_steps = 24
""" + output("1 s", "0 s") + """[checkpoint]
every_steps = 12
[fluid]
lower = [0, 0, 0]
upper = [0.4, 0.4, 0.4]
cells = [16, 16, 16]
amr = {levels = 1, every = 3}
boundary = {x_upper = "outflow", y_upper = "outflow", z_upper = "outflow"}
""" + material("air", AIR) + material("water", WATER) + material("TNT", TNT) + region('{kind = "everywhere"}', "air", 1.225, 101325.0)
         + region('{kind = "half_space", point = [0, 0, 0.2], normal = [0, 0, -1]}', "water", 1000.0, 101325.0)
         + '[[fluid.region]]\nshape = {kind = "sphere", centre = [0, 0, 0.15], radius = 0.08}\nmaterial = "TNT"\nunburnt = true\npressure = 101325.0\n'
         + '[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0, 0, 0.15]]\n'
         + '[[fluid.body]]\nname = "plate"\nshape = {kind = "box", lower = [0.25, 0.1, 0.1], upper = [0.3, 0.25, 0.35]}\nmotion = {kind = "velocity", value = [0.0, 0.0, 30.0]}\n')


def fields_of(result):
    flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
    return [flow.array(name) for name in ("density", "pressure", "alpha_TNT", "alpha_water", "alpha_air")]


@case("near_surface")
def near_surface():
    """A charge below a surface of water, air above, a plate that moves through both, levels: the same bits on ranks, threads and after a restart"""
    base = run("near_surface_1", BLAST, only="fluid", ranks="1", threads=1)
    first = fields_of(base)
    yield at_most("sum of volume fractions less 1", float(np.max(np.abs(sum(first[2:]) - 1)[first[0] > 0])), 1e-6, base.seconds)
    halfway = sorted(base.directory.glob("fluid_checkpoint_*.h5"))[0]
    others = {"2 threads": dict(threads=2), "2 ranks": dict(threads=1, ranks="2"),
              "after a restart halfway": dict(threads=2, words=("--restart", str(halfway)))}
    for name, how in others.items():
        other = run("near_surface_" + name.replace(" ", "_"), BLAST, only="fluid", **how)
        yield at_most(f"fields with other bits, {name}", sum(not np.array_equal(a, b) for a, b in zip(first, fields_of(other))), 0, other.seconds)
