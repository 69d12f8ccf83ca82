# SPDX-License-Identifier: Apache-2.0
"""Exact solutions, made here from first principles and independent of the programs: Riemann problems of Mie-Grueneisen gases, pistons,
detonation waves, the ring, and the impulse of a travelling front. SI units; pressure positive in compression."""
import collections
import math

import numpy as np


# --- equations of state ---------------------------------------------------------------------------------------------------------------
class IdealGas:
    """p + p_inf = (gamma - 1) rho e - (gamma - 1) p_inf ... stiffened gas; p_inf = 0 is an ideal gas."""

    def __init__(self, gamma, p_inf=0.0):
        self.gamma, self.p_inf = gamma, p_inf

    def isentrope(self, rho, rho_i, p_i):
        return (p_i + self.p_inf) * (rho / rho_i) ** self.gamma - self.p_inf

    def sound_speed(self, rho, p):
        return math.sqrt(self.gamma * (p + self.p_inf) / rho)

    def hugoniot(self, rho, rho_i, p_i):
        g = self.gamma
        ratio = rho / rho_i
        top, bottom = (g + 1) * ratio - (g - 1), (g + 1) - (g - 1) * ratio
        return (p_i + self.p_inf) * top / bottom - self.p_inf if bottom > 0 else math.inf

    def energy(self, rho, p):
        return (p + self.gamma * self.p_inf) / ((self.gamma - 1) * rho)


class NobleAbel(IdealGas):
    """p (1/rho - b) = (gamma - 1) e: an ideal gas in the volume that its molecules leave, whose density is reduced()."""

    def __init__(self, gamma, b):
        super().__init__(gamma)
        self.b = b

    def reduced(self, rho):
        return rho / (1 - self.b * rho) if self.b * rho < 1 else math.inf

    def isentrope(self, rho, rho_i, p_i):
        return super().isentrope(self.reduced(rho), self.reduced(rho_i), p_i)

    def sound_speed(self, rho, p):
        return math.sqrt(self.gamma * p / (rho * (1 - self.b * rho)))

    def hugoniot(self, rho, rho_i, p_i):
        return super().hugoniot(self.reduced(rho), self.reduced(rho_i), p_i)

    def energy(self, rho, p):
        return p / ((self.gamma - 1) * self.reduced(rho))


class Jwl:
    """Products: p = A(1 - w/(R1 V))exp(-R1 V) + B(1 - w/(R2 V))exp(-R2 V) + w rho e, V = rho0/rho."""

    def __init__(self, rho0, a, b, r1, r2, omega, e0, d=0.0, p_cj=0.0):
        self.rho0, self.a, self.b, self.r1, self.r2, self.omega, self.e0, self.d, self.p_cj = rho0, a, b, r1, r2, omega, e0, d, p_cj

    def cold(self, v):
        return self.a * math.exp(-self.r1 * v) + self.b * math.exp(-self.r2 * v)

    def energy(self, rho, p):
        v = self.rho0 / rho
        e_ref = (self.a / self.r1 * math.exp(-self.r1 * v) + self.b / self.r2 * math.exp(-self.r2 * v)) / self.rho0
        return e_ref + (p - self.cold(v)) / (self.omega * rho)

    def pressure(self, rho, e):
        v = self.rho0 / rho
        e_ref = (self.a / self.r1 * math.exp(-self.r1 * v) + self.b / self.r2 * math.exp(-self.r2 * v)) / self.rho0
        return self.cold(v) + self.omega * rho * (e - e_ref)

    def isentrope(self, rho, rho_i, p_i):
        v, v_i = self.rho0 / rho, self.rho0 / rho_i
        c = (p_i - self.cold(v_i)) * v_i ** (1 + self.omega)
        return self.cold(v) + c * v ** -(1 + self.omega)

    def sound_speed(self, rho, p):
        v = self.rho0 / rho
        slope = self.a * self.r1 * math.exp(-self.r1 * v) + self.b * self.r2 * math.exp(-self.r2 * v)
        c2 = v * v / self.rho0 * (slope + (1 + self.omega) * (p - self.cold(v)) / v)
        return math.sqrt(max(c2, 0.0))

    def hugoniot(self, rho, rho_i, p_i):
        # e - e_i = (p + p_i)/2 (1/rho_i - 1/rho) is linear in p
        half = 0.5 * (1 / rho_i - 1 / rho)
        free = self.pressure(rho, self.energy(rho_i, p_i) + p_i * half)
        bottom = 1 - self.omega * rho * half
        return free / bottom if bottom > 0 else math.inf

    def cj_state(self):
        """D, P, V, u, c of the Chapman-Jouguet point: the least detonation speed on the Hugoniot of the stored energy e0 (per volume)."""
        def speed2(v):
            half = 0.5 * (1 - v)  # E = e0 + p (1 - v)/2 per volume of explosive
            free = (self.a * (1 - self.omega / (self.r1 * v)) * math.exp(-self.r1 * v)
                    + self.b * (1 - self.omega / (self.r2 * v)) * math.exp(-self.r2 * v) + self.omega * self.e0 / v)
            p = free / (1 - self.omega / v * half)
            return p / (self.rho0 * (1 - v)), p
        low, high = 0.5, 0.95
        ratio = (math.sqrt(5) - 1) / 2
        for _ in range(200):
            left, right = high - ratio * (high - low), low + ratio * (high - low)
            if speed2(left)[0] < speed2(right)[0]:
                high = right
            else:
                low = left
        v = 0.5 * (low + high)
        d2, p = speed2(v)
        d = math.sqrt(d2)
        return {"D": d, "P": p, "V": v, "u": d * (1 - v), "c": d * v}


