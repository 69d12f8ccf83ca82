# SPDX-License-Identifier: Apache-2.0
"""Cases of the solid program's materials: spot values, plane waves, impact with heat, necking."""
import numpy as np

from . import reference
from .case import between, case, close, output, run, at_most
from .solid import fields, j2, roller


def body(name, mesh, material, velocity=(0.0, 0.0, 0.0)):
    return f'[[solid.body]]\nname = "{name}"\nmesh = {mesh}\n{material}velocity = {list(velocity)}\n'


def probe(name, kind, **keys):
    return f'[[solid.probe]]\nname = "{name}"\nkind = "{kind}"\n' + "".join(f"{key} = {value}\n" for key, value in keys.items())


def prescribed(nodes, value, components, extra=""):
    return f'[[solid.condition]]\nkind = "velocity"\nnodes = "{nodes}"\nvalue = {list(value)}\ncomponents = "{components}"\n{extra}'


@case("S11", quick=True)
def s11():
    """Flow stress and temperature of the library's rate-dependent metals in a fast shear, against their formulas"""
    size, speed = 1e-3, 10.0
    names = list(reference.FLOW_LAWS)
    text = '[time]\nend = "30 us"\n' + output("0 s", "0 s")
    for i, name in enumerate(names):
        low, high = [3 * size * i, 0.0, 0.0], [3 * size * i + size, size, size]
        text += body(f"b{i}", f'{{kind = "box", lower = {low}, upper = {high}, cells = [1, 1, 1]}}', f'material = {{library = "{name}"}}\n')
        text += prescribed(f"b{i}.x_upper", (speed, 0.0, 0.0), "x") + prescribed(f"b{i}.y_upper", (0.0, -speed, 0.0), "y")
        text += "".join(roller(f"b{i}.{side}", axis) for side, axis in (("x_lower", 0), ("y_lower", 1), ("z_lower", 2), ("z_upper", 2)))
        text += probe(f"b{i}", "element", position=[low[0] + size / 2, size / 2, size / 2])
    result = run("S11", text, only="solid")
    table = fields.history(result.directory / "solid_history.csv")
    t = table["t"]
    for i, name in enumerate(names):
        eqps, kirchhoff = table[f"b{i} eqps"], table[f"b{i} von_mises"] * table[f"b{i} J"]
        stress, temperature = reference.flow_history(name, t, eqps)
        flowing = np.flatnonzero(eqps > 0.01)
        yield at_most(f"{name}: flow stress, eqps 0.01 to {eqps[-1]:.2f}", np.abs(kirchhoff[flowing] / stress[flowing] - 1).max(), 1e-3, result.seconds)
        yield close(f"{name}: temperature at the end [K]", table[f"b{i} temperature"][-1], temperature[-1], 1e-3)


def plane_wave(name, material, speed, end, viscosity='[solid.viscosity]\nlinear = 0.06\nquadratic = 1.5\n'):
    """A bar of 100 mm in uniaxial strain runs into a wall; stress [Pa, compression positive] against time at 30 and 60 mm."""
    text = (f"[time]\nend = {end!r}\n" + output("0 s", "0 s") + viscosity
            + body("bar", '{kind = "box", lower = [0, 0, 0], upper = ["100 mm", "0.25 mm", "0.25 mm"], cells = [400, 1, 1]}', material, (-speed, 0.0, 0.0))
            + roller("x_lower", 0) + "".join(roller(f"{axis}_{side}", k) for k, axis in ((1, "y"), (2, "z")) for side in ("lower", "upper"))
            + "".join(probe(f"at{x}", "element", position=[x * 1e-3 + 0.125e-3, 0.125e-3, 0.125e-3]) for x in (30, 60)))
    result = run(name, text, only="solid")
    table = fields.history(result.directory / "solid_history.csv")
    return table["t"], {x: -table[f"at{x} sigma_xx"] for x in (30, 60)}, result.seconds


def arrival(t, stress, level):
    """Time at which the stress first reaches a level, linear between rows."""
    k = int(np.argmax(stress >= level))
    return t[k - 1] + (level - stress[k - 1]) / (stress[k] - stress[k - 1]) * (t[k] - t[k - 1])


