# SPDX-License-Identifier: Apache-2.0
"""Detonation waves."""
import math

import numpy as np


def planar_detonation(explosive, xi):
    """F7: pressure and velocity at x = D t xi behind a plane detonation from a closed end; xi may be an array. Also the tail xi and p."""
    cj = explosive.cj_state()
    rho_cj = explosive.rho0 / cj["V"]
    rows = []
    for rho in np.exp(np.linspace(math.log(rho_cj), math.log(rho_cj / 3), 3000)):
        u = cj["u"] - riemann_integral_fast(explosive, rho_cj, cj["P"], rho)
        p = explosive.isentrope(rho, rho_cj, cj["P"])
        rows.append(((u + explosive.sound_speed(rho, p)) / cj["D"], p, u))
        if u <= 0:
            break
    table = np.array(rows[::-1])
    tail = (table[0, 0], table[0, 1])
    p = np.interp(xi, table[:, 0], table[:, 1])
    u = np.interp(xi, table[:, 0], np.maximum(table[:, 2], 0))
    return p, np.where(np.asarray(xi) < tail[0], 0.0, u), tail


def riemann_integral_fast(eos, rho_i, p_i, rho, points=24):
    nodes, weights = np.polynomial.legendre.leggauss(points)
    low, high = math.log(rho), math.log(rho_i)
    total = 0.0
    for node, weight in zip(nodes, weights):
        at = math.exp(0.5 * (low + high) + 0.5 * (high - low) * node)
        total += 0.5 * (high - low) * weight * eos.sound_speed(at, eos.isentrope(at, rho_i, p_i))
    return total


def spherical_detonation(explosive, xi):
    """F7: pressure and velocity at r = D t xi behind a detonation from a point; xi may be an array. Also the core's edge and pressure.
    Self-similar and isentropic: with y = u - xi (over D), rho' = -rho y u'/c^2 and u' (1 - y^2/c^2) = -2 u/xi, from the sonic point at xi = 1,
    where the slope is infinite; u ~ u_CJ - k sqrt(1 - xi) there, so it is left by steps of u."""
    cj = explosive.cj_state()
    d, rho_cj = cj["D"], explosive.rho0 / cj["V"]

    def sound(rho):
        return explosive.sound_speed(rho, explosive.isentrope(rho, rho_cj, cj["P"])) / d

    def slopes(u, xi, rho):  # d xi/du and d rho/du
        y, c = u - xi, sound(rho)
        return -xi * (1 - (y / c) ** 2) / (2 * u), -rho * y / c ** 2
    steps = 4000
    us = cj["u"] / d * (1 - np.linspace(0, 1, steps + 1)) ** 2  # finer towards the core, where xi is stationary
    xi_at, rho, table = 1.0, rho_cj, [(1.0, rho_cj, us[0])]
    for u, u_next in zip(us[:-2], us[1:-1]):
        h = u_next - u
        a1, b1 = slopes(u, xi_at, rho)
        a2, b2 = slopes(u + h / 2, xi_at + h / 2 * a1, rho + h / 2 * b1)
        a3, b3 = slopes(u + h / 2, xi_at + h / 2 * a2, rho + h / 2 * b2)
        a4, b4 = slopes(u_next, xi_at + h * a3, rho + h * b3)
        xi_at, rho = xi_at + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4), rho + h / 6 * (b1 + 2 * b2 + 2 * b3 + b4)
        table.append((xi_at, rho, u_next))
    table = np.array(table[::-1])
    p_table = np.array([explosive.isentrope(value, rho_cj, cj["P"]) for value in table[:, 1]])
    return np.interp(xi, table[:, 0], p_table), d * np.interp(xi, table[:, 0], table[:, 2], left=0.0), (table[0, 0], p_table[0])