# name: rho0, A, B, R1, R2, omega, E0, D, P_CJ (Dobratz & Crawford, UCRL-52997)
JWL_SETS = {name: Jwl(rho * 1e3, a * 1e9, b * 1e9, r1, r2, w, e0 * 1e9, d * 1e3, p * 1e9) for name, rho, a, b, r1, r2, w, e0, d, p in [
    ("TNT", 1.630, 371.2, 3.231, 4.15, .95, .30, 7.0, 6.93, 21.0), ("Comp B", 1.717, 524.2, 7.678, 4.20, 1.10, .34, 8.5, 7.98, 29.5),
    ("C-4", 1.601, 609.77, 12.95, 4.50, 1.40, .25, 9.0, 8.193, 28.0), ("PETN", 1.770, 617.0, 16.926, 4.40, 1.20, .25, 10.1, 8.30, 33.5),
    ("PETN 1.50", 1.50, 625.3, 23.29, 5.25, 1.60, .28, 8.56, 7.45, 22.0), ("LX-14", 1.835, 826.1, 17.24, 4.55, 1.32, .38, 10.2, 8.80, 37.0),
    ("Octol 78/22", 1.821, 748.6, 13.38, 4.50, 1.20, .38, 9.6, 8.48, 34.2), ("HMX", 1.891, 778.3, 7.071, 4.20, 1.00, .30, 10.5, 9.11, 42.0),
    ("PBX-9404", 1.840, 852.4, 18.02, 4.60, 1.30, .38, 10.2, 8.80, 37.0), ("LX-10", 1.865, 880.7, 18.36, 4.62, 1.32, .38, 10.4, 8.82, 37.5),
    ("Cyclotol 77/23", 1.754, 603.4, 9.924, 4.30, 1.10, .35, 9.2, 8.25, 32.0), ("H-6", 1.760, 758.07, 8.513, 4.90, 1.10, .20, 10.3, 7.47, 24.0),
    ("Pentolite", 1.700, 540.94, 9.3726, 4.50, 1.10, .35, 8.1, 7.53, 25.5)]}
AIR = dict(rho=1.225, p=101325.0, gamma=1.4)


# --- waves ----------------------------------------------------------------------------------------------------------------------------
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


# --- pistons ---------------------------------------------------------------------------------------------------------------------------
def gas_column_modes(m, k, count=4, length=1.0, rho=1.225, p=101325.0, gamma=1.4):
    """Hz: a piston of m [kg/m^2] on a spring k [N/m^3] before a closed column of gas: (k - m w^2) sin(wL/c) + rho c w cos(wL/c) = 0, linear
    acoustics (VALIDATION C2)."""
    c = math.sqrt(gamma * p / rho)

    def value(w):
        return (k - m * w * w) * math.sin(w * length / c) + rho * c * w * math.cos(w * length / c)
    modes, step = [], 1e-3 * c / length
    w = step
    while len(modes) < count:
        if value(w) * value(w + step) <= 0:
            low, high = w, w + step
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if value(low) * value(middle) > 0 else (low, middle)
            modes.append(0.5 * (low + high) / (2 * math.pi))
        w += step
    return modes


