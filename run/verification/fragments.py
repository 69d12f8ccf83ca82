# SPDX-License-Identifier: Apache-2.0
"""Cases of fragments: rigid bodies in flight, the switch from deformable to rigid."""
import numpy as np

from .case import at_least, at_most, case, close, output, run, unit_rows
from .solid import COPPER, fields


@case("C9", quick=True)
def c9():
    """Rigid fragment: momenta and energy of a million steps, a cube after one revolution, what the switch keeps"""
    yield from unit_rows("csd", "C9.*", {"momentum_change": 1e-12, "angular_momentum_change": 1e-12, "kinetic_energy_change": 1e-12,
                                         "kinetic_energy_change_tumbling": 1e-8, "off_after_a_revolution_over_side": 1e-11, "shape_change": 1e-10})


SPINNING = ('[[solid.body]]\nname = "bar"\nmesh = {kind = "box", lower = ["-20 mm", "-2 mm", "-2 mm"], upper = ["20 mm", "2 mm", "2 mm"], cells = [20, 2, 2]}\n'
            + COPPER + 'velocity = ["100 m/s", "20 m/s", 0.0]\nmotion = {spin = [500.0, 300.0, 2000.0]}\n')


def spinning_bar(name, rigid, end=20e-6, step=2e-8):
    text = f"[time]\nend = {end!r}\n" + output("0 s", f"{step!r} s") + SPINNING + f"[solid.time_step]\nfixed = {step!r}\n" + rigid
    result = run(name, text, only="solid")
    return fields.history(result.directory / "solid_history.csv"), fields.summary(result.directory, "solid"), result.seconds


@case("T10", quick=True)
def t10():
    """A spinning bar made rigid and deformable again every 10 steps: momenta, energy"""
    yield from unit_rows("csd", "T10.*", {"momentum_change": 1e-12, "angular_momentum_change": 1e-12, "energy_growth": 1e-12, "energy_residual": 1e-8})
    times = [f"{0.2 * k:.1f} us" for k in range(1, 100)]
    table, _, seconds = spinning_bar("T10", f'[solid.rigid]\nbodies = ["bar"]\nswitch_times = {times!r}\n')
    p = np.stack([table[f"momentum {axis}"] for axis in "xyz"])
    yield at_most("program: largest change of momentum", np.abs(p - p[:, :1]).max() / np.linalg.norm(p[:, 0]), 1e-12, seconds)
    switched = np.flatnonzero(np.diff(table["rigid_fragments"]) > 0) + 1
    yield at_least("program: switches to rigid", len(switched), 49)
    kinetic, lost = table["kinetic_energy"], table["rigidization_energy"]
    yield at_least("program: least kinetic energy lost in a switch [J]", np.diff(lost)[switched - 1].min(), 0.0)
    yield at_most("program: energy residual over the kinetic energy", np.abs(table["energy_residual"]).max() / kinetic[0], 1e-5)


@case("T21R", quick=True)
def t21_rigid():
    """A rigid body passes over the force loop (counted), and flies as the deformable one does in the mean"""
    soft, _, _ = spinning_bar("T21R_soft", "", end=10e-6)
    rigid, summary, seconds = spinning_bar("T21R_rigid", '[solid.rigid]\nbodies = ["bar"]\n', end=10e-6)
    yield close("blocks passed over, of 10 in each of 500 steps", summary["counts"]["skipped_rigid_blocks"], 10 * 500, 1e-12, seconds)
    yield close("momentum against the deformable bar", rigid["momentum x"][-1], soft["momentum x"][-1], 1e-12)
    yield at_most("kinetic energy: change of the rigid one", np.abs(rigid["kinetic_energy"] / rigid["kinetic_energy"][0] - 1).max(), 1e-12)
