# SPDX-License-Identifier: Apache-2.0
"""Columns of gas, shocks and pistons."""
import collections
import math

import numpy as np

from .waves import NODES, WEIGHTS


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