@case("S2c")
def s2c():
    """Plane waves in uniaxial strain: elastic precursor and plastic front at 50 m/s; a shock under Mie-Gruneisen"""
    for name, steel in (("copper", dict(density=8930.0, young=117e9, poisson=0.35, yield_stress=400e6, hardening=100e6)),
                        ("4340-like", dict(density=7830.0, young=206e9, poisson=0.3, yield_stress=792e6, hardening=1e9)),
                        ("paper steel", dict(density=7760.0, young=641.5e9, poisson=0.3, yield_stress=1.283e9, hardening=8.657e9))):
        wave = reference.plastic_wave(speed=50.0, **steel)
        t, stress, seconds = plane_wave(f"S2c_{name.replace(' ', '_')}", j2(**steel), 50.0, 0.075 / wave["plastic_speed"])
        gap = 0.03  # between the probes, 0.25 mm elements apart as well
        elastic, plastic = 0.5 * wave["hel"], 0.5 * (wave["hel"] + wave["stress"])
        yield close(f"{name}: elastic speed [m/s]", gap / (arrival(t, stress[60], elastic) - arrival(t, stress[30], elastic)), wave["elastic_speed"], 0.02, seconds)
        yield close(f"{name}: plastic speed [m/s]", gap / (arrival(t, stress[60], plastic) - arrival(t, stress[30], plastic)), wave["plastic_speed"], 0.02)
        first, second = arrival(t, stress[60], elastic), arrival(t, stress[60], plastic)
        plateau = (t > first + 0.35 * (second - first)) & (t < first + 0.65 * (second - first))
        behind = t > second + 0.3 * (t[-1] - second)
        yield close(f"{name}: stress of the precursor [Pa]", stress[60][plateau].mean(), wave["hel"], 0.02)
        yield close(f"{name}: stress behind [Pa]", stress[60][behind].mean(), wave["stress"], 0.02)
        yield at_most(f"{name}: overshoot", max(stress[60].max() / wave["stress"] - 1, 0.0), 0.05)
    c0, s, density, speed = 3940.0, 1.489, 8960.0, 800.0
    material = 'material = {library = "copper OFHC", volumetric = {kind = "mie_gruneisen"}, flow = {kind = "linear", yield_stress = "1 MPa"}}\n'
    t, stress, seconds = plane_wave("S2c_shock", material, speed, 0.075 / (c0 + s * speed - speed))
    pressure, front = density * (c0 + s * speed) * speed, c0 + s * speed
    yield close("copper, Mie-Gruneisen, 800 m/s: shock stress [Pa]", stress[60][t > arrival(t, stress[60], 0.5 * pressure) + 1e-6].mean(), pressure, 0.01, seconds)
    # the probes move with the bar, towards the wall, until the front reaches them: 30 mm of material in between
    yield close("copper, Mie-Gruneisen, 800 m/s: U_s [m/s]", 0.03 / (arrival(t, stress[60], 0.5 * pressure) - arrival(t, stress[30], 0.5 * pressure)), front, 0.01)


@case("S7b")
def s7b():
    """Taylor bar of OFHC copper, Johnson-Cook with heating, 190 m/s, 120 us: shape, strain, temperature, energy"""
    length = 25.4e-3
    text = ('[time]\nend = "120 us"\n' + output("120 us", "1 us")
            + body("bar", '{kind = "cylinder", radius = "3.81 mm", length = "25.4 mm", across = 8, along = 56, sector = "quarter"}',
                   'material = {library = "copper OFHC"}\n', (0.0, 0.0, -190.0))
            + roller("lower", 2) + roller("cut_x", 0) + roller("cut_y", 1))
    result = run("S7b", text, only="solid")
    solid = fields.Solid(fields.series(result.directory, "solid")[-1][1])
    x = solid.points
    radius = np.hypot(x[:, 0], x[:, 1])
    foot = 2e3 * radius[x[:, 2] < 1e-6].max()
    heights = np.unique(np.round(x[radius > 0.99 * 3.81e-3, 2], 9))
    outline = np.array([radius[np.abs(x[:, 2] - z) < 1e-7].max() for z in heights])
    yield close("length [mm]", 1e3 * (x[:, 2].max() - x[:, 2].min()), 17.33, 0.01, result.seconds)
    yield close("foot diameter [mm]", foot, 14.51, 0.015)
    yield close("diameter at a fifth of the length [mm]", 2e3 * np.interp(0.2 * length, heights, outline), 9.46, 0.015)
    table = fields.history(result.directory / "solid_history.csv")
    yield close("largest plastic strain", table["eqps_max"][-1], 2.04, 0.06)
    yield close("highest temperature [K]", table["temperature_max"][-1], 521.0, 0.03)
    yield at_most("energy residual over the kinetic energy at the start", np.abs(table["energy_residual"]).max() / table["kinetic_energy"][0], 0.01)
    yield close("heat over plastic work", table["heat"][-1] / table["plastic_work"][-1], 0.9, 1e-9)


