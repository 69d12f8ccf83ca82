# SPDX-License-Identifier: Apache-2.0
"""Adaptive blocks of the fluid program against uniform grids of their finest cells: error, and cell-steps saved."""
import numpy as np

from . import fluid, reference
from .case import at_least, at_most, case, output, run, unit_rows
from .fluid import fields, material, region

AIR = reference.GAS


def with_levels(text, levels, finest, extra=""):
    """The case on a grid of `levels`, whose finest cells are those of `finest`."""
    coarse = [n if n == 1 else n >> levels for n in finest]
    return text.replace(f"cells = {list(finest)}", f"cells = {coarse}") + f"[fluid.amr]\nlevels = {levels}\nblock = 8\n" + extra


def updates(result):
    return fields.summary(result.directory, "fluid")["rates"]["cell_updates"]


def last(result):
    return fields.Fluid(fields.series(result.directory, "fluid")[-1][1])


def distance(flow, expected):
    """Mean over the domain of |density - expected|, each cell against the mean of the finest cells' values [i,j,k] under it."""
    for spacing, boxes, data in flow.levels:
        factor = np.rint(spacing / flow.spacing).astype(int)
        shape = [n for pair in zip(np.array(expected.shape) // factor, factor) for n in pair]
        means = expected.reshape(shape).mean(axis=(1, 3, 5))
        parts = [means[b[0]:b[1] + 1, b[2]:b[3] + 1, b[4]:b[5] + 1].transpose(2, 1, 0).reshape(-1) for b in boxes]
        data["distance"] = np.abs(data["density"] - np.concatenate(parts))
    return float(flow.array("distance").mean())


def sod():
    left, right, eos, _, x0, t = reference.SHOCK_TUBES["Sod"]
    n = 512
    text = fluid.tube(0.0, 1.0, n, 0, ("outflow", "outflow"), t) + material("gas", eos)
    text += region('{kind = "everywhere"}', "gas", float(left[0]), float(left[2]))
    text += region(fluid.half_space(x0, 0), "gas", float(right[0]), float(right[2]))
    expected = reference.Riemann(left, right, eos).cell_averages(np.linspace(0, 1, n + 1), x0, t)[0]
    uniform = run("levels_sod_uniform", text, only="fluid")
    adaptive = run("levels_sod", with_levels(text, 3, [n, 1, 1]), only="fluid")
    errors = [distance(last(r), expected.reshape(n, 1, 1)) for r in (uniform, adaptive)]
    yield at_most("Sod, 3 levels to 512: L1(density) over that of uniform 512", errors[1] / errors[0], 1.1, adaptive.seconds)
    yield at_least("Sod, 3 levels to 512: cell-steps saved, uniform over adaptive", updates(uniform) / updates(adaptive), 2.0)


def blast_text(m, t):
    head = (f"[time]\nend = {t!r}\n" + output(f"{t!r} s", "0 s") + f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = {[m] * 3}\n"
            + 'boundary = {x_upper = "outflow", y_upper = "outflow", z_upper = "outflow"}\n' + material("air", AIR))
    head += region('{kind = "everywhere"}', "air", 1.0, 1e5)
    return head + region('{kind = "sphere", centre = [0.0, 0.0, 0.0], radius = 0.2}', "air", 5.0, 5e6)


def blast():
    n, t = 64, 4e-4
    everywhere = "[fluid.scheme]\nskip_quiet = false\n"  # how much of a uniform grid is passed over depends on the shape of its blocks
    fine, coarse, adaptive = (run(f"levels_{name}", text + everywhere, only="fluid") for name, text in (
        ("blast_fine", blast_text(n, t)), ("blast_coarse", blast_text(n // 2, t)), ("blast", with_levels(blast_text(n, t), 2, [n] * 3))))
    exact = last(fine).array("density")
    means = exact.reshape(n // 2, 2, n // 2, 2, n // 2, 2).mean(axis=(1, 3, 5))
    difference, of_coarse = distance(last(adaptive), exact), distance(last(coarse), means)
    yield at_most("blast in 3-D, 2 levels to 64^3: L1 distance to uniform 64^3, over that of uniform 32^3", difference / of_coarse, 0.05, adaptive.seconds)
    yield at_least("blast in 3-D, 2 levels to 64^3: cell-steps saved, uniform over adaptive", updates(fine) / updates(adaptive), 3.0)


def through_a_fixed_fine_box():
    """A blast crosses the faces of a box that is fine all the time: the result is nearer to the fine grid's than the coarse one's is."""
    n, t = 64, 4e-4
    fine, coarse = (last(run(f"levels_blast_{name}", blast_text(m, t), only="fluid")) for name, m in (("fine", n), ("coarse", n // 2)))
    box = ('follow_flow = false\n[[fluid.amr.region]]\nshape = {kind = "box", lower = [0.3, 0.05, 0.05], upper = [0.7, 0.45, 0.45]}\nlevel = 1\n')
    result = run("levels_box", with_levels(blast_text(n, t), 1, [n] * 3, box), only="fluid")
    exact = fine.array("density")
    means = exact.reshape(n // 2, 2, n // 2, 2, n // 2, 2).mean(axis=(1, 3, 5))
    yield at_most("blast through a fixed fine box: L1 distance to uniform 64^3, over that of uniform 32^3", distance(last(result), exact) / distance(coarse, means),
                  0.97, result.seconds)


def moving_ball():
    u, n = (100.0, 50.0, 20.0), 32
    gas = region('{kind = "everywhere"}', "air", 1.225, 101325.0, u)
    body = ('[[fluid.body]]\nname = "body"\nshape = {kind = "sphere", centre = [0.31, 0.33, 0.37], radius = 0.1}\n'
            f'motion = {{kind = "velocity", value = {list(u)}}}\n')
    text = fluid.block(2 * n, body, u, 2e-3, gas)
    result = run("levels_ball", with_levels(text, 1, [2 * n] * 3), only="fluid")
    flow = last(result)
    p, covered = flow.array("pressure"), flow.array("covered")
    worst = np.nanmax(np.abs(p[covered == 0] / 101325 - 1))
    yield at_most("uniform flow past a moving sphere, 1 level: max |p/p0-1|", worst, 1e-12, result.seconds)
    yield at_most("the same: share of the domain on the finest level", len(flow.levels[1][1]) / 8 ** 3, 0.6)


@case("levels", quick=True)
def levels():
    """Adaptive blocks: Sod and a blast against uniform grids, uniform flow past a moving ball, conservation and contacts across levels"""
    yield from sod()
    yield from blast()
    yield from through_a_fixed_fine_box()
    yield from moving_ball()
    yield from unit_rows("cfd", "Levels.*-*ClosedBox*", {"mass_energy_change": 1e-13, "p_change": 1e-10, "v_change": 1e-10, "U_change": 1e-13})
