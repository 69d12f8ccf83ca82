# SPDX-License-Identifier: Apache-2.0
"""Pistons: embedded walls that push gas and products or run away from them, against exact solutions."""
import math

import numpy as np

from . import reference
from .case import at_least, at_most, case, close, output, run, unit_rows
from .fluid import along, material, profile, plateau, region, tube

import fields  # noqa: E402  (fluid.py adds the folder)


def piston(speed, point, normal=(1.0, 0.0, 0.0)):
    velocity = [float(speed * n) for n in normal]
    return (f'[[fluid.body]]\nname = "piston"\nshape = {{kind = "piston", point = {[float(x) for x in point]}, normal = {list(normal)}}}\n'
            f'motion = {{kind = "velocity", value = {velocity}}}\n')


@case("F10")
def f10():
    """Impulsively started pistons, 50 to 2000 m/s, pushing and withdrawing: wall pressure, density, mass, 400 cells; at 30 degrees to the grid"""
    yield from aligned_pistons()
    yield from oblique_pistons()


def aligned_pistons(walls="", note="", body=piston):
    """Pistons along the grid; walls: text of [fluid.walls]; body: that of a speed, a point and a normal."""
    n, x0 = 400, 0.5
    for speed in (50, 100, 340, 1000, 2000, -50, -100, -340, -1000, -2000):
        t = 1e-3 if abs(speed) < 1000 else 2e-4
        text = tube(0.0, 2.0, n, 0, ("wall", "wall"), t) + walls + material("air", reference.GAS)
        text += region('{kind = "everywhere"}', "air", 1.225, 101325.0) + body(speed, (x0, 0, 0))
        result = run(f"F10_{speed}{note}", text, only="fluid")
        x, rho, u, p = profile(result.directory, 0)
        yield from impulsive(speed, x, rho, p, x0, t, 2.0 / n, result.seconds, note)
        # mass: cells are whole, so their edge beside the wall is up to half a cell off
        h = 2.0 / n
        open_cells = x > x0 + speed * t
        first = x[open_cells][0]
        mass = float(np.sum(rho[open_cells]) * h + rho[open_cells][0] * (first - 0.5 * h - (x0 + speed * t)))
        name = f"{'push' if speed > 0 else 'withdraw'} {abs(speed)} m/s{note}"
        yield at_most(f"{name}: mass in front of the wall, off by so many cells of gas at rest", abs(mass - 1.225 * (2.0 - x0)) / (1.225 * h), 1.0)


def impulsive(speed, x, rho, p, x0, t, h, seconds, note=""):
    """Rows of one profile along the way of the wall."""
    wall = x0 + speed * t
    expected_p, expected_rho, shock = reference.driven_piston(speed)
    c0 = math.sqrt(1.4 * 101325 / 1.225)
    reach = shock * t if shock else max((c0 + 1.2 * speed) * t, speed * t)
    inside = (wall + 4 * h, wall + 4 * h + max(0.6 * (x0 + reach - wall - 8 * h), 2 * h))
    name = f"{'push' if speed > 0 else 'withdraw'} {abs(speed)} m/s{note}"
    if expected_p > 1000:
        yield close(f"{name}: wall pressure plateau", plateau(x, p, *inside), expected_p, 0.01, seconds)
        first = int(np.flatnonzero(x > wall + 0.5 * h)[0])
        yield close(f"{name}: density beside the wall", rho[first], expected_rho, 0.05)
    else:
        yield at_most(f"{name}: wall pressure over p0 (exact {expected_p / 101325:.2g})", plateau(x, p, *inside) / 101325, 0.01, seconds)
        yield at_least(f"{name}: least pressure", p[x > wall].min(), 0.0)


