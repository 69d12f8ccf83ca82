# SPDX-License-Identifier: Apache-2.0
"""Cases of the solid program: element and material identities (its unit tests), impact, ring, energy."""
import sys

import numpy as np

from . import reference
from .case import ROOT, at_most, between, case, close, output, run, unit_rows

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402

COPPER = ('material = {kind = "j2", density = "8930 kg/m^3", young_modulus = "117 GPa", poisson_ratio = 0.35, '
          'flow = {kind = "linear", yield_stress = "400 MPa", hardening = "100 MPa"}}\n')


@case("S1", quick=True)
def s1():
    """Patch test, rigid rotation and objectivity of the element"""
    yield from unit_rows("csd", "*S1*:*Patch*:*Rotation*:*Objectiv*")


@case("S2", quick=True)
def s2():
    """Closed elastic cycle: nothing is left"""
    yield from unit_rows("csd", "*S2*:*Cycle*")


@case("A2", quick=True)
def a2():
    """Test vectors of the return map: simple shear, uniaxial strain, isochoric plastic flow"""
    yield from unit_rows("csd", "*A2*:*Shear*:*Uniaxial*:*Isochoric*:*isochoric*")


@case("A3", quick=True)
def a3():
    """Internal force against the finite difference of the energy; forces and moments sum to nothing"""
    yield from unit_rows("csd", "*A3*:*FiniteDifference*:*Gradient*")


@case("S5", quick=True)
def s5():
    """Hydrostatic compression of a perturbed block"""
    yield from unit_rows("csd", "*S5*:*Hydrostatic*")


@case("S13", quick=True)
def s13():
    """Crack topology, eq (16): counts of nodes, conserved mass and momentum, order independence"""
    yield from unit_rows("csd", "*S13*:*Crack*:*Split*")


def taylor(across, along, extra=""):
    return ("[time]\nend = \"80 us\"\n" + output("80 us", "1 us")
            + f'[[solid.body]]\nname = "bar"\nmesh = {{kind = "cylinder", radius = "3.2 mm", length = "32.4 mm", across = {across}, along = {along}}}\n'
            + 'velocity = [0.0, 0.0, "-227 m/s"]\n' + COPPER
            + '[[solid.condition]]\nkind = "rigid_wall"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n' + extra)


@case("S7")
def s7():
    """Taylor bar, copper, 227 m/s, 8 elements across the radius: foot radius, length, largest plastic strain, energy"""
    result = run("S7", taylor(8, 80), only="solid")
    solid = fields.Solid(fields.series(result.directory, "solid")[-1][1])
    x = solid.points
    foot = np.hypot(x[:, 0], x[:, 1])[x[:, 2] < 1e-4].max() * 1e3
    yield between("foot radius [mm]", foot, 7.05, 7.25, result.seconds)
    yield between("length [mm]", (x[:, 2].max() - x[:, 2].min()) * 1e3, 21.38, 21.50)
    yield between("largest plastic strain", solid.cell["eqps"].max(), 2.9, 3.4)