def necking(across, along):
    """An octant of Simo's bar, pulled by 7 mm in 1 ms with its ends held; its lower end is the neck."""
    e_young, nu = reference.young_and_poisson(164.206e9, 80.1938e9)
    ramp, end = 0.1e-3, 1e-3
    speed = 7e-3 / (end - 0.5 * ramp)
    return (f"[time]\nend = {end!r}\n" + output("0 s", "2 us")
            + f'[[solid.body]]\nname = "bar"\nmesh = {{kind = "cylinder", radius = "6.297566 mm", upper_radius = "6.413 mm", length = "26.667 mm", across = {across}, '
            + f'along = {along}, grading = 10.0, sector = "quarter"}}\n'
            + f'material = {{kind = "j2", density = 7850.0, young_modulus = {e_young!r}, poisson_ratio = {nu!r}, flow = {{kind = "saturation", '
            + 'yield_stress = "450 MPa", hardening = "129.24 MPa", saturation_stress = "715 MPa", saturation_exponent = 16.93}}\n'
            + roller("lower", 2) + roller("cut_x", 0) + roller("cut_y", 1)
            + prescribed("upper", (0.0, 0.0, speed), "xyz", f"factor = {{times = [0.0, {ramp!r}], factors = [0.0, 1.0]}}\n")
            + probe("neck", "node", position=[6.297566e-3, 0.0, 0.0]) + probe("end", "node", position=[0.0, 0.0, 26.667e-3])
            + probe("pull", "wall_force", condition=0))


def neck_history(result):
    """Elongation, radius of the neck, and the table."""
    table = fields.history(result.directory / "solid_history.csv")
    return table["end z"] - table["end z"][0], table["neck x"], table


@case("S8")
def s8():
    """Necking of a cylindrical bar (Simo), an octant, pulled in 1 ms with its ends held: neck radius and axial force"""
    result = run("S8", necking(10, 30), only="solid")
    u, neck, table = neck_history(result)
    force = np.abs(table["pull fz"])
    corner = np.pi / 2 / 10 / 2  # half the angle between neighbouring nodes of the outline: a polygon's area is less than the circle's
    smooth = np.convolve(force, np.ones(5) / 5, mode="same") * corner / (np.sin(corner) * np.cos(corner))
    seconds = result.seconds
    for at, r, f, band in ((1, 6.165, 70.77, .01), (2, 6.024, 76.48, .01), (3, 5.782, 77.2, .01), (5, 4.430, 58.5, .04)):
        yield close(f"u = {at} mm: neck radius [mm]", 1e3 * np.interp(at * 1e-3, u, neck), r, band, seconds)
        yield close(f"u = {at} mm: axial force [kN]", 4e-3 * np.interp(at * 1e-3, u, smooth), f, band)
        seconds = None
    yield between("u = 7 mm: neck radius [mm]", 1e3 * neck[-1], 2.153 * 0.88, 2.204 * 1.12)
    yield between("largest plastic strain at 7 mm", table["eqps_max"][-1], 2.19 * 0.88, 2.40 * 1.12)
    yield at_most("kinetic over plastic energy at the end", table["kinetic_energy"][-1] / table["plastic_work"][-1], 0.01)