Gas = collections.namedtuple("Gas", "rho p u c")


def air_sound(rho=1.225, p=101325.0, gamma=1.4):
    return math.sqrt(gamma * p / rho)


def shock_state(M, rho=1.225, p=101325.0, gamma=1.4):
    """Behind a shock of M into gas at rest [Toro, 3.1.3]."""
    ratio = 1 + 2 * gamma / (gamma + 1) * (M * M - 1)
    rho2 = rho * (gamma + 1) * M * M / ((gamma - 1) * M * M + 2)
    return Gas(rho2, p * ratio, 2 / (gamma + 1) * (M - 1 / M) * air_sound(rho, p, gamma), math.sqrt(gamma * p * ratio / rho2))


def reflected_state(M, rho=1.225, p=101325.0, gamma=1.4):
    """Behind the shock that a fixed wall sends back (VALIDATION C3: M = 2 gives 15 p): the reflected shock stops the gas, so its Mach number R before
    the gas behind the first one has R - 1/R = (gamma + 1) u2 / (2 c2)."""
    two = shock_state(M, rho, p, gamma)
    half = (gamma + 1) * two.u / (4 * two.c)
    back = shock_state(half + math.sqrt(half * half + 1), two.rho, two.p, gamma)
    return Gas(back.rho, back.p, 0.0, back.c)


def neo_hooke_under_shock(pressure, impedance, rho, young):
    """Speeds of the front and then of the free back of a slab (uniaxial strain, nu = 0, tau = kappa/2 (J^2 - 1) + mu dev b_bar) that gas with
    pressure - impedance u hits at once: a shock in the slab, u^2 = -P (1 - stretch)/rho; the back gains what unloading from there gives,
    the integral of sqrt(P'/rho) over the stretch."""
    kappa, mu = young / 3, young / 2

    def P(s):  # nominal stress
        return (kappa / 2 * (s * s - 1) + 2 / 3 * mu * s ** (-2 / 3) * (s * s - 1)) / s
    low, high = 0.3, 1.0
    for _ in range(80):
        s = 0.5 * (low + high)
        low, high = (s, high) if -P(s) > pressure - impedance * math.sqrt(-P(s) * (1 - s) / rho) else (low, s)
    u = math.sqrt(-P(s) * (1 - s) / rho)
    n = 2000
    steps = [s + (1 - s) * (i + 0.5) / n for i in range(n)]
    return u, u + sum(math.sqrt((P(a + 1e-6) - P(a - 1e-6)) / 2e-6 / rho) for a in steps) * (1 - s) / n


def free_piston(t, mass, rho0=1.225, p0=101325.0, gamma=1.4):
    """C1: a piston of `mass` per area, gas on one side, vacuum on the other: u, x, p at time t (exact simple wave)."""
    c0 = math.sqrt(gamma * p0 / rho0)

    def y(time):
        return (1 + (gamma + 1) / 2 * p0 * time / (mass * c0)) ** (-(gamma - 1) / (gamma + 1))

    def u(time):
        return 2 * c0 / (gamma - 1) * (1 - y(time))
    x = sum(0.5 * t * w * u(0.5 * t * (1 + n)) for n, w in zip(NODES, WEIGHTS))
    return u(t), x, p0 * y(t) ** (2 * gamma / (gamma - 1))


def free_piston_before(eos, rho_i, p_i, mass, t, panels=1000):
    """Speed at time t of a piston of `mass` per area, gas at rest on one side, vacuum on the other (simple wave: mass du = p dt, du = -c drho/rho)."""
    u, now, step = 0.0, 0.0, math.log(1e3) / panels
    for i in range(panels):
        rho = rho_i * math.exp(-(i + 0.5) * step)
        p = eos.isentrope(rho, rho_i, p_i)
        du = eos.sound_speed(rho, p) * step
        dt = mass * du / p
        if now + dt > t:
            return u + du * (t - now) / dt
        u, now = u + du, now + dt
    return u


