# SPDX-License-Identifier: Apache-2.0
"""Equations of state, and the sets of explosives."""
import math


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
