#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Wrong input, through the real programs: each must end with exit code 2 before the first step and name file and line.
    bad_input.py BUILD_FOLDER [name ...]    prints each message"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

BUILD = pathlib.Path(sys.argv[1]).resolve()

SOLID = """\
[time]
end = "1 us"
[output]
directory = "out"
[[solid.body]]
name = "block"
mesh = {kind = "box", lower = [0, 0, 0], upper = ["10 mm", "10 mm", "10 mm"], cells = [2, 2, 2]}
[solid.body.material]
kind = "j2"
density = "7.8 g/cm^3"
young_modulus = "206 GPa"
poisson_ratio = 0.3
flow = {kind = "linear", yield_stress = "400 MPa", hardening = "1 GPa"}
"""
DRAG = '[solid.rigid.drag]\ndensity = 1.2\nsound_speed = 340\nmach = {}\ncoefficient = {}\n'
FLUID = """\
[time]
end = "1 us"
[output]
directory = "out"
[fluid]
lower = [0, 0, 0]
upper = ["160 mm", "10 mm", "10 mm"]
cells = [16, 1, 1]
[[fluid.material]]
name = "air"
eos = {kind = "ideal_gas", gamma = 1.4}
[[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = "101325 Pa"
"""
BURN = """\
[[fluid.burn]]
material = "TNT"
points = [["80 mm", "5 mm", "5 mm"]]
"""
RADIAL = FLUID.replace('lower = [0, 0, 0]\nupper = ["160 mm", "10 mm", "10 mm"]', 'geometry = "spherical"\nradius = "160 mm"')
# a hexahedron with a corner pushed through the opposite one: no order of its nodes is right
PUSHED_MSH = """\
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 -0.5 -0.5 -0.5
8 0 1 1
$EndNodes
$Elements
1
1 5 2 1 1 1 2 3 4 5 6 7 8
$EndElements
"""
INP = """\
*Node
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
*Element, type=C3D8, elset=All
1, 1, 2, 3, 4, 5, 6, 7, 8
"""
KEY = "*NODE\n" + "".join(f"{line}\n" for line in INP.split("\n")[1:9]) + "*ELEMENT_SOLID\n1,1,1,2,3,4,5,6,7,8\n*END\n"
EMPTY_MSH = PUSHED_MSH.split("$Elements")[0] + "$Elements\n0\n$EndElements\n"
BOX = 'mesh = {kind = "box", lower = [0, 0, 0], upper = ["10 mm", "10 mm", "10 mm"], cells = [2, 2, 2]}'


def swap(text, old, new):
    assert old in text, old
    return text.replace(old, new)


FREE = '[[fluid.body]]\nname = "a"\nshape = {{kind = "box", lower = [0.02, 0, 0], upper = [0.04, 0.01, 0.01]}}\nmotion = {{kind = "free", {}}}\n'

