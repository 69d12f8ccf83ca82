# SPDX-License-Identifier: Apache-2.0
"""Blast in air: Kingery and Bulmash, Sedov."""
import math

import numpy as np


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