def fragment_flight(times, v0, mass, area, density, sound_speed, mach, coefficient, steps=2000):
    """Speeds at `times` of a body in still air, m dv/dt = -1/2 rho Cd(v/c) A v^2: through t(v), Simpson's rule over 1/v, which is exact for constant Cd."""
    def rate(s):  # of s = 1/v
        return 0.5 * density * area / mass * np.interp(1 / s / sound_speed, mach, coefficient)
    slowest = 1 / v0 + 0.5 * density * area / mass * max(coefficient) * times[-1]
    s = np.linspace(1 / v0, slowest, steps + 1)
    step = s[1] - s[0]
    t = np.concatenate([[0.0], np.cumsum(step / 6 * (1 / rate(s[:-1]) + 4 / rate(s[:-1] + 0.5 * step) + 1 / rate(s[1:])))])
    return 1 / np.interp(times, t, s)


def driven_piston(u_p, rho0=1.225, p0=101325.0, gamma=1.4):
    """F10: wall pressure and density for a piston moving into (u_p > 0) or away from (u_p < 0) gas at rest, and the shock speed."""
    c0 = math.sqrt(gamma * p0 / rho0)
    if u_p > 0:
        k = (gamma + 1) / 4 * u_p
        speed = k + math.sqrt(k * k + c0 * c0)
        return p0 + rho0 * speed * u_p, rho0 * speed / (speed - u_p), speed
    ratio = max(1 + (gamma - 1) / 2 * u_p / c0, 0.0)
    return p0 * ratio ** (2 * gamma / (gamma - 1)), rho0 * ratio ** (2 / (gamma - 1)), None


# --- detonation -------------------------------------------------------------------------------------------------------------------------
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


# --- blast ------------------------------------------------------------------------------------------------------------------------------
# Kingery & Bulmash, ARBRL-TR-02555 (1984), free-air sphere of TNT: log10 Y = sum c_i U^i, U = K0 + K1 log10 Z; Z m/kg^(1/3)
KB_PRESSURE = ((-.214362789151, 1.35034249993), (2.611368669, -1.69012801396, .00804973591951, .336743114941, -.00516226351334, -.0809228619888,
                                                 -.00478507266747, .00793030472242, .0007684469735))
KB_ARRIVAL = ((-.253273111999, 1.37407043777), (.0720707787637, 1.36456871214, -.0570035692784, -.182832224796, .0118851436014, .0432648687627,
                                                -.0007997367834, -.00436073555033))
KB_IMPULSE_NEAR = ((2.34723921354, 3.24299066475), (2.38830516757, -.443749377691, .168825414684, .0348138030308, -.010435192824))
KB_IMPULSE = ((-1.75305660315, 2.30629231803), (1.55197227115, -.40463292088, -.0142721946082, .00912366316617, -.0006750681404, -.00800863718901,
                                                .00314819515931, .00152044783382, -.0007470265899))


def tnt_heat_of_combustion():
    """C7H5N3O6 + 5.25 O2 -> 7 CO2 + 2.5 H2O(g) + 1.5 N2 at 25 degC [J/kg]; heats of formation in kJ/mol: CODATA, TNT NIST WebBook."""
    return 1e6 * (7 * 393.51 + 2.5 * 241.83 - 63.2) / (7 * 12.011 + 5 * 1.008 + 3 * 14.007 + 6 * 15.999)


def kingery_bulmash(z, mass):
    """Overpressure [Pa], arrival [s] and impulse [Pa s] of the incident wave of `mass` kg at Z = z."""
    def fit(coefficients):
        (k0, k1), c = coefficients
        u = k0 + k1 * math.log10(z)
        return 10 ** sum(c_i * u ** i for i, c_i in enumerate(c))
    size = mass ** (1 / 3)
    return 1e3 * fit(KB_PRESSURE), 1e-3 * size * fit(KB_ARRIVAL), size * fit(KB_IMPULSE_NEAR if z < .792 else KB_IMPULSE)


