# SPDX-License-Identifier: Apache-2.0
"""A small weapon made like run/cases/weapon, coarse enough for seconds: it burns for 30 us, breaks up from the nose on into pieces and chips, which
become rigid, meet each other and a wall, and leave a box."""
from verification.case import output

CASE = ('[time]\nend = "60 us"\n' + output("20 us", "2 us")
        + '[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\n[solid.fracture]\ncriterion = {kind = "eqps", limit = 0.15}\n'
        + 'pieces = {kind = "fixed", width = "20 mm", least_speed = "5 m/s", exempt = ["case.nose_plug", "case.base_plug"]}\n'
        + '[solid.rigid]\nelements = 12\nage = "5 us"\nbox = {lower = ["-55 mm", "-55 mm", "-60 mm"], upper = ["60 mm", "55 mm", "250 mm"]}\n'
        + '[solid.contact]\nrestitution = 0.5\nfriction = 0.2\n'
        + '[[solid.condition]]\nkind = "rigid_wall"\npoint = ["58 mm", 0.0, 0.0]\nnormal = [-1.0, 0.0, 0.0]\nrestitution = 0.3\nfriction = "coulomb"\n'
        + '[[solid.body]]\nname = "case"\nmesh = {kind = "weapon", length = "260 mm", diameter = "80 mm", wall = "6 mm", nose_length = "90 mm", nose_radius = "14 mm", '
        + 'nose_plug = "20 mm", tail_length = "60 mm", tail_diameter = "64 mm", tail_wall = "8 mm", base_plug = "14 mm", around = 16, through = 1}\n'
        + '[solid.body.material]\nkind = "j2"\ndensity = 7760.0\nyoung_modulus = "206 GPa"\npoisson_ratio = 0.3\n'
        + 'flow = {kind = "linear", yield_stress = "412 MPa", hardening = "2.78 GPa"}\n'
        + '[fluid]\nlower = ["-80 mm", "-80 mm", "-80 mm"]\nupper = ["80 mm", "80 mm", "400 mm"]\ncells = [16, 16, 48]\n[fluid.amr]\nlevels = 1\nevery = 2\n'
        + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.material]]\nname = "air"\nlibrary = "air"\n'
        + '[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "air"\ndensity = 1.225\npressure = 101325.0\n'
        + '[[fluid.region]]\nshape = {kind = "cavity", seed = [0.001, 0.001, 0.13]}\nmaterial = "TNT"\nunburnt = true\npressure = 101325.0\n'
        + '[[fluid.burn]]\nmaterial = "TNT"\npoints = [[0.001, 0.001, 0.225]]\n')
