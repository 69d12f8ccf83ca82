# SPDX-License-Identifier: Apache-2.0
"""Local time steps of the solid against one step for all."""
import numpy as np

from .case import at_least, at_most, case, close, output, run
from .solid import PAPER_STEEL, fields, j2, taylor

LEVELS = "[solid.time_step]\nlevels = 3\n"


def shape(result):
    """Foot radius and length [mm] of a bar."""
    x = fields.Solid(fields.series(result.directory, "solid")[-1][1]).points
    return np.hypot(x[:, 0], x[:, 1])[x[:, 2] < 1e-6].max() * 1e3, (x[:, 2].max() - x[:, 2].min()) * 1e3


def residual_part(result):
    """Largest energy residual over the energy that came in."""
    table = fields.history(result.directory / "solid_history.csv")
    brought = table["kinetic_energy"][0] + np.abs(table["external_work"]).max()
    return np.abs(table["energy_residual"]).max() / brought


def tumbling_bar(extra, steps):
    """An elastic bar whose cells grow 40 times along it turns, stretches and bends, held at its fine end."""
    return (f"[time]\nend = \"1 s\"\nmax_steps = {steps}\n" + output("0 s", "20 us")
            + '[[solid.body]]\nname = "bar"\nmesh = {kind = "box", lower = [0, 0, 0], upper = ["100 mm", "20 mm", "20 mm"], cells = [24, 4, 4], grading = [40, 1, 1]}\n'
            + 'motion = {axis = [1.0, 2.0, 3.0], centre = [0.02, 0.0, 0.0], spin = [10.0, 20.0, 30.0], radial = 20.0}\n'
            + 'material = {kind = "neo_hooke", density = "7800 kg/m^3", young_modulus = "206 GPa", poisson_ratio = 0.3}\n'
            + '[[solid.condition]]\nkind = "fixed"\nnodes = "x_lower"\n' + extra)


def burst(extra):
    """The weapon's body bursts under the front of eq (18), to single elements, which become rigid."""
    return ("[time]\nend = \"120 us\"\n" + output("0 s", "1 us") + '[[solid.body]]\nname = "case"\nmesh = {kind = "weapon", size = "demo", wall = "12 mm"}\n'
            + j2(**PAPER_STEEL) + '[[solid.load]]\nkind = "pressure_front"\nfaces = ["inner"]\npeak = "1e11 dyn/cm^2"\ndecay = "0.1 1/cm"\nspeed = "7.2e5 cm/s"\n'
            + 'axis = [0.0, 0.0, -1.0]\nstart = [0.0, 0.0, 1.45]\n[solid.fracture]\ncriterion = {kind = "eqps", limit = 0.3}\n[solid.rigid]\nelements = 4\n' + extra)


@case("LT")
def lt():
    """Local time steps: the bar of S7, an elastic bar over 320,000 short steps, a bursting case, against one step for all; what is left out"""
    # split tetrahedra have their flattest elements all over the bar: little can be left out
    for name, text, most in (("S7, 8 across", taylor(8, 80), 0.7), ("S7 split, 2 across", taylor(2, 10, split=True), 1.0)):
        file = "LT_" + name.replace(", ", "_").replace(" ", "_")
        one, local = run(file, text, only="solid"), run(file + "_local", text + LEVELS, only="solid")
        (foot, length), (foot_local, length_local) = shape(one), shape(local)
        yield close(f"{name}: foot radius [mm]", foot_local, foot, 5e-4, local.seconds)
        yield close(f"{name}: length [mm]", length_local, length, 2e-4, one.seconds)
        yield at_most(f"{name}: energy residual over the kinetic energy at the start", residual_part(local), 0.01)
        summaries = [fields.summary(r.directory, "solid") for r in (one, local)]
        evaluations = summaries[1]["counts"]["element_steps"] / (summaries[0]["steps"] * summaries[0]["counts"]["elements"])
        yield at_most(f"{name}: element evaluations over those with one step", evaluations, most)
    for multiple in (0.9, 1.0):
        result = run(f"LT_bar_{multiple:g}", tumbling_bar(LEVELS + f"safety = {multiple!r}\n", 40000), only="solid")
        yield at_least(f"elastic bar at {multiple:g} of the bound: short steps a whole step", fields.summary(result.directory, "solid")["counts"]["short_steps"] / 40000, 4, result.seconds)
        yield at_most(f"elastic bar at {multiple:g} of the bound: largest energy residual over its energy", residual_part(result), 0.01)
    one, local = (run("LT_burst" + ("_local" if extra else ""), burst(extra), only="solid") for extra in ("", LEVELS))
    summaries = [fields.summary(r.directory, "solid") for r in (one, local)]
    yield close("bursting case: mass [kg]", summaries[1]["masses"]["solid"], summaries[0]["masses"]["solid"], 1e-12, local.seconds)
    yield close("bursting case: kinetic energy [J]", summaries[1]["energies"]["kinetic"], summaries[0]["energies"]["kinetic"], 0.01, one.seconds)
    yield close("bursting case: pieces", summaries[1]["counts"]["fragments"], summaries[0]["counts"]["fragments"], 0.05)
    yield at_most("bursting case: energy residual over the work done on it", residual_part(local), 0.01)
