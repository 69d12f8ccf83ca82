# SPDX-License-Identifier: Apache-2.0
"""What may break the solid: T1, T2 (a tube torn open), T4 (random meshes), T13 (tiny steps), T14 (long runs), T15 (filters), T17 (one flat element), T18 (metal that melts)."""
import numpy as np

from . import reference
from .case import WORK, RunFailed, at_least, at_most, case, close, finest, output, run
from .materials import body, prescribed, probe
from .solid import COPPER, PAPER_STEEL, fields, j2, roller, taylor


def history(result):
    return fields.history(result.directory / "solid_history.csv")


def is_finite(table):
    return all(np.isfinite(column).all() for name, column in table.items() if column.dtype == float)


# --- the weapon's wall under a step of pressure ---------------------------------------------------------------------------------------
def torn_tube(pressure, end, more="", mesh="", pictures=1):
    """A slab of the weapon's wall, 60 mm long between rollers, under a pressure from 0 on."""
    text = (f"[time]\nend = {end!r}\n" + output(f"{end / pictures!r} s", f"{end / 50!r} s")
            + body("case", f'{{kind = "tube", inner_radius = "125 mm", outer_radius = "137 mm", length = "60 mm", around = 48, through = 2, along = 3{mesh}}}', j2(**PAPER_STEEL))
            + f'[[solid.load]]\nkind = "pressure"\nfaces = ["inner"]\ntimes = [0.0, 1.0]\npressures = [{pressure!r}, {pressure!r}]\n' + more)
    return text + "".join(roller(side, 2) for side in ("lower", "upper"))


def outward(result, picture=-1):
    """Radial velocity of the nodes, at the end unless told otherwise."""
    solid = fields.Solid(fields.series(result.directory, "solid")[picture][1])
    r = np.hypot(solid.points[:, 0], solid.points[:, 1])
    return (solid.point["velocity"][:, :2] * solid.points[:, :2]).sum(axis=1) / r


def residual_part(table):
    """Largest energy residual over the energy that had come in by then."""
    brought = np.abs(table["external_work"]) + np.abs(table["kinetic_energy"])
    return np.abs(table["energy_residual"][1:] / brought[1:].max()).max()


@case("T1")
def t1():
    """A tube of split tetrahedra, and one with nodes shifted by 25 %, torn open by 10 GPa: no collapsed points, energy, speed against the regular mesh, at 80 us (walls a \
fifth as thick as at first) and at 100 us, when metal that a pressure drives has begun to grow ripples"""
    meshes = {"regular": "", "shifted": ", perturb = 0.25", "split": ", split = true", "split and shifted": ", split = true, perturb = 0.25"}
    regular = {}
    for name, mesh in meshes.items():
        result = run(f"T1_{name}", torn_tube(1e10, 100e-6, mesh=mesh, pictures=5), only="solid")
        table = history(result)
        for picture, until in ((-2, 80e-6), (-1, 100e-6)):
            rows, v, when = table["t"] < 1.001 * until, outward(result, picture), f"{name}, {1e6 * until:.0f} us"
            yield at_most(f"{when}: points of elements that collapsed", table["collapsed"][rows].max(), 0, result.seconds)
            yield at_most(f"{when}: energy residual over the energy brought in", residual_part({key: column[rows] for key, column in table.items()}), 0.01)
            yield at_most(f"{when}: spread of the radial speed, std over mean", v.std() / v.mean(), 0.03)
            if name == "regular":
                regular[picture] = v.mean()
            else:
                yield close(f"{when}: mean radial speed against the regular mesh [m/s]", v.mean(), regular[picture], 0.03)


@case("T2")
def t2():
    """The same under 100 GPa, ten times too much: it runs, or ends saying why; never NaN"""
    for name, mesh in (("regular", ""), ("split", ", split = true")):
        try:
            result = run(f"T2_{name}", torn_tube(1e11, 20e-6, mesh=mesh), only="solid")
            directory = result.directory
        except RunFailed as failure:
            directory = WORK / f"T2_{name}" / "out"
            told = all(words in str(failure) for words in ("ended with 3,", "error: element ", "t = "))
            yield at_least(f"{name}: ended, and the reason names the place and the time", float(told), 1)
        table = fields.history(directory / "solid_history.csv")
        yield at_most(f"{name}: rows of the history with NaN", float(not is_finite(table)), 0)