def sedov_constants(gamma, dimensions):
    """F8: alpha in R = (E t^2/(alpha rho))^(1/(n+2)) and the core's pressure over that behind the shock, by Runge-Kutta from the shock inwards.
    With r = R s, u = R' V(s), rho = rho0 G(s), p = rho0 R'^2 P(s), and R'' = -n/2 R'^2/R:
      (V - s) G' + G V' = -(n-1) G V/s,  (V - s) V' + P'/G = n/2 V,  (V - s)(P' - gamma P G'/G) = n P."""
    n, g = dimensions, gamma

    def slopes(s, y):
        v, rho, p = y
        w = v - s
        matrix = np.array([[rho, w, 0.0], [w, 0.0, 1 / rho], [0.0, -g * p * w / rho, w]])
        return np.linalg.solve(matrix, np.array([-(n - 1) * rho * v / s, 0.5 * n * v, n * p]))
    y = np.array([2 / (g + 1), (g + 1) / (g - 1), 2 / (g + 1)])
    p2, energy, s = y[2], 0.0, 1.0
    nodes = np.exp(np.linspace(0, math.log(0.05), 2500))  # below, u ~ s and p is constant
    for s_next in nodes[1:]:
        h = s_next - s
        k1 = slopes(s, y)
        k2 = slopes(s + h / 2, y + h / 2 * k1)
        k3 = slopes(s + h / 2, y + h / 2 * k2)
        k4 = slopes(s_next, y + h * k3)
        new = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)

        def density(s_at, at):
            return (0.5 * at[1] * at[0] ** 2 + at[2] / (g - 1)) * s_at ** (n - 1)
        energy += abs(h) * (density(s, y) + 4 * density(s + h / 2, 0.5 * (y + new) + h / 8 * (k1 - k4)) + density(s_next, new)) / 6
        y, s = new, s_next
    energy += y[2] / (g - 1) * s ** n / n
    area = {1: 2.0, 2: 2 * math.pi, 3: 4 * math.pi}[n]
    return area * energy * (2 / (n + 2)) ** 2, y[2] / p2


# --- solid ---------------------------------------------------------------------------------------------------------------------------
def first_stop(r0, v0, acceleration):
    """ln(r/r0) and time at which r'' = acceleration(r), from r0 at speed v0, first stops (Runge-Kutta)."""
    def rate(state):
        return np.array([state[1], acceleration(state[0])])
    state, t, dt = np.array([r0, float(v0)]), 0.0, r0 / v0 * 1e-5 * 5
    while True:
        k1 = rate(state)
        k2 = rate(state + 0.5 * dt * k1)
        k3 = rate(state + 0.5 * dt * k2)
        k4 = rate(state + dt * k3)
        new = state + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if new[1] <= 0:
            part = state[1] / (state[1] - new[1])
            return math.log((state[0] + part * (new[0] - state[0])) / r0), t + part * dt
        state, t = new, t + dt


def ring_stop(r0, v0, e_young, rho, sigma_y, hardening):
    """S9: thin ring in free flight, uniaxial Kirchhoff hoop stress, elastic then plastic: ln(r/r0) and time at the first stop.
    The hoop stress is tau(eps) with log strain; the mass per reference length stays: r'' = -tau/(rho r)."""
    plastic_slope = e_young * hardening / (e_young + hardening)
    eps_y = sigma_y / e_young

    def acceleration(r):
        eps = math.log(r / r0)
        return -(e_young * eps if eps < eps_y else sigma_y + plastic_slope * (eps - eps_y)) / (rho * r)
    return first_stop(r0, v0, acceleration)


def sphere_stop(r0, v0, density, young, poisson, yield_stress, hardening):
    """S9: thin sphere in free flight, equal Kirchhoff stress tau in both directions: r'' = -2 tau/(rho r). Each strain is
    eps = tau (1 - nu)/E + alpha/2, and tau = sigma_y + K alpha once it flows (the equivalent plastic strain is twice each)."""
    elastic = young / (1 - poisson)
    eps_y = yield_stress / elastic
    plastic_slope = 1 / (1 / elastic + 1 / (2 * hardening))

    def acceleration(r):
        eps = math.log(r / r0)
        return -2 * (elastic * eps if eps < eps_y else yield_stress + plastic_slope * (eps - eps_y)) / (density * r)
    return first_stop(r0, v0, acceleration)


