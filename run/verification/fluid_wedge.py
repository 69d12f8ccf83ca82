# SPDX-License-Identifier: Apache-2.0
"""Shocks and embedded bodies across the grid: wedges in supersonic flow, tilted shock tube, cylinder, sphere."""
import math

import numpy as np

import fields

from . import reference
from .case import at_least, at_most, case, close, near, output, run
from .fluid import material, region
from .fluid_reflection import GAS, oblique

INFLOW = '[[fluid.inflow]]\nside = "x_lower"\nmaterial = "gas"\n'


def weak_shock(mach, theta):
    """Angle of the weak oblique shock that turns the flow by theta [degrees]."""
    want = math.radians(theta)
    low = math.asin(1 / mach) + 1e-9
    angles = np.linspace(low, math.pi / 2, 20001)
    high = max(angles, key=lambda b: oblique(mach, b)[2])
    for _ in range(100):
        mid = 0.5 * (low + high)
        low, high = (mid, high) if oblique(mach, mid)[2] < want else (low, mid)
    return low


def stream(mach, n, lower, upper, end, extra, sides='x_lower = "inflow", x_upper = "outflow", y_lower = "outflow", y_upper = "outflow"', history="1000 s"):
    """A box in a supersonic stream along x of (1.4, mach, 1); n cells a unit of length, one cell deep where lower and upper have two numbers."""
    low, high = [*lower, 0.0][:3], [*upper, 1 / n][:3]
    cells = [max(1, round((b - a) * n)) for a, b in zip(low, high)]
    text = f"[time]\nend = {end!r}\n" + output(f"{end!r} s", history)
    text += f"[fluid]\nlower = {low}\nupper = {high}\ncells = {cells}\nboundary = {{{sides}}}\n" + extra
    text += INFLOW + f"density = 1.4\npressure = 1.0\nvelocity = [{float(mach)!r}, 0, 0]\n"
    return text + material("gas", GAS) + region('{kind = "everywhere"}', "gas", 1.4, 1.0, (mach, 0, 0))


def picture(result, *names):
    """x, y and arrays [j, i] of the first layer at the end."""
    flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
    return (flow.centres(0), flow.centres(1), *(flow.array(name)[:, :, 0].T for name in names))


@case("F11")
def f11():
    """Oblique shocks from an embedded wedge, four of Mach 2 to 5: angle of the shock, pressure behind it, noise along the wall"""
    n, x0 = 100, 0.203
    for mach, theta in ((2, 10), (2, 20), (3, 20), (5, 20)):
        beta = weak_shock(mach, theta)
        p2, rho2, _, after = oblique(mach, beta)
        end = 1.6 / ((after - 1) * math.sqrt(p2 / rho2))  # until the slowest wave along the wall has left
        body = f'[[fluid.body]]\nname = "wedge"\nshape = {{kind = "wedge", point = [{x0!r}, 0.1037, 0.0], angle = {theta!r}, length = 3.0}}\n'
        result = run(f"F11_{mach}_{theta}", stream(mach, n, (0, 0), (1.6, 1.6), end, body), only="fluid")
        x, y, p = picture(result, "pressure")
        crossing, columns = [], []
        for i in np.flatnonzero((x > x0 + 0.4) & (x < 1.4)):
            if x0 + (x[i] - x0) * math.tan(beta) > 1.4:
                continue
            above = np.flatnonzero(p[:, i] > 0.5 * (1 + p2))
            j = above.max()
            if j + 1 < len(y):
                crossing.append(y[j] + (p[j, i] - 0.5 * (1 + p2)) / (p[j, i] - p[j + 1, i]) / n)
                columns.append(x[i])
        slope = np.polyfit(columns, crossing, 1)[0]
        yield near(f"M {mach}, {theta} deg: angle of the shock", math.degrees(math.atan(slope)), math.degrees(beta), 0.5, result.seconds)
        wall = lambda at: 0.1037 + (at - x0) * math.tan(math.radians(theta))  # noqa: E731
        front = lambda at: 0.1037 + (at - x0) * math.tan(beta)  # noqa: E731
        middle, beside = [], []
        for i in np.flatnonzero((x > x0 + 0.5) & (x < 1.3)):
            if front(x[i]) > 1.5:
                continue
            between = (y > wall(x[i]) + 0.3 * (front(x[i]) - wall(x[i]))) & (y < wall(x[i]) + 0.7 * (front(x[i]) - wall(x[i])))
            middle.append(p[between, i].mean())
            beside.append(p[np.flatnonzero(y > wall(x[i]))[0], i])
        yield close(f"M {mach}, {theta} deg: pressure between shock and wall", float(np.mean(middle)), p2, 0.02)
        yield at_most(f"M {mach}, {theta} deg: largest error of the pressure in the cells along the wall", np.abs(np.array(beside) / p2 - 1).max(), 0.05)


@case("tilted")
def tilted():
    """Sod's tube between walls at 30 degrees to the grid: L1 of density over that of a tube along the grid, order"""
    left, right, eos, _, x0, t = reference.SHOCK_TUBES["Sod"]
    exact = reference.Riemann(left, right, eos)
    sizes, errors = (50, 100, 200), {}
    for angle in (0, 30):
        errors[angle] = []
        for n in sizes:
            result, l1 = tube_at(angle, n, left, right, exact, t)
            errors[angle].append(l1)
    for n, straight, leaning in zip(sizes, errors[0], errors[30]):
        yield at_most(f"{n} cells a length: L1 at 30 deg over that along the grid", leaning / straight, 2.5, result.seconds)
    yield at_least("order of L1 at 30 deg", math.log(errors[30][0] / errors[30][-1]) / math.log(sizes[-1] / sizes[0]), 0.8)


def tube_at(angle, n, left, right, exact, t, width=0.203):
    """Two walls `width` apart, their tube through the middle of a box; L1 of density over the middle part of its length."""
    a = math.radians(angle)
    along, across = np.array([math.cos(a), math.sin(a)]), np.array([-math.sin(a), math.cos(a)])
    size = (1.0, 1.0) if angle else (1.0, 0.4)
    centre = np.array(size) / 2 + 0.0031
    text = f"[time]\nend = {t!r}\n" + output(f"{t!r} s", "1000 s")
    text += (f"[fluid]\nlower = [0, 0, 0]\nupper = [{size[0]}, {size[1]}, {1 / n!r}]\ncells = [{n}, {round(size[1] * n)}, 1]\n"
             'boundary = {x_lower = "outflow", x_upper = "outflow", y_lower = "outflow", y_upper = "outflow"}\n')
    vector = lambda v: [float(v[0]), float(v[1]), 0.0]  # noqa: E731
    text += material("gas", GAS) + region('{kind = "everywhere"}', "gas", float(left[0]), float(left[2]))
    text += region(f'{{kind = "half_space", point = {vector(centre)}, normal = {vector(along)}}}', "gas", float(right[0]), float(right[2]))
    for side in (1, -1):
        text += (f'[[fluid.body]]\nname = "wall{side}"\nshape = {{kind = "piston", point = {vector(centre - side * width / 2 * across)}, '
                 f'normal = {vector(side * across)}}}\n')
    result = run(f"tilted_{angle}_{n}", text, only="fluid")
    x, y, rho = picture(result, "density")
    X, Y = np.meshgrid(x - centre[0], y - centre[1])
    s, d = X * along[0] + Y * along[1], X * across[0] + Y * across[1]
    inside = (np.abs(d) < width / 2) & (np.abs(s) < 0.42)
    expected = exact.sample(s[inside] / t)[0]
    return result, float(np.mean(np.abs(rho[inside] - expected)))
