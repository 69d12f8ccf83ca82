# SPDX-License-Identifier: Apache-2.0
"""Bodies of a few cells in fast flow: the cells around them see walls that disagree, and must stay within what a wall can do to the gas."""
import math
import random

import fields

from . import reference
from .case import at_most, case, output, run
from .fluid import material, region

N, P0, RHO0, GAMMA = 40, 101325.0, 1.225, 1.4
SCENES = [("sphere", "fixed", 2.0), ("box", "fixed", 3.0), ("cylinder", "fixed", 8.0), ("sphere", "turning", 5.0), ("cylinder", "turning", 2.0), ("box", "turning", 3.0),
          ("sphere", "driven", 3.0), ("cylinder", "driven", 5.0), ("box", "driven", 1.5), ("sphere", "free", 2.0), ("cylinder", "free", 3.0), ("box", "free", 8.0)]


def behind(mach):
    """Density, pressure, speed of the gas behind a shock into air at rest."""
    c, square = math.sqrt(GAMMA * P0 / RHO0), mach * mach
    return RHO0 * 2.4 * square / (0.4 * square + 2), P0 * (1 + 2.8 / 2.4 * (square - 1)), 2 * c / 2.4 * (mach - 1 / mach)


def stopped(rho, p, speed):
    """Pressure at a wall which the gas meets with that speed [Toro 4.6, for the pressure]."""
    a, b = 2 / (2.4 * rho), 0.4 / 2.4 * p
    half = speed * speed / (2 * a)
    return p + half + math.sqrt(half * half + speed * speed * (p + b) / a)


def small_body(rng, shape, motion):
    """Text of a body of 1.2 to 5 cells, turned, not on the grid; its fastest speed."""
    size = rng.uniform(1.2, 5) / N
    centre = [0.4 + rng.uniform(-0.5, 0.5) / N] + [0.5 + rng.uniform(-0.5, 0.5) / N for _ in range(2)]
    if shape == "sphere":
        text = f'{{kind = "sphere", centre = {centre}, radius = {size!r}}}'
    elif shape == "box":
        half = [size * rng.uniform(0.3, 1.2) for _ in range(3)]
        text = f'{{kind = "box", lower = {[c - h for c, h in zip(centre, half)]}, upper = {[c + h for c, h in zip(centre, half)]}}}'
    else:
        ends = [centre[:2] + [centre[2] + side * 1.3 * size] for side in (-1, 1)]
        text = f'{{kind = "cylinder", start = {ends[0]}, end = {ends[1]}, radius = {0.7 * size!r}}}'
    speed, rim = 200.0, 300.0
    v = [rng.uniform(-1, 1) for _ in range(3)]
    v = [speed * a / math.hypot(*v) for a in v]
    moves = {"fixed": '{kind = "fixed"}', "driven": f'{{kind = "velocity", value = {v}}}',
             "turning": f'{{kind = "rotation", rate = {rim / (2 * size)!r}, axis = [1, 2, 0.5], point = {centre}}}',
             "free": f'{{kind = "free", density = 500.0, velocity = {v}}}'}
    axis = [rng.uniform(-1, 1) for _ in range(3)]
    place = f"turn_angle = {rng.uniform(0, 90)!r}\nturn_axis = {axis}\nturn_point = {centre}\n"
    fastest = {"fixed": 0.0, "driven": speed, "turning": rim, "free": speed}[motion]
    return f'[[fluid.body]]\nname = "body"\nshape = {text}\n{place}motion = {moves[motion]}\n', fastest


def extremes(result):
    """Largest pressure and density in the fields' open cells."""
    most_p = most_rho = 0.0
    for _, path in fields.series(result.directory, "fluid"):
        flow = fields.Fluid(path)
        is_open = flow.array("covered") == 0
        most_p = max(most_p, float(flow.array("pressure")[is_open].max()))
        most_rho = max(most_rho, float(flow.array("density")[is_open].max()))
    return most_p, most_rho


def chamber(end, sides="outflow", inflow=""):
    names = {f"{a}_{s}": sides for a in "xyz" for s in ("lower", "upper")} | ({"x_lower": inflow} if inflow else {})
    return (f"[time]\nend = {end!r}\n" + output(f"{end / 3!r} s", "0 s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = [{N}, {N}, {N}]\n"
            + "boundary = {" + ", ".join(f'{name} = "{kind}"' for name, kind in names.items()) + "}\n")


@case("T9b", quick=True)
def t9b():
    """Balls, boxes and cylinders of 1 to 5 cells, fixed, driven, turning, free, under shocks of Mach 1.5 to 8, and in products that burst into air: pressure and density within what a wall can make of the gas"""
    rng = random.Random(10)
    for shape, motion, mach in SCENES:
        rho, p, u = behind(mach)
        body, fastest = small_body(rng, shape, motion)
        supersonic = u > math.sqrt(GAMMA * p / rho)
        text = chamber(0.9 / (mach * math.sqrt(GAMMA * P0 / RHO0)), inflow="inflow" if supersonic else "far_field")
        text += f'[[fluid.inflow]]\nside = "x_lower"\nmaterial = "air"\ndensity = {rho!r}\npressure = {p!r}\nvelocity = [{u!r}, 0, 0]\n'
        text += material("air", reference.GAS) + region('{kind = "everywhere"}', "air", RHO0, P0)
        text += region('{kind = "half_space", point = [0.2, 0, 0], normal = [-1, 0, 0]}', "air", rho, p, (u, 0, 0)) + body
        result = run(f"T9b_{shape}_{motion}", text, only="fluid")
        most_p, most_rho = extremes(result)
        name = f"{shape}, {motion}, Mach {mach:g}"
        yield at_most(f"{name}: largest pressure over that of a wall which stops the gas", most_p / stopped(rho, p, u + fastest), 1.0, result.seconds)
        yield at_most(f"{name}: largest density over 6 times that behind the shock", most_rho / (6 * rho), 1.0)
    tnt = reference.JWL_SETS["TNT"]
    rho, energy = 800.0, 3e9  # kg/m^3, J/m^3
    p = tnt.pressure(rho, energy / rho)
    for shape in ("sphere", "box", "cylinder"):
        body, _ = small_body(rng, shape, "fixed")
        text = chamber(1.5e-4) + material("products", tnt) + material("air", reference.GAS) + region('{kind = "everywhere"}', "air", RHO0, P0)
        text += region('{kind = "half_space", point = [0.2, 0, 0], normal = [-1, 0, 0]}', "products", rho, p) + body
        result = run(f"T9b_products_{shape}", text, only="fluid")
        most_p, most_rho = extremes(result)
        yield at_most(f"{shape} in products: largest pressure over the first", most_p / p, 1.0 + 1e-6, result.seconds)
        yield at_most(f"{shape} in products: largest density over the first", most_rho / rho, 1.0 + 1e-6)
