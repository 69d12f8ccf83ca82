# SPDX-License-Identifier: Apache-2.0
"""Steady supersonic flow of an ideal gas onto a sphere, on a grid that follows the sphere: what flows across a Cartesian grid are held against. Finite volumes of second order
around the axis, HLLC [Toro 10.4] across shells and HLL [Toro 10.3] along them, where contacts are none and shocks would grow carbuncles; each cell by its own step to rest."""
import numpy as np

GAMMA = 1.4


def conserved(W):
    rho, u, v, p = W
    return np.stack([rho, rho * u, rho * v, p / (GAMMA - 1) + 0.5 * rho * (u * u + v * v)])


def primitive(U):
    u, v = U[1] / U[0], U[2] / U[0]
    return np.stack([U[0], u, v, np.maximum((GAMMA - 1) * (U[3] - 0.5 * U[0] * (u * u + v * v)), 1e-3)])


def sound(W):
    return np.sqrt(GAMMA * W[3] / W[0])


def face_flux(L, R, n, with_contact):
    """Through faces with unit normals n, from states on both sides."""
    def part(W):
        U, un = conserved(W), W[1] * n[0] + W[2] * n[1]
        push = np.stack([0 * un, W[3] * n[0], W[3] * n[1], W[3] * un])
        return U, un, U * un + push
    (U_L, u_L, F_L), (U_R, u_R, F_R) = part(L), part(R)
    low = np.minimum(u_L - sound(L), u_R - sound(R))
    high = np.maximum(u_L + sound(L), u_R + sound(R))
    if with_contact:
        m_L, m_R = L[0] * (low - u_L), R[0] * (high - u_R)
        middle = (R[3] - L[3] + m_L * u_L - m_R * u_R) / (m_L - m_R)

        def star(W, U, un, F, s):
            k = (s - un) / (s - middle)
            p = W[3] + W[0] * (s - un) * (middle - un)
            U_star = k * U + np.stack([0 * k, k * W[0] * (middle - un) * n[0], k * W[0] * (middle - un) * n[1], (p * middle - W[3] * un) / (s - middle)])
            return F + s * (U_star - U)
        between = np.where(middle >= 0, star(L, U_L, u_L, F_L, low), star(R, U_R, u_R, F_R, high))
    else:
        between = (high * F_L - low * F_R + low * high * (U_R - U_L)) / (high - low)
    return np.where(low >= 0, F_L, np.where(high <= 0, F_R, between))


def sides(W):
    """States on both sides of the faces across the second axis of W [4, cells + 4, ...], slopes by van Leer's harmonic mean."""
    a, b = W[:, 1:-1] - W[:, :-2], W[:, 2:] - W[:, 1:-1]
    slope = np.where(a * b > 0, 2 * a * b / np.where(a * b > 0, a + b, 1), 0)
    return (W[:, 1:-1] + 0.5 * slope)[:, :-1], (W[:, 1:-1] - 0.5 * slope)[:, 1:]


def sphere_stand_off(mach, shells, outer, steps):
    """Distance of the bow shock from a sphere of radius 1 on the axis, and the pressure at the nose over that of the stream."""
    rays = shells // 2
    r, angle = np.linspace(1, outer, shells + 1), np.linspace(0, np.radians(95), rays + 1)
    x, y = -r[:, None] * np.cos(angle), r[:, None] * np.sin(angle)

    def faces(x0, y0, x1, y1):  # normals times areas, per radian around the axis; towards growing r or angle
        return np.stack([y0 - y1, x1 - x0]) * 0.5 * (y0 + y1)
    across = faces(x[:, :-1], y[:, :-1], x[:, 1:], y[:, 1:])
    along = -faces(x[:-1], y[:-1], x[1:], y[1:])
    area = volume = 0
    corners = [(x[:-1, :-1], y[:-1, :-1]), (x[1:, :-1], y[1:, :-1]), (x[1:, 1:], y[1:, 1:]), (x[:-1, 1:], y[:-1, 1:])]
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1]):
        area, volume = area - 0.5 * (x0 * y1 - x1 * y0), volume - (y0 + y1) * (x0 * y1 - x1 * y0) / 6
    size_across, size_along = (np.sqrt((f * f).sum(0)) for f in (across, along))
    n_across, n_along = across / size_across, along / np.maximum(size_along, 1e-300)
    n_along[:, :, 0] = n_along[:, :, 1]  # faces on the axis have no area
    stream = np.array([GAMMA, mach, 0.0, 1.0])
    W = np.repeat(np.repeat(stream[:, None, None], shells, 1), rays, 2)

    def change(W):
        def image(w):  # behind the wall
            un = w[1] * n_across[0, 0] + w[2] * n_across[1, 0]
            return np.stack([w[0], w[1] - 2 * un * n_across[0, 0], w[2] - 2 * un * n_across[1, 0], w[3]])
        far = np.repeat(np.repeat(stream[:, None, None], 2, 1), rays, 2)
        F = face_flux(*sides(np.concatenate([image(W[:, 1])[:, None], image(W[:, 0])[:, None], W, far], 1)), n_across, True) * size_across
        at_wall = 1.5 * W[3, 0] - 0.5 * W[3, 1]
        F[:, 0] = np.stack([0 * at_wall, at_wall * across[0, 0], at_wall * across[1, 0], 0 * at_wall])
        turned = W[:, :, 1::-1] * np.array([1, 1, -1, 1])[:, None, None]  # beyond the axis
        rows = np.concatenate([turned, W, W[:, :, -1:], W[:, :, -1:]], 2).swapaxes(1, 2)
        G = face_flux(*(w.swapaxes(1, 2) for w in sides(rows)), n_along, False) * size_along
        total = F[:, :-1] - F[:, 1:] + G[:, :, :-1] - G[:, :, 1:]
        total[2] += W[3] * area
        return total
    reach = 0.5 * (size_across[1:] + size_across[:-1] + size_along[:, 1:] + size_along[:, :-1])
    for _ in range(steps):
        over = 0.4 / ((np.hypot(W[1], W[2]) + sound(W)) * reach)  # dt/volume
        U = conserved(W)
        half = U + over * change(W)
        W = primitive(0.5 * (U + half + over * change(primitive(half))))
    middle_r, middle_angle = 0.5 * (r[1:] + r[:-1]), 0.5 * (angle[1:] + angle[:-1])
    level, front = 1 + GAMMA / (GAMMA + 1) * (mach * mach - 1), []
    for p in W[3, :, :4].T:  # on the rays beside the axis, then on the axis itself
        k = np.flatnonzero(p >= level)[-1]
        front.append(middle_r[k] + (p[k] - level) / (p[k] - p[k + 1]) * (middle_r[1] - middle_r[0]))
    return np.polyfit(middle_angle[:4] ** 2, front, 1)[1] - 1, float(1.5 * W[3, 0, 0] - 0.5 * W[3, 1, 0])
