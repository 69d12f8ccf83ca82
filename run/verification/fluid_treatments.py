# SPDX-License-Identifier: Apache-2.0
"""Embedded walls treated otherwise than by default (`[fluid.walls] treatment`), under the same tests."""
from .case import case, unit_rows
from .fluid import comoving, plate, resting
from .fluid_pistons import aligned_pistons, oblique_pistons
from .fluid_wedge import wedges

# Wall-pressure error of F10b at 100 cells by a one-dimensional prototype of each treatment, A = -0.5; and its order
PROTOTYPE = {"first_order": (4.2e-2, 1), "mirror": (1.7e-3, 2)}


@case("treatments")
def treatments():
    """Mirrored cells (first order) and mirrored points (second order) at embedded walls: F10, F10b, F11, F13 with the default's bands"""
    bands = {}
    for treatment, (error, _) in PROTOTYPE.items():
        bands |= {f"{treatment}_m0.5_error_100": 1.2 * error} | {f"{treatment}_{A}_short_of_order": 0.1 for A in ("m0.5", "m0.3", "p0.3")}
    yield from unit_rows("cfd", "EmbedPiston.OtherTreatments*", bands)
    for treatment in PROTOTYPE:
        walls, note = f'[fluid.walls]\ntreatment = "{treatment}"\n', f", {treatment}"
        for rows in (comoving, resting, plate, wedges, aligned_pistons, oblique_pistons):
            yield from rows(walls, note)