# name: program, case text, what the message must hold (besides file:line), other files
CASES = {
    "unknown key": ("csd", swap(SOLID, "poisson_ratio", "poisson_ration"), r"poisson_ratio", {}),
    "unknown key, fluid": ("cfd", swap(FLUID, "density =", "densty ="), r"density", {}),
    "wrong unit": ("csd", swap(SOLID, '"7.8 g/cm^3"', '"7.8 g/cm^2"'), r"density", {}),
    "wrong unit, fluid": ("cfd", swap(FLUID, '"101325 Pa"', '"101325 m"'), r"pressure", {}),
    "missing mesh file": ("csd", swap(SOLID, BOX, 'mesh = {kind = "gmsh", file = "nowhere.msh"}'), r"nowhere\.msh", {}),
    "zero elements": ("csd", swap(SOLID, BOX, 'mesh = {kind = "gmsh", file = "empty.msh"}'), r"element|hexahedr", {"empty.msh": EMPTY_MSH}),
    "zero elements, box": ("csd", swap(SOLID, "cells = [2, 2, 2]", "cells = [2, 0, 2]"), r"cells", {}),
    "inverted element": ("csd", swap(SOLID, BOX, 'mesh = {kind = "gmsh", file = "pushed.msh"}'), r"element 1|invert|negative|volume",
                         {"pushed.msh": PUSHED_MSH}),
    "nu = 0.5": ("csd", swap(SOLID, "poisson_ratio = 0.3", "poisson_ratio = 0.5"), r"poisson_ratio", {}),
    "negative density": ("csd", swap(SOLID, '"7.8 g/cm^3"', '"-7.8 g/cm^3"'), r"density", {}),
    "unknown library name": ("csd", re.sub(r'(?s)kind = "j2".*', 'library = "copper OFHK"\n', SOLID), r'did you mean "copper OFHC"', {}),
    "rate law twice": ("csd", re.sub(r'(?s)kind = "j2".*', 'library = "copper OFHC"\nrate = {kind = "cowper_symonds", rate = 40, exponent = 5}\n', SOLID), r"rate", {}),
    "melts at room temperature": ("csd", re.sub(r'(?s)kind = "j2".*', 'library = "copper OFHC"\nflow = {melting_temperature = "10 degC"}\n', SOLID),
                                  r"melting_temperature", {}),
    "levels that blocks can't have": ("cfd", FLUID.replace("cells = [16, 1, 1]", "cells = [20, 1, 1]") + "[fluid.amr]\nlevels = 2\n", r"cells.*blocks", {}),
    "levels without number": ("cfd", FLUID + "[fluid.amr]\nevery = 2\n", r"levels", {}),
    "coarsen above refine": ("cfd", FLUID + "[fluid.amr]\nlevels = 1\nrefine = 0.2\ncoarsen = 0.3\n", r"coarsen.*refine", {}),
    "too few fine cells at walls": ("cfd", FLUID + "[fluid.amr]\nlevels = 1\nwall_cells = 3\n", r"wall_cells", {}),
    "fine region beyond the levels": ("cfd", FLUID + "[fluid.amr]\nlevels = 1\n[[fluid.amr.region]]\nshape = {kind = \"everywhere\"}\nlevel = 2\n", r"level", {}),
    "plane outside the domain": ("cfd", FLUID + '[[fluid.plane]]\nname = "a"\nnormal = "x"\nat = 1.0\n', r"plane.*inside the domain", {}),
    "plane without direction": ("cfd", FLUID + '[[fluid.plane]]\nname = "a"\nnormal = "w"\nat = 0.1\n', r"normal", {}),
    "two gauges of one name": ("cfd", FLUID + 2 * '[[fluid.gauge]]\nname = "a"\nposition = ["80 mm", "5 mm", "5 mm"]\n', r"gauge.*name of its own", {}),
    "unknown way with slits": ("cfd", FLUID + '[fluid.walls]\nslits = "open"\n', r"case.toml:\d+:.*slits.*centre", {}),
    "far field without a state": ("cfd", FLUID.replace("cells = [16, 1, 1]", 'cells = [16, 1, 1]\nboundary = {x_upper = "far_field"}'), r"boundary.*far_field", {}),
    "too much noise": ("cfd", FLUID.replace("cells = [16, 1, 1]", "cells = [16, 1, 1]\nperturbation = 0.7"), r"perturbation", {}),
    "unknown treatment of walls": ("cfd", FLUID + '[fluid.walls]\ntreatment = "second_order"\n', r"case.toml:\d+:.*treatment.*mirror", {}),
    "unknown kind of loads": ("cfd", FLUID + '[fluid.walls]\nloads = "links"\n', r"case.toml:\d+:.*loads.*conservative", {}),
    "free body with mass and density": ("cfd", FLUID + FREE.format("density = 1, mass = 1"), r"case.toml:\d+:.*density.*not both", {}),
    "free body in a direction that isn't": ("cfd", FLUID + FREE.format('mass = 1, fixed = ["x", "turn"]'), r"fixed.*turn_x", {}),
    "free body that flies where it can't": ("cfd", FLUID + FREE.format("mass = 1, plane = true, velocity = [0, 0, 1]"), r"velocity", {}),
    "cut cells of two materials": ("cfd", FLUID + '[fluid.walls]\ntreatment = "cut_cell"\n[[fluid.material]]\nname = "water"\nlibrary = "water"\n', r"case.toml:\d+:.*one \[\[fluid.material\]\]", {}),
    "cut cells with slits": ("cfd", FLUID + '[fluid.walls]\ntreatment = "cut_cell"\nslits = "area"\n', r"case.toml:\d+:.*centre", {}),
    "cut cells behind an open piston": ("cfd", FLUID + '[fluid.walls]\ntreatment = "cut_cell"\n[[fluid.body]]\nname = "p"\nshape = {kind = "piston", point = [0.05, 0, 0]}\n',
                                        r"case.toml:\d+:.*closed body", {}),
    "free plate without inertia": ("cfd", FLUID + FREE.format("mass = 1").replace("shape", "thin = true\nshape"), r"case.toml:\d+:.*inertia and centre", {}),
    "map without cells": ("cfd", FLUID + "[fluid.map]\ncells = [4, 0, 1]\n", r"cells", {}),
    "negative arrival": ("cfd", FLUID.replace("cells = [16, 1, 1]", 'cells = [16, 1, 1]\narrival_overpressure = "-1 Pa"'), r"arrival_overpressure", {}),
    "checkpoints that none keeps": ("cfd", FLUID.replace("[output]", "[checkpoint]\nevery_steps = 5\nkeep = 0\n[output]"), r"keep", {}),
    "long concurrent windows": ("csd", SOLID + '[coupling]\nscheme = "concurrent"\nwindow = "1 us"\n', r"window.*concurrent", {}),
    "negative window": ("csd", SOLID + '[coupling]\nwindow = "-1 us"\n', r"window.*>= 0", {}),
    "port without a file": ("csd", SOLID + '[coupling]\njoin = "port"\n', r"join.*port_file", {}),
    "no such record": ("csd", SOLID + '[coupling]\nreplay = "nowhere.h5"\n', r"case.toml:\d+: coupling.replay: nowhere.h5", {}),
    "no such record, fluid": ("cfd", FLUID + '[coupling]\nreplay = "case.toml"\n', r"replay: case.toml: no record", {}),
    "unknown radiation": ("csd", SOLID + '[coupling]\nradiation = "sometimes"\n', r"radiation.*always", {}),
    "negative pressure, fluid": ("cfd", swap(FLUID, 'pressure = "101325 Pa"', 'pressure = "-1 bar"'), r"region\[0\].pressure: expected a pressure above 0 Pa, got -1", {}),
    "negative threads, fluid": ("cfd", swap(FLUID, "cells = [16, 1, 1]", "cells = [16, 1, 1]\nthreads = -3"), r"threads", {}),
    "negative threads": ("csd", SOLID + "[solid]\nthreads = -3\n", r"threads", {}),
    "inflow that leaves": ("cfd", FLUID.replace("cells = [16, 1, 1]", 'cells = [16, 1, 1]\nboundary = {x_upper = "inflow"}') + '[[fluid.inflow]]\nside = "x_upper"\nmaterial = "air"\ndensity = 1.2\npressure = 1e5\nvelocity = [600, 0, 0]\n', r"velocity.*into the domain at x_upper", {}),
    "two lines of one name": ("cfd", FLUID + 2 * '[[fluid.line]]\nname = "a"\nfrom = [0, 0, 0]\nto = [0.1, 0, 0]\n', r"line.*name of its own", {}),
    "line of no length": ("cfd", FLUID + '[[fluid.line]]\nname = "a"\nfrom = [0, 0, 0]\nto = [0, 0, 0]\n', r"line.*apart", {}),
    "fields outside the domain": ("cfd", FLUID + "[fluid.fields]\nlower = [1, 0, 0]\nupper = [2, 1, 1]\n", r"fields.*inside the domain", {}),
    "moments that no body has": ("cfd", FLUID + FREE.format("mass = 1, inertia = [1, 1, 3]"), r"inertia.*sum of the others", {}),
    "plate along its normal": ("cfd", FLUID + '[[fluid.body]]\nname = "p"\nshape = {kind = "plane", point = [0.05, 0, 0], along = [2, 0, 0], size = [0.1, 0.1]}\n', r"along.*across the normal", {}),
    "negative density, fluid": ("cfd", swap(FLUID, "density = 1.225", "density = -1.225"), r"density", {}),
    "no explosive to burn": ("cfd", FLUID + BURN, r"TNT", {}),
    "burn of a gas": ("cfd", FLUID + swap(BURN, '"TNT"', '"air"'), r"air|explosive", {}),
    "corners along a radius": ("cfd", swap(RADIAL, "cells", "lower = [0, 0, 0]\ncells"), r"lower", {}),
    "no radius": ("cfd", swap(RADIAL, 'radius = "160 mm"\n', ""), r"radius", {}),
    "inner radius beyond": ("cfd", swap(RADIAL, "cells", 'inner_radius = "0.2 m"\ncells'), r"radius.*above inner_radius", {}),
    "cells across a radius": ("cfd", swap(RADIAL, "[16, 1, 1]", "[16, 4, 1]"), r"cells.*radius", {}),
    "open centre": ("cfd", swap(RADIAL, "cells", 'boundary = {x_lower = "outflow"}\ncells'), r"boundary.*centre", {}),
    "flow across a radius": ("cfd", RADIAL + "velocity = [0, 1, 0]\n", r"velocity.*radius", {}),
    "levels along a radius": ("cfd", RADIAL + "[fluid.amr]\nlevels = 1\nblock = 8\n", r"amr.*radius", {}),
    "unknown geometry": ("cfd", swap(RADIAL, "spherical", "sphere"), r"spherical", {}),
    "products of air burn on": ("cfd", FLUID + '[fluid.afterburn]\nmaterial = "air"\nend = 1\n', r"explosive", {}),
    "afterburn ends before it begins": ("cfd", FLUID + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[fluid.afterburn]\nmaterial = "TNT"\nbegin = 2\nend = 1\n', r"end.*after begin", {}),
    "afterburn of no known energy": ("cfd", FLUID + '[[fluid.material]]\nname = "C-4"\nlibrary = "C-4"\n[fluid.afterburn]\nmaterial = "C-4"\nend = 1\n', r"energy", {}),
    "miller without a rate": ("cfd", FLUID + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[fluid.afterburn]\nmaterial = "TNT"\nkind = "miller"\n', r"rate", {}),
    "vortex that leaves no gas": ("cfd", FLUID + '[[fluid.vortex]]\ncentre = [0, 0, 0]\nradius = "50 mm"\nspeed = 2000\n', r"leaves gas at the vortex's centre", {}),
    "denser than its covolume": ("cfd", swap(FLUID, 'kind = "ideal_gas", gamma = 1.4', 'kind = "noble_abel", gamma = 1.25, covolume = 1.0'), r"density below 1/covolume", {}),
    "afterburn before the burn is over": ("cfd", FLUID + '[[fluid.material]]\nname = "TNT"\nlibrary = "TNT"\n[[fluid.region]]\nshape = {kind = "everywhere"}\nmaterial = "TNT"\nunburnt = true\npressure = 101325\n' + BURN + '[fluid.afterburn]\nmaterial = "TNT"\nbegin = "1 us"\nend = 1\n', r"end of the programmed burn", {}),
    "sharp interface beside a body": ("cfd", FLUID.replace("[fluid]", '[fluid]\nscheme = {interface = "sharp"}') + '[[fluid.body]]\nname = "ball"\nshape = {kind = "sphere", centre = [0.08, 0, 0], radius = 0.02}\n', r"beside bodies", {}),
    "sharpness of nothing": ("cfd", FLUID.replace("[fluid]", '[fluid]\nscheme = {interface = "sharp", sharpness = 0}'), r"from 1 to 3", {}),
    "start from nowhere": ("cfd", FLUID + '[fluid.start_from]\nfile = "nowhere.h5"\n', r"nowhere\.h5", {}),
    "start from another file": ("cfd", FLUID + '[fluid.start_from]\nfile = "a.inp"\n', r"profile", {"a.inp": INP}),
    "burn without light": ("cfd", FLUID + '[[fluid.burn]]\nmaterial = "air"\n', r"points.*at least one point, line or plane", {}),
    "burn line of no length": ("cfd", FLUID + BURN + "[[fluid.burn.line]]\nfrom = [0, 0, 0]\nto = [0, 0, 0]\n", r"to.*apart", {}),
    "burn plane without normal": ("cfd", FLUID + BURN + "[[fluid.burn.plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n", r"normal", {}),
    "unknown path of burn": ("cfd", FLUID + BURN + 'path = "crooked"\n', r"straight", {}),
    "Abaqus: unknown node": ("csd", swap(SOLID, BOX, 'mesh = {kind = "abaqus", file = "a.inp"}'), r"a\.inp:11: .*node 77",
                             {"a.inp": swap(INP, "6, 7, 8\n", "6, 77, 8\n")}),
    "Abaqus: duplicate element": ("csd", swap(SOLID, BOX, 'mesh = {kind = "abaqus", file = "a.inp"}'), r"a\.inp:12: .*same nodes",
                                  {"a.inp": INP + "2, 1, 2, 3, 4, 5, 6, 7, 8\n"}),
    "Abaqus: unknown set": ("csd", swap(SOLID, BOX, 'mesh = {kind = "abaqus", file = "a.inp", elements = ["Al"]}'), r"has: All", {"a.inp": INP}),
    "LS-DYNA: coordinate": ("csd", swap(SOLID, BOX, 'mesh = {kind = "lsdyna", file = "a.k"}'), r"a\.k:3: expected a coordinate",
                            {"a.k": swap(KEY, "2, 1, 0, 0", "2, one, 0, 0")}),
    "blast too near": ("csd", SOLID + '[[solid.load]]\nkind = "blast"\nfaces = ["x_lower"]\ncentre = [-0.001, 0, 0]\ncharge = 1.0\n', r"0\.0531", {}),
    "front without decay": ("csd", SOLID + '[[solid.load]]\nkind = "pressure_front"\nfaces = ["x_lower"]\npeak = 1e9\nspeed = 1000.0\n', r"decay", {}),
    "traction twice": ("csd", SOLID + '[[solid.load]]\nkind = "traction"\nfaces = ["x_lower"]\ntraction = [1.0, 0, 0]\ntotal = [1.0, 0, 0]\n', r"either", {}),
    "spring of nothing": ("csd", SOLID + '[[solid.condition]]\nkind = "spring"\nnodes = "x_lower"\n', r"stiffness", {}),
    "symmetry inside": ("csd", SOLID + '[[solid.condition]]\nkind = "symmetry"\nnormal = [1, 0, 0]\npoint = [0.005, 0, 0]\n', r"both sides", {}),
    "tie to far faces": ("csd", SOLID + '[[solid.condition]]\nkind = "tie"\nnodes = "x_lower"\nfaces = ["x_upper"]\n', r"lies within", {}),
    "unknown region": ("csd", SOLID + '[[solid.velocity]]\nnodes = "x_lowr"\nvelocity = [1.0, 0, 0]\n', r"x_lower", {}),
    "local steps and a filter": ("csd", SOLID + '[solid.time_step]\nlevels = 2\n[solid.filter]\nkind = "plain"\n', r"pressure filter", {}),
    "too many levels": ("csd", SOLID + '[solid.time_step]\nlevels = 9\n', r"from 0 to 6", {}),
    "drag with Mach numbers that fall": ("csd", SOLID + DRAG.format("[1, 0.5]", "[1.2, 1.2]"), r"drag\.mach.*rise", {}),
    "drag with too few coefficients": ("csd", SOLID + DRAG.format("[0, 1]", "[1.2]"), r"coefficient.*mach", {}),
    "more elements than numbers": ("csd", swap(SOLID, "cells = [2, 2, 2]", "cells = [100000, 100000, 100000]"), r"cells.*358 million", {}),
    "set that exists": ("csd", swap(SOLID, "cells = [2, 2, 2]", 'cells = [2, 2, 2], sets = [{name = "x_lower"}]'), r"sets\[0\]\.name.*x_lower", {}),
    "two probes of one name": ("csd", SOLID + 2 * '[[solid.probe]]\nname = "a"\nkind = "node"\nposition = [0, 0, 0]\n', r"probe.*name of its own", {}),
    "probe that splits its column": ("csd", SOLID + '[[solid.probe]]\nname = "a,b"\nkind = "node"\nposition = [0, 0, 0]\n', r"name.*commas", {}),
    "load on no faces": ("csd", SOLID + '[[solid.load]]\nkind = "pressure"\nfaces = []\ntimes = [0.0]\npressures = [1e6]\n', r"load\[0\]\.faces.*face set", {}),
    "wet faces that don't exist": ("csd", SOLID + '[solid.wet]\nfaces = ["inner"]\n', r"wet\.faces.*inner", {}),
    "front ahead of itself": ("csd", SOLID + '[[solid.load]]\nkind = "pressure_front"\nfaces = ["x_lower"]\npeak = 1e9\nspeed = 1000.0\nbehind = [-0.1, 0.1]\nfactors = [1, 0]\n',
                              r"behind.*0 as the first", {}),
    "wall inside": ("csd", SOLID + '[[solid.condition]]\nkind = "rigid_wall"\npoint = [0, 0, 0.005]\nnormal = [0, 0, 1]\n', r"condition\[0\].*behind the wall", {}),
    "plastic strain of what doesn't flow": ("csd", re.sub(r'(?s)kind = "j2"(.*)flow.*', r'kind = "neo_hooke"\1', SOLID) + '[solid.fracture]\ncriterion = {kind = "eqps", limit = 0.1}\n',
                                            r"fracture\.criterion.*j2", {}),
    "no minimum step": ("csd", SOLID + '[solid.mass_scaling]\nminimum_step = 0.0\n', r"minimum_step", {}),
    "broken TOML": ("csd", swap(SOLID, "[[solid.body]]", "[[solid.body]"), r".", {}),
}


def main():
    wanted = sys.argv[2:] or list(CASES)
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
    bad = 0
    for name in wanted:
        program, text, expected, files = CASES[name]
        with tempfile.TemporaryDirectory() as folder:
            for file, content in {"case.toml": text, **files}.items():
                (pathlib.Path(folder) / file).write_text(content)
            done = subprocess.run([BUILD / "bin" / program, "case.toml"], cwd=folder, env=environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=60)
            stepped = any((pathlib.Path(folder) / "out").glob("*_summary.json"))
        message = [line for line in done.stdout.split("\n") if re.search(r"\.(toml|msh|inp|k):\d+", line)]
        faults = []
        if done.returncode != 2:
            faults.append(f"exit code {done.returncode}, not 2")
        if not message:
            faults.append("no file:line in the message")
        elif not re.search(expected, "\n".join(message), re.IGNORECASE):
            faults.append(f"the message does not speak of {expected}")
        if stepped:
            faults.append("the run went on to a summary")
        bad += bool(faults)
        print(f"{'FAIL' if faults else 'ok  '} {name:24} exit {done.returncode}  {message[0].strip() if message else done.stdout.strip()[-300:]}"
              + (f"\n     {'; '.join(faults)}" if faults else ""))
    print(f"{len(wanted)} wrong inputs, {bad} not refused as they should be")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
