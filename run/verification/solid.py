# SPDX-License-Identifier: Apache-2.0
"""Cases of the solid program: element and material identities (its unit tests), impact, ring, energy."""
import sys

import numpy as np

from . import reference
from .case import ROOT, RunFailed, at_least, at_most, between, case, close, finest, output, run, unit_rows

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402

COPPER = ('material = {kind = "j2", density = "8930 kg/m^3", young_modulus = "117 GPa", poisson_ratio = 0.35, '
          'flow = {kind = "linear", yield_stress = "400 MPa", hardening = "100 MPa"}}\n')


@case("S1", quick=True)
def s1():
    """Patch test, rigid rotation and objectivity of the element"""
    yield from unit_rows("csd", "S1.*", {"force_inside": 1e-12, "stress_error_over_kappa": 1e-12, "stress_error_over_mu": 1e-11, "invariant_error": 1e-10})


@case("S2", quick=True)
def s2():
    """Closed elastic cycle: nothing is left"""
    yield from unit_rows("csd", "S2.*", {"residual_over_mu": 1e-13})


@case("A2", quick=True)
def a2():
    """Test vectors of the return map: simple shear, uniaxial strain, isochoric plastic flow"""
    yield from unit_rows("csd", "A2.*", {"det_Cp_error": 1e-12})


@case("A3", quick=True)
def a3():
    """Internal force against the finite difference of the energy; forces and moments sum to nothing"""
    yield from unit_rows("csd", "A3.*", {"relative_error": 1e-7, "sum_over_largest": 8e-13})


@case("S5", quick=True)
def s5():
    """Hydrostatic compression of a perturbed block"""
    yield from unit_rows("csd", "S5.*", {"pressure_error": 1e-12})


@case("S13", quick=True)
def s13():
    """Crack topology, eq (16): counts of nodes, conserved mass and momentum, order independence"""
    yield from unit_rows("csd", "FractureTopology.*")


def taylor(across, along, sector="quarter", extra="", split=False):
    """The bar of S7. Its foot keeps to the wall (u_z = 0), as in the reference; a wall that lets go lets the rim curl up."""
    text = ("[time]\nend = \"80 us\"\n" + output("80 us", "1 us")
            + f'[[solid.body]]\nname = "bar"\nmesh = {{kind = "cylinder", radius = "3.2 mm", length = "32.4 mm", across = {across}, along = {along}, '
            + f'sector = "{sector}", split = {str(split).lower()}}}\nvelocity = [0.0, 0.0, "-227 m/s"]\n' + COPPER + roller("lower", 2))
    return text + (roller("cut_x", 0) + roller("cut_y", 1) if sector == "quarter" else "") + extra


def roller(nodes, axis):
    return f'[[solid.condition]]\nkind = "roller"\nnodes = "{nodes}"\nnormal = {[float(axis == k) for k in range(3)]}\n'


def j2(density, young, poisson, yield_stress, hardening):
    return (f'material = {{kind = "j2", density = {density!r}, young_modulus = {young!r}, poisson_ratio = {poisson!r}, '
            f'flow = {{kind = "linear", yield_stress = {yield_stress!r}, hardening = {hardening!r}}}}}\n')


PAPER_STEEL = dict(density=7760.0, young=641.5e9, poisson=0.3, yield_stress=1.283e9, hardening=8.657e9)
TAYLOR_COPPER = dict(density=8930.0, young=117e9, poisson=0.35, yield_stress=400e6, hardening=100e6)


def taylor_shape(across, threads=0):
    """The bar of S7, `across` elements over the radius and 10 times as many along: its history, foot radius and length [mm], plastic strain."""
    result = run(f"S7_{across}", taylor(across, 10 * across), only="solid", threads=threads)
    solid = fields.Solid(fields.series(result.directory, "solid")[-1][1])
    x = solid.points
    foot = np.hypot(x[:, 0], x[:, 1])[x[:, 2] < 1e-6].max() * 1e3
    return result, foot, (x[:, 2].max() - x[:, 2].min()) * 1e3, solid.cell["eqps_max"].max()