@case("T4")
def t4():
    """The bar of S7, 4 across, nodes shifted by 15 %, three seeds: foot radius against the regular mesh"""
    def foot(name, text):
        result = run(name, text, only="solid")
        x = fields.Solid(fields.series(result.directory, "solid")[-1][1]).points
        return np.hypot(x[:, 0], x[:, 1])[x[:, 2] < 1e-6].max(), x[:, 2].max() - x[:, 2].min(), result.seconds
    regular, length, _ = foot("T4_regular", taylor(4, 40))
    for seed in (1, 2, 3):
        radius, high, seconds = foot(f"T4_{seed}", taylor(4, 40).replace("along = 40,", f"along = 40, perturb = 0.15, seed = {seed},"))
        yield close(f"seed {seed}: foot radius over that of the regular mesh", radius / regular, 1, 0.015, seconds)
        yield close(f"seed {seed}: length over that of the regular mesh", high / length, 1, 0.015)


@case("T13")
def t13():
    """Tiny steps: the bar of S7 to 10 us by steps of 1/100 of the stable one (1/1000 with --all), and as loads of a coupled window would cut it: the same answer, energy kept"""
    text = taylor(4, 40).replace('end = "80 us"', 'end = "10 us"').replace('"80 us"', '"10 us"')
    whole = run("T13_whole", text, only="solid")
    base, reference_table = fields.Solid(fields.series(whole.directory, "solid")[-1][1]), history(whole)
    travel = 227.0 * 10e-6
    for part in (1e-2, 1e-3) if finest() else (1e-2,):
        step = part * reference_table["dt_stable"][0]
        result = run(f"T13_{part:g}", text + f"[solid.time_step]\nmaximum = {step!r}\n", only="solid")
        tiny, table = fields.Solid(fields.series(result.directory, "solid")[-1][1]), history(result)
        yield at_most(f"steps of {part:g} of the stable one: largest distance of a node, over the way of the bar", np.linalg.norm(tiny.points - base.points, axis=1).max() / travel, 0.01, result.seconds)
        yield close(f"steps of {part:g}: kinetic energy", table["kinetic_energy"][-1], reference_table["kinetic_energy"][-1], 0.01)
        yield at_most(f"steps of {part:g}: energy residual over the kinetic energy at the start", np.abs(table["energy_residual"]).max() / table["kinetic_energy"][0], 1e-3)


# --- long runs ------------------------------------------------------------------------------------------------------------------------
STEEL = 'material = {kind = "neo_hooke", density = 7800.0, young_modulus = 2e11, poisson_ratio = 0.3}\n'


def whole_body(path, density, volume):
    """Centre, momentum and angular momentum about the origin from a field file of equal cubes: masses by their corners."""
    solid = fields.Solid(path)
    mass = np.bincount(solid.hex.ravel(), minlength=len(solid.points)) * density * volume / 8
    x, v = solid.points, solid.point["velocity"]
    return (mass[:, None] * x).sum(0) / mass.sum(), (mass[:, None] * v).sum(0), np.cross(x, mass[:, None] * v).sum(0)


@case("T14")
def t14():
    """A million steps: an elastic ring that breathes, an elastic block that flies and turns: energy, momenta, place"""
    ring = ("[time]\nend = 1.0\nmax_steps = 1000000\n" + output("1 s", "1e-4 s")
            + body("ring", '{kind = "tube", inner_radius = "49 mm", outer_radius = "51 mm", length = "2 mm", around = 16, through = 1, along = 1}', STEEL) + "motion = {radial = 1.0}\n")
    cube = ("[time]\nend = 1.0\nmax_steps = 1000000\n" + output("1 s", "1e-4 s")
            + body("cube", '{kind = "box", lower = ["-10 mm", "-10 mm", "-10 mm"], upper = ["10 mm", "10 mm", "10 mm"], cells = [2, 2, 2]}', STEEL, (30.0, 20.0, 10.0))
            + "motion = {spin = [300.0, 200.0, 500.0]}\n")
    # steps that swing with the vibration feed it: slowly, by the strain
    for name, text in (("ring", ring), ("ring, steps of 0.65", ring + '[solid.time_step]\nfixed = "180 ns"\n'), ("cube", cube)):
        result = run(f"T14_{name.replace(', ', '_').replace(' ', '_')}", text, only="solid", threads=1)
        table = history(result)
        t, first = table["t"], table["kinetic_energy"][0]

        def drift(column):
            parts = [part.mean() for part in np.array_split(column[1:], 100)]
            return abs(parts[-1] - parts[0]) / first
        # the residual is of leapfrog's own energy; that of the velocities swings with the vibration, but sees what grows at the limit of stability
        yield at_most(f"{name}, 1,000,000 steps: drift of the energy residual, last hundredth less first", drift(table["energy_residual"]), 1e-8, result.seconds)
        yield at_most(f"{name}: drift of kinetic and elastic energy", drift(table["kinetic_energy"] + table["elastic_energy"]), 1e-3)
        if name != "cube":
            continue
        files = fields.series(result.directory, "solid")
        (c0, p0, l0), (c1, p1, l1) = (whole_body(files[k][1], 7800.0, 1e-6) for k in (0, -1))
        duration = files[-1][0] - files[0][0]
        yield at_most(f"{name}: momentum", np.linalg.norm(p1 - p0) / np.linalg.norm(p0), 1e-10)
        yield at_most(f"{name}: angular momentum about its centre", np.linalg.norm((l1 - np.cross(c1, p1)) - (l0 - np.cross(c0, p0))) / np.linalg.norm(l0), 1e-10)
        way = np.array([30.0, 20.0, 10.0]) * duration
        yield at_most(f"{name}: place of its centre, over its way", np.linalg.norm(c1 - c0 - way) / np.linalg.norm(way), 1e-9)
        yield at_least(f"{name}: time [s] (reported)", t[-1], 0)