def thick_ring(r_i, wall, rho, sigma_y, hardening, pressure, eps_limit, points=24):
    """Plane-strain incompressible ring, rigid-plastic with linear hardening, under pressure(t) inside: time, velocity and radius of
    the wall's middle when its strain is eps_limit. With v = q/r: rho (q' ln(r_o/r_i) + q/2 d/dt ln(r_o/r_i)) = p - int (2/sqrt 3)
    sigma_y(alpha)/r dr and alpha(r) = (2/sqrt 3) ln(r/R), r^2 - R^2 the same for all rings of material."""
    factor, nodes, weights = 2 / math.sqrt(3), *np.polynomial.legendre.leggauss(points)
    outer2 = (r_i + wall) ** 2
    start = 0.5 * (r_i + r_i + wall)

    def radii(shift):  # shift: growth of r^2
        return math.sqrt(r_i ** 2 + shift), math.sqrt(outer2 + shift)

    def rate(t, state):
        shift, q = state
        a, b = radii(shift)
        r = 0.5 * (a + b) + 0.5 * (b - a) * nodes
        alpha = factor * np.log(r / np.sqrt(r * r - shift))
        strength = factor * 0.5 * (b - a) * np.sum(weights * (sigma_y + hardening * alpha) / r)
        turn = 0.5 * q * q * (1 / b ** 2 - 1 / a ** 2)
        return np.array([2 * q, ((pressure(t) - strength) / rho - turn) / math.log(b / a)])
    state, t, dt, before = np.zeros(2), 0.0, 2e-8, (0.0, 0.0, 0.0, start)
    while t < 1e-3:
        k1 = rate(t, state)
        k2 = rate(t + dt / 2, state + dt / 2 * k1)
        k3 = rate(t + dt / 2, state + dt / 2 * k2)
        k4 = rate(t + dt, state + dt * k3)
        state, t = state + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4), t + dt
        radius = 0.5 * sum(radii(state[0]))
        now = (factor * math.log(radius / start), t, state[1] * 0.5 * sum(1 / r for r in radii(state[0])), radius)
        if now[0] >= eps_limit:
            part = (eps_limit - before[0]) / (now[0] - before[0])
            return tuple(x + part * (y - x) for x, y in zip(before[1:], now[1:]))
        before = now
    raise ValueError("the ring stops before the limit")


def loaded_ring(r_i, wall, rho, sigma_y, hardening, peak, decay_length, speed, eps_limit, t_end=None):
    """Section B: plane-strain incompressible ring under the front p0 exp(-D t/L) on its growing inner radius; hoop flow stress
    (2/sqrt 3)(sigma_y + K alpha), alpha = (2/sqrt 3) ln(r/r0) of the mean radius. Returns time, velocity and radius at eps_limit."""
    r0 = r_i + wall / 2
    state, t, dt = np.array([r0, 0.0]), 0.0, 2e-8
    factor = 2 / math.sqrt(3)
    outer2_minus_inner2 = (r_i + wall) ** 2 - r_i ** 2

    def rate(state, t):
        r, v = state
        alpha = factor * math.log(max(r / r0, 1.0))
        # mean radius r: r_o^2 - r_i^2 = const, r_o + r_i = 2 r
        thickness = outer2_minus_inner2 / (2 * r)
        inner = r - thickness / 2
        p = peak * math.exp(-speed * t / decay_length)
        mass = rho * outer2_minus_inner2 / 2  # per radian
        hoop = factor * (sigma_y + hardening * alpha) if (alpha > 0 or v > 0 or p > 0) else 0.0
        return np.array([v, (p * inner - hoop * thickness) / mass])
    while t < (t_end or 1e-3):
        k1 = rate(state, t)
        k2 = rate(state + 0.5 * dt * k1, t + 0.5 * dt)
        k3 = rate(state + 0.5 * dt * k2, t + 0.5 * dt)
        k4 = rate(state + dt * k3, t + dt)
        state = state + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        t += dt
        if eps_limit is not None and factor * math.log(state[0] / r0) >= eps_limit:
            break
    return t, state[1], state[0]


# name: density, specific heat, initial temperature, flow stress over (eqps, rate, temperature); Johnson and Cook 1983, Zerilli and Armstrong 1987
def johnson_cook(a, b, n, c, m, melting, room=293.0):
    def stress(eqps, rate, temperature):
        star = np.clip((temperature - room) / (melting - room), 0.0, 1.0)
        return 1e6 * (a + b * eqps ** n) * (1 + c * np.log(np.maximum(rate, 1.0))) * (1 - star ** m)
    return stress


