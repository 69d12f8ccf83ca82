# SPDX-License-Identifier: Apache-2.0
"""T7: gas at 100 bar leaks through a slit in a thin plate into gas at 1 bar."""
import numpy as np

import fields

from . import reference
from .case import at_least, at_most, case, close, output, run
from .fluid import material, region

COARSE = 16  # cells a metre; widths of slits are counted in these
P_HIGH, P_LOW, RHO_LOW = 1e7, 1e5, 1.2
END = 1e-3


def leak(name, n, width, offset=0.0, slits="area", half=False):
    """Mass on the low side after END less that at the start [kg per metre of depth] of a slit of `width` cells, centre at y = offset; the greatest
    pressure there. half: only y > 0, with a plane of symmetry through the slit."""
    w = width / COARSE
    low = 0.0 if half else -0.5
    cells = [n, n // 2 if half else n, 1]
    text = f"[time]\nend = {END!r}\n" + output(f"{END!r} s", "1000 s")
    text += f'[fluid]\nlower = [-0.5, {low}, 0.0]\nupper = [0.5, 0.5, {1 / n!r}]\ncells = {cells}\n'
    text += f'[fluid.walls]\nslits = "{slits}"\n'
    text += material("air", reference.GAS) + region('{kind = "everywhere"}', "air", RHO_LOW, P_LOW)
    text += region('{kind = "half_space", point = [0.0, 0.0, 0.0], normal = [-1.0, 0.0, 0.0]}', "air", RHO_LOW * P_HIGH / P_LOW, P_HIGH)
    for side in (1, -1) if not half else (1,):
        length = 2.0
        centre = offset + side * (w / 2 + length / 2)
        text += (f'[[fluid.body]]\nname = "plate{side}"\nshape = {{kind = "plane", point = [0.0, {centre!r}, 0.0], normal = [1.0, 0.0, 0.0], '
                 f'size = [{length!r}, 2.0], along = [0.0, 1.0, 0.0]}}\n')
    result = run(f"T7_{name}", text, only="fluid")
    flow = fields.Fluid(fields.series(result.directory, "fluid")[-1][1])
    rho, p = flow.array("density")[:, :, 0], flow.array("pressure")[:, :, 0]
    right = flow.centres(0) > 0
    h = flow.centres(0)[1] - flow.centres(0)[0]
    mass = float(np.sum(rho[right] - RHO_LOW) * h * h) * (2 if half else 1)
    return mass, float(p[right].max()), result


@case("T7")
def t7():
    """A slit of 0.05 to 2 cells between 100 bar and 1 bar, area of cell faces open in part: leak in 1 ms against that of a fine grid; sealed"""
    # a fine grid with eight cells (four at 0.25) across half of the slit, its plane of symmetry in the middle
    fine = {width: leak(f"fine_{width}", n, width, half=True)[0] for width, n in ((2, 128), (1, 256), (0.5, 512), (0.25, 512))}
    fine[0.05] = fine[0.25] * 0.05 / 0.25  # from a large vessel, after a short time: as the width
    before = 0.0
    for width in (0.05, 0.25, 0.5, 1, 2):
        leaks = [leak(f"{width}_{offset}", COARSE, width, offset / COARSE) for offset in (0, 0.15, 0.3, 0.5)]
        seconds = sum(result.seconds for _, _, result in leaks)
        worst = max((mass for mass, _, _ in leaks), key=lambda mass: abs(mass / fine[width] - 1))
        yield close(f"slit of {width} cells, worst of four places in the grid: gas that leaks [kg/m]", worst, fine[width], 0.30 if width < 0.25 else 0.10, seconds)
        yield at_most(f"slit of {width} cells: largest pressure on the low side over that at rest", max(p for _, p, _ in leaks) / P_HIGH, 1.05)
        yield at_least(f"slit of {width} cells: leaks more than the narrower one, least of four places", min(mass for mass, _, _ in leaks), before)
        before = max(mass for mass, _, _ in leaks)
    for offset in (0, 0.3):
        yield at_most(f"plates that touch, {offset} cells off: gas that leaks [kg/m]", leak(f"0_{offset}", COARSE, 0, offset / COARSE)[0], 1e-12)
        yield at_most(f"slit of 0.5 cells, sealed, {offset} cells off: gas that leaks [kg/m]", leak(f"sealed_{offset}", COARSE, 0.5, offset / COARSE, "sealed")[0], 1e-12)
