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
            if h == 10.0:
                yield close(f"{scheme}, 10 mm: u at 1 ms", measured_u, u, 0.005, result.seconds)
                yield close(f"{scheme}, 10 mm: x at 1 ms", measured_x, x, 0.005)
                ledger = fields.history(result.directory / "coupling_history.csv")
                yield at_most(f"{scheme}: impulse defect of any window", np.abs(ledger["impulse_defect"]).max(), 1e-12)
                yield close(f"{scheme}: kinetic energy against the gas's work", 0.5 * 1.0 * (h * 1e-3) ** 2 * measured_u ** 2,
                            float(np.sum(ledger["fluid_work"])), 0.01 if scheme == "fluid_first" else 0.05)
        yield at_least(f"{scheme}: order of u, 20 to 5 mm (reported)", np.log(errors[scheme, 20.0] / errors[scheme, 5.0]) / np.log(4), 0.0)


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
        yield close(f"{h:g} mm: solid's momentum against the impulse", solid["momentum x"][-1], impulse, 1e-9)
        yield close(f"{h:g} mm: work of the fluid against the solid's", float(np.sum(ledger["fluid_work"])), float(np.sum(ledger["solid_work"])), 0.01)


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
