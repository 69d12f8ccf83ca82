#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Figures for the pieces of a run:

    run/pieces.py run/out/front [run/out/front_mott ...]

prints, for each field file of the solid, how many pieces there are, how many of them are single elements (chips), which share of the mass is in
strips (longest over middle extent of the uncracked piece above 8), and the spread of the pieces' masses; and the rings that broke up, if any.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import fields  # noqa: E402

STRIP = 8.0


def hex_volumes(corners):
    """[m,8,3] -> exact volumes of trilinear hexahedra, by six tetrahedra of each of two diagonals, averaged."""
    def tets(order):
        c = corners[:, order]
        return sum(np.einsum("ij,ij->i", c[:, b] - c[:, 0], np.cross(c[:, d] - c[:, 0], c[:, e] - c[:, 0]))
                   for b, d, e in ((1, 2, 6), (2, 3, 6), (3, 7, 6), (7, 4, 6), (4, 5, 6), (5, 1, 6))) / 6
    return 0.5 * (tets([0, 1, 2, 3, 4, 5, 6, 7]) + tets([6, 5, 4, 7, 2, 1, 0, 3]))


def extents(points):
    """Ranges along the principal axes of a cloud of points, the largest first."""
    centred = points - points.mean(axis=0)
    axes = np.linalg.eigh(centred.T @ centred)[1][:, ::-1]
    return np.ptp(centred @ axes, axis=0)


def figures(solid):
    """Of a fields.Solid: dictionary with pieces, chips, strips (share of the mass), masses (share of each piece)."""
    label = solid.cell["frag_id"]
    X = solid.point["X"].astype(float)
    volume = hex_volumes(X[solid.hex])
    ids, index, count = np.unique(label, return_inverse=True, return_counts=True)
    mass = np.bincount(index, weights=volume) / volume.sum()
    order = np.argsort(index, kind="stable")
    ends = np.concatenate([[0], np.cumsum(count)])
    aspect = np.ones(len(ids))
    for k in np.flatnonzero(count > 1):
        size = extents(X[np.unique(solid.hex[order[ends[k]:ends[k + 1]]])])
        aspect[k] = size[0] / max(size[1], 1e-300)
    return dict(pieces=len(ids), chips=int((count == 1).sum()), chip_mass=mass[count == 1].sum(), strips=mass[aspect > STRIP].sum(), masses=mass,
                elements=count, aspect=aspect, ids=ids)


def rows_of(directory, solid):
    """Rings of pieces.csv with the number of pieces that each really has in the fields: a table of columns."""
    table = fields.history(pathlib.Path(directory) / "pieces.csv")
    bins, label = solid.cell["bin"], solid.cell["frag_id"]
    found = []
    for first, count in zip(table["first_bin"], table["bins"]):
        inside = (bins >= first) & (bins < first + count)
        found.append(len(np.unique(label[inside])))
    table["found"] = np.array(found)
    table["wanted"] = np.maximum(1, np.rint(2 * np.pi * table["radius"] / table["width"]))
    return table


def main(directories):
    for directory in directories:
        for t, path in fields.series(directory, "solid"):
            solid = fields.Solid(path)
            if "frag_id" not in solid.cell:
                sys.exit(f"{path}: the run has no cracks")
            f = figures(solid)
            m = np.sort(f["masses"])[::-1]
            print(f"{directory} t = {t * 1e6:.0f} us: {f['pieces']} pieces, {f['chips']} chips ({100 * f['chip_mass']:.2f} % of the mass), "
                  f"{100 * f['strips']:.1f} % of the mass in strips, median mass {np.median(m):.2e} of the whole, standard deviation over mean {m.std() / m.mean():.2f}")
        if (pathlib.Path(directory) / "pieces.csv").exists():
            rows = rows_of(directory, solid)
            print("   t [us]  lower  upper [m]  r [mm]  V [m/s]  x0 [mm]  elements across  2 pi r/x0  bins  pieces")
            for k in np.argsort(-rows["upper"]):
                print(f"  {rows['t'][k] * 1e6:7.1f} {rows['lower'][k]:7.3f} {rows['upper'][k]:7.3f}  {rows['radius'][k] * 1e3:8.1f} {rows['speed'][k]:8.0f} "
                      f"{rows['width'][k] * 1e3:8.2f} {rows['elements_across'][k]:14.1f} {2 * np.pi * rows['radius'][k] / rows['width'][k]:12.1f} "
                      f"{rows['bins'][k]:6.0f} {rows['found'][k]:6.0f}")


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__.strip())
    main(sys.argv[1:])
