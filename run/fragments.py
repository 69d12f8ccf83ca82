#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Statistics of the pieces of a run: masses with Mott's distribution, speeds by polar zone, a Z-data file, pictures.

    run/fragments.py DIRECTORY [--axis z] [--zones 18] [--least MASS] [--elements N] [--classes 12]

reads DIRECTORY/fragments.csv and writes into DIRECTORY:
    fragment_masses.csv   m [kg], pieces of at least m, mass in them [kg], the fitted number and mass
    fragment_zones.csv    a row a polar zone: bounds [deg] of the direction of flight from the axis, solid angle [sr], pieces, mass [kg],
                          mass [kg/sr], speed: mean over mass, least, largest [m/s], mean mass [kg]
    fragments.zdata       the same for fragment-hazard codes, by zone and class of mass (its columns are explained in its head)
    fragment_statistics.json, pictures/fragment_statistics.png

Mott: N(>m) = N0 exp(-sqrt(m/mu)). sqrt(m) above sqrt(least) is then exponential, so that the estimate of largest likelihood is
sqrt(mu) = mean of sqrt(m) - sqrt(least). Pieces below --least [kg] or of fewer than --elements elements are left out of the fit; N0 counts
as if the law went down to nothing. The distance is Kolmogorov's, between the fitted and the counted distribution."""
import argparse
import csv
import json
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import fields  # noqa: E402


def mott_fit(mass, least=0.0):
    """{mu [kg], N0, error of mu [kg], pieces, distance} of masses [kg]; None if there are fewer than 3."""
    mass = np.sort(np.asarray(mass, dtype=float)[np.asarray(mass) >= least])
    if mass.size < 3:
        return None
    least = max(least, 0.0)
    root = (np.sqrt(mass) - np.sqrt(least)).mean()
    fitted = 1 - np.exp(-(np.sqrt(mass) - np.sqrt(least)) / root)
    steps = np.arange(mass.size + 1) / mass.size
    distance = max(np.abs(fitted - steps[1:]).max(), np.abs(fitted - steps[:-1]).max())
    return dict(mu=root**2, N0=mass.size * np.exp(np.sqrt(least) / root), error=2 * root**2 / np.sqrt(mass.size), pieces=int(mass.size), distance=distance)


def mott_number(mass, mu, N0):
    """Pieces heavier than mass."""
    return N0 * np.exp(-np.sqrt(np.asarray(mass) / mu))


def mott_mass(mass, mu, N0):
    """Mass in pieces heavier than mass: of all, 2 mu N0, the part (1 + s + s^2/2) exp(-s), s = sqrt(m/mu)."""
    s = np.sqrt(np.asarray(mass) / mu)
    return 2 * mu * N0 * (1 + s + s**2 / 2) * np.exp(-s)


def polar_zones(velocity, mass, axis, count):
    """List of zones over [0, 180] deg of the angle between flight and axis; pieces without speed are in none."""
    speed = np.linalg.norm(velocity, axis=1)
    angle = np.degrees(np.arccos(np.clip(velocity @ axis / np.maximum(speed, 1e-300), -1, 1)))
    bounds = np.linspace(0, 180, count + 1)
    zone = np.where(speed > 0, np.minimum((angle / (180 / count)).astype(int), count - 1), -1)
    zones = []
    for k in range(count):
        inside = zone == k
        m, v = mass[inside], speed[inside]
        sr = 2 * np.pi * (np.cos(np.radians(bounds[k])) - np.cos(np.radians(bounds[k + 1])))
        some = m.size > 0
        zones.append(dict(lower=bounds[k], upper=bounds[k + 1], solid_angle=sr, pieces=int(m.size), mass=m.sum(), mass_per_sr=m.sum() / sr,
                          speed=float((m * v).sum() / m.sum()) if some else 0.0, speed_least=float(v.min()) if some else 0.0,
                          speed_largest=float(v.max()) if some else 0.0, mean_mass=float(m.mean()) if some else 0.0, inside=inside))
    return zones


