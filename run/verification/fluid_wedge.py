# SPDX-License-Identifier: Apache-2.0
"""Shocks and embedded bodies across the grid: wedges in supersonic flow, tilted shock tube, cylinder, sphere."""
import math

import numpy as np

import fields

from . import blunt_body, reference
from .case import at_least, at_most, case, close, near, output, run
from .fluid import material, region
from .fluid_reflection import GAS, along_wall, behind, fronts, oblique, regular_reflection

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


def wedge(mach, theta, n, x0=0.203, threads=0, walls="", note="", ramp=False):
    """A wedge in a supersonic stream until it is steady, n cells a unit of length; walls: text of [fluid.walls]; ramp: it rises from the floor: the run, the exact angle of its shock
    and the pressure behind it."""
    beta = weak_shock(mach, theta)
    p2, rho2, _, after = oblique(mach, beta)
    end = 1.6 / ((after - 1) * math.sqrt(p2 / rho2))  # until the slowest wave along the wall has left
    body = f'[[fluid.body]]\nname = "wedge"\nshape = {{kind = "wedge", point = [{x0!r}, 0.1037, 0.0], angle = {theta!r}, length = 3.0}}\n'
    lower, upper, sides = (0, 0), (1.6, 1.6), ("outflow", "outflow")
    if ramp:
        lower, upper, sides = (0, 0.1037), (1.6, 1.6037), ("wall", "outflow")
        corners = [[x0, 0.1037, 0.0], [x0, -1.0, 0.0], [x0 + 3, -1.0, 0.0], [x0 + 3, 0.1037 + 3 * math.tan(math.radians(theta)), 0.0]]
        body = f'[[fluid.body]]\nname = "ramp"\nshape = {{kind = "prism", points = {corners}}}\n'
    sides = f'x_lower = "inflow", x_upper = "outflow", y_lower = "{sides[0]}", y_upper = "{sides[1]}"'
    return run(f"F11_{mach}_{theta}_{n}{note}", stream(mach, n, lower, upper, end, walls + body, sides), only="fluid", threads=threads), beta, p2


@case("F11")
def f11():
    """Oblique shocks from an embedded wedge, four of Mach 2 to 5: angle of the shock, pressure behind it, noise along the wall"""
    yield from wedges()


def wedges(walls="", note="", ramp=False):
    n, x0 = 100, 0.203
    for mach, theta in ((2, 10), (2, 20), (3, 20), (5, 20)):
        result, beta, p2 = wedge(mach, theta, n, x0, walls=walls, note=note, ramp=ramp)
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
        yield near(f"M {mach}, {theta} deg{note}: angle of the shock", math.degrees(math.atan(slope)), math.degrees(beta), 0.5, result.seconds)
        wall = lambda at: 0.1037 + (at - x0) * math.tan(math.radians(theta))  # noqa: E731
        front = lambda at: 0.1037 + (at - x0) * math.tan(beta)  # noqa: E731
        middle, beside = [], []
        for i in np.flatnonzero((x > x0 + 0.5) & (x < 1.3)):
            if front(x[i]) > 1.5:
                continue
            between = (y > wall(x[i]) + 0.3 * (front(x[i]) - wall(x[i]))) & (y < wall(x[i]) + 0.7 * (front(x[i]) - wall(x[i])))
            middle.append(p[between, i].mean())
            beside.append(p[np.flatnonzero(y > wall(x[i]))[0], i])
        yield close(f"M {mach}, {theta} deg{note}: pressure between shock and wall", float(np.mean(middle)), p2, 0.02)
        yield at_most(f"M {mach}, {theta} deg{note}: largest error of the pressure in the cells along the wall", np.abs(np.array(beside) / p2 - 1).max(), 0.05)


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


@case("F12e")
def f12e():
    """Embedded walls across the grid: double Mach reflection on a wedge, shock on a cylinder, stand-off before a sphere"""
    yield from embedded_wedge()
    yield from shocked_cylinder()
    yield from sphere()


