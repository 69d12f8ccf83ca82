#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures and plots of a run, by matplotlib alone:

    run/pictures.py run/out/weapon [--axis z] [--frames 4]

writes case.png (the body at a few times, coloured by plastic strain, and its fragments), flow.png (slices through the fluid with the
metal), energy.png, coupling.png, gauges.png and fragments.png into <directory>/pictures, whichever the run has data for.
"""
import argparse
import pathlib
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import fields  # noqa: E402
import raster  # noqa: E402

plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.25,
                     "legend.frameon": False, "figure.dpi": 130, "savefig.bbox": "tight"})
STEEL = LinearSegmentedColormap.from_list("steel", [(0, "#98a0a8"), (0.12, "#b9ad95"), (0.35, "#e8a33d"), (0.65, "#cf3f22"), (1, "#5e0a2e")])


def spread(entries, count):
    """`count` entries, evenly through the run, the last one included and the first left out if there are enough."""
    if len(entries) <= count:
        return entries
    picks = np.unique(np.linspace(0, len(entries) - 1, count + 1).round().astype(int))[1:]
    return [entries[k] for k in picks]


def microseconds(t):
    return f"{t * 1e6:.0f} µs" if t * 1e6 >= 2 else f"{t * 1e6:.2f} µs"


def find(names, *wanted):
    for want in wanted:
        for name in names:
            if name.lower() == want:
                return name
    for want in wanted:
        for name in names:
            if want in name.lower():
                return name
    return None


def shuffled_colours(labels):
    """A colour for each label, neighbours unlike each other."""
    golden = (labels * 0.6180339887498949) % 1.0
    base = plt.get_cmap("twilight_shifted")(0.08 + 0.84 * golden)[:, :3]
    return 0.25 + 0.75 * base


def case_picture(directory, out, axis, frames):
    entries = spread(fields.series(directory, "solid"), frames)
    if not entries:
        return None
    solids = [(t, fields.Solid(path)) for t, path in entries]
    first = fields.Solid(fields.series(directory, "solid")[0][1])
    lower, upper = first.points.min(axis=0), first.points.max(axis=0)
    centre, length = (lower + upper) / 2, (upper - lower)[axis]
    radius = max((upper - lower)[k] for k in range(3) if k != axis) / 2
    reach = max(np.percentile(np.linalg.norm(np.delete(s.points - centre, axis, 1), axis=1), 99) for _, s in solids)
    up = np.eye(3)[axis]
    side = np.eye(3)[(axis + 1) % 3]
    other = np.eye(3)[(axis + 2) % 3]
    height = max(max((s.points.max(axis=0) - s.points.min(axis=0))[axis] for _, s in solids), 2 * radius) * 1.12
    width = 2.3 * max(reach, radius)
    pixels_high = 950
    pixels_wide = int(np.clip(pixels_high * width / height, 220, 1100))
    camera = raster.Camera(centre + 4.0 * height * (0.93 * side + 0.35 * other + 0.22 * up), centre, up, height, (pixels_wide, pixels_high))
    name = find(solids[0][1].cell, "eqps", "equivalent_plastic_strain")
    strain = [solid.cell[name].mean(axis=1) if solid.cell[name].ndim > 1 else solid.cell[name] for _, solid in solids] if name else []
    top = max(0.05, max(np.percentile(values, 99) for values in strain)) if strain else 1.0
    columns = len(solids) + 1
    figure, axes = plt.subplots(1, columns, figsize=(columns * pixels_wide / pixels_high * 6.2, 6.6), squeeze=False)
    for k, ax in enumerate(axes[0]):
        t, solid = solids[min(k, len(solids) - 1)]
        quads, owner = solid.boundary()
        pieces = solid.pieces()
        if k < len(solids):
            shade = STEEL(np.clip(strain[k] / top, 0, 1))[:, :3] if strain else np.full((len(solid.hex), 3), 0.55)
            title = microseconds(t)
        else:
            mass = np.bincount(pieces)
            shade = shuffled_colours(pieces)
            shade[mass[pieces] == mass.max()] = (0.62, 0.64, 0.66)
            title = f"{len(mass)} pieces, {microseconds(t)}"
        picture = raster.render(camera, solid.points, quads, shade[owner], outline=pieces[owner])
        ax.imshow(picture, interpolation="lanczos")
        ax.set_title(title, fontsize=11)
        ax.axis("off")
    if strain:
        bar = figure.colorbar(plt.cm.ScalarMappable(Normalize(0, top), STEEL), ax=list(axes[0]),
                              orientation="horizontal", fraction=0.025, pad=0.02, aspect=60)
        bar.set_label("equivalent plastic strain")
    path = out / "case.png"
    figure.savefig(path)
    plt.close(figure)
    return path


EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]])


def cut_by_plane(solid, axis, position):
    """Polygons [k,2] in the plane, and the element of each: the metal that the plane goes through."""
    offset = solid.points[:, axis] - position
    offset = np.where(np.abs(offset) < 1e-12, 1e-12, offset)
    sides = offset[solid.hex] > 0
    crossed = np.flatnonzero(sides.any(axis=1) & ~sides.all(axis=1))
    keep = [k for k in range(3) if k != axis]
    polygons, owner = [], []
    for element in crossed:
        nodes = solid.hex[element]
        a, b = nodes[EDGES[:, 0]], nodes[EDGES[:, 1]]
        cut = (offset[a] > 0) != (offset[b] > 0)
        if cut.sum() < 3:
            continue
        a, b = a[cut], b[cut]
        part = offset[a] / (offset[a] - offset[b])
        points = (solid.points[a] + part[:, None] * (solid.points[b] - solid.points[a]))[:, keep]
        around = points - points.mean(axis=0)
        polygons.append(points[np.argsort(np.arctan2(around[:, 1], around[:, 0]))])
        owner.append(element)
    return polygons, np.array(owner, dtype=int)


def products_of(fluid, names):
    """Name of the field that says how much of a cell is detonation products, if there is one."""
    return find(names, "alpha_products", "products", "volume_fraction_products", "alpha[0]", "alpha1", "alpha_1", "alpha", "volume_fraction")


def flow_picture(directory, out, axis, frames):
    entries = spread(fields.series(directory, "fluid"), frames)
    if not entries:
        return None
    solids = fields.series(directory, "solid")
    across = 1 if axis != 1 else 2
    horizontal = 3 - axis - across
    flows = [(t, fields.Fluid(path)) for t, path in entries]
    first = flows[0][1]
    if min(first.shape[axis], first.shape[horizontal]) < 2:
        return line_picture(directory, out, flows)
    position = 0.5 * (first.lower()[across] + first.upper()[across]) + 0.25 * first.spacing[across]
    pressure_name, density_name = find(first.names, "pressure", "p"), find(first.names, "density", "rho")
    products = products_of(first, first.names)

    def picture(fluid, name):
        plane = fluid.plane(name, across, position)
        return plane.T if axis > horizontal else plane
    extent = [first.lower()[horizontal], first.upper()[horizontal], first.lower()[axis], first.upper()[axis]]
    window = extent
    if solids:
        reach = fields.Solid(solids[-1][1]).points
        low, high = reach.min(axis=0) - 0.2, reach.max(axis=0) + 0.2
        window = [max(low[horizontal], extent[0]), min(high[horizontal], extent[1]), max(low[axis], extent[2]), min(high[axis], extent[3])]
    aspect = (window[1] - window[0]) / (window[3] - window[2])
    rows = [name for name in (pressure_name, density_name) if name]
    figure, axes = plt.subplots(len(rows), len(flows), figsize=(len(flows) * max(1.6, 4.6 * aspect) + 1.2, 4.7 * len(rows)), squeeze=False, sharex=True,
                                sharey=True, layout="constrained")
    for r, name in enumerate(rows):
        planes = [picture(fluid, name) for _, fluid in flows]
        positive = np.concatenate([p[np.isfinite(p) & (p > 0)] for p in planes])
        norm = LogNorm(max(np.percentile(positive, 0.2), positive.max() * 1e-6), np.percentile(positive, 99.95))
        colour = "inferno" if name == pressure_name else "viridis"
        for k, (t, fluid) in enumerate(flows):
            ax = axes[r][k]
            image = ax.imshow(np.maximum(planes[k], norm.vmin), origin="lower", extent=extent, norm=norm, cmap=colour, interpolation="nearest")
            if products and extent[1] > extent[0]:
                try:
                    ax.contour(fluid.centres(horizontal), fluid.centres(axis), picture(fluid, products), levels=[0.5], colors="white" if name == pressure_name else "#ff3b6b", linewidths=0.7)
                except (ValueError, TypeError):
                    pass
            if solids:
                nearest = min(solids, key=lambda entry: abs(entry[0] - t))
                solid = fields.Solid(nearest[1])
                polygons, _ = cut_by_plane(solid, across, position)
                if horizontal > axis:
                    polygons = [p[:, ::-1] for p in polygons]
                ax.add_collection(PolyCollection(polygons, facecolors="#e4e7ea", edgecolors="#5a6067", linewidths=0.2))
            ax.set_xlim(window[0], window[1])
            ax.set_ylim(window[2], window[3])
            ax.grid(False)
            if r == 0:
                ax.set_title(microseconds(t), fontsize=11)
            if k == 0:
                ax.set_ylabel(f"{'xyz'[axis]} [m]")
            if r == len(rows) - 1:
                ax.set_xlabel(f"{'xyz'[horizontal]} [m]")
        bar = figure.colorbar(image, ax=list(axes[r]), fraction=0.02, pad=0.01)
        bar.set_label("pressure [Pa]" if name == pressure_name else "density [kg/m³]")
    path = out / "flow.png"
    figure.savefig(path)
    plt.close(figure)
    return path


def line_picture(directory, out, flows):
    """One-dimensional runs: profiles along the long direction."""
    axis = int(np.argmax(flows[0][1].shape))
    names = [name for name in flows[0][1].names if np.ndim(flows[0][1].levels[0][2][name]) == 1][:4]
    figure, axes = plt.subplots(1, len(names), figsize=(3.4 * len(names), 2.9), squeeze=False)
    for ax, name in zip(axes[0], names):
        for t, fluid in flows:
            ax.plot(fluid.centres(axis), fluid.array(name).reshape(-1), lw=1, label=f"{t:.3g} s")
        ax.set_title(name)
        ax.set_xlabel(f"{'xyz'[axis]} [m]")
    axes[0][-1].legend(fontsize=7)
    path = out / "flow.png"
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
    return path


def time_of(table):
    name = find(table, "t", "time")
    t = table[name]
    return (t * 1e6, "time [µs]") if t.size and t[-1] < 1e-2 else (t, "time [s]")


def energy_picture(directory, out):
    panels = []
    for program in ("solid", "fluid"):
        path = directory / f"{program}_history.csv"
        if not path.exists():
            continue
        table, unit = fields.history(path), fields.units(path)
        columns = {name.replace("_", " "): table[name] for name in table if unit.get(name) == "J" and np.isfinite(table[name]).any()}
        if not columns:
            continue
        if {"energy", "stored energy", "face work"} <= set(columns):
            columns["sum of flow, stored, work on the body"] = columns["energy"] + columns["stored energy"] + columns["face work"]
        largest = max(np.nanmax(np.abs(values)) for values in columns.values()) or 1.0
        panels.append((program, table, {name: values for name, values in columns.items()
                                        if np.nanmax(np.abs(values)) > 2e-3 * largest or name == "energy residual"}, largest))
    if not panels:
        return None
    figure, axes = plt.subplots(1, len(panels), figsize=(5.4 * len(panels), 3.8), squeeze=False)
    for ax, (program, table, columns, largest) in zip(axes[0], panels):
        t, label = time_of(table)
        scale, unit = (1e6, "MJ") if largest > 1e6 else (1e3, "kJ") if largest > 1e3 else (1.0, "J")
        for name, values in columns.items():
            total = name.startswith("sum")
            ax.plot(t, values / scale, "k--" if total else "-", lw=1.0 if total else 1.4, label=name)
        ax.set(title=program, xlabel=label, ylabel=f"energy [{unit}]")
        ax.legend(fontsize=7)
    path = out / "energy.png"
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
    return path


def ledger_picture(directory, out):
    """What crossed between the programs, and what was lost: coupling_history.csv."""
    source = directory / "coupling_history.csv"
    if not source.exists():
        return None
    table = fields.history(source)
    t, label = time_of(table)
    if t.size < 2:
        return None
    figure, axes = plt.subplots(2, 3, figsize=(13, 6.4))

    def plot(ax, title, unit, *columns, scale=1.0, log=False):
        for column in columns:
            name, values = column if isinstance(column, tuple) else (column.replace("_", " "), table.get(column))
            if values is not None:
                ax.plot(t, np.abs(values) if log else values / scale, lw=1.2, label=name)
        ax.set(title=title, xlabel=label, ylabel=unit)
        if log:
            ax.set_yscale("log")
        if ax.lines:
            ax.legend(fontsize=7)
    plot(axes[0][0], "impulse of each window on the solid", "[N s]", "impulse_x", "impulse_y", "impulse_z")
    plot(axes[0][1], "impulse that was lost, of what was exchanged", "[1]", ("defect", np.maximum(np.abs(table["impulse_defect"]), 1e-18)), log=True)
    axes[0][1].axhline(1e-12, color="0.5", ls="--", lw=0.8)
    plot(axes[0][2], "work", "[MJ]", "fluid_work_sum", "solid_work_sum", scale=1e6)
    mass = table.get("fluid_mass")
    if mass is not None and mass[0] > 0:
        plot(axes[1][0], "change of the fluid's mass", "[%]", ("mass", 100 * (mass / mass[0] - 1)))
    plot(axes[1][1], "faces", "[1]", "born_faces", "dry_faces")
    plot(axes[1][2], "waiting of the solid in each window", "[s]", "waited")
    path = out / "coupling.png"
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
    return path


def columns_picture(source, out, name, title, most=12):
    """Every column against time, one panel for each unit."""
    if not source.exists():
        return None
    table, unit = fields.history(source), fields.units(source)
    t, label = time_of(table)
    if t.size < 2:
        return None
    time_name = find(table, "t", "time")
    groups = {}
    for column, values in table.items():
        if column != time_name and values.dtype.kind == "f" and np.isfinite(values).any() and column not in ("step", "window"):
            groups.setdefault(unit.get(column, ""), []).append(column)
    if not groups:
        return None
    rows = (len(groups) + 2) // 3
    figure, axes = plt.subplots(rows, min(3, len(groups)), figsize=(4.4 * min(3, len(groups)), 3.0 * rows), squeeze=False)
    for ax, (symbol, columns) in zip(axes.ravel(), groups.items()):
        for column in columns[:most]:
            ax.plot(t, table[column], lw=1.1, label=column.replace("_", " "))
        ax.set_xlabel(label)
        ax.set_ylabel(f"[{symbol}]" if symbol else "")
        ax.legend(fontsize=6)
        values = np.concatenate([table[c][np.isfinite(table[c])] for c in columns[:most]])
        if values.size and values.min() > 0 and values.max() / values.min() > 1e3:
            ax.set_yscale("log")
    for ax in axes.ravel()[len(groups):]:
        ax.axis("off")
    figure.suptitle(title, fontsize=10)
    path = out / name
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
    return path


def fragment_picture(directory, out):
    source = directory / "fragments.csv"
    if not source.exists():
        return None
    table = fields.history(source)
    mass_name = find(table, "mass")
    if mass_name is None or table[mass_name].size < 2:
        return None
    mass = np.sort(table[mass_name])[::-1] * 1e3
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.5))
    axes[0].step(mass, np.arange(1, len(mass) + 1), where="post", lw=1.4)
    small = mass[1:] if len(mass) > 2 and mass[0] > 20 * mass[1] else mass
    mean = small.mean()
    m = np.linspace(0, small[0], 200)
    axes[0].plot(np.maximum(m, 1e-6), len(small) * np.exp(-np.sqrt(m / (mean / 2))), "--", lw=1, color="0.4", label=f"Mott, mean {mean:.3g} g")
    axes[0].set(xscale="log", yscale="log", xlabel="mass m [g]", ylabel="pieces heavier than m", title=f"{len(mass)} pieces, {mass.sum() / 1e3:.4g} kg")
    axes[0].set_ylim(0.8, None)
    axes[0].legend(fontsize=7)
    velocity = [find(table, f"velocity_{a}", f"v_{a}", f"v{a}") for a in "xyz"]
    if all(velocity):
        v = np.stack([table[name] for name in velocity], axis=1)
        speed = np.linalg.norm(v, axis=1)
        axes[1].scatter(table[mass_name] * 1e3, speed, s=7, alpha=0.6)
        axes[1].set(xscale="log", xlabel="mass [g]", ylabel="speed [m/s]")
        angle = np.degrees(np.arccos(np.clip(v[:, 2] / np.maximum(speed, 1e-12), -1, 1)))
        axes[2].scatter(angle, speed, s=np.clip(4 * table[mass_name] * 1e3 / mean, 2, 60), alpha=0.5)
        axes[2].set(xlabel="angle from the axis [deg]", ylabel="speed [m/s]", xlim=(0, 180))
    path = out / "fragments.png"
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--axis", default="z", choices=["x", "y", "z"], help="the direction that points up in the pictures")
    parser.add_argument("--frames", type=int, default=4, help="times shown")
    options = parser.parse_args()
    if not options.directory.is_dir():
        print(f"pictures: {options.directory} is not a folder", file=sys.stderr)
        return 2
    directory, axis = options.directory, "xyz".index(options.axis)
    out = directory / "pictures"
    out.mkdir(exist_ok=True)
    made = [case_picture(directory, out, axis, options.frames), flow_picture(directory, out, axis, options.frames), energy_picture(directory, out),
            ledger_picture(directory, out),
            columns_picture(directory / "fluid_gauges.csv", out, "gauges.png", "gauges in the fluid"), fragment_picture(directory, out)]
    made = [str(path) for path in made if path]
    print("\n".join(made) or f"pictures: no data in {directory}")
    return 0 if made else 1


if __name__ == "__main__":
    sys.exit(main())
