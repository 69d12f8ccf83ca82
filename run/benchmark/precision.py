# SPDX-License-Identifier: Apache-2.0
"""Error against run time on meshes of several sizes, one thread; a table and a plot per case in build/bench. Here the solid's cases."""
import csv
import math

import numpy as np

from verification import materials, reference, solid, solid_ring, solid_static, solid_waves
from verification.case import BUILD, output, run

from .row import row

FOLDER = BUILD / "bench"
# errors that are good enough in practice
WANTED = {"S7": 0.01, "S8": 0.03, "S9": 0.01, "cook": 0.02, "wave": 0.1, "sod": 2e-3, "vortex": 1e-3, "sedov": 0.01, "detonation": 0.02, "blast": 0.03, "piston": 2e-3,
          "wedge": 0.01}


def study(name, quantity, exact, sizes, measure, across="elements across", peers=()):
    """measure(size) gives (value, processor seconds); writes the table and the plot, returns the rows. peers: (name of another program, its measure)."""
    def points_of(how):
        found = []
        for size in sizes:
            value, seconds = how(size)
            found.append((size, value, abs(value - exact) / (abs(exact) if exact else 1), seconds))
        return found
    points = points_of(measure)
    others = [(peer, points_of(how)) for peer, how in peers]
    errors, seconds = (np.array([p[k] for p in points]) for k in (2, 3))
    order = -np.polyfit(np.log([p[0] for p in points]), np.log(errors), 1)[0]
    slope, offset = np.polyfit(np.log(seconds), np.log(errors), 1)
    enough = math.exp((math.log(WANTED[name]) - offset) / slope)
    FOLDER.mkdir(parents=True, exist_ok=True)
    with open(FOLDER / f"precision_{name}.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["program", across, quantity, "reference", "error", "processor seconds"])
        table.writerows(["Breakwave", p[0], p[1], exact, p[2], p[3]] for p in points)
        table.writerows([peer, p[0], p[1], exact, p[2], p[3]] for peer, found in others for p in found)
    plot(name, quantity, points, order, slope, offset, others)
    print(f"{FOLDER / f'precision_{name}.csv'} and .png", flush=True)
    rows = [row(f"{name}_{p[0]}_error", p[2], "") for p in points] + [row(f"{name}_{p[0]}_seconds", p[3], "s of the processor") for p in points]
    for peer, found in others:
        for theirs in found:
            rows += [row(f"{name}_{theirs[0]}_error_{peer}", theirs[2], ""), row(f"{name}_{theirs[0]}_seconds_{peer}", theirs[3], "s of the processor")]
    return rows + [row(f"{name}_order", order, "of the error in 1/h"), row(f"{name}_slope", slope, "d log error/d log seconds"),
                   row(f"{name}_seconds_to_{WANTED[name]:g}", enough, "s of the processor, by the fit")]


def plot(name, quantity, points, order, slope, offset, others):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(5, 4), layout="constrained")
    seconds = np.array([p[3] for p in points])
    axes.loglog(seconds, [p[2] for p in points], "o", color="tab:blue")
    axes.loglog(seconds, np.exp(offset) * seconds ** slope, "-", color="tab:blue", label=f"seconds^{slope:.2f}; h^{order:.2f}")
    for size, _, error, at in points:
        axes.annotate(f" {size}", (at, error))
    for peer, found in others:
        axes.loglog([p[3] for p in found], [p[2] for p in found], "s", color="tab:orange", label=peer)
    axes.axhline(WANTED[name], color="0.6", lw=0.8)
    axes.set(xlabel="processor seconds, one thread", ylabel="error", title=f"{name}: {quantity}")
    axes.legend()
    axes.grid(True, which="both", alpha=0.3)
    figure.savefig(FOLDER / f"precision_{name}.png", dpi=120)
    pyplot.close(figure)


def seconds_of(result, program="solid"):
    """Of the processor, so that what else runs on the machine counts little."""
    return solid.fields.summary(result.directory, program)["cpu_seconds"]


def taylor_bar():
    """S7: foot radius of the Taylor bar, 4, 8, 16 elements over the radius"""
    def measure(across):
        result, foot, _, _ = solid.taylor_shape(across, threads=1)
        return foot, seconds_of(result)
    return study("S7", "foot radius [mm]", 7.23, (4, 8, 16), measure)


def necking_bar():
    """S8: neck radius at u = 5 mm, 5, 10, 15 elements over the radius"""
    def measure(across):
        result = run(f"precision_S8_{across}", materials.necking(across, 3 * across), threads=1, only="solid")
        u, neck, _ = materials.neck_history(result)
        return 1e3 * np.interp(5e-3, u, neck), seconds_of(result)
    return study("S8", "neck radius at u = 5 mm [mm]", 4.418, (5, 10, 15), measure)


def free_ring():
    """S9: strain of the free ring of copper at its first stop, 32, 64, 128 elements around"""
    steel, speed = solid.TAYLOR_COPPER, 200.0
    strain, stop = reference.ring_stop(0.05, speed, steel["young"], steel["density"], steel["yield_stress"], steel["hardening"])

    def measure(around):
        result, table = solid_ring.fly(f"precision_S9_{around}", steel, speed, stop, solid_ring.free_ring(around), '[[solid.probe]]\nname = "ring"\nkind = "ring"\n', threads=1)
        return solid_ring.first_stop(table["t"], table["ring radius"], table["ring v_radial"])[0], seconds_of(result)
    return study("S9", "ln(r/r0) at the first stop", strain, (32, 64, 128), measure)


def cook_membrane():
    """S4: Cook's membrane of finite strain, kappa/mu = 5,000: tip, 8, 16, 32 elements a side"""
    def measure(n):
        result, _ = solid_static.relaxed(f"precision_cook_{n}", solid_static.cook(n, solid_static.neo_hooke(80.194, 400943.3), 100.0, True))
        return solid_waves.history(result)["A y"][-1] - 60, seconds_of(result)
    return study("cook", "v of (48, 60)", 6.92, (8, 16, 32), measure)


def wave():
    """S2b: shape of an elastic pulse after 0.84 m, 50, 100, 200 elements a metre: integral of the error over that of the pulse"""
    c = math.sqrt(solid_waves.STEEL["young"] * 0.7 / (1.3 * 0.4) / solid_waves.STEEL["density"])
    times = np.linspace(0, 0.2 / c, 101)

    place = 0.84  # a node of all three

    def measure(cells):
        result = run(f"precision_wave_{cells}", solid_waves.driven(solid_waves.uniaxial_strain(1.4, round(1.4 * cells)), 1.4 / c, times, np.maximum(np.sin(np.pi * times * 5 * c), 0))
                     + solid_waves.node("end", (place, 0, 0)), only="solid", threads=1)
        table = solid_waves.history(result)
        t, v = table["t"], table["end vx"]
        late = t - place / c
        exact = np.where((late > 0) & (late < 0.2 / c), np.sin(np.pi * late * 5 * c), 0)
        return solid_waves.integral(np.abs(v - exact), t) / solid_waves.integral(exact, t), seconds_of(result)
    return study("wave", "integral of the error over that of the pulse", 0.0, (50, 100, 200), measure)


MAKERS = [taylor_bar, necking_bar, free_ring, cook_membrane, wave]
