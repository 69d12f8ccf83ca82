# SPDX-License-Identifier: Apache-2.0
"""Flows that break solvers: near vacuum, pressures of 1e6 to 1, strong shocks along the grid with noise."""
import numpy as np

import fields

from . import reference
from .case import at_most, case, close, output, row, run
from .fluid import AIR_EOS, half_space, material, region, shock_tube, tube


def same_on_threads(name, text):
    """Rows and result: the last fields with 1 and with 2 threads."""
    results = [run(f"{name}_{threads}", text, only="fluid", threads=threads) for threads in (1, 2)]
    flows = [fields.Fluid(fields.series(r.directory, "fluid")[-1][1]) for r in results]
    different = sum(not np.array_equal(flows[0].array(key), flows[1].array(key)) for key in ("density", "pressure"))
    return row(f"{name[3:]}: fields that differ on 1 and 2 threads", different, 0, different, 0, results[0].seconds), flows[0], results[0]


def floors(name, result, cells):
    table = fields.history(result.directory / "fluid_history.csv")
    last = {key: values[-1] for key, values in table.items()}
    yield at_most(f"{name}: cell-steps with p at its floor, of all", last["floors"] / max(cells * last["step"], 1), 1e-3)
    made = abs(last["mass"] + last["outflow mass"] - table["mass"][0]) / table["mass"][0]
    yield at_most(f"{name}: mass made or lost, of all", made, 1e-8)


@case("T5")
def t5():
    """Near vacuum: products into 1 Pa, the 123 problem, a withdrawing wall; floors counted, mass kept, threads alike"""
    n = 400
    tnt, air = reference.JWL_SETS["TNT"], reference.GAS
    text = tube(0.0, 1.0, n, 0, ("wall", "outflow"), 3e-5) + material("products", tnt) + material("air", air)
    text += region('{kind = "everywhere"}', "air", 1e-5, 1.0)
    text += region('{kind = "box", lower = [-1, -1, -1], upper = [0.3, 1, 1]}', "products", 1630.0, 7e9)
    same, flow, result = same_on_threads("T5_products", text)
    yield same
    yield from floors("products into 1 Pa", result, n)
    yield at_most("products into 1 Pa: cells with p or density not above 0", int((flow.array("pressure") <= 0).sum() + (flow.array("density") <= 0).sum()), 0)
    text = tube(0.0, 1.0, n, 0, ("outflow", "outflow"), 0.15) + material("gas", reference.IdealGas(1.4))
    text += region('{kind = "everywhere"}', "gas", 1.0, 0.01, (-4.0, 0, 0)) + region(half_space(0.5, 0), "gas", 1.0, 0.01, (4.0, 0, 0))
    same, flow, result = same_on_threads("T5_receding", text)
    yield same
    yield from floors("gas that parts at Mach 34", result, n)
    text = tube(0.0, 4.0, n, 0, ("outflow", "outflow"), 5e-4).replace("cells = [400, 1, 1]", "cells = [400, 1, 1]") + f'[[fluid.material]]\nname = "air"\n{AIR_EOS}\n'
    text += region('{kind = "everywhere"}', "air", 1.225, 101325.0)
    text += ('[[fluid.body]]\nname = "piston"\nshape = {kind = "box", lower = [1.5, -1, -1], upper = [2.0, 1, 1]}\n'
             + 'motion = {kind = "velocity", value = [-2000.0, 0.0, 0.0]}\n')
    same, flow, result = same_on_threads("T5_piston", text)
    yield same
    p = flow.array("pressure")
    yield at_most("wall withdrawn at 2000 m/s: cells with p not above 0", int((p <= 0).sum()), 0)


@case("T6")
def t6():
    """Pressures of 1e5 and 1e6 to 1; a plane shock of Mach 10 along the grid with noise of 1e-6 stays plane (3-D)"""
    for ratio in (1e5, 1e6):
        for cfl in (0.4, 0.8):
            eos = reference.IdealGas(1.4)
            left, right = (1.0, 0.0, ratio), (1.0, 0.0, 1.0)
            exact = reference.Riemann(left, right, eos)
            t, n = 0.3 / exact.shock_speed(1), 1600
            text = tube(0.0, 1.0, n, 0, ("outflow", "outflow"), t, f"scheme = {{cfl = {cfl}}}\n") + material("gas", eos)
            text += region('{kind = "everywhere"}', "gas", *left[::2]) + region(half_space(0.5, 0), "gas", *right[::2])
            result = run(f"T6_tube_{ratio:g}_{cfl}", text, only="fluid")
            flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
            x, p = flow.centres(0), flow.array("pressure").reshape(-1)
            shock = 0.5 + exact.shock_speed(1) * t
            contact = 0.5 + exact.u * t
            inside = (x > contact - 0.02) & (x < shock - 0.01)
            yield close(f"{ratio:g} to 1, cfl {cfl}, N = {n}: p*", float(np.median(p[inside])), exact.p, 0.03, result.seconds)
    cells, side = 160, 16
    text = ("[time]\nend = 10.0\n" + output("10 s", "1000 s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [{cells}, {side}, {side}]\ncells = [{cells}, {side}, {side}]\n"
            + 'perturbation = 1e-6\nboundary = {x_lower = "inflow", x_upper = "outflow", y_lower = "periodic", y_upper = "periodic", z_lower = "periodic", z_upper = "periodic"}\n')
    state = "density = 8.0\npressure = 116.5\nvelocity = [8.25, 0, 0]\n"
    text += material("gas", reference.IdealGas(1.4)) + f'[[fluid.inflow]]\nside = "x_lower"\nmaterial = "gas"\n{state}'
    text += region('{kind = "everywhere"}', "gas", 1.4, 1.0)
    text += region('{kind = "box", lower = [-1, -1, -1], upper = [25, 99, 99]}', "gas", 8.0, 116.5, (8.25, 0, 0))
    same, flow, result = same_on_threads("T6_plane_shock", text)
    yield same
    velocity = flow.levels[0][2]["velocity"]
    c = (1.4 * 116.5 / 8.0) ** 0.5
    yield at_most("Mach 10 over 100 cells, noise 1e-6: transverse velocity, of c", np.abs(velocity.reshape(-1, 3)[:, 1:]).max() / c, 1e-2, result.seconds)