def zerilli_armstrong(c0, c1, c2, c3, c4, c5, n):
    def stress(eqps, rate, temperature):
        thermal = np.exp(temperature * (c4 * np.log(np.maximum(rate, 1.0)) - c3))
        return 1e6 * (c0 + (c1 + c2 * np.sqrt(eqps)) * thermal + c5 * eqps ** n)
    return stress


FLOW_LAWS = {
    "copper OFHC": (8960, 383, johnson_cook(90, 292, .31, .025, 1.09, 1356)),
    "brass cartridge": (8520, 385, johnson_cook(112, 505, .42, .009, 1.68, 1189)),
    "iron Armco": (7890, 452, johnson_cook(175, 380, .32, .06, .55, 1811)),
    "steel 1006": (7890, 452, johnson_cook(350, 275, .36, .022, 1.0, 1811)),
    "steel 4340": (7830, 477, johnson_cook(792, 510, .26, .014, 1.03, 1793)),
    "steel S-7": (7750, 477, johnson_cook(1539, 477, .18, .012, 1.0, 1763)),
    "aluminium 2024-T351": (2770, 875, johnson_cook(265, 426, .34, .015, 1.0, 775)),
    "aluminium 7039": (2770, 875, johnson_cook(337, 343, .41, .01, 1.0, 877)),
    "tungsten alloy": (17000, 134, johnson_cook(1506, 177, .12, .016, 1.0, 1723)),
    "copper OFHC/ZA": (8960, 383, zerilli_armstrong(65, 0, 890, .0028, .000115, 0, 1)),
    "iron Armco/ZA": (7890, 452, zerilli_armstrong(0, 1033, 0, .00698, .000415, 266, .289))}


def flow_history(name, t, eqps, share=0.9, start=293.0):
    """Flow stress [Pa] and temperature [K] along a given eqps(t), adiabatic: rho c_p dT = share sigma_y d(eqps), by the trapezium rule."""
    density, specific_heat, law = FLOW_LAWS[name] if isinstance(name, str) else name
    stress, temperature = np.zeros(len(t)), np.full(len(t), start)
    stress[0] = law(0.0, 0.0, start)
    for k in range(1, len(t)):
        change = eqps[k] - eqps[k - 1]
        stress[k] = law(eqps[k], change / (t[k] - t[k - 1]), temperature[k - 1])
        temperature[k] = temperature[k - 1] + share / (density * specific_heat) * change * 0.5 * (stress[k - 1] + stress[k])
    return stress, temperature


def wave_number(omega, h, c, dt, kind, strength):
    """S2b: k of plane waves of frequency omega on elements of length h with lumped masses, central differences in time and the pressure filter:
    sin(omega dt/2)/dt = c/h sin(k h/2) g, g^2 the share of stiffness that the filter leaves, with A = cos^2(k h/2). The filter acts on the
    mean stress alone, whose share of c^2 is kappa/(kappa + 4/3 mu) = (1 + nu)/(3 (1 - nu)); nu = 0.3 here."""
    volume = 1.3 / (3 * 0.7)
    power = {"off": 0, "plain": 1, "self_adjoint": 2}[kind]

    def excess(k):
        left = 1 - strength * math.sin(k * h / 2) ** 2
        return c / h * math.sin(k * h / 2) * math.sqrt(1 - volume + volume * left ** power) - math.sin(omega * dt / 2) / dt
    low, high = 0.5 * omega / c, 2 * omega / c
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0 else (low, middle)
    return low


def plastic_wave(density, young, poisson, yield_stress, hardening, speed):
    """S2c: waves of small strain in uniaxial strain, linear hardening, body stopped from `speed` by a wall: elastic and plastic speeds,
    Hugoniot elastic limit and the stress behind both."""
    bulk, shear = young / (3 * (1 - 2 * poisson)), young / (2 * (1 + poisson))
    elastic_speed = math.sqrt((bulk + 4 * shear / 3) / density)
    # s = 2/3 sigma_y = 4/3 mu (e - 3/2 eqps) and d sigma_y = H d(eqps) give ds/de = 4/3 mu H / (3 mu + H)
    plastic_speed = math.sqrt((bulk + 4 * shear / 3 * hardening / (3 * shear + hardening)) / density)
    hel = yield_stress * (bulk + 4 * shear / 3) / (2 * shear)
    v_hel = hel / (density * elastic_speed)
    return dict(elastic_speed=elastic_speed, plastic_speed=plastic_speed, hel=hel, v_hel=v_hel,
                stress=hel + density * plastic_speed * (speed - v_hel))


