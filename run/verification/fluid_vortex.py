# SPDX-License-Identifier: Apache-2.0
"""F4: a smooth flow in two dimensions whose exact solution is known at any time."""
import math

import numpy as np

from . import reference
from .case import at_least, at_most, case, close, output, run
from .fluid import fields, material, region

BETA = 5.0  # of VALIDATION F4: the fastest turn is beta/(2 pi) at r = 1
CENTRE = (0.49380732, 0.37237502)  # density and pressure at the centre


def vortex(n, axis=2, threads=0, prefix="F4"):
    """The vortex carried along a diagonal of a periodic square for one period, n cells a side, around `axis`."""
    h = 10 / n
    across = [d for d in range(3) if d != axis]
    low, high, cells, velocity = [0.0] * 3, [h] * 3, [1] * 3, [0.0] * 3
    for d in across:
        low[d], high[d], cells[d], velocity[d] = -5.0, 5.0, n, 1.0
    sides = ", ".join(f'{"xyz"[d]}_{side} = "periodic"' for d in across for side in ("lower", "upper"))
    text = ("[time]\nend = 10.0\n" + output("10 s", "1 s") + f"[fluid]\nlower = {low}\nupper = {high}\ncells = {cells}\nboundary = {{{sides}}}\n"
            + material("gas", reference.GAS) + region('{kind = "everywhere"}', "gas", 1.0, 1.0, velocity)
            + f'[[fluid.vortex]]\ncentre = [0, 0, 0]\naxis = "{"xyz"[axis]}"\nradius = 1.0\nspeed = {BETA / (2 * math.pi)!r}\n')
    result = run(f"{prefix}_{'xyz'[axis]}_{n}", text, only="fluid", threads=threads)
    begin, end = (fields.Fluid(path) for _, path in (fields.series(result.directory, "fluid")[k] for k in (0, -1)))
    return result, begin, end


def errors(begin, end):
    """Mean and largest difference of the density to what it was."""
    gap = np.abs(end.array("density") - begin.array("density"))
    return float(gap.mean()), float(gap.max())


@case("F4", quick=True)
def f4():
    """Isentropic vortex carried across a periodic square for one period, 32 to 128 cells a side: order, state at its centre, around x as around z"""
    means, largest = [], []
    for n in (32, 64, 128):
        result, begin, end = vortex(n)
        mean, most = errors(begin, end)
        means.append(mean), largest.append(most)
        yield at_most(f"{n}: L1(density) (reported)", mean, 1.0, result.seconds)
    # the mean over a cell beside the centre lies above the value at the centre by O(h^2)
    yield close("128: least density at the start", begin.array("density").min(), CENTRE[0], 0.005)
    yield close("128: least pressure at the start", begin.array("pressure").min(), CENTRE[1], 0.01)
    for k, (coarse, fine) in enumerate(((32, 64), (64, 128))):
        yield at_least(f"order of L1(density), {coarse} to {fine}", math.log2(means[k] / means[k + 1]), 1.9)
        yield at_least(f"order of max |error|, {coarse} to {fine}", math.log2(largest[k] / largest[k + 1]), 1.9)
    _, first, last = vortex(32, axis=0)
    yield at_most("32, around x: L1(density) against that around z", abs(errors(first, last)[0] / means[0] - 1), 1e-9)
