# SPDX-License-Identifier: Apache-2.0
"""Sides of the domain: what comes back from an open one, and what flows in."""
import numpy as np

import fields

from . import reference
from .case import at_most, case, close, output, run
from .fluid import material, region, tube

P0, RHO0, C0 = 101325.0, 1.225, (1.4 * 101325.0 / 1.225) ** 0.5


def side_state(side, velocity=(0.0, 0.0, 0.0), density=RHO0, pressure=P0):
    return f'[[fluid.inflow]]\nside = "{side}"\nmaterial = "air"\ndensity = {density!r}\npressure = {pressure!r}\nvelocity = {[float(v) for v in velocity]}\n'


def acoustic_pulse(kind, n=200):
    """A pulse of 1e-4 p0 to the right, 20 cells wide at half height; largest |p - p0| left behind of its own height."""
    steps = "".join(region(f'{{kind = "box", lower = [{(i + .0) / n!r}, -1, -1], upper = [{(i + 1.) / n!r}, 2, 2]}}', "air",
                           RHO0 * (1 + s / 1.4), P0 * (1 + s), (s * P0 / (RHO0 * C0), 0.0, 0.0))
                    for i in range(n) if (s := float(1e-4 * np.exp(-(((i + .5) / n - 0.5) / 0.06) ** 2))) > 1e-12)
    end = 1.2 / C0
    text = tube(0.0, 1.0, n, 0, ("outflow", kind), end, fields_every=end)
    text += side_state("x_upper") if kind == "far_field" else ""
    text += material("air", reference.GAS) + region('{kind = "everywhere"}', "air", RHO0, P0) + steps
    result = run(f"boundaries_acoustic_{kind}", text, only="fluid")
    p = fields.Fluid(fields.series(result.directory, "fluid")[-1][1]).array("pressure").reshape(-1)
    first = fields.Fluid(fields.series(result.directory, "fluid")[0][1]).array("pressure").reshape(-1)
    return np.abs(p - P0).max() / (first - P0).max(), result.seconds


def blast(size, kind, n):
    """A quarter of a cylinder of hot air bursts; p/p0 over time at a point near the side x = 1 and one at the middle of it."""
    end = 2.2 / C0
    text = (f"[time]\nend = {end!r}\n" + output("0 s", "1 s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [{size!r}, {size!r}, 0.1]\ncells = [{n}, {n}, 1]\n"
            + f'boundary = {{x_upper = "{kind}", y_upper = "{kind}"}}\n')
    text += "".join(side_state(side) for side in ("x_upper", "y_upper")) if kind == "far_field" else ""
    text += material("air", reference.GAS) + region('{kind = "everywhere"}', "air", RHO0, P0)
    text += region('{kind = "cylinder", start = [0, 0, -1], end = [0, 0, 1], radius = 0.2}', "air", RHO0, 40 * P0)
    for name, x in (("head_on", (0.9, 0.0)), ("oblique", (0.9, 0.6)), ("inside", (0.5, 0.1))):
        text += f'[[fluid.gauge]]\nname = "{name}"\nposition = [{x[0]}, {x[1]}, 0.05]\n'
    return run(f"boundaries_blast_{kind}_{n}", text, only="fluid")


@case("boundaries")
def boundaries():
    """What an open side sends back: an acoustic pulse, a blast shock against a larger domain; inflow, supersonic and subsonic"""
    for kind in ("outflow", "far_field"):
        back, seconds = acoustic_pulse(kind)
        yield at_most(f"acoustic pulse, {kind}: what comes back of it", back, 0.01, seconds)
    n = 64
    wide = blast(3.0, "outflow", 3 * n)
    expected = fields.history(wide.directory / "fluid_gauges.csv")
    for kind in ("outflow", "far_field"):
        near = blast(1.0, kind, n)
        measured = fields.history(near.directory / "fluid_gauges.csv")
        for name in ("head_on", "oblique", "inside"):
            p = np.interp(expected["t"], measured["t"], measured[f"{name} pressure"])
            shock = expected[f"{name} pressure"].max() - P0
            # the front passes steeply: a step's shift in time is no reflection
            yield at_most(f"blast, {kind}, {name}: largest difference to a domain of 3 times the size, of the shock", np.abs(p - expected[f"{name} pressure"]).max() / shock,
                          0.03, near.seconds)
    yield from inflows()


def inflows():
    for name, kind, mach, density, pressure in (("supersonic", "inflow", 2.0, 2.0, 150e3), ("subsonic", "subsonic_inflow", 0.4, RHO0, P0)):
        u = mach * (1.4 * pressure / density) ** 0.5
        end = 30 / C0 if kind != "inflow" else 4 / C0
        text = tube(0.0, 1.0, 100, 0, (kind, "far_field"), end, fields_every=end)
        text += side_state("x_lower", (u, 0, 0), density, pressure) + side_state("x_upper", (u, 0, 0), density, P0)
        text += material("air", reference.GAS) + region('{kind = "everywhere"}', "air", RHO0, P0, (0.5 * u, 0, 0))
        result = run(f"boundaries_{name}", text, only="fluid")
        flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
        rho = flow.array("density").reshape(-1)
        yield close(f"{name} inflow, Mach {mach}: density in the end", rho.mean(), density, 1e-3, result.seconds)
        yield close(f"{name} inflow: pressure in the end", flow.array("pressure").reshape(-1).mean(), pressure if kind == "inflow" else P0, 1e-3)
        yield close(f"{name} inflow: velocity in the end", flow.levels[0][2]["velocity"].reshape(100, -1)[:, 0].mean(), u, 1e-3)
