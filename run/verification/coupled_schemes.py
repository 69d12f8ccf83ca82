# SPDX-License-Identifier: Apache-2.0
"""The schemes of the pair against each other: who leads, who computes when."""
import re
import sys

import numpy as np

from . import reference
from .case import ROOT, at_least, at_most, case, close, output, run
from .coupled import closed_column, oscillates, piston, shock_on_slab

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402


def shell(end=24e-6):
    """A ball of TNT in a shell of steel that cracks at a strain of 0.15; 24 cells across four radii, a step of the fluid is about 0.4 us."""
    return (f"[time]\nend = {end!r}\n" + output(f"{end!r} s", "0 s")
            + '[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\n[solid.fracture]\ncriterion = {kind = "eqps", limit = 0.15}\n'
            + '[[solid.body]]\nname = "shell"\nmesh = {kind = "shell_of_revolution", shape = "sphere", radius = "62 mm", wall = "6 mm", around = 16, through = 2}\n'
            + '[solid.body.material]\nkind = "j2"\ndensity = 7760.0\nyoung_modulus = "206 GPa"\npoisson_ratio = 0.3\n'
            + 'flow = {kind = "linear", yield_stress = "412 MPa", hardening = "2.78 GPa"}\n'
            + '[fluid]\nlower = ["-160 mm", "-160 mm", "-160 mm"]\nupper = ["160 mm", "160 mm", "160 mm"]\ncells = [24, 24, 24]\n'
            + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
            + '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
            + '[[fluid.region]]\nshape = {kind = "cavity", seed = [0.001, 0.001, 0.001]}\nmaterial = "TNT"\nunburnt = true\npressure = 101325.0\n'
            + '[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0.001, 0.001, 0.001]]\n[coupling]\n')


def under(text, scheme, window):
    """The case under a scheme, with fixed windows of so many us; 0: the fluid leads."""
    return re.sub(r'\[coupling\]\n(scheme = "\w+"\n)?', f'[coupling]\nscheme = "{scheme}"\n' + (f'window = "{window} us"\n' if window else ""), text)


def words(scheme, window):
    return f"{scheme}, " + (f"windows of {window} us" if window else "the fluid leads")


def tables(result):
    return [fields.history(result.directory / f"{name}_history.csv") for name in ("solid", "coupling")]


def order(errors, long, short):
    return np.log(abs(errors[long] / errors[short])) / np.log(long / short)


@case("schemes")
def schemes():
    """C1 and C2 under every scheme, led by the fluid's step and by fixed windows of the solid: error, order, energy"""
    u = reference.free_piston(1e-3, 1.0)[0]
    for scheme, books in (("box1", 0.05), ("fluid_first", 0.01), ("concurrent", 0.01)):
        errors = {}
        for window in (0,) if scheme == "concurrent" else (0, 100, 400):  # us; the fluid's own step is 12 us, its error in space 1e-4
            result = run(f"schemes_C1_{scheme}_{window}", under(piston(), scheme, window))
            table, ledger = tables(result)
            measured, where = table["momentum x"][-1] / 1e-4, f"C1, {words(scheme, window)}"
            errors[window] = measured / u - 1
            if window == 0:
                yield close(f"{where}: kinetic energy against the gas's work", 0.5e-4 * measured ** 2, float(np.sum(ledger["fluid_work"])), books)
            if window and scheme == "box1":  # of first order
                yield at_least(f"{where}: u at 1 ms over the exact one (reported)", measured / u, 0.0, result.seconds)
            else:
                yield close(f"{where}: u at 1 ms", measured, u, 0.005, result.seconds)
            yield at_most(f"{where}: impulse defect of any window", np.abs(ledger["impulse_defect"]).max(), 1e-12)
        if scheme == "box1":  # of the others the gas's error in space is left; their order: tests coupled_order_*
            yield at_least(f"C1, {scheme}: order in the window, 400 to 100 us (reported)", order(errors, 400, 100), 0.0)
    mode = reference.gas_column_modes(0.8, 0.0)
    for scheme, window in (("concurrent", 0), ("fluid_first", 200), ("box1", 200)):
        where = f"C2, {words(scheme, window)}"
        result = run(f"schemes_C2_{scheme}_{window}", under(closed_column(scheme, 0.8, 2 * np.pi * mode[0] * 1e-4, 20 / mode[0]), scheme, window))
        yield from oscillates(where, result, mode, 20)


@case("schemes_shock")
def schemes_shock():
    """C3, a shock of M = 2 onto steel, under every scheme and windows of up to 18 steps of the fluid: error, order, energy"""
    wall = reference.reflected_state(2.0)
    Z = wall.rho * wall.c + 1.225 * reference.air_sound()
    hit, after = 0.1 / (2 * reference.air_sound()), (wall.p - 101325.0) / Z * (1 - np.exp(-Z * 1e-3 / 78.0))
    text = shock_on_slab("fluid_first", 2.0, 10.0, hit + 1e-3, 7800.0, 206e9, 2, True)
    for scheme in ("fluid_first", "box1", "concurrent"):
        errors = {}
        for window in (0,) if scheme == "concurrent" else (0, 50, 100, 200):
            result = run(f"schemes_C3_{scheme}_{window}", under(text, scheme, window))
            table, ledger = tables(result)
            u, where = table["momentum x"][-1] / 78.0 / 1e-4, words(scheme, window)
            errors[window] = u / after - 1
            work, energy = float(ledger["fluid_work"].sum()), table["kinetic_energy"][-1]
            if scheme == "box1" and window:  # of first order in such windows
                yield at_least(f"{where}: u 1 ms later over the exact one (reported)", u / after, 0.0, result.seconds)
                yield at_least(f"{where}: kinetic energy over the gas's work (reported)", energy / work, 0.0)
                continue
            yield close(f"{where}: u 1 ms later", u, after, 0.01, result.seconds)
            yield close(f"{where}: kinetic energy against the gas's work", energy, work, 0.02)
        if scheme != "concurrent":  # beside the run that the fluid leads, whose error is that in space
            late = {window: error - errors[0] for window, error in errors.items() if window}
            yield at_least(f"{scheme}: order in the window, 200 to 50 us (reported)", order(late, 200, 50), 0.0)


@case("schemes_crack")
def schemes_crack():
    """A shell full of TNT that cracks under every scheme: opened faces, kinetic energy beside the default's, energy and impulse lost between the programs"""
    kinetic = {}
    for scheme, window in (("fluid_first", 0), ("fluid_first", 1), ("fluid_first", 2), ("fluid_first", 4), ("concurrent", 0), ("box1", 0)):
        result = run(f"schemes_crack_{scheme}_{window}", under(shell(), scheme, window))
        table, ledger = tables(result)
        where, now = words(scheme, window), table["kinetic_energy"][-1]
        kinetic[scheme, window] = now
        yield at_least(f"{where}: faces that opened", table["opened_faces"][-1], 20, result.seconds)
        yield at_least(f"{where}: kinetic energy over that of fluid_first (reported)", now / kinetic["fluid_first", 0], 0.0)
        lost = (ledger["fluid_work_sum"][-1] - ledger["solid_work_sum"][-1]) / now
        if scheme == "box1":  # moves its walls by the last velocity
            yield at_least(f"{where}: works of both, abs(difference) over the kinetic energy (reported)", abs(lost), 0.0)
        else:
            yield at_most(f"{where}: works of both, abs(difference) over the kinetic energy", abs(lost), 0.01)
        yield at_most(f"{where}: impulse defect of any window", np.abs(ledger["impulse_defect"]).max(), 1e-12)
