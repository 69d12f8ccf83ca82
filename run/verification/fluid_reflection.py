# SPDX-License-Identifier: Apache-2.0
"""Shocks that meet walls at an angle: regular, Mach and double Mach reflection; walls along the grid and embedded."""
import math

import numpy as np

import fields

from . import reference
from .case import at_most, case, close, near, output, run
from .fluid import material, region

GAS = reference.IdealGas(1.4)


def oblique(mach, beta):
    """p2/p1, rho2/rho1, deflection, Mach number behind of an oblique shock of angle beta; gamma = 1.4 [Anderson, 4.3]."""
    g, m2 = 1.4, (mach * math.sin(beta)) ** 2
    p, rho = 1 + 2 * g / (g + 1) * (m2 - 1), (g + 1) * m2 / ((g - 1) * m2 + 2)
    theta = math.atan(2 / math.tan(beta) * (m2 - 1) / (mach**2 * (g + math.cos(2 * beta)) + 2))
    after = math.sqrt((1 + (g - 1) / 2 * m2) / (g * m2 - (g - 1) / 2)) / math.sin(beta - theta)
    return p, rho, theta, after


def regular_reflection(mach, wedge):
    """Behind the reflected shock at a wedge of so many degrees: p2/p0, the angle between that shock and the wall, and how fast the zone of this
    state grows along the wall (the flow leaves the point faster than sound)."""
    phi = math.radians(90 - wedge)  # between incident shock and wall
    p1, rho1, theta, m1 = oblique(mach / math.sin(phi), phi)
    low = math.asin(1 / m1) + 1e-9
    angles = np.linspace(low, math.pi / 2, 20001)
    strong = max(angles, key=lambda b: oblique(m1, b)[2])
    if oblique(m1, strong)[2] < theta:
        raise ValueError("no regular reflection")
    high = strong
    for _ in range(100):  # the weak solution
        mid = 0.5 * (low + high)
        low, high = (mid, high) if oblique(m1, mid)[2] < theta else (low, mid)
    p2, rho2, _, m2 = oblique(m1, low)
    return p1 * p2, math.degrees(low - theta), (m2 - 1) * math.sqrt(p1 * p2 / (rho1 * rho2))


def behind(mach):
    """density, speed, pressure behind a shock into (1.4, 0, 1)."""
    m2 = mach**2
    rho = 1.4 * 2.4 * m2 / (0.4 * m2 + 2)
    return rho, mach * (1 - 1.4 / rho), 1 + 2.8 / 2.4 * (m2 - 1)


def along_wall(mach, wedge, n, end, length, height, name, x0=1 / 6, threads=0):
    """A shock that leans over a wall y = 0, which it reaches at x0 when t = 0; n cells a unit of length."""
    lean = math.radians(wedge)  # the wall is the wedge; the shock's normal leans by its angle
    normal = (math.cos(lean), -math.sin(lean), 0.0)
    rho, u, p = behind(mach)
    velocity = [u * c for c in normal]
    text = (f"[time]\nend = {end!r}\n" + output(f"{end!r} s", "1000 s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [{length!r}, {height!r}, {1 / n!r}]\n"
            + f'cells = [{round(length * n)}, {round(height * n)}, 1]\nboundary = {{x_lower = "inflow", x_upper = "outflow", y_upper = "outflow"}}\n')
    text += f'[[fluid.inflow]]\nside = "x_lower"\nmaterial = "gas"\ndensity = {rho!r}\npressure = {p!r}\nvelocity = {[*velocity]}\n'
    text += material("gas", GAS) + region('{kind = "everywhere"}', "gas", 1.4, 1.0)
    text += region(f'{{kind = "half_space", point = [{x0!r}, 0, 0], normal = {[-c for c in normal]}}}', "gas", rho, p, velocity)
    result = run(f"F12_{name}", text, only="fluid", threads=threads)
    flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
    return flow.array("pressure")[:, :, 0].T, result


def fronts(p, n, level=58.75):
    """Where the foremost shock of each row has half of its pressure, linear between cells."""
    last = [np.nonzero(row > level)[0].max() for row in p]
    return np.array([(i + 0.5 + (row[i] - level) / (row[i] - row[i + 1])) / n for i, row in zip(last, p)])


@case("F12")
def f12():
    """Reflection of shocks: pressures of regular reflection, double Mach reflection and the straightness of its stem"""
    n, x0 = 60, 0.2
    for mach, wedge in ((2.0, 60), (2.0, 70), (3.0, 60), (1.5, 60)):
        expected, _, zone = regular_reflection(mach, wedge)
        speed = mach / math.cos(math.radians(wedge))  # of the reflection point along the wall
        end = 1.2 / speed
        p, result = along_wall(mach, wedge, n, end, 1.6, 1.6, f"regular_{mach:g}_{wedge}", x0)
        wall = p[0]
        foot = int((x0 + speed * end) * n)
        part = wall[foot - int(0.9 * zone * end * n):foot - int(0.5 * zone * end * n)]  # in the uniform zone, where it is thickest
        yield close(f"regular reflection, M {mach:g}, {wedge} deg: p2/p0 at the wall", float(np.median(part)), expected, 0.02, result.seconds)
    end = 0.2
    p, result = along_wall(10.0, 30, n, end, 3.6, 3.0, "double_mach")
    x = fronts(p[:int(1.3 * n)], n)
    row = round(1.0 * n)
    yield near("double Mach, 1/60: undisturbed shock at y = 1, t = 0.2 (in cells)", x[row] * n, (1 / 6 + (1 + 20 * end + 0.5 / n) / math.sqrt(3)) * n, 1.5, result.seconds)
    yield from stem(x, n, "double Mach, wall along the grid")


def stem(x, n, name):
    """The foremost front between wall and triple point: where the incident shock's slope begins."""
    slope = 1 / math.sqrt(3)
    y = (np.arange(len(x)) + 0.5) / n
    incident = x[int(1.2 * n)] + slope * (y - y[int(1.2 * n)])
    ahead = np.nonzero(x[:int(1.0 * n)] - incident[:int(1.0 * n)] > 2.0 / n)[0]
    triple = int(ahead.max()) + 1 if len(ahead) else 0
    yield near(f"{name}: triple point above the wall", triple / n, 0.44, 0.1)
    if triple > 4:
        line = np.polyfit(y[:triple - 2], x[:triple - 2], 2)  # a stem may bend as a whole
        yield at_most(f"{name}: kinks of the stem, in cells", np.abs(x[:triple - 2] - np.polyval(line, y[:triple - 2])).max() * n, 1.5)
        yield at_most(f"{name}: how far the stem's foot runs ahead of its middle, in cells", max(0.0, (x[0] - x[triple // 2]) * n), 3.0)