def mass_classes(mass, count):
    """Bounds that part the range of masses evenly in their logarithm."""
    return np.geomspace(mass.min() * (1 - 1e-12), mass.max() * (1 + 1e-12), count + 1)


ZDATA_HEAD = """# Z-data: fragments by polar zone and class of mass
# line 1: zones, classes of mass
# line 2: lower bounds of the classes [g], then the upper bound of the last
# then for each zone two lines:
#   from [deg], to [deg] (direction of flight from the axis, 0: along it), speed, mean over mass [m/s], pieces, mass [kg]
#   for each class in turn: pieces, their mean mass [g] (0 0: none)
"""


def write_zdata(path, zones, mass, classes):
    lines = [f"{len(zones)} {len(classes) - 1}", " ".join(f"{1e3 * m:.6g}" for m in classes)]
    for zone in zones:
        lines.append(f"{zone['lower']:.6g} {zone['upper']:.6g} {zone['speed']:.6g} {zone['pieces']} {zone['mass']:.9g}")
        m = mass[zone["inside"]]
        group = np.digitize(m, classes) - 1
        lines.append("  ".join(f"{(group == g).sum()} {1e3 * m[group == g].mean() if (group == g).any() else 0:.6g}" for g in range(len(classes) - 1)))
    path.write_text(ZDATA_HEAD + "\n".join(lines) + "\n")


def read_zdata(path):
    """(classes [kg], [(from, to, speed, pieces, mass, [(pieces, mean mass [kg])...])])"""
    lines = [line for line in pathlib.Path(path).read_text().splitlines() if not line.startswith("#")]
    zones, count = (int(n) for n in lines[0].split())
    classes = np.array([float(m) for m in lines[1].split()]) / 1e3
    found = []
    for k in range(zones):
        head, body = lines[2 + 2 * k].split(), np.array(lines[3 + 2 * k].split(), dtype=float).reshape(count, 2)
        found.append((float(head[0]), float(head[1]), float(head[2]), int(head[3]), float(head[4]), [(int(n), m / 1e3) for n, m in body]))
    return classes, found


def write_csv(path, columns):
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(columns)
        out.writerows(zip(*(np.asarray(values).tolist() for values in columns.values())))


