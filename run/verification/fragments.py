# SPDX-License-Identifier: Apache-2.0
"""Cases of fragments: rigid bodies in flight, the switch from deformable to rigid."""
import sys

import h5py
import numpy as np

from . import reference
from .case import BUILD, ROOT, at_least, at_most, case, close, near, output, run, unit_rows
from .solid import COPPER, fields
from .solid_waves import elastic, node

sys.path.insert(0, str(ROOT / "run"))
import fragments as fragment_statistics  # noqa: E402


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


@case("drag", quick=True)
def drag():
    """Drag of still air on fragments smaller than a cell: speed along the way of a cube that starts at 2.5 km/s, Cd constant and by Mach number"""
    yield from unit_rows("csd", "Rigid.DragOfStillAir", {"drag_error": 1e-5})
    for name, mach, coefficient in (("constant", [0.0], [1.2]), ("by Mach number", [0.5, 1.0, 1.5, 4.0], [0.8, 1.1, 1.25, 1.15])):
        text = ('[time]\nend = "12 ms"\n' + output("0 s", "0.1 ms") + "[solid.time_step]\nfixed = 4e-5\n"
                + '[[solid.body]]\nname = "cube"\nmesh = {kind = "box", lower = [0, 0, 0], upper = ["2 mm", "2 mm", "2 mm"], cells = [2, 2, 2]}\n'
                + COPPER + 'velocity = ["1500 m/s", "2000 m/s", 0.0]\n'
                + f'[solid.rigid]\nbodies = ["cube"]\ndrag = {{density = 1.2, sound_speed = 340.0, mach = {mach}, coefficient = {coefficient}}}\n')
        result = run(f"drag_{name}", text, only="solid")
        table = fields.history(result.directory / "solid_history.csv")
        mass, area = 8930.0 * 8e-9, 6e-6
        found = np.hypot(table["momentum x"], table["momentum y"]) / mass
        expected = reference.fragment_flight(table["t"], 2500.0, mass, area, 1.2, 340.0, mach, coefficient)
        yield at_most(f"Cd {name}: largest error of the speed in 12 ms, from 2.5 km/s to {expected[-1]:.0f} m/s", np.abs(found / expected - 1).max(), 1e-4, result.seconds)
        yield at_most(f"Cd {name}: energy residual over the kinetic energy", np.abs(table["energy_residual"]).max() / table["kinetic_energy"][0], 1e-5)


@case("CT")
def contact():
    """Contact: collisions of rigid and deformable bodies, a cloud of 200 cubes between walls, a plate that is hit, lips of cracks"""
    yield from unit_rows("csd", "Contact*.*", {"left_of_the_speed_40": 0.02, "left_of_the_speed_80": 0.01, "node_depth_over_side": 0.005,
                                               "edge_depth_over_side": 0.15, "energy_rise": 1e-12, "momentum_off_the_walls_impulse": 1e-13,
                                               "residual_over_kinetic": 5e-3, "rigid_residual_over_kinetic": 5e-3, "depth_with": 1e-4})
    bar = '[[solid.body]]\nname = "{}"\nmesh = {{kind = "box", lower = [{}, 0, 0], upper = [{}, 0.004, 0.004], cells = [{}, 2, 2]}}\nvelocity = [{}, 0, 0]\n{}'
    for name, density, young in (("a light bar", 1.0, 1e6), ("an equal bar", 7800.0, 200e9), ("a heavy bar", 2e4, 4e11)):
        text = ('[time]\nend = "6 us"\n' + output("0 s", "0 s") + "[solid.contact]\n[solid.viscosity]\nlinear = 0.06\n"
                + bar.format("left", 0.0, 0.05, 50, 10.0, elastic(7800.0, 200e9, 0.0)) + bar.format("right", 0.050001, 0.07, 20, 0.0, elastic(density, young, 0.0))
                + node("left", (0.05, 0.002, 0.002)) + node("right", (0.050001, 0.002, 0.002)))
        result = run(f"CT_{name}", text, only="solid")
        table = fields.history(result.directory / "solid_history.csv")
        late = table["t"] > 3e-6
        expected = 10.0 / (1 + (density * young / (7800.0 * 200e9)) ** 0.5)  # by the impedances
        for side in ("left", "right"):
            yield close(f"a steel bar hits {name}: speed of the touching face, {side} [m/s]", table[f"{side} vx"][late].mean(), expected, 0.02, result.seconds)
        yield near(f"a steel bar hits {name}: pieces told without [solid.fracture]", table["fragments"][-1], 2, 0)


def mott_sample(mu, number, seed):
    return mu * np.random.default_rng(seed).exponential(size=number) ** 2


