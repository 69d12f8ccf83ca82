# SPDX-License-Identifier: Apache-2.0
"""Static solutions by dynamic relaxation: S4 (Cook's membrane, thick cylinder, thick sphere)."""
import json

from . import reference
from .case import at_most, case, close, output, run
from .solid import roller
from .solid_waves import history, node


def relaxed(name, text, tolerance=1e-6, end=1e6):
    """Runs to rest; the result and the number of steps."""
    text = f"[time]\nend = {end!r}\nmax_steps = 400000\n" + output("0 s", f"{end!r} s") + f"[solid.static]\ntolerance = {tolerance!r}\n" + text
    result = run(name, text, only="solid", threads=1)
    summary = json.loads((result.directory / "solid_summary.json").read_text())
    return result, summary


def neo_hooke(mu, kappa):
    young, nu = 9 * kappa * mu / (3 * kappa + mu), (3 * kappa - 2 * mu) / (6 * kappa + 2 * mu)
    return f'material = {{kind = "neo_hooke", density = 1.0, young_modulus = {young!r}, poisson_ratio = {nu!r}}}\n'


def cook(n, material, force, plane_strain):
    """Cook's membrane, n x n elements of unit thickness, left side held; `force` upward on the right one."""
    corners = [(0, 0), (48, 44), (48, 60), (0, 44)]
    points = [[float(x), float(y), z] for z in (0.0, 1.0) for x, y in corners]
    planes = roller("z_lower", 2) + (roller("z_upper", 2) if plane_strain else "")
    return (f'[[solid.body]]\nname = "cook"\nmesh = {{kind = "block", corners = {points!r}, cells = [{n}, {n}, 1]}}\n' + material + planes
            + '[[solid.condition]]\nkind = "roller"\nnodes = "x_lower"\nnormal = [1, 0, 0]\n[[solid.condition]]\nkind = "roller"\nnodes = "x_lower"\nnormal = [0, 1, 0]\n'
            + f'[[solid.load]]\nkind = "traction"\nfaces = ["x_upper"]\ntotal = [0.0, {force!r}, 0.0]\n'
            + node("A", (48, 60, 0)) + node("C", (48, 52, 0)))