@case("S7")
def s7():
    """Taylor bar, copper, 227 m/s, a quarter: foot radius, length, plastic strain, energy at 8 elements over the radius; convergence from 4 (to 16 with --all)"""
    meshes = (4, 8, 16) if finest() else (4, 8)
    foot, length = {}, {}
    for across in meshes:
        result, foot[across], length[across], strain = taylor_shape(across)
        name = f"{across} across: "
        # a coarse mesh is below the band of 8 across; it has to be within what the references' spread of 1982 to 1997 allows
        low, high = ((6.9, 7.25), (21.38, 21.66)) if across < 8 else ((7.05, 7.25), (21.38, 21.50))
        yield between(name + "foot radius [mm]", foot[across], *low, result.seconds)
        yield between(name + "length [mm]", length[across], *high)
        if across >= 8:
            yield between(name + "largest plastic strain", strain, 2.9, 3.4)
        table = fields.history(result.directory / "solid_history.csv")
        yield at_most(name + "S12, energy residual over the kinetic energy at the start", np.abs(table["energy_residual"]).max() / table["kinetic_energy"][0], 0.01)
        if across == 8:  # VALIDATION's history of the fully refined bar, at 20 us: kinetic energy 148.30 J of the whole bar
            yield close(name + "kinetic energy at 20 us [J]", 4 * np.interp(20e-6, table["t"], table["kinetic_energy"]), 148.30, 0.02)
    yield at_most("foot radius: meshes that do not approach 7.23 mm from below", sum(not a < b < 7.25 for a, b in zip(foot.values(), list(foot.values())[1:])), 0)
    yield at_least("foot radius: fitted order of the distance to 7.23 mm (axisymmetric: 1.1)", fitted_order(meshes, [7.23 - foot[n] for n in meshes]), 0.9)
    yield at_least("length: fitted order of the distance to 21.42 mm", fitted_order(meshes, [length[n] - 21.42 for n in meshes]), 0.9)
    yield close(f"foot radius at {meshes[-1]} across over 7.23 mm", foot[meshes[-1]], 7.23, 0.007 if finest() else 0.016)
    yield close(f"length at {meshes[-1]} across over 21.42 mm", length[meshes[-1]], 21.42, 0.001)


def fitted_order(meshes, errors):
    """Slope of log |error| over -log n."""
    return -np.polyfit(np.log(meshes), np.log(np.abs(errors)), 1)[0]


MULTIPLES = (0.5, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5)


def largest_stable_multiple(name, text):
    """Of the bound 2/omega: the runs up to it keep the energy to 1 % of what the bar brings; and the collapsed elements of the run at 0.9."""
    stable, collapsed, seconds = 0.0, 0, 0.0
    for multiple in MULTIPLES:
        try:
            result = run(f"T16_{name}_{multiple:g}", text + f"[solid.time_step]\nsafety = {multiple!r}\n", only="solid")
        except RunFailed:
            break
        table = fields.history(result.directory / "solid_history.csv")
        seconds += result.seconds
        if not np.abs(table["energy_residual"]).max() <= 0.01 * table["kinetic_energy"][0]:
            break
        if multiple == 0.9:
            collapsed = int(np.max(table["collapsed"]))
        stable = multiple
    return stable, collapsed, seconds


@case("T16")
def t16():
    """Largest stable multiple of the time step's bound on flattened elements: the bar of S7 to 80 us, plain, hexahedra of split tetrahedra, 8 across"""
    for name, text in (("4 across", taylor(4, 40)), ("split, 2 across", taylor(2, 10, split=True)), ("8 across (S7)", taylor(8, 80))):
        stable, collapsed, seconds = largest_stable_multiple(name.replace(" ", "_"), text)
        yield between(f"{name}: largest stable multiple (of {', '.join(format(m, 'g') for m in MULTIPLES)})", stable, 0.9, 1.6, seconds)
        yield at_most(f"{name}: elements with a collapsed point at 0.9", collapsed, 0)


@case("C12")
def c12():
    """The weapon's body under the travelling front of eq (18): mid-body wall against the ring's differential equation"""
    inner, wall = 0.1365 - 0.012, 0.012
    t_ring, v_ring, r_ring = reference.loaded_ring(inner, wall, 7760.0, 1.283e9, 8.657e9, 1e10, 0.1, 7200.0, 0.3)
    text = ("[time]\nend = \"160 us\"\n" + output("0 s", "0.2 us")
            + '[[solid.body]]\nname = "case"\nmesh = {kind = "weapon", size = "demo", wall = "12 mm"}\n' + j2(**PAPER_STEEL)
            + '[solid.filter]\nkind = "self_adjoint"\n'
            + '[[solid.load]]\nkind = "pressure_front"\nfaces = ["inner"]\npeak = "1e11 dyn/cm^2"\ndecay = "0.1 1/cm"\nspeed = "7.2e5 cm/s"\n'
            + 'axis = [0.0, 0.0, -1.0]\nstart = [0.0, 0.0, 1.45]\n'
            + '[[solid.probe]]\nname = "mid"\nkind = "ring"\nlower = 0.725\nupper = 0.775\n')
    result = run("C12", text, only="solid")
    table = fields.history(result.directory / "solid_history.csv")
    t, radius, velocity = table["t"], table["mid radius"], table["mid v_radial"]
    passed = (1.45 - 0.75) / 7200
    alpha = 2 / np.sqrt(3) * np.log(radius / radius[0])
    yield close("time from the front's passage to a strain of 0.3", float(np.interp(0.3, alpha, t)) - passed, t_ring, 0.08, result.seconds)
    yield close("radial velocity then", float(np.interp(0.3, alpha, velocity)), v_ring, 0.08)