@case("C10", quick=True)
def c10():
    """Mott's distribution: its closed numbers, the fit of run/fragments.py on samples of it, the paper's and a shell's mu; polar zones"""
    for s, number, mass in ((1, 0.3679, 0.9197), (2, 0.1353, 0.6767), (3, 0.0498, 0.4232)):
        yield near(f"N(>m)/N0 at sqrt(m/mu) = {s}", fragment_statistics.mott_number(s**2, 1, 1), number, 5e-5)
        yield near(f"mass above over the whole at {s}", fragment_statistics.mott_mass(s**2, 1, 1) / 2, mass, 5e-5)
    sample = mott_sample(0.330e-3, 18200, 1)
    fit = fragment_statistics.mott_fit(sample)
    yield close("fit to 18,200 pieces: mu [g]", 1e3 * fit["mu"], 0.330, 3 * fit["error"] / fit["mu"])
    yield close("their mean mass over 2 mu", sample.mean() / (2 * fit["mu"]), 1, 0.03)
    cut = fragment_statistics.mott_fit(sample, 0.2e-3)  # light ones were not collected
    yield close("fit to those above 0.2 g: mu [g]", 1e3 * cut["mu"], 0.330, 3 * cut["error"] / cut["mu"])
    yield close("the same: N0", cut["N0"], 18200, 0.05)
    yield at_most("Kolmogorov's distance, largest of 20 samples of 1,000",
                  max(fragment_statistics.mott_fit(mott_sample(1e-3, 1000, k))["distance"] for k in range(20)), 1.36 / np.sqrt(1000))
    one_size = fragment_statistics.mott_fit(np.full(1000, 1e-3) * np.random.default_rng(0).uniform(0.9, 1.1, 1000))
    yield at_least("the same of pieces of one size: no Mott", one_size["distance"], 0.3)
    # mu = sqrt(2/rho) (sigma_F/gamma)^1.5 (r/V)^3 [Mott]: a shell's from its calibrated strength, the paper's ring
    yield close("105 mm shell: mu [g]", 1e3 * reference.mott_mu(7850.0, 800e6, 65.0, 0.0778, 994.0), 0.330, 0.01)
    yield close("the paper's ring, r = 0.1 m, V = 1,500 m/s, at 0.3 strain: mu [g]", 1e3 * reference.mott_mu(7760.0, 1.283e9 + 0.3 * 8.657e9, 56.0, 0.1, 1500.0), 2.743, 0.001)
    # a sphere that flies apart evenly: a zone's share of mass is its share of solid angle
    directions = np.random.default_rng(3).normal(size=(200000, 3))
    speeds = 1000 * directions / np.linalg.norm(directions, axis=1)[:, None]
    zones = fragment_statistics.polar_zones(speeds, np.full(len(speeds), 1e-3), np.array([0, 0, 1.0]), 18)
    even = 200 / (4 * np.pi)
    yield at_most("evenly flying pieces: mass per solid angle off the even one, worst of zones", max(abs(z["mass_per_sr"] / even - 1) for z in zones), 0.06)
    yield close("mass of all zones", sum(zone["mass"] for zone in zones), 200.0, 1e-12)
    path = BUILD / "verify" / "C10.zdata"
    path.parent.mkdir(parents=True, exist_ok=True)
    mass = mott_sample(1e-3, len(speeds), 5)
    zones = fragment_statistics.polar_zones(speeds, mass, np.array([0, 0, 1.0]), 18)
    fragment_statistics.write_zdata(path, zones, mass, fragment_statistics.mass_classes(mass, 12))
    _, rows = fragment_statistics.read_zdata(path)
    yield close("Z-data: mass by classes, read back", sum(n * m for row in rows for n, m in row[5]), mass.sum(), 1e-5)
    yield close("Z-data: pieces by classes", sum(n for row in rows for n, _ in row[5]), len(mass), 1e-12)


BURST = ('[time]\nend = "30 us"\n' + output("0 us", "5 us")
         + '[solid.fracture]\ncriterion = {kind = "eqps", limit = 0.05}\n[solid.rigid]\nelements = 30\n'
         + '[[solid.body]]\nname = "shell"\nmesh = {kind = "shell_of_revolution", shape = "sphere", radius = "62 mm", wall = "6 mm", around = 24, through = 2}\n'
         + '[solid.body.material]\nkind = "j2"\ndensity = 7760.0\nyoung_modulus = "206 GPa"\npoisson_ratio = 0.3\n'
         + 'flow = {kind = "linear", yield_stress = "412 MPa", hardening = "2.78 GPa"}\n'
         + '[[solid.load]]\nkind = "pressure"\nfaces = ["shell.inner"]\ntimes = [0.0, "40 us"]\npressures = ["1 GPa", "0.5 GPa"]\n')


@case("C10T")
def c10_table():
    """The fragment table of a burst shell: sums against the run's totals, CSV against HDF5, its statistics"""
    result = run("C10T", BURST, only="solid")
    table, summary = fields.history(result.directory / "fragments.csv"), fields.summary(result.directory, "solid")
    yield close("pieces in the table against the run's count", len(table["id"]), summary["counts"]["fragments"], 1e-12, result.seconds)
    yield at_least("pieces", len(table["id"]), 50)
    yield close("mass of the pieces against the run's", table["mass"].sum(), summary["masses"]["solid"], 1e-10)
    yield close("kinetic energy likewise", table["kinetic_energy"].sum(), summary["energies"]["kinetic"], 1e-10)
    p = np.stack([(table["mass"] * table[f"v_{axis}"]).sum() - summary["momenta"][axis] for axis in "xyz"])
    yield at_most("momentum: difference over the sum of sizes", np.linalg.norm(p) / (table["mass"] * np.abs(table["v_x"])).sum(), 1e-10)
    yield at_most("energy residual over the external work", abs(summary["energies"]["residual"]) / summary["energies"]["external"], 0.01)
    with h5py.File(result.directory / "fragments.h5") as file:
        group = file["fragments"]
        worst = max(np.abs(group[name][()] - values).max() / max(1e-300, np.abs(values).max()) for name, values in table.items() if name != "t")
    yield at_most("HDF5 against CSV, worst column", worst, 1e-11)
    found = fragment_statistics.statistics(result.directory, pictures=False)
    yield at_least("rigid pieces", table["rigid"].sum(), 30)
    yield at_most("length over thickness of one-element pieces, largest", (table["length"] / table["thickness"])[table["elements"] == 1].max(), 20)
    yield close("mass in the polar zones", fields.history(result.directory / "fragment_zones.csv")["mass"].sum(), found["mass"], 1e-10)
