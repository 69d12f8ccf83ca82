# SPDX-License-Identifier: Apache-2.0
"""Rings, spheres, bars, flow laws, Cook's membrane, pieces of Mott's size."""
import math

import numpy as np


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


def mott_mu(density, strength, gamma, radius, speed):
    """mu of Mott's distribution [kg] for a ring of this strength, gamma, radius and speed at break-up: sqrt(2/rho) (sigma_F/gamma)^1.5 (r/V)^3 [Mott 1943]."""
    return math.sqrt(2 / density) * (strength / gamma) ** 1.5 * (radius / speed) ** 3