def embedded_wedge():
    """A shock of Mach 10 along the grid meets a wedge of 30 degrees; regular reflection on one of 60 at Mach 2."""
    n, lift = 60, 0.0137
    for mach, wedge, end in ((10.0, 30, 0.2), (2.0, 60, 0.35)):
        slope = math.tan(math.radians(wedge))
        length, height = (3.0, 2.2) if wedge == 30 else (1.2, 2.0)
        x0 = 0.2
        rho, u, p = behind(mach)
        text = f"[time]\nend = {end!r}\n" + output(f"{end!r} s", "1000 s")
        text += (f"[fluid]\nlower = [0, 0, 0]\nupper = [{length}, {height}, {1 / n!r}]\ncells = [{round(length * n)}, {round(height * n)}, 1]\n"
                 'boundary = {x_lower = "inflow", x_upper = "outflow"}\n')
        text += INFLOW + f"density = {rho!r}\npressure = {p!r}\nvelocity = [{u!r}, 0, 0]\n"
        # its floor lies below the domain, so that the ramp begins at the lower side
        text += (f'[[fluid.body]]\nname = "wedge"\nshape = {{kind = "wedge", point = [{x0 - lift / slope!r}, {-lift!r}, 0.0], angle = {float(wedge)!r}, '
                 'length = 4.0}\n')
        text += material("gas", GAS) + region('{kind = "everywhere"}', "gas", 1.4, 1.0)
        text += region(f'{{kind = "half_space", point = [{x0!r}, 0, 0], normal = [-1.0, 0.0, 0.0]}}', "gas", rho, p, (u, 0, 0))
        result = run(f"F12e_wedge_{wedge}", text, only="fluid")
        x, y, pressure = picture(result, "pressure")
        shock = x0 + mach * end
        top = pressure[-4]
        i = np.flatnonzero(top > 0.5 * p).max()
        at = x[i] + (top[i] - 0.5 * p) / (top[i] - top[i + 1]) / n
        yield near(f"M {mach:g}, wedge {wedge} deg: incident shock (in cells)", at * n, shock * n, 1.5, result.seconds)
        X, Y = np.meshgrid(x, y)
        along = (X - x0) * math.cos(math.radians(wedge)) + Y * math.sin(math.radians(wedge))
        off = -(X - x0) * math.sin(math.radians(wedge)) + Y * math.cos(math.radians(wedge))
        beside = (off > 0) & (off < 1.0 / n)
        order = np.argsort(along[beside])
        s, p_wall = along[beside][order], pressure[beside][order]
        foot = mach * end / math.cos(math.radians(wedge))  # of the incident shock on the wedge
        if wedge == 60:
            expected, _, zone = regular_reflection(mach, wedge)
            part = p_wall[(s > foot - 0.9 * zone * end) & (s < foot - 0.5 * zone * end)]
            yield close(f"M {mach:g}, wedge {wedge} deg: p2/p0 at the wall", float(np.median(part)), expected, 0.02)
            yield at_most("the same: noise of the pressure in the cells along the wall", float(np.abs(part / np.median(part) - 1).max()), 0.05)
        else:
            # the same flow with its wall along the grid (F12), turned: where the stem stands on the wall, in units of time
            straight, _ = along_wall(10.0, 30, n, end, 3.6, 3.0, "double_mach")
            row0 = straight[0]
            stem_straight = fronts(straight[:1], n)[0] - 1 / 6
            last = np.flatnonzero(p_wall > 58.75).max()
            foot = s[last] + (p_wall[last] - 58.75) / (p_wall[last] - p_wall[last + 1]) * (s[last + 1] - s[last])
            yield near("double Mach: foot of the stem along the embedded wedge, against the wall along the grid (in cells)", foot * n, stem_straight * n, 3.0)
            peak_e, peak_s = float(np.max(p_wall[s > 0.3])), float(np.max(row0[int((1 / 6 + 0.3) * n):]))
            yield close("double Mach: largest pressure along the wall, against the wall along the grid", peak_e, peak_s, 0.05)