@case("S4")
def s4():
    """Locking: Cook's membrane of small and finite strain, compressible and not; thick cylinder and sphere under pressure"""
    def deflections(name, text):
        result, summary = relaxed(name, text)
        table = history(result)
        print(f"    {name}: {summary['status']} after {summary['steps']} steps, out of balance {summary['values']['static_imbalance']:.1e}", flush=True)
        return table["A y"][-1] - 60, table["C y"][-1] - 52, table["A x"][-1] - 48, result.seconds
    plane = 'material = {kind = "neo_hooke", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.3333333333333333}\n'
    a, c, _, seconds = deflections("S4_cook_stress", cook(32, plane, 1e-3, False))
    yield close("Cook, plane stress, small strain, 32 x 32: v_C / F", c / 1e-3, 23.965, 0.01, seconds)
    nearly = 'material = {kind = "neo_hooke", density = 1.0, young_modulus = 240.565, poisson_ratio = 0.4999}\n'
    a, c, _, seconds = deflections("S4_cook_strain", cook(16, nearly, 0.1, True))
    yield close("Cook, plane strain, nu = 0.4999, small strain, 16 x 16: v_A of F = 100", 1000 * a, 8.075, 0.02, seconds)
    # what is missing there is the element's own: a linear system of the same elements, solved directly, says so
    direct_a, direct_c = reference.cook_direct(16, 240.565, 0.4999)
    yield close("... v_A, against a direct solution with the same element", 1000 * a, 100 * direct_a, 0.001)
    yield close("... v_C, against a direct solution with the same element", 1000 * c, 100 * direct_c, 0.001)
    yield close("direct solution, 32 x 32: v_A of F = 100", 100 * reference.cook_direct(32, 240.565, 0.4999)[0], 8.075, 0.01)
    for n, band in ((16, 0.02), (32, 0.01)):
        a, c, u, seconds = deflections(f"S4_cook_finite_{n}", cook(n, neo_hooke(80.194, 400943.3), 100.0, True))
        yield close(f"Cook, finite strain, kappa/mu = 5000, {n} x {n}: v_A", a, 6.92, band, seconds)
        yield close(f"Cook, finite strain, kappa/mu = 5000, {n} x {n}: v_C", c, 6.953, band)
        yield close(f"Cook, finite strain, kappa/mu = 5000, {n} x {n}: u_A", u, -5.81, 0.02)
    a, c, _, seconds = deflections("S4_cook_compressible", cook(16, neo_hooke(92.525, 200.471), 100.0, True))
    yield close("Cook, finite strain, nu = 0.3, 16 x 16: v_A", a, 7.831, 0.02, seconds)
    yield close("Cook, finite strain, nu = 0.3, 16 x 16: v_C", c, 7.951, 0.02)

    pressure, young, inner, outer = 100e6, 206e9, 0.1, 0.2
    for nu in (0.3, 0.4999):
        material = f'material = {{kind = "neo_hooke", density = 7800.0, young_modulus = {young!r}, poisson_ratio = {nu!r}}}\n'
        load = f'[[solid.load]]\nkind = "pressure"\nfaces = ["inner"]\ntimes = [0.0]\npressures = [{pressure!r}]\n'
        # u(r) = c1 r + c2/r^m from the radial equilibrium of Lame
        m = pressure * inner ** 2 / (outer ** 2 - inner ** 2)
        for shape, exact in (("cylinder", lambda r: (1 + nu) / young * m * ((1 - 2 * nu) * r + outer ** 2 / r)),
                             ("sphere", lambda r: pressure * inner ** 3 / (young * (outer ** 3 - inner ** 3))
                              * ((1 - 2 * nu) * r + (1 + nu) * outer ** 3 / (2 * r ** 2)))):
            if shape == "cylinder":
                mesh = (f'mesh = {{kind = "tube", inner_radius = {inner}, outer_radius = {outer}, length = 0.0125, around = 64, through = 8, along = 1, sector = "quarter"}}\n'
                        + material + roller("cut_x", 0) + roller("cut_y", 1) + roller("lower", 2) + roller("upper", 2))
                place = (inner, 0.0, 0.0), (outer, 0.0, 0.0)
            else:
                mesh = (f'mesh = {{kind = "ball", radius = {outer}, inner_radius = {inner}, across = 6, through = 8}}\n' + material
                        + "".join(roller(f"cut_{a}", k) for k, a in enumerate("xyz")))
                place = (inner, 0.0, 0.0), (outer, 0.0, 0.0)
            # the innermost element on the x axis: its middle, and the hoop stress there
            radius = inner + (outer - inner) / 16
            hoop = (m * (1 + outer ** 2 / radius ** 2) if shape == "cylinder"
                    else pressure * inner ** 3 / (outer ** 3 - inner ** 3) * (1 + outer ** 3 / (2 * radius ** 3)))
            text = ('[[solid.body]]\nname = "wall"\n' + mesh + load + node("inner", place[0]) + node("outer", place[1])
                    + f'[[solid.probe]]\nname = "element"\nkind = "element"\nposition = [{radius!r}, 0.0, 0.0]\n')
            result, summary = relaxed(f"S4_{shape}_{nu:g}", text)
            table = history(result)
            yield close(f"{shape}, nu = {nu:g}: u(a)", table["inner x"][-1] - inner, exact(inner), 0.01, result.seconds)
            yield close(f"{shape}, nu = {nu:g}: u(b)", table["outer x"][-1] - outer, exact(outer), 0.01)
            yield close(f"{shape}, nu = {nu:g}: hoop stress of the innermost element", table["element sigma_yy"][-1], hoop, 0.03)
            yield at_most(f"{shape}, nu = {nu:g}: out of balance after {summary['steps']} steps", summary["values"]["static_imbalance"], 1e-6)
