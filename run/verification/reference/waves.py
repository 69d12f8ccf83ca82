# SPDX-License-Identifier: Apache-2.0
"""Riemann problems of Mie-Grueneisen gases."""
import math

import numpy as np

from .eos import IdealGas

NODES, WEIGHTS = np.polynomial.legendre.leggauss(64)


def riemann_integral(eos, rho_i, p_i, rho):
    """Integral of c/rho drho along the isentrope from rho to rho_i (positive in an expansion)."""
    panels = max(1, int(abs(math.log(rho_i / rho)) / 0.5) + 1)
    edges = np.linspace(math.log(rho), math.log(rho_i), panels + 1)
    total = 0.0
    for low, high in zip(edges[:-1], edges[1:]):
        for node, weight in zip(NODES, WEIGHTS):
            at = math.exp(0.5 * (low + high) + 0.5 * (high - low) * node)
            total += 0.5 * (high - low) * weight * eos.sound_speed(at, eos.isentrope(at, rho_i, p_i))
    return total


def wave(eos, rho_i, p_i, p):
    """State behind a wave into (rho_i, p_i) that brings the pressure to p: density and |change of velocity| (signed: + in a shock)."""
    shock = p > p_i
    curve = eos.hugoniot if shock else eos.isentrope
    low, high = (rho_i, rho_i * 40) if shock else (rho_i * 1e-9, rho_i)
    if not shock and curve(low, rho_i, p_i) > p:
        return low, -riemann_integral(eos, rho_i, p_i, low)
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if curve(middle, rho_i, p_i) < p else (low, middle)
    rho = math.sqrt(low * high)
    if shock:
        return rho, math.sqrt(max((p - p_i) * (1 / rho_i - 1 / rho), 0.0))
    return rho, -riemann_integral(eos, rho_i, p_i, rho)


class Riemann:
    """Exact solution of a Riemann problem; left and right are (rho, u, p) with their own equations of state."""

    def __init__(self, left, right, eos_left, eos_right=None):
        eos_right = eos_right or eos_left
        self.left, self.right, self.eos = left, right, (eos_left, eos_right)
        (rho_l, u_l, p_l), (rho_r, u_r, p_r) = left, right

        def gap(p):
            return (u_r + wave(eos_right, rho_r, p_r, p)[1]) - (u_l - wave(eos_left, rho_l, p_l, p)[1])
        low, high = min(p_l, p_r) * 1e-12, max(p_l, p_r)
        while gap(high) < 0:
            high *= 2
        for _ in range(120):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if gap(middle) < 0 else (low, middle)
            if high / low - 1 < 1e-14:
                break
        self.p = math.sqrt(low * high)
        self.rho_left, change_l = wave(eos_left, rho_l, p_l, self.p)
        self.rho_right, change_r = wave(eos_right, rho_r, p_r, self.p)
        self.u = 0.5 * ((u_l - change_l) + (u_r + change_r))
        self._fans = [self._fan(side) for side in (0, 1)]

    def shock_speed(self, side):
        """Speed of the shock on the left (0) or right (1) side; None if that wave is a fan."""
        rho, u, p = (self.left, self.right)[side]
        if self.p <= p:
            return None
        behind = (self.rho_left, self.rho_right)[side]
        mass = math.sqrt((self.p - p) / (1 / rho - 1 / behind))
        return u - mass / rho if side == 0 else u + mass / rho

    def _fan(self, side):
        """Table of (speed, rho, u, p) through the fan, in order of speed."""
        rho_i, u_i, p_i = (self.left, self.right)[side]
        if self.p > p_i:
            return None
        eos, end, sign = self.eos[side], (self.rho_left, self.rho_right)[side], (-1, 1)[side]
        rows, u, previous = [], u_i, rho_i
        for rho in np.exp(np.linspace(math.log(rho_i), math.log(end), 400)):
            p_previous = eos.isentrope(previous, rho_i, p_i)
            if rho != previous:
                u += -sign * riemann_integral(eos, previous, p_previous, rho)
            p = eos.isentrope(rho, rho_i, p_i)
            rows.append((u + sign * eos.sound_speed(rho, p), rho, u, p))
            previous = rho
        return np.array(rows if side == 0 else rows[::-1])

    def sample(self, s):
        """(rho, u, p) arrays at the speeds s = (x - x0)/t."""
        s = np.asarray(s, dtype=float)
        out = np.empty((3,) + s.shape)
        for side in (0, 1):
            mine = s <= self.u if side == 0 else s > self.u
            star = (self.rho_left if side == 0 else self.rho_right, self.u, self.p)
            start = (self.left, self.right)[side]
            fan, shock = self._fans[side], self.shock_speed(side)
            if shock is not None:
                outside = s < shock if side == 0 else s > shock
                for k in range(3):
                    out[k][mine] = np.where(outside, start[k], star[k])[mine]
            else:
                for k in range(3):
                    out[k][mine] = np.interp(s, fan[:, 0], fan[:, 1 + k])[mine]
                head = s < fan[0, 0] if side == 0 else s > fan[-1, 0]
                for k in range(3):
                    out[k][mine & head] = start[k]
        return out

    def cell_averages(self, edges, x0, t, points=64):
        """Means of (rho, u, p) over the cells between the edges at time t."""
        edges = np.asarray(edges)
        at = (np.arange(points) + 0.5) / points
        x = edges[:-1, None] + np.diff(edges)[:, None] * at
        return self.sample((x - x0) / t).mean(axis=2)


# F1 and F5: (left, right, eos_left, eos_right, x0, t)
GAS = IdealGas(1.4)
SHOCK_TUBES = {
    "Sod": ((1, 0, 1), (.125, 0, .1), GAS, GAS, .5, .2), "Lax": ((.445, .698, 3.528), (.5, 0, .571), GAS, GAS, .5, .13),
    "Toro1": ((1, .75, 1), (.125, 0, .1), GAS, GAS, .3, .2), "Toro2": ((1, -2, .4), (1, 2, .4), GAS, GAS, .5, .15),
    "Toro3": ((1, 0, 1000), (1, 0, .01), GAS, GAS, .5, .012)}
