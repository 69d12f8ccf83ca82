# SPDX-License-Identifier: Apache-2.0
"""Light pieces in dense gas."""
import sys

import numpy as np

from . import reference
from .case import ROOT, at_least, at_most, case, output, run

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402

RHO, P = 1630.0, 1e10  # products at rest
STEEL, RADIUS, WALL = 7760.0, 50.0, 0.4  # mm
LIMIT, END = 0.05, 16e-6  # plastic strain at failure; s


def ring(keys, radius=RADIUS, wall=WALL, around=96, h=1.5, end=END):
    """A ring of steel, one element high, full of products at rest; lengths in mm. It breaks early, each element on its own: chips of 3.1 kg/m^2 in gas of
    rho c = 8e6 kg/(m^2 s), which stops a face within 0.4 us."""
    half, length = 64 * h, 4.0
    rollers = "".join(f'[[solid.condition]]\nkind = "roller"\nnodes = "ring.{side}"\nnormal = [0, 0, 1]\n' for side in ("lower", "upper"))
    text = f"[time]\nend = {end!r}\n" + output(f"{end / 4!r} s", "0 s")
    text += ('[[solid.body]]\nname = "ring"\n'
             f'mesh = {{kind = "tube", inner_radius = "{radius} mm", outer_radius = "{radius + wall} mm", length = "{length} mm", around = {around}, through = 1, along = 1}}\n'
             f'material = {{kind = "j2", density = {STEEL!r}, young_modulus = "206 GPa", poisson_ratio = 0.3, '
             'flow = {kind = "linear", yield_stress = "412 MPa", hardening = "2.78 GPa"}}\n')
    text += rollers + f'[solid.wet]\nfaces = ["ring.inner", "ring.outer"]\n'
    text += f'[solid.fracture]\ncriterion = {{kind = "eqps", limit = {LIMIT!r}}}\n'
    text += (f'[fluid]\nlower = ["-{half} mm", "-{half} mm", "0 mm"]\nupper = ["{half} mm", "{half} mm", "{length} mm"]\ncells = [128, 128, 1]\n'
             'boundary = {x_lower = "outflow", x_upper = "outflow", y_lower = "outflow", y_upper = "outflow"}\n'
             '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
             '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
             f'[[fluid.region]]\nshape = {{kind = "cavity", seed = [0.001, 0.001, 0.002]}}\nmaterial = "TNT"\ndensity = {RHO}\npressure = {P}\n')
    return text + f"[coupling]\n{keys}\n"


@case("C13")
def c13():
    """A ring of 0.4 mm full of products at 10 GPa falls into chips of one element: slower than a plane wall before the same gas, books closed; with radiation, without, and under the other schemes"""
    escape = reference.riemann_integral(reference.JWL_SETS["TNT"], RHO, P, RHO * 1e-9)
    # the ring stretches, by less than exp(limit), until it breaks; a wall in a plane, whose gas can't pass by it nor run out of pressure behind, is faster
    per_area = STEEL * (1e-3 * WALL) * (1 + 0.5 * WALL / RADIUS) * np.exp(-LIMIT)
    plane = reference.free_piston_before(reference.JWL_SETS["TNT"], RHO, P, per_area, END)
    lost, ringing = {}, {}
    for name, keys in {"auto": "", "never": 'radiation = "never"', "concurrent": 'scheme = "concurrent"', "box1": 'scheme = "box1"'}.items():
        result = run(f"C13_{name}", ring(keys))
        fluid, solid = (fields.history(result.directory / f"{side}_history.csv") for side in ("fluid", "solid"))
        ledger, pieces = (fields.history(result.directory / table) for table in ("coupling_history.csv", "fragments.csv"))
        fastest = max(np.linalg.norm(fields.Solid(file).point["velocity"], axis=1).max() for _, file in fields.series(result.directory, "solid"))
        kinetic, momentum = solid["kinetic_energy"][-1], float(np.sum(pieces["mass"] * np.hypot(pieces["v_x"], pieces["v_y"])))
        lost[name] = abs(ledger["fluid_work_sum"][-1] - ledger["solid_work_sum"][-1]) / kinetic
        ringing[name] = solid["plastic_work"][-1]
        yield at_most(f"{name}: fastest node at any output over the escape velocity of {escape:.0f} m/s", fastest / escape, 1.0, result.seconds)
        yield at_most(f"{name}: fastest piece over the plane wall that the gas drives, {plane:.0f} m/s", np.hypot(pieces["v_x"], pieces["v_y"]).max() / plane, 1.0)
        yield at_least(f"{name}: pieces of one element (96)", np.sum(pieces["elements"] == 1), 96)
        yield at_most(f"{name}: impulse defect of any window", np.abs(ledger["impulse_defect"]).max(), 1e-12)
        yield at_most(f"{name}: solid's momentum less impulses and advance, over the sum of m v",
                      max(abs(solid[f"momentum {d}"][-1] - np.sum(ledger[f"impulse_{d}"]) - ledger[f"advance_{d}"][-1]) for d in "xyz") / momentum, 1e-9)
        yield at_most(f"{name}: momentum of all over the sum of m v", max(abs(solid[f"momentum {d}"][-1]) for d in "xy") / momentum, 0.01)
        yield at_most(f"{name}: solid's energy residual over the work of the loads", np.abs(solid["energy_residual"]).max() / solid["external_work"][-1], 0.01)
        mass = fluid["mass"] + fluid["outflow mass"]
        yield at_most(f"{name}: fluid: mass, largest change over the mass at the start", np.abs(mass - mass[0]).max() / mass[0], 0.01)
    yield at_most("auto: work of the fluid less the solid's, over the kinetic energy", lost["auto"], 0.01)
    yield at_least("never over auto: the same difference of works", lost["never"] / lost["auto"], 1.0)
    yield at_least("never over auto: plastic work (chips that ring flow again and again)", ringing["never"] / ringing["auto"], 1.0)