def picture(path, table, mass, fit, zones):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.5))
    heavy = np.sort(mass)[::-1] * 1e3
    axes[0, 0].step(heavy, np.arange(1, len(heavy) + 1), where="post")
    root = np.sqrt(heavy)
    axes[0, 1].step(root, np.arange(1, len(heavy) + 1), where="post")
    if fit:
        m = np.geomspace(heavy[-1], heavy[0], 300)
        number = mott_number(m / 1e3, fit["mu"], fit["N0"])
        label = f"Mott, mu {1e3 * fit['mu']:.3g} g, N0 {fit['N0']:.4g}"
        axes[0, 0].plot(m, number, "--", color="0.4", label=label)
        axes[0, 1].plot(np.sqrt(m), number, "--", color="0.4", label=label)
        axes[0, 0].legend(fontsize=8)
    axes[0, 0].set(xscale="log", yscale="log", xlabel="mass m [g]", ylabel="pieces of at least m", ylim=(0.8, None), title=f"{len(heavy)} pieces, {mass.sum():.4g} kg")
    axes[0, 1].set(yscale="log", xlabel="sqrt(m) [g^1/2]", ylabel="pieces of at least m", ylim=(0.8, None), title="a line: Mott")
    middle = [0.5 * (zone["lower"] + zone["upper"]) for zone in zones]
    width = zones[0]["upper"] - zones[0]["lower"]
    axes[1, 0].bar(middle, [zone["mass_per_sr"] for zone in zones], width=0.9 * width)
    axes[1, 0].set(xlabel="direction from the axis [deg]", ylabel="mass [kg/sr]", xlim=(0, 180))
    speed = np.linalg.norm(np.stack([table[f"v_{d}"] for d in "xyz"], axis=1), axis=1)
    axes[1, 1].scatter(table["angle"], speed, s=5, alpha=0.4)
    some = [zone for zone in zones if zone["pieces"]]
    axes[1, 1].step([zone["lower"] for zone in some], [zone["speed"] for zone in some], where="post", color="C3", label="mean over mass")
    axes[1, 1].set(xlabel="direction from the axis [deg]", ylabel="speed [m/s]", xlim=(0, 180))
    if some:
        axes[1, 1].legend(fontsize=8)
    figure.tight_layout()
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def statistics(directory, axis="z", zones=18, least=0.0, elements=1, classes=12, pictures=True):
    directory = pathlib.Path(directory)
    table = fields.history(directory / "fragments.csv")
    mass, count = table["mass"], table["elements"]
    velocity = np.stack([table[f"v_{d}"] for d in "xyz"], axis=1)
    along = np.eye(3)["xyz".index(axis)]
    speed = np.linalg.norm(velocity, axis=1)
    table["angle"] = np.degrees(np.arccos(np.clip(velocity @ along / np.maximum(speed, 1e-300), -1, 1)))
    fit = mott_fit(mass[count >= elements], least)
    parts = polar_zones(velocity, mass, along, zones)
    order = np.argsort(-mass)
    columns = {"m [kg]": mass[order], "pieces [1]": np.arange(1, mass.size + 1), "mass [kg]": np.cumsum(mass[order])}
    if fit:
        columns |= {"Mott pieces [1]": mott_number(mass[order], fit["mu"], fit["N0"]), "Mott mass [kg]": mott_mass(mass[order], fit["mu"], fit["N0"])}
    write_csv(directory / "fragment_masses.csv", columns)
    units = {"lower": "deg", "upper": "deg", "solid_angle": "sr", "pieces": "1", "mass": "kg", "mass_per_sr": "kg/sr", "speed": "m/s", "speed_least": "m/s",
             "speed_largest": "m/s", "mean_mass": "kg"}
    write_csv(directory / "fragment_zones.csv", {f"{name} [{unit}]": [zone[name] for zone in parts] for name, unit in units.items()})
    write_zdata(directory / "fragments.zdata", parts, mass, mass_classes(mass, classes))
    aspect = table["length"] / np.maximum(table["thickness"], 1e-300)
    found = dict(pieces=int(mass.size), mass=float(mass.sum()), mean_mass=float(mass.mean()), median_mass=float(np.median(mass)), largest_mass=float(mass.max()),
                 one_element_pieces=int((count == 1).sum()), mass_part_of_aspect_over_8=float(mass[aspect > 8].sum() / mass.sum()),
                 speed_largest=float(speed.max()), speed_mean_over_mass=float((mass * speed).sum() / mass.sum()), mott=fit)
    (directory / "fragment_statistics.json").write_text(json.dumps(found, indent=1) + "\n")
    if pictures:
        picture(directory / "pictures" / "fragment_statistics.png", table, mass, fit, parts)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--axis", default="z", choices=["x", "y", "z"], help="the weapon's axis; angles count from its positive direction")
    parser.add_argument("--zones", type=int, default=18, help="polar zones between 0 and 180 deg")
    parser.add_argument("--classes", type=int, default=12, help="classes of mass in the Z-data file")
    parser.add_argument("--least", type=float, default=0.0, help="pieces below this mass [kg] are left out of the fit")
    parser.add_argument("--elements", type=int, default=1, help="pieces of fewer elements are left out of the fit")
    options = parser.parse_args()
    if not (options.directory / "fragments.csv").exists():
        print(f"fragments: {options.directory} has no fragments.csv", file=sys.stderr)
        return 2
    found = statistics(options.directory, options.axis, options.zones, options.least, options.elements, options.classes)
    print(json.dumps(found, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
