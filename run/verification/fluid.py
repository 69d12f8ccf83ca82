# SPDX-License-Identifier: Apache-2.0
"""Cases of the fluid program: shock tubes, contacts, detonation, blast, pistons, embedded walls."""
import math
import sys

import numpy as np

from . import reference
from .case import ROOT, at_least, at_most, case, close, near, output, run, row, unit_rows

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402

AIR_EOS = 'eos = {kind = "ideal_gas", gamma = 1.4}'
AXES = "xyz"


def eos_text(eos):
    if isinstance(eos, reference.Jwl):
        return (f'{{kind = "jwl", A = {eos.a!r}, B = {eos.b!r}, R1 = {eos.r1!r}, R2 = {eos.r2!r}, omega = {eos.omega!r}, rho0 = {eos.rho0!r}, '
                f'E0 = {eos.e0!r}}}')
    if isinstance(eos, reference.NobleAbel):
        return f'{{kind = "noble_abel", gamma = {eos.gamma!r}, covolume = {eos.b!r}}}'
    if eos.p_inf:
        return f'{{kind = "stiffened_gas", gamma = {eos.gamma!r}, p_inf = {eos.p_inf!r}}}'
    return f'{{kind = "ideal_gas", gamma = {eos.gamma!r}}}'


def material(name, eos):
    return f'[[fluid.material]]\nname = "{name}"\neos = {eos_text(eos)}\n'


def region(shape, name, density, pressure, velocity=None):
    text = f'[[fluid.region]]\nshape = {shape}\nmaterial = "{name}"\ndensity = {density!r}\npressure = {pressure!r}\n'
    return text + (f"velocity = {[float(v) for v in velocity]}\n" if velocity is not None else "")


def along(axis, value, rest=0.0):
    """A vector with `value` in the direction `axis`."""
    vector = [rest] * 3
    vector[axis] = value
    return vector


def tube(lower, upper, n, axis, boundary, end, extra="", fields_every=None, history_every=0.0):
    """Head of a one-dimensional case along `axis`; cells are cubes."""
    h = (upper - lower) / n
    cells = [1, 1, 1]
    cells[axis] = n
    low, high = along(axis, lower), [h] * 3
    high[axis] = upper
    ends = ", ".join(f'{AXES[axis]}_{side} = "{kind}"' for side, kind in zip(("lower", "upper"), boundary))
    return (f"[time]\nend = {end!r}\n" + output(f"{end if fields_every is None else fields_every!r} s", f"{history_every!r} s")
            + f"[fluid]\nlower = {low}\nupper = {high}\ncells = {cells}\nboundary = {{{ends}}}\n" + extra)


def half_space(position, axis):
    return f'{{kind = "half_space", point = {along(axis, float(position))}, normal = {along(axis, 1.0)}}}'


SHARP = 'scheme = {interface = "sharp"}\n'


def shock_tube(name, left, right, eos_left, eos_right, x0, t, n, axis=0, lower=0.0, upper=1.0, extra="", threads=0):
    """Runs a Riemann problem; centres, density, velocity, pressure, seconds."""
    two = eos_left is not eos_right
    names = ("left", "right") if two else ("gas", "gas")
    text = tube(lower, upper, n, axis, ("outflow", "outflow"), t, extra)
    text += material(names[0], eos_left) + (material(names[1], eos_right) if two else "")
    text += region('{kind = "everywhere"}', names[0], float(left[0]), float(left[2]), along(axis, float(left[1])))
    text += region(half_space(x0, axis), names[1], float(right[0]), float(right[2]), along(axis, float(right[1])))
    result = run(name, text, only="fluid", threads=threads)
    x, rho, u, p = profile(result.directory, axis)
    return x, rho, u, p, result


def profile(directory, axis, which=-1):
    """x, density, velocity along the axis, pressure of a 1-D field file."""
    t, path = fields.series(directory, "fluid")[which]
    flow = fields.Fluid(path)
    velocity = flow.levels[0][2]["velocity"]
    component = velocity[:, axis] if velocity.ndim == 2 else velocity
    flow.levels[0][2]["u"] = component
    return (flow.centres(axis), *(flow.array(name).reshape(-1) for name in ("density", "u", "pressure")))


def plateau(x, values, low, high):
    inside = (x > low) & (x < high)
    return float(np.mean(values[inside]))


TABLE_L1 = {"Sod": (4.56e-3, 2.72e-3, 1.47e-3), "Toro1": (5.61e-3, 2.92e-3, 1.82e-3), "Toro3": (.119, .0758, .0419)}


