# SPDX-License-Identifier: Apache-2.0
"""The pressure filter: A4 (Taylor bar with every kind and strength), S6 (punch into an incompressible block)."""
import numpy as np

from .case import at_most, between, case, close, output, run
from .solid import fields, roller, taylor
from .solid_waves import history

# VALIDATION A.4, an axisymmetric code, 8 x 40: kind, strength, raw chi, max |J - 1| and foot radius [mm] at 80 us
TABLE = (("off", 0.0, .081, .0032, 7.110), ("plain", 0.5, .091, .0035, 7.111), ("self_adjoint", 0.5, .120, .0041, 7.123),
         ("plain", 1.0, .220, .0051, 7.125), ("self_adjoint", 0.9, .288, .0069, 7.139), ("self_adjoint", 1.0, .726, .0139, 7.140))


@case("A4")
def a4():
    """What filters do to the Taylor bar (8 across, 40 along): volumes' real checkerboard, foot radius, energy, against VALIDATION A.4"""
    measured = {}
    for kind, strength, chi, volume, radius in TABLE:
        extra = "" if kind == "off" else f'[solid.filter]\nkind = "{kind}"\nstrength = {strength}\nbeyond = true\n'
        result = run(f"A4_{kind}_{strength:g}", taylor(8, 40, extra=extra), only="solid", threads=1)
        solid = fields.Solid(fields.series(result.directory, "solid")[-1][1])
        table = history(result)
        x = solid.points
        foot = np.hypot(x[:, 0], x[:, 1])[x[:, 2] < 1e-6].max() * 1e3
        measured[kind, strength] = table["checkerboard"][-1]
        name = f"{kind} {strength:g}" if kind != "off" else "off"
        yield close(f"{name}: foot radius [mm]", foot, radius, 0.01, result.seconds)
        yield between(f"{name}: raw chi at 80 us (axisymmetric: {chi})", table["checkerboard"][-1], 0.4 * chi, 2.5 * chi)
        yield between(f"{name}: largest |J - 1| (axisymmetric: {volume})", np.abs(solid.cell["J"] - 1).max(), 0.4 * volume, 2.5 * volume)
        yield at_most(f"{name}: energy residual over the kinetic energy at the start", np.abs(table["energy_residual"]).max() / table["kinetic_energy"][0], 0.01)
    yield between("raw chi, self_adjoint 1 over self_adjoint 0.5", measured["self_adjoint", 1.0] / measured["self_adjoint", 0.5], 2.5, 20)
    yield between("raw chi, self_adjoint 0.5 over none", measured["self_adjoint", 0.5] / measured["off", 0.0], 0.7, 2.5)
    for gate in ("checkerboard", "plastic"):
        result = run(f"A4_gate_{gate}", taylor(8, 40, extra=f'[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\ngate = "{gate}"\n'), only="solid", threads=1)
        table = history(result)
        yield at_most(f"self_adjoint 0.5, gate {gate}: raw chi at 80 us", table["checkerboard"][-1], 2.5 * TABLE[2][2], result.seconds)
        yield at_most(f"self_adjoint 0.5, gate {gate}: energy residual", np.abs(table["energy_residual"]).max() / table["kinetic_energy"][0], 0.01)


def roughness(values, n):
    """chi of a field on n x n equal elements in row order: sum |p - A p| / sum |p| over the inner ones."""
    p = values.reshape(n, n)
    padded = np.zeros((n + 1, n + 1))
    count = np.zeros((n + 1, n + 1))
    for i in (0, 1):
        for j in (0, 1):
            padded[i:i + n, j:j + n] += p
            count[i:i + n, j:j + n] += 1
    nodal = padded / count
    mean = 0.25 * (nodal[:-1, :-1] + nodal[1:, :-1] + nodal[:-1, 1:] + nodal[1:, 1:])
    inside = np.s_[1:-1, 1:-1]
    return np.abs(p - mean)[inside].sum() / np.abs(p)[inside].sum()


@case("S6")
def s6():
    """Punch into a nearly incompressible block of 16 x 16 elements: checkerboard of the mean stress with and without filter"""
    n, end = 16, 3e-3
    ramp = np.linspace(0, 1, 41)
    push = 0.05 * (ramp - np.sin(2 * np.pi * ramp) / (2 * np.pi))
    raw, rough = {}, {}
    for kind in ("off", "plain", "self_adjoint"):
        text = (f"[time]\nend = {end!r}\n" + output(f"{end!r} s", f"{end / 100!r} s")
                + f'[[solid.body]]\nname = "block"\nmesh = {{kind = "box", lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, {1 / n!r}], cells = [{n}, {n}, 1], '
                + 'sets = [{name = "punch", lower = [0.33, 0.999, -1.0], upper = [0.67, 2.0, 1.0]}]}\n'
                + 'material = {kind = "neo_hooke", density = 7800.0, young_modulus = 206e9, poisson_ratio = 0.4999}\n'
                + roller("x_lower", 0) + roller("x_upper", 0) + roller("y_lower", 1) + roller("z_lower", 2) + roller("z_upper", 2)
                + '[[solid.condition]]\nkind = "displacement"\nnodes = "punch"\ndirection = [0.0, -1.0, 0.0]\nacross = "held"\n'
                + f"times = {list(map(float, 0.8 * end * ramp))!r}\ndisplacements = {list(map(float, push))!r}\n"
                + (f'[solid.filter]\nkind = "{kind}"\n' if kind != "off" else ""))
        result = run(f"S6_{kind}", text, only="solid", threads=1)
        table = history(result)
        solid = fields.Solid(fields.series(result.directory, "solid")[-1][1])
        order = np.argsort(solid.cell["gid"])
        raw[kind] = table["checkerboard"][-20:].mean()
        rough[kind] = roughness(solid.cell["sigma_m"][order], n)
        spread = table["checkerboard"][-40:-20].mean()
        yield at_most(f"{kind}: raw chi", raw[kind], 1, result.seconds)
        if kind != "off":
            yield at_most(f"{kind}: raw chi at the end over that before (no growth, {int(table['step'][-1])} steps)", raw[kind] / spread, 1.3)
    for kind in ("plain", "self_adjoint"):
        yield at_most(f"{kind}: chi of the mean stress that acts over that without filter", rough[kind] / rough["off"], 0.5)
        yield at_most(f"{kind}: raw chi over that without filter", raw[kind] / raw["off"], 1.5)