def oblique_pistons(walls="", note="", body=piston):
    """The wall leans by 30 degrees: a line along its way through the middle of a box; arguments as of aligned_pistons."""
    n, angle = 200, math.radians(30)
    normal = (math.cos(angle), math.sin(angle), 0.0)
    h, centre = 1.0 / n, np.array([0.5, 0.5])
    for speed in (100, 340, 1000, -100, -340):
        t, start = 3e-4 if speed > 500 else 7e-4, 0.0
        text = (f"[time]\nend = {t!r}\n" + output(f"{t!r} s", "0 s")
                + f'[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, {h!r}]\ncells = [{n}, {n}, 1]\n'
                + 'boundary = {x_lower = "outflow", x_upper = "outflow", y_lower = "outflow", y_upper = "outflow"}\n')
        text += walls + material("air", reference.GAS) + region('{kind = "everywhere"}', "air", 1.225, 101325.0) + body(speed, (*centre, 0.0), normal)
        result = run(f"F10_30deg_{speed}{note}", text, only="fluid")
        flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
        X, Y = np.meshgrid(flow.centres(0), flow.centres(1), indexing="ij")
        way = (X - centre[0]) * normal[0] + (Y - centre[1]) * normal[1]
        aside = -(X - centre[0]) * normal[1] + (Y - centre[1]) * normal[0]
        rho, p = flow.array("density")[:, :, 0], flow.array("pressure")[:, :, 0]
        pick = (np.abs(aside) < 0.5 * h) & (way > speed * t)
        order = np.argsort(way[pick])
        yield from impulsive(speed, way[pick][order], rho[pick][order], p[pick][order], start, t, h, result.seconds, ", 30 deg" + note)


@case("F10b")
def f10b():
    """Smooth pistons (sin^2 pulse), wall pressure against the exact simple wave: error at 100 cells, order to 400"""
    bands = {"m0.5_error_100": 1.2 * 1.27e-3, "m0.3_error_100": 1.2 * 3.98e-4, "p0.3_error_100": 1.2 * 1.02e-4}
    yield from unit_rows("cfd", "EmbedPiston.SmoothPiston*", bands | {f"{a}_short_of_order_2": 0.1 for a in ("m0.5", "m0.3", "p0.3")})


@case("F10c")
def f10c():
    """Walls that run away from products at 10 GPa with 0.5 to 3 km/s: pressure against the isentrope, least pressure, density"""
    tnt, n, length, x0, t = reference.JWL_SETS["TNT"], 400, 0.24, 0.12, 1.2e-5
    rho0, p0 = 1630.0, 1e10
    for speed in (500.0, 1000.0, 2000.0, 3000.0):
        text = tube(0.0, length, n, 0, ("wall", "wall"), t) + material("products", tnt)
        text += region('{kind = "everywhere"}', "products", rho0, p0) + piston(-speed, (x0, 0, 0))
        result = run(f"F10c_{speed:.0f}", text, only="fluid")
        x, rho, u, p = profile(result.directory, 0)
        low, high = rho0 * 1e-3, rho0  # the gas that has the wall's speed
        for _ in range(100):
            rho_w = math.sqrt(low * high)
            low, high = (rho_w, high) if reference.riemann_integral(tnt, rho0, p0, rho_w) > speed else (low, rho_w)
        p_w = tnt.isentrope(rho_w, rho0, p0)
        wall, tail = x0 - speed * t, x0 + (tnt.sound_speed(rho_w, p_w) - speed) * t
        h = length / n
        inside = (wall + 2 * h, wall + 2 * h + 0.6 * (tail - wall - 2 * h))
        yield close(f"from {speed:.0f} m/s: pressure between wall and fan", plateau(x, p, *inside), p_w, 0.02, result.seconds)
        yield close(f"from {speed:.0f} m/s: pressure of the cell at the wall", p[x > wall + 0.5 * h][0], p_w, 0.02)
        yield close(f"from {speed:.0f} m/s: density between wall and fan", plateau(x, rho, 0.5 * (inside[0] + inside[1]), inside[1]), rho_w, 0.02)
        yield at_least(f"from {speed:.0f} m/s: least pressure", p[x > wall].min(), 0.0)