@case("F1", quick=True)
def f1():
    """Riemann problems of an ideal gas: L1 error of density, order, conservation, and the same bits along x, y, z"""
    resolutions = (100, 200, 400)
    for name, (left, right, eos, _, x0, t) in reference.SHOCK_TUBES.items():
        exact = reference.Riemann(left, right, eos)
        errors = []
        for k, n in enumerate(resolutions):
            x, rho, u, p, result = shock_tube(f"F1_{name}_{n}", left, right, eos, eos, x0, t, n)
            expected = exact.cell_averages(np.linspace(0, 1, n + 1), x0, t)[0]
            errors.append(float(np.mean(np.abs(rho - expected))))
            if name in TABLE_L1:
                yield at_most(f"{name} N={n}: L1(density)", errors[-1], 1.5 * TABLE_L1[name][k], result.seconds)
        order = math.log(errors[0] / errors[-1]) / math.log(resolutions[-1] / resolutions[0])
        # 0.75 (to two digits) is asked of the problems with a table; the near vacuum of Toro2 converges more slowly everywhere
        yield at_least(f"{name}: order of L1, N={resolutions[0]}..{resolutions[-1]}", order, 0.745 if name != "Toro2" else 0.5)
        yield at_least(f"{name}: least density", rho.min(), 0.0)
        yield at_least(f"{name}: least pressure", p.min(), 0.0)
    left, right, eos, _, x0, t = reference.SHOCK_TUBES["Sod"]
    base = shock_tube("F1_axis_x", left, right, eos, eos, x0, t, 100, axis=0)
    for axis in (1, 2):
        other = shock_tube(f"F1_axis_{AXES[axis]}", left, right, eos, eos, x0, t, 100, axis=axis)
        yield at_most(f"Sod along {AXES[axis]} against x: max |density|", np.abs(other[1] - base[1]).max(), 1e-12)


PROPELLANT = reference.NobleAbel(1.25, 1e-3)  # gas of a gun's propellant, 1 litre of covolume a kg


def carried_contact(density, extra="", products=reference.JWL_SETS["TNT"]):
    """Rows of a contact between products of this density and air, carried for one period."""
    n, p0, u0 = 96, 101325.0, 100.0
    text = tube(0.0, 1.0, n, 0, ("periodic", "periodic"), 0.01, extra) + material("products", products) + material("air", reference.GAS)
    text += region('{kind = "everywhere"}', "air", 1.225, p0, (u0, 0, 0))
    text += region('{kind = "box", lower = [0.25, -1.0, -1.0], upper = [0.75, 1.0, 1.0]}', "products", density, p0, (u0, 0, 0))
    how = "sharp " if extra else ""
    result = run(f"F5_{how.strip()}contact_{density:.0f}", text, only="fluid")
    x, rho, u, p = profile(result.directory, 0)
    yield at_most(f"{how}contact {density:g}:1.225, one period: max |p/p0-1|", np.abs(p / p0 - 1).max(), 1e-11, result.seconds)
    yield at_most(f"{how}contact {density:g}:1.225, one period: max |u/u0-1|", np.abs(u / u0 - 1).max(), 1e-11)


@case("F5", quick=True)
def f5():
    """Two materials: a contact of products and air carried for one period keeps p and u; gas against gas, dense gas of a propellant"""
    yield from carried_contact(50.0)
    yield from carried_contact(300.0, products=PROPELLANT)
    yield from carried_contact(50.0, SHARP)
    for name, left, right, eos_l, eos_r, t in (("1.4|1.2", (1, 0, 1), (.125, 0, .1), 1.4, 1.2, .15),
                                              ("1.4|1.667", (1, 0, 500), (1, 0, .2), 1.4, 1.667, .015)):
        eos_l, eos_r = reference.IdealGas(eos_l), reference.IdealGas(eos_r)
        exact = reference.Riemann(left, right, eos_l, eos_r)
        x, rho, u, p, result = shock_tube(f"F5_{name}", left, right, eos_l, eos_r, 0.5, t, 400)
        contact, shock = 0.5 + exact.u * t, 0.5 + exact.shock_speed(1) * t
        inside = (contact + 0.25 * (shock - contact), shock - 0.25 * (shock - contact))
        yield close(f"gases {name} N=400: p*", plateau(x, p, *inside), exact.p, 0.01, result.seconds)
        yield close(f"gases {name} N=400: u*", plateau(x, u, *inside), exact.u, 0.01)
    yield from dense_gas()


