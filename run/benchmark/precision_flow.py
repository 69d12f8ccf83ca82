# SPDX-License-Identifier: Apache-2.0
"""Error against run time of the flow and of its walls, one thread; OpenFOAM's rhoCentralFoam beside it on Sod's tube where it is installed."""
import math

import numpy as np

from verification import fluid, fluid_blast, fluid_pistons, fluid_vortex, fluid_wedge, reference
from verification.case import run

from . import rho_central_foam
from .precision import seconds_of, study


def flow_seconds(result):
    return seconds_of(result, "fluid")


def sod():
    """F1: Sod's tube, 100, 400, 1,600 cells: L1 of the density; rhoCentralFoam, if it is installed, on the same cells"""
    left, right, eos, _, x0, t = reference.SHOCK_TUBES["Sod"]
    exact = reference.Riemann(left, right, eos)

    def l1(rho):
        return float(np.mean(np.abs(rho - exact.cell_averages(np.linspace(0, 1, len(rho) + 1), x0, t)[0])))

    def measure(n):
        _, rho, _, _, result = fluid.shock_tube(f"precision_sod_{n}", left, right, eos, eos, x0, t, n, threads=1)
        return l1(rho), flow_seconds(result)

    def foam(n):
        rho, seconds = rho_central_foam.shock_tube(n, left, right, x0, t)
        return l1(rho), seconds
    return study("sod", "L1 of the density", 0.0, (100, 400, 1600), measure, "cells", [("rhoCentralFoam", foam)] if rho_central_foam.is_installed() else [])


def vortex():
    """F4: vortex carried for one period, 32, 64, 128, 256 cells a side: L1 of the density"""
    def measure(n):
        result, begin, end = fluid_vortex.vortex(n, threads=1, prefix="precision_vortex")
        return fluid_vortex.errors(begin, end)[0], flow_seconds(result)
    return study("vortex", "L1 of the density", 0.0, (32, 64, 128, 256), measure, "cells a side")


def sedov():
    """F8: point blast in an octant, 32, 64, 96 cells a side: radius of the shock, mean over angles"""
    def measure(n):
        result, mean, _, _, _ = fluid_blast.sedov_in_an_octant(n, threads=1)
        return mean, flow_seconds(result)
    return study("sedov", "radius of the shock at t = 1", 1.0, (32, 64, 96), measure, "cells a side")


def detonation():
    """F7: ball of TNT lit at its centre, 200, 400, 800, 1,600 cells along the radius: mean error of the pressure over P_CJ"""
    def measure(n):
        result, xi, p, exact, _ = fluid_blast.ball_of_tnt(n)
        inside = xi <= 1
        return float(np.mean(np.abs(p[inside] - exact[inside]))) / reference.JWL_SETS["TNT"].cj_state()["P"], flow_seconds(result)
    return study("detonation", "mean error of the pressure over P_CJ", 0.0, (200, 400, 800, 1600), measure, "cells along the radius")


def blast():
    """F9: 1 kg of TNT in air along a radius, 6, 12, 25, 50 cells in the charge: peak overpressure at Z = 2 against that of 100 cells"""
    def measure(per_radius):
        found, result = fluid_blast.air_blast(f"precision_blast_{per_radius}", 1.0, per_radius, (2,), 3e-3, 3.0)
        return found["Z2"]["peak_overpressure"], flow_seconds(result)
    return study("blast", "peak overpressure at Z = 2 [Pa]", measure(100)[0], (6, 12, 25, 50), measure, "cells in the charge's radius")


def piston():
    """F10: an embedded wall that starts into air at 340 m/s, 100, 200, 400, 800 cells: L1 of the density in front of it over that at rest"""
    speed, x0, t = 340.0, 0.5, 1e-3
    _, behind, shock = reference.driven_piston(speed)

    def measure(n):
        text = fluid.tube(0.0, 2.0, n, 0, ("wall", "wall"), t) + fluid.material("air", reference.GAS)
        text += fluid.region('{kind = "everywhere"}', "air", 1.225, 101325.0) + fluid_pistons.piston(speed, (x0, 0, 0))
        result = run(f"precision_piston_{n}", text, only="fluid", threads=1)
        x, rho, _, _ = fluid.profile(result.directory, 0)
        h = 2.0 / n
        part = np.clip((x0 + shock * t - (x - 0.5 * h)) / h, 0, 1)  # of each cell that the shock has passed
        ahead = x - 0.5 * h > x0 + speed * t
        return float(np.sum(np.abs(rho - 1.225 - part * (behind - 1.225))[ahead]) * h / (1.225 * (2.0 - x0))), flow_seconds(result)
    return study("piston", "L1 of the density over that at rest", 0.0, (100, 200, 400, 800), measure, "cells")


def wedge():
    """F11: a wedge of 20 degrees across the grid at Mach 3, 25, 50, 100 cells a length: mean error of the pressure in the cells along it"""
    def measure(n):
        x0 = 0.203
        result, _, p2 = fluid_wedge.wedge(3, 20, n, x0, threads=1)
        x, y, p = fluid_wedge.picture(result, "pressure")
        beside = [p[np.flatnonzero(y > 0.1037 + (x[i] - x0) * math.tan(math.radians(20)))[0], i] for i in np.flatnonzero((x > x0 + 0.3) & (x < 1.3))]
        return float(np.mean(np.abs(np.array(beside) / p2 - 1))), flow_seconds(result)
    return study("wedge", "mean error of the pressure along the wall", 0.0, (25, 50, 100), measure, "cells a length")


FLUID, WALL = [sod, vortex, sedov, detonation, blast], [piston, wedge]