@case("T15")
def t15():
    """Filters on T1's split tube: off, and both kinds at 0.25, 0.5, 1: energy, speed; full strength lets checkerboard volumes grow and is told so"""
    base = outward(run("T15_off", torn_tube(1e10, 60e-6, mesh=", split = true"), only="solid")).mean()
    for kind in ("plain", "self_adjoint"):
        for strength in (0.25, 0.5, 1.0):
            more = f'[solid.filter]\nkind = "{kind}"\nstrength = {strength}\n' + ("beyond = true\n" if strength > 0.5 else "")
            name = f"{kind} {strength:g}"
            result = run(f"T15_{kind}_{strength:g}", torn_tube(1e10, 60e-6, more, ", split = true"), only="solid")
            table = history(result)
            if strength <= 0.5:
                yield at_most(f"{name}: collapsed points", table["collapsed"].max(), 0, result.seconds)
                yield close(f"{name}: mean radial speed against no filter [m/s]", outward(result).mean(), base, 0.01)
                yield at_most(f"{name}: energy residual over the energy brought in", residual_part(table), 0.01)
            else:
                yield at_least(f"{name}: warnings of the checkerboard", float("checkerboard" in result.output), 1, result.seconds)


# --- one element flattened 1000:1 -----------------------------------------------------------------------------------------------------
def bar_with_a_flat_layer(path, cells, width, length, flat):
    """Abaqus file of a square bar of width x width in 2 x 2 columns along z, one layer in its middle `flat` times thinner than wide."""
    step = length / cells
    z = np.concatenate([np.arange(cells // 2 + 1) * step, np.arange(cells // 2, cells + 1) * step + width / 2 / flat])
    lines, node = ["*NODE"], lambda i, j, k: 1 + i + 3 * (j + 3 * k)
    lines += [f"{node(i, j, k)}, {i * width / 2!r}, {j * width / 2!r}, {float(z[k])!r}" for k in range(len(z)) for j in range(3) for i in range(3)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=BAR")
    number = 0
    for k in range(len(z) - 1):
        for j in range(2):
            for i in range(2):
                number += 1
                corners = [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)]
                lines.append(", ".join(str(n) for n in [number] + corners))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")


@case("T17")
def t17():
    """One layer of elements 1000 times flatter than the others in a bar that hits a wall: masses lent by neighbours, mass scaling, local steps bound the work, the bar comes to rest as without the layer"""
    width, length, cells = 4e-3, 40e-3, 40
    bar_with_a_flat_layer(WORK / "T17_mesh" / "flat.inp", cells, width, length, 1000)
    impact = ("[time]\nend = \"60 us\"\n" + output("60 us", "1 us") + '[[solid.condition]]\nkind = "rigid_wall"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n')
    mesh = {"regular": f'{{kind = "box", lower = [0, 0, 0], upper = [{width}, {width}, {length}], cells = [2, 2, {cells}]}}'}
    mesh["flat"] = f'{{kind = "abaqus", file = "{WORK / "T17_mesh" / "flat.inp"}"}}'
    steps, high = {}, {}
    for name, kind, more in (("regular", "regular", ""), ("masses lent", "flat", ""), ("mass scaling", "flat", '[solid.mass_scaling]\nminimum_step = "12 ns"\nlimit = 0.2\n'), ("local steps", "flat", "[solid.time_step]\nlevels = 6\n")):
        result = run(f"T17_{name.replace(' ', '_')}", impact + body("bar", mesh[kind], COPPER, (0.0, 0.0, -200.0)) + more, only="solid")
        x, table = fields.Solid(fields.series(result.directory, "solid")[-1][1]).points, history(result)
        steps[name], high[name] = table["step"][-1], x[:, 2].max() - x[:, 2].min()
        yield at_most(f"{name}: energy residual over the kinetic energy at the start", np.abs(table["energy_residual"]).max() / table["kinetic_energy"][0], 0.01, result.seconds)
        if name != "regular":
            yield close(f"{name}: length at the end [mm]", 1e3 * high[name], 1e3 * high["regular"], 0.01)
        if name == "mass scaling":
            yield at_most(f"{name}: mass added, over the whole", table["added_mass"].max() / table["mass"][0], 0.2)
        if name in ("masses lent", "mass scaling"):  # with levels the flat elements alone take the short steps
            yield at_most(f"{name}: steps over those of the regular bar", steps[name] / steps["regular"], 10)


MELTS_AT_400_K = ('material = {kind = "j2", density = 2770.0, young_modulus = 73e9, poisson_ratio = 0.33, heat = {specific_heat = 875.0}, flow = {kind = "johnson_cook", yield_stress = "265 MPa", '
                  'hardening = "426 MPa", hardening_exponent = 0.34, rate_coefficient = 0.015, softening_exponent = 1.0, melting_temperature = 400.0}}\n')


@case("T18")
def t18():
    """A Johnson-Cook metal drawn out at 1e7 /s to a strain of 3, up to its melting point: stress and temperature against the formula, never negative"""
    size, rate, name, melting = 1e-4, 1e7, "a metal that melts at 400 K", 400.0
    metal = (2770.0, 875.0, reference.johnson_cook(265, 426, .34, .015, 1.0, melting))
    times = np.linspace(0, 2.6 / rate, 400)

    def drawn(side, axis, sign):
        value = [0.0] * 3
        value[axis] = sign * rate * size
        factor = f"factor = {{times = {times.tolist()}, factors = {np.exp(sign * rate * times).tolist()}}}\n"
        return prescribed(side, value, "xyz"[axis], factor)
    text = (f"[time]\nend = {float(times[-1])!r}\n" + output("0 s", "0 s")
            + body("b", f'{{kind = "box", lower = [0, 0, 0], upper = [{size}, {size}, {size}], cells = [1, 1, 1]}}', MELTS_AT_400_K)
            + drawn("x_upper", 0, 1) + drawn("y_upper", 1, -1)
            + "".join(roller(side, axis) for side, axis in (("x_lower", 0), ("y_lower", 1), ("z_lower", 2), ("z_upper", 2))) + probe("b", "element", position=[size / 2] * 3))
    for how, more, strains in (("steps as long as they are stable", "", 0.5), ("steps of 0.003 in strain", '[solid.time_step]\nmaximum = "0.26 ns"\n', 0.01)):
        result = run(f"T18_{'whole' if strains > 0.1 else 'fine'}", text + more, only="solid")
        table = history(result)
        eqps, kirchhoff = table["b eqps"], table["b von_mises"] * table["b J"]
        stress, temperature = reference.flow_history(metal, table["t"], eqps)
        flowing = (eqps > 0.01) & (temperature < 0.97 * melting)
        yield at_most(f"{how}: largest step in strain (reported)", np.diff(eqps).max(), strains, result.seconds)
        yield at_most(f"{how}: rows with NaN", float(not is_finite(table)), 0)
        yield at_least(f"{how}: strain that was reached", eqps[-1], 2.9)
        if strains < 0.1:  # the formula's own integration over rows is explicit
            yield at_most(f"{how}: flow stress below 0.97 of the melting point, of its largest", np.abs(kirchhoff - stress)[flowing].max() / stress.max(), 0.01)
        yield at_most(f"{how}: temperature over that of melting at the end", table["b temperature"][-1] / melting, 1.001)
        yield at_least(f"{how}: least von Mises stress [Pa]", table["b von_mises"].min(), 0.0)
        yield at_most(f"{how}: stress at the end, of its largest", kirchhoff[-1] / kirchhoff.max(), 0.02)