def shocked_cylinder():
    """A shock of Mach 2.81 hits a cylinder [Bryson and Gross 1961]: the pressure at its nose as it arrives is that of reflection at a plane wall."""
    mach, radius = 2.81, 0.5
    m2 = mach * mach
    p2 = 1 + 2.8 / 2.4 * (m2 - 1)
    p5 = p2 * ((3 * 1.4 - 1) * p2 - 0.4) / (0.4 * p2 + 2.4)
    rho, u, p = behind(mach)
    peaks = []
    for n in (100, 200):
        end = 0.05
        text = f"[time]\nend = {end!r}\n" + output(f"{end!r} s", "0 s")
        text += (f"[fluid]\nlower = [-1.0, 0.0, 0.0]\nupper = [0.0, 0.6, {1 / n!r}]\ncells = [{n}, {round(0.6 * n)}, 1]\n"
                 'boundary = {x_lower = "inflow", x_upper = "wall", y_lower = "symmetry", y_upper = "outflow"}\n')
        text += INFLOW + f"density = {rho!r}\npressure = {p!r}\nvelocity = [{u!r}, 0, 0]\n"
        text += (f'[[fluid.body]]\nname = "cylinder"\nfacet = {0.5 / n!r}\nshape = {{kind = "cylinder", start = [0.0037, 0.0, -1.0], end = [0.0037, 0.0, 1.0], '
                 f'radius = {radius}}}\n')
        text += f'[[fluid.gauge]]\nname = "nose"\nposition = [{0.0037 - radius - 0.5 / n!r}, {0.5 / n!r}, {0.5 / n!r}]\n'
        text += material("gas", GAS) + region('{kind = "everywhere"}', "gas", 1.4, 1.0)
        text += region('{kind = "half_space", point = [-0.58, 0, 0], normal = [-1.0, 0.0, 0.0]}', "gas", rho, p, (u, 0, 0))
        result = run(f"F12e_cylinder_{n}", text, only="fluid")
        gauges = fields.history(result.directory / "fluid_gauges.csv")
        peaks.append(float(gauges["nose pressure"].max()))
    yield close("M 2.81 on a cylinder, 100 cells a radius: peak of the pressure beside the nose, p5", peaks[-1], p5, 0.05, result.seconds)
    yield at_most("the same: 100 cells are nearer than 50 (error over error)", abs(peaks[1] / p5 - 1) / abs(peaks[0] / p5 - 1), 0.75)


def sphere():
    """Bow shock before a sphere at Mach 3, a quarter of the flow: stand-off (against a grid that follows the sphere; Billig's fit of experiments is 5 % below) and pitot pressure \
(Rayleigh)."""
    mach, radius, n = 3.0, 0.5, 80
    body = f'[[fluid.body]]\nname = "sphere"\nfacet = {1.0 / n!r}\nshape = {{kind = "sphere", centre = [0.0037, 0.0, 0.0], radius = {radius}}}\n'
    sides = 'x_lower = "inflow", x_upper = "outflow", y_lower = "symmetry", y_upper = "outflow", z_lower = "symmetry", z_upper = "outflow"'
    result = run("F12e_sphere", stream(mach, n, (-0.75, 0.0, 0.0), (-0.1, 0.75, 0.75), 2.0, body, sides), only="fluid")
    flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
    x, p = flow.centres(0), flow.array("pressure")[:, 0, 0]
    nose = 0.0037 - radius
    ahead = x < nose
    half = 0.5 * (1 + 2.8 / 2.4 * (mach * mach - 1) + 1)
    i = np.flatnonzero(ahead & (p < half)).max()
    front = x[i] + (half - p[i]) / (p[i + 1] - p[i]) / n
    pitot = (1.2 * mach**2) ** 3.5 / ((2.8 * mach**2 - 0.4) / 2.4) ** 2.5
    stand_off, at_nose = blunt_body.sphere_stand_off(mach, 40, 1.6, 3000)
    yield close("the reference itself: pressure at the nose over that of a pitot tube", at_nose, pitot, 0.002)
    yield close("M 3 on a sphere, 40 cells a radius: stand-off over the radius", (nose - front) / radius, stand_off, 0.06, result.seconds)
    yield close("the same: pressure of the cell at the nose over that of a pitot tube", float(p[ahead][-1]), pitot, 0.02)
