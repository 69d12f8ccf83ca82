#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""csd on 1 to 4 ranks with 1 and 2 threads: the same bits in all fields, histories, fragments and totals, cracks included; 2 + 1 coupled.
    csd.py BUILD_FOLDER [cracks | pieces | rigid | flying | contact | bar | loaded | static | local | coupled | errors ...]   none named: all
    csd.py BUILD_FOLDER weapon    the small weapon, 1+1 to 2+2 ranks and 2 threads"""
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parents[1] / "run"), str(HERE.parents[1] / "tests" / "regression")]
arguments = sys.argv[1:]
os.environ["BREAKWAVE_BUILD"] = str(pathlib.Path(arguments.pop(0)).resolve())
sys.argv = sys.argv[:2]  # the regression runs, whose shell is used here, read theirs
import runs  # noqa: E402
import weapon as small_weapon  # noqa: E402
from fields import history, series, summary, Solid  # noqa: E402
from verification import solid  # noqa: E402
from verification.case import output, run  # noqa: E402

STEEL = ('[solid.body.material]\nkind = "j2"\ndensity = 7760.0\nyoung_modulus = "206 GPa"\npoisson_ratio = 0.3\n'
         + 'flow = {kind = "linear", yield_stress = "412 MPa", hardening = "2.78 GPa"}\n')
# a shell that a pressure bursts, with a second body of another material, a filter and probes
CRACKS = ('[time]\nend = "26 us"\n' + output("13 us", "1 us")
          + '[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\n[solid.fracture]\ncriterion = {kind = "eqps", limit = 0.05}\n'
          + '[[solid.body]]\nname = "shell"\nmesh = {kind = "shell_of_revolution", shape = "sphere", radius = "62 mm", wall = "6 mm", around = 24, through = 2}\n'
          + STEEL
          + '[[solid.body]]\nname = "block"\nmesh = {kind = "box", lower = ["0.1 m", 0, 0], upper = ["0.11 m", "10 mm", "10 mm"], cells = [3, 3, 3]}\n'
          + 'material = {kind = "neo_hooke", density = 7760.0, young_modulus = "206 GPa", poisson_ratio = 0.3}\nvelocity = ["-50 m/s", 0.0, 0.0]\n'
          + '[[solid.load]]\nkind = "pressure"\nfaces = ["shell.inner"]\ntimes = [0.0, "40 us"]\npressures = ["1 GPa", "0.5 GPa"]\n'
          + '[[solid.condition]]\nkind = "fixed"\nnodes = "block.x_lower"\n'
          + '[[solid.probe]]\nname = "wall"\nkind = "element"\nposition = ["59 mm", 0.0, 0.0]\n'
          + '[[solid.probe]]\nname = "ring"\nkind = "ring"\nlower = "-5 mm"\nupper = "5 mm"\n')
# the same in pieces of Mott's size but for one end, on an axis of its own
PIECES = CRACKS.replace('limit = 0.05}', 'limit = 0.05}\npieces = {kind = "mott", least_speed = "5 m/s", axis = [1, 0, 0], range = ["-45 mm", "80 mm"]}')
# the foot against a rigid wall, viscosity, plain filter: sums that every step makes
BAR = ('[time]\nend = "6 us"\n' + output("3 us", "0.5 us")
       + '[[solid.body]]\nname = "bar"\nmesh = {kind = "cylinder", radius = "3.2 mm", length = "32.4 mm", across = 3, along = 24}\n'
       + 'velocity = [0.0, 0.0, "-227 m/s"]\n' + solid.COPPER
       + '[[solid.condition]]\nkind = "rigid_wall"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n'
       + '[[solid.probe]]\nname = "wall"\nkind = "wall_force"\n'
       + '[solid.filter]\nkind = "plain"\nstrength = 0.5\n[solid.viscosity]\nlinear = 0.06\nquadratic = 1.5\n')
# loads and conditions that look at some nodes only, non-matching bodies tied, mass that is added as elements flatten
LOADED = ('[time]\nend = "30 us"\n' + output("15 us", "1 us")
          + '[[solid.body]]\nname = "beam"\nmesh = {kind = "box", lower = [0, 0, 0], upper = ["60 mm", "18 mm", "18 mm"], cells = [20, 6, 6]}\n' + solid.COPPER
          + '[[solid.body]]\nname = "plate"\nmesh = {kind = "box", lower = [0, 0, "18 mm"], upper = ["60 mm", "18 mm", "24 mm"], cells = [30, 9, 3]}\n' + STEEL
          + '[[solid.load]]\nkind = "traction"\nfaces = ["beam.x_upper"]\ntotal = ["80 kN", "10 kN", "0 N"]\n'
          + '[[solid.load]]\nkind = "blast"\nfaces = ["plate.z_upper"]\ncentre = ["30 mm", 0, "150 mm"]\ncharge = "100 g"\nstart_time = "-5 us"\n'
          + '[[solid.load]]\nkind = "body_force"\ndensity = [0.0, 0.0, "-1e9 N/m^3"]\nelements = "plate"\n'
          + '[[solid.condition]]\nkind = "symmetry"\nnormal = [0.0, 1.0, 0.0]\n'
          + '[[solid.condition]]\nkind = "displacement"\nnodes = "beam.x_lower"\ndirection = [1.0, 0.0, 0.0]\ntimes = [0.0, "30 us"]\ndisplacements = [0.0, "3 mm"]\n'
          + '[[solid.condition]]\nkind = "tie"\nnodes = "plate.z_lower"\nfaces = ["beam.z_upper"]\n'
          + '[[solid.condition]]\nkind = "spring"\nnodes = "beam.z_lower"\nstiffness = "2 MN/m"\ndamping = "20 N s/m"\n'
          + '[[solid.condition]]\nkind = "damping"\nnodes = "plate.x_upper"\nrate = "1e4 1/s"\n'
          + '[solid.mass_scaling]\nminimum_step = "STEP"\nlimit = 0.3\n')
STATIC = ('[time]\nend = "4 ms"\n' + output("0 s", "10 us") + '[solid.static]\ntolerance = 1e-3\n'
          + '[[solid.body]]\nname = "beam"\nmesh = {kind = "box", lower = [0, 0, 0], upper = ["60 mm", "15 mm", "15 mm"], cells = [16, 4, 4]}\n' + STEEL
          + '[[solid.load]]\nkind = "traction"\nfaces = ["beam.x_upper"]\ntotal = ["0 N", "0 N", "-2 kN"]\n'
          + '[[solid.condition]]\nkind = "fixed"\nnodes = "beam.x_lower"\n')
LAYOUTS = [("1", 1), ("1", 2), ("2", 1), ("2", 2), ("4", 1)]
TOTALS = ("steps", "t", "energies", "masses", "momenta", "counts")


def totals_differ(one, two):
    a, b = summary(one, "solid"), summary(two, "solid")
    values = [{key: value for key, value in s["values"].items() if not key.endswith("_share")} for s in (a, b)]
    for s in (a, b):
        s["counts"].pop("skipped_blocks", None)  # work, not result: those at a border are never passed over
    return [f"solid_summary.json:{key}" for key in TOTALS if a[key] != b[key]] + (["solid_summary.json:values"] if values[0] != values[1] else [])


def compare(name, text, layouts, only="solid"):
    """Runs the layouts; texts of what is not as in the first."""
    faults, first = [], None
    for ranks, threads in layouts:
        directory = run(f"ranks_{name}_{ranks}_{threads}", text, ranks=ranks, threads=threads, only=only).directory
        if first is None:
            first = directory
            continue
        different = runs.differences(first, directory) + totals_differ(first, directory)
        share = summary(directory, "solid")["values"].get("exchange_share")
        print(f"{name}: {ranks} ranks x {threads} threads: {'the same bits' if not different else 'DIFFERENT: ' + ', '.join(different[:6])}"
              + (f" (exchange and waiting {100 * share:.0f} % of the time)" if share is not None else ""), flush=True)
        faults += [f"{name} {ranks} x {threads}: other bits"] if different else []
    return faults, first


def cracks():
    faults, directory = compare("cracks", CRACKS, LAYOUTS)
    opened, pieces = (history(directory / "solid_history.csv")[key][-1] for key in ("opened_faces", "fragments"))
    print(f"cracks: {opened:.0f} faces opened, {pieces:.0f} pieces")
    exact = Solid(series(directory, "solid")[-1][1]).cell["sigma_m"].dtype == "float64"
    return faults + ([] if opened > 100 and pieces > 3 else ["cracks: nothing cracks"]) + ([] if exact else ["cracks: the fields are not exact"])


RIGID = (CRACKS.replace('"26 us"', '"30 us"') + '[solid.rigid]\nelements = 60\nbodies = ["plate"]\nswitch_times = ["20 us", "24 us"]\nbox = {lower = ["-58 mm", -1, -1], upper = [1, 1, 1]}\n'
         + '[[solid.body]]\nname = "plate"\nmesh = {kind = "box", lower = [0, 0, "0.07 m"], upper = ["20 mm", "20 mm", "75 mm"], cells = [3, 3, 2]}\n'
         + 'material = {kind = "neo_hooke", density = 7760.0, young_modulus = "206 GPa", poisson_ratio = 0.3}\nvelocity = [0.0, 0.0, "500 m/s"]\n'
         + '[[solid.condition]]\nkind = "rigid_wall"\npoint = [0.0, 0.0, "78 mm"]\nnormal = [0.0, 0.2, -1.0]\nfriction = "coulomb"\nrestitution = 0.5\n')


def rigid():
    faults, directory = compare("rigid", RIGID, LAYOUTS)
    table = history(directory / "solid_history.csv")
    print(f"rigid: {table['rigid_fragments'][-1]:.0f} of {table['fragments'][-1]:.0f} fragments are rigid, {table['left_fragments'][-1]:.0f} left the box")
    return faults + ([] if min(table["rigid_fragments"][-1], -table["contact_work"][-1], table["left_fragments"][-1]) > 0 else ["rigid: nothing becomes rigid, meets the wall or leaves"])


# the same without conditions: nodes of rigid bodies follow where loads or elements beside them look
FLYING = "".join("[[" + table for table in RIGID.split("[[") if not table.startswith("solid.condition")).removeprefix("[[")


def flying():
    faults, directory = compare("flying", FLYING, [("1", 1), ("1", 2), ("2", 1)])
    table, residual = history(directory / "solid_history.csv"), summary(directory, "solid")["energies"]
    share = abs(residual["residual"]) / residual["external"]
    print(f"flying: {table['rigid_fragments'][-1]:.0f} of {table['fragments'][-1]:.0f} fragments are rigid, residual {share:.2g} of the work")
    return faults + ([] if table["rigid_fragments"][-1] > 100 and share < 0.01 else ["flying: too few are rigid, or energy is lost"])


CONTACT = (CRACKS.replace('"26 us"', '"34 us"') + '[solid.contact]\nrestitution = 0.5\nfriction = 0.2\n[solid.rigid]\nelements = 60\n'
           + '[[solid.body]]\nname = "shot"\nmesh = {kind = "box", lower = ["-68 mm", "-4 mm", "-4 mm"], upper = ["-62.5 mm", "4 mm", "4 mm"], cells = [3, 4, 4]}\n'
           + 'velocity = ["300 m/s", "20 m/s", 0.0]\n' + STEEL)


def contact():
    faults, directory = compare("contact", CONTACT, LAYOUTS)
    table = history(directory / "solid_history.csv")
    given, work, external = summary(directory, "solid")["counts"]["contact_impulses"], table["contact_work"], table["external_work"][-1]
    print(f"contact: {given:.0f} impulses, work {work[-1]:.4g} J, residual {abs(table['energy_residual']).max():.3g} J of {external:.4g} J")
    return (faults + ([] if given > 100 and work[-1] < 0 and max(work[1:] - work[:-1]) <= 1e-9 * abs(work[-1]) else ["contact: nothing meets, or energy is made"])
            + ([] if -work[-1] < 0.01 * external else ["contact: fragments that fly apart hold each other"]))


def pieces():
    faults, directory = compare("pieces", PIECES, LAYOUTS)
    rows = history(directory / "pieces.csv")
    print(f"pieces: {len(rows['bins'])} rows, {rows['bins'].sum():.0f} bins")
    return faults + ([] if rows["bins"].sum() > 10 else ["pieces: nothing breaks up"])


def bar():
    return compare("bar", BAR, LAYOUTS)[0]


def loaded():
    faults, directory = compare("loaded", LOADED.replace("STEP", "0.26 us"), [("1", 1), ("2", 1), ("3", 1), ("2", 2)])
    values = summary(directory, "solid")
    added = [value for group in ("masses", "values", "counts") for key, value in values[group].items() if "scal" in key or "added" in key]
    print(f"loaded: mass scaling {added}")
    return faults + ([] if added and max(added) > 0 else ["loaded: no mass was added"])


def static():
    faults, directory = compare("static", STATIC, [("1", 1), ("2", 1), ("3", 1), ("2", 2)])
    status, steps = summary(directory, "solid")["status"], summary(directory, "solid")["steps"]
    print(f"static: {status} after {steps} steps")
    return faults + ([] if status == "converged" else ["static: not converged"])


# cracks, rigid pieces and a body that is freed again, a moving plate and a wall, all by local steps; on one rank
LOCAL = RIGID.replace('[solid.filter]\nkind = "self_adjoint"\nstrength = 0.5\n', "[solid.time_step]\nlevels = 3\n")


def local():
    faults, directory = compare("local", LOCAL, [("1", 1), ("1", 2)])
    now, table = summary(directory, "solid"), history(directory / "solid_history.csv")
    residual = abs(now["energies"]["residual"]) / now["energies"]["external"]
    print(f"local: {now['steps']} steps, {now['counts']['short_steps']:.0f} short ones, residual {residual:.2g} of the work, {table['fragments'][-1]:.0f} pieces, "
          f"{table['rigid_fragments'][-1]:.0f} rigid")
    return faults + ([] if now["counts"]["short_steps"] > 1.5 * now["steps"] and table["rigid_fragments"][-1] > 0 and residual < 0.01 else ["local: no local steps, or energy is lost"])


def coupled():
    return compare("coupled", small_weapon.CASE.replace('"60 us"', '"26 us"'), [("1+1", 1), ("2+2", 1)], only=None)[0]


def weapon():
    faults, directory = compare("weapon", small_weapon.CASE, [("1+1", 1), ("2+1", 1), ("1+2", 1), ("2+2", 1), ("1+1", 2)], only=None)
    table = history(directory / "solid_history.csv")
    print(f"weapon: {table['fragments'][-1]:.0f} pieces, {table['rigid_fragments'][-1]:.0f} rigid, {table['left_fragments'][-1]:.0f} left the box, contact work {table['contact_work'][-1]:.3g} J")
    return faults + ([] if min(table[key][-1] for key in ("fragments", "rigid_fragments", "left_fragments")) > 1 else ["weapon: nothing breaks, becomes rigid or leaves"])


def errors():
    """A rank too many is refused before the first step; an inverted element ends all ranks with its place."""
    faults = []
    small = BAR.replace("across = 3, along = 24", "across = 2, along = 1")
    said = run("ranks_too_many", small, ranks="4", threads=1, expect=2).output
    if "use fewer ranks" not in said:
        faults.append(f"too many ranks: {said}")
    hard = BAR.replace('end = "6 us"', 'end = "6 us"\nmax_steps = 400').replace("[solid.viscosity]", '[solid.time_step]\nfixed = "1 us"\n[solid.viscosity]')
    texts = [run(f"ranks_inverted_{ranks}", hard, ranks=ranks, threads=1, expect=3).output for ranks in ("1", "2")]
    lines = [[line for line in text.split("\n") if "element" in line and "error" in line] for text in texts]
    if not lines[0] or lines[0][0] != (lines[1] or [""])[0]:
        faults.append(f"inverted: {lines}")
    print(f"errors: {lines[0][:1]}")
    return faults


if __name__ == "__main__":
    groups = {"cracks": cracks, "pieces": pieces, "rigid": rigid, "flying": flying, "contact": contact, "bar": bar, "loaded": loaded, "static": static, "local": local, "coupled": coupled, "errors": errors}
    failures = [fault for group in arguments or groups for fault in (groups | {"weapon": weapon})[group]()]
    print("\n".join(failures) or "all the same")
    sys.exit(1 if failures else 0)