def dense_gas():
    """A propellant's gas at 300 MPa against itself (a tube of its own) and against air: the whole profile and the state between the waves."""
    left = (250.0, 0.0, 3e8)
    for name, right, eos_right, t in (("propellant", (20.0, 0.0, 1e6), PROPELLANT, 2.5e-4), ("air", (1.225, 0.0, 101325.0), reference.GAS, 1.2e-4)):
        exact = reference.Riemann(left, right, PROPELLANT, eos_right)
        errors = []
        for n in (100, 200, 400):
            x, rho, u, p, result = shock_tube(f"F5_dense_{name}_{n}", left, right, PROPELLANT, eos_right, 0.5, t, n)
            errors.append(float(np.mean(np.abs(rho - exact.cell_averages(np.linspace(0, 1, n + 1), 0.5, t)[0]))) / left[0])
        contact, shock = 0.5 + exact.u * t, 0.5 + exact.shock_speed(1) * t
        inside = (contact + 0.25 * (shock - contact), shock - 0.25 * (shock - contact))
        yield at_most(f"dense gas against {name}, N=400: L1(density) over that of the left", errors[-1], 0.01, result.seconds)
        yield at_least(f"dense gas against {name}: order of L1, N=100..400", math.log(errors[0] / errors[-1]) / math.log(4), 0.745)
        yield close(f"dense gas against {name}, N=400: p*", plateau(x, p, *inside), exact.p, 0.01)
        yield close(f"dense gas against {name}, N=400: u*", plateau(x, u, *inside), exact.u, 0.01)


@case("F5i")
def f5i():
    """TNT burnt at constant volume against air, N = 400, and how it converges; a contact of 1000:1 with cold products"""
    tnt = reference.JWL_SETS["TNT"]
    left, right, t = (1630.0, 0.0, tnt.pressure(1630.0, 7e9 / 1630)), (1.225, 0.0, 101325.0), 2e-5
    exact = reference.Riemann(left, right, tnt, reference.GAS)
    contact, shock = 0.5 + exact.u * t, 0.5 + exact.shock_speed(1) * t
    inside = (contact + 0.15 * (shock - contact), shock - 0.3 * (shock - contact))
    for n, extra in [(n, extra) for extra in ("", SHARP) for n in (400, 1600, 6400)]:
        how = "sharp, " if extra else ""
        x, rho, u, p, result = shock_tube(f"F5i_{how[:5]}{n}", left, right, tnt, reference.GAS, 0.5, t, n, extra=extra)
        last = np.flatnonzero(p > 0.5 * exact.p)[-1]
        jump = x[last] + (p[last] - 0.5 * exact.p) / (p[last] - p[last + 1]) / n
        yield close(f"JWL|air, {how}N={n}: p*", plateau(x, p, *inside), exact.p, 0.02, result.seconds)
        yield close(f"JWL|air, {how}N={n}: u*", plateau(x, u, *inside), exact.u, 0.02)
        yield close(f"JWL|air, {how}N={n}: way of the shock over t", (jump - 0.5) / t, exact.shock_speed(1), 0.005)
    yield from carried_contact(1225.0)
    yield from carried_contact(1225.0, SHARP)


@case("F6", quick=True)
def f6():
    """Every explosive of the library: D and P_CJ computed from its JWL set against the tabulated ones"""
    yield from unit_rows("cfd", "F6.*:EosProperties.*", {"worst_D_error": 1e-3, "worst_P_CJ_error": 1e-3, "round_trip_error": 1e-12, "sound_speed_error": 1e-6})


def block(n, body, u, end, extra="", walls=""):
    text = f"[time]\nend = {end!r}\n" + output(f"{end!r} s", "0 s")
    text += f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = [{n}, {n}, {n}]\n"
    sides = ", ".join(f'{a}_{s} = "periodic"' for a in AXES for s in ("lower", "upper"))
    return text + f"boundary = {{{sides}}}\n" + walls + material("air", reference.GAS) + extra + body


@case("F13", quick=True)
def f13():
    """Embedded walls that must change nothing: uniform flow with co-moving bodies, a thin plate between 1 and 100 bar"""
    yield from comoving()
    yield from plate()
    yield from unit_rows("cfd", "EmbedInvariants.*-*TenThousand*")