def young_and_poisson(bulk, shear):
    return 9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))


def cook_direct(n, young, poisson):
    """S4: Cook's membrane, plane strain, small strain, n x n four-node elements of mean dilatation (Q1/P0), unit force: v of (48, 60) and
    (48, 52) from the assembled linear system."""
    shear, bulk = young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))
    corners = np.array([(0, 0), (48, 44), (48, 60), (0, 44)], dtype=float)
    a, b = (k.ravel() / n for k in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    x = np.stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b], axis=1) @ corners
    stiffness = np.zeros((2 * len(x), 2 * len(x)))
    deviator = 2 * shear * np.array([[2 / 3, -1 / 3, 0], [-1 / 3, 2 / 3, 0], [0, 0, 0.5]])
    gauss = [(s, t) for s in (-1 / math.sqrt(3), 1 / math.sqrt(3)) for t in (-1 / math.sqrt(3), 1 / math.sqrt(3))]
    for i in range(n):
        for j in range(n):
            nodes = np.array([i * (n + 1) + j, (i + 1) * (n + 1) + j, (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1])
            element, dilatation, area = np.zeros((8, 8)), np.zeros(8), 0.0
            for s, t in gauss:
                slopes = 0.25 * np.array([[t - 1, s - 1], [1 - t, -1 - s], [1 + t, 1 + s], [-1 - t, 1 - s]])
                jacobian = slopes.T @ x[nodes]
                weight, gradient = np.linalg.det(jacobian), slopes @ np.linalg.inv(jacobian).T
                strain = np.zeros((3, 8))
                strain[0, 0::2] = strain[2, 1::2] = gradient[:, 0]
                strain[1, 1::2] = strain[2, 0::2] = gradient[:, 1]
                element += weight * strain.T @ deviator @ strain
                dilatation += weight * (strain[0] + strain[1])
                area += weight
            element += bulk / area * np.outer(dilatation, dilatation)
            at = np.stack([2 * nodes, 2 * nodes + 1], axis=1).ravel()
            stiffness[np.ix_(at, at)] += element
    force = np.zeros(2 * len(x))
    force[2 * np.arange(n * (n + 1), (n + 1) ** 2) + 1] = 1 / n
    force[[2 * n * (n + 1) + 1, -1]] /= 2
    free = np.arange(2 * (n + 1), 2 * len(x))
    v = np.zeros(2 * len(x))
    v[free] = np.linalg.solve(stiffness[np.ix_(free, free)], force[free])
    return v[-1], v[2 * (n * (n + 1) + n // 2) + 1]


# --- the pressure filter on n x n equal elements, in row order -------------------------------------------------------------------------
def filter_mean(p):
    """A p: the mean over an element's nodes of the nodes' means over their elements."""
    nodes = np.zeros((p.shape[0] + 1, p.shape[1] + 1))
    count = np.zeros_like(nodes)
    corners = [(np.s_[i:i + p.shape[0]], np.s_[j:j + p.shape[1]]) for i in (0, 1) for j in (0, 1)]
    for at in corners:
        nodes[at] += p
        count[at] += 1
    return sum((nodes / count)[at] for at in corners) / 4


def undo_filter(p, strength):
    """The field q with (1 - strength) q + strength A q = p."""
    size = p.size
    matrix = np.stack([(1 - strength) * e + strength * filter_mean(e.reshape(p.shape)).ravel() for e in np.eye(size)], axis=1)
    return np.linalg.solve(matrix, p.ravel()).reshape(p.shape)


def roughness(p):
    """chi: sum |p - A p| / sum |p|."""
    return np.abs(p - filter_mean(p)).sum() / np.abs(p).sum()


def mott_mu(density, strength, gamma, radius, speed):
    """mu of Mott's distribution [kg] for a ring of this strength, gamma, radius and speed at break-up: sqrt(2/rho) (sigma_F/gamma)^1.5 (r/V)^3 [Mott 1943]."""
    return math.sqrt(2 / density) * (strength / gamma) ** 1.5 * (radius / speed) ** 3