def comoving(walls="", note=""):
    """F13 (a): uniform flow; walls: text of [fluid.walls]."""
    u = (100.0, 50.0, 20.0)
    flow_text = region('{kind = "everywhere"}', "air", 1.225, 101325.0, u)
    for shape in ('{kind = "sphere", centre = [0.41, 0.43, 0.47], radius = 0.2}',
                  '{kind = "box", lower = [0.3, 0.3, 0.3], upper = [0.6, 0.55, 0.65]}'):
        kind = shape.split('"')[1]
        body = f'[[fluid.body]]\nname = "body"\nshape = {shape}\nmotion = {{kind = "velocity", value = {list(u)}}}\n'
        result = run(f"F13a_{kind}{note}", block(32, body, u, 2e-3, flow_text, walls), only="fluid")
        flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
        p, rho = flow.array("pressure"), flow.array("density")
        yield at_most(f"(a) uniform flow past a moving {kind}{note}: max |p/p0-1|", np.nanmax(np.abs(p / 101325 - 1)), 1e-12, result.seconds)
        yield at_most(f"(a) uniform flow past a moving {kind}{note}: max |rho/rho0-1|", np.nanmax(np.abs(rho / 1.225 - 1)), 1e-12)


@case("F13b", quick=True)
def f13b():
    """Gas at rest in and around a tilted closed box of no thickness stays at rest; sound of 1e-6 around it dies away"""
    yield from resting()


def resting(walls="", remark=""):
    for angle, axis, steps in ((33.0, (1.0, 2.0, 3.0), 726), (45.0, (0.0, 0.0, 1.0), 1000)):
        body = ('[[fluid.body]]\nname = "box"\nthin = true\nshape = {kind = "box", lower = [0.2, 0.25, 0.3], upper = [0.8, 0.75, 0.7]}\n'
                f'turn_angle = {angle}\nturn_axis = {list(axis)}\nturn_point = [0.5, 0.5, 0.5]\n')
        rest = region('{kind = "everywhere"}', "air", 1.225, 101325.0)
        sound = "".join(region(f'{{kind = "sphere", centre = {list(centre)}, radius = {radius}}}', "air", 1.225 * (1 + size), 101325.0 * (1 + 1.4 * size))
                        for centre, radius, size in (((0.1, 0.2, 0.3), 0.25, 1e-6), ((0.5, 0.5, 0.5), 0.12, 1e-6), ((0.45, 0.62, 0.4), 0.06, -1e-6)))
        for note, gas, n, band in (("rest", rest, 32, 1e-12), ("sound", rest + sound, 24, 1.4e-6)):
            text = block(n, body, (0, 0, 0), 1.0, gas, walls).replace("[output]", f"max_steps = {steps}\n[output]", 1)
            result = run(f"F13b_{angle:.0f}_{note}{remark}", text, only="fluid")
            flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
            yield at_most(f"(b) {note}{remark}, tilt {angle:.0f} deg, {steps} steps: max |p/p0-1|", np.nanmax(np.abs(flow.array("pressure") / 101325 - 1)), band,
                          result.seconds)


def plate(walls="", remark=""):
    """F13 (c): a plate of no thickness between 1 bar and 100 bar, 10,000 steps."""
    for position, note in ((0.5, "on cell faces"), (0.5 + 0.37 / 32, "between")):
        text = "[time]\nend = 1.0\nmax_steps = 10000\n" + output("1 s", "0.001 s")
        text += "[fluid]\nlower = [0, 0, 0]\nupper = [1, 0.5, 0.5]\ncells = [32, 16, 16]\n" + walls + material("air", reference.GAS)
        text += region('{kind = "everywhere"}', "air", 1.225, 1e5) + region(half_space(0.5, 0), "air", 122.5, 1e7)  # cells are whole: each belongs to the side of its centre
        text += (f'[[fluid.body]]\nname = "plate"\nshape = {{kind = "plane", point = [{position!r}, 0.0, 0.0], normal = [1.0, 0.0, 0.0]}}\n'
                 'motion = {kind = "fixed"}\n')
        result = run(f"F13c_{note.replace(' ', '_')}{remark}", text, only="fluid")
        flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
        rho = flow.array("density")
        left = flow.centres(0) < position
        mass = (rho[left].mean() / 1.225 - 1, rho[~left].mean() / 122.5 - 1)
        yield at_most(f"(c) plate {note}{remark}: relative change of mass, either side", max(abs(m) for m in mass), 1e-12, result.seconds)
        yield at_most(f"(c) plate {note}{remark}: max |p/p_side-1|", max(np.abs(flow.array('pressure')[left] / 1e5 - 1).max(),
                                                                 np.abs(flow.array('pressure')[~left] / 1e7 - 1).max()), 1e-12)
