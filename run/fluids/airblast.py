#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The empirical blast of Kingery and Bulmash as a fluid program: arrival by distance, Friedlander decay, angle of incidence.

    run/breakwave run/cases/plate/case.toml
    mpirun -n 1 build/bin/csd case.toml : -n 1 python3 run/fluids/airblast.py case.toml

No cells, no shielding, no suction phase; lips of cracks feel the ambient pressure. A face's wave is that of the place where it was first
seen, the angle that of the moment. Reads [fluid] of the case file (numbers in SI, or texts with a unit):

    [fluid]
    program = "../../fluids/airblast.py"     # for run/breakwave, from the case file's folder
    time_step = "10 us"                      # windows while the blast lasts; default: a fiftieth of the shortest duration
    [fluid.charge]
    centre = ["0 m", "0 m", "0.5 m"]
    mass = "1 kg"
    tnt_equivalent = 1.0                     # mass of TNT that does what a unit of the explosive does
    burst = "free_air"                       # or "hemispherical": a half sphere on rigid ground
    start_time = "0 s"                       # of the detonation; may be negative
"""
import pathlib
import re
import sys
import tomllib

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "coupling" / "python"))
import breakwave_coupling  # noqa: E402
import kingery_bulmash  # noqa: E402

UNITS = {"length": {"m": 1, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}, "mass": {"kg": 1, "g": 1e-3, "t": 1e3, "lb": 0.45359237},
         "time": {"s": 1, "ms": 1e-3, "us": 1e-6}, "pressure": {"Pa": 1, "kPa": 1e3, "MPa": 1e6, "bar": 1e5, "atm": 101325}, "number": {}}
BURSTS = {"free_air": kingery_bulmash.FREE_AIR, "hemispherical": kingery_bulmash.HEMISPHERE}


class Wrong(Exception):
    """The case is wrong."""


def quantity(value, kind, key):
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    found = re.fullmatch(r"\s*([-+\d.eE]+)\s*([A-Za-z]+)\s*", value) if isinstance(value, str) else None
    try:
        return float(found[1]) * UNITS[kind][found[2]]
    except (TypeError, ValueError, KeyError):
        raise Wrong(f"{key}: {value!r}: expected a {kind}, a number in SI or a text with one of the units {', '.join(UNITS[kind]) or '(none)'}") from None


def take(table, place, keys):
    """Values of the keys, {name: (kind, default)}; kind may be a parser; a default of None means required."""
    for name in table:
        if name not in keys:
            raise Wrong(f"{place}.{name}: unknown key; there are {', '.join(keys)}")
    for name, (_, default) in keys.items():
        if name not in table and default is None:
            raise Wrong(f"{place}.{name}: missing")
    values = []
    for name, (kind, default) in keys.items():
        value, key = table.get(name, default), f"{place}.{name}"
        values.append(kind(value, key) if callable(kind) else quantity(value, kind, key))
    return values


def point(value, key):
    if not isinstance(value, list) or len(value) != 3:
        raise Wrong(f"{key}: expected three lengths")
    return np.array([quantity(component, "length", key) for component in value])


def table_of(value, key):
    if not isinstance(value, dict):
        raise Wrong(f"{key}: expected a table")
    return value


def burst_of(value, key):
    if value not in BURSTS:
        raise Wrong(f"{key}: expected one of {', '.join(BURSTS)}")
    return BURSTS[value]


class Blast:
    def __init__(self, file):
        try:
            case = tomllib.loads(pathlib.Path(file).read_text(encoding="utf-8"))
        except (OSError, tomllib.TOMLDecodeError) as error:
            raise Wrong(str(error)) from None
        fluid = table_of(case.get("fluid", {}), "fluid")
        _, self.time_step, charge = take(fluid, "fluid", {
            "program": (lambda value, key: value, ""), "time_step": ("time", 0.0), "charge": (table_of, None)})
        self.centre, mass, equivalent, self.curves, self.start = take(charge, "fluid.charge", {
            "centre": (point, None), "mass": ("mass", None), "tnt_equivalent": ("number", 1.0), "burst": (burst_of, "free_air"),
            "start_time": ("time", 0.0)})
        self.charge = mass * equivalent
        if not self.charge > 0 or self.time_step < 0:
            raise Wrong("fluid.charge.mass, tnt_equivalent: expected positive numbers; fluid.time_step: a time")
        self.p0 = quantity(case.get("coupling", {}).get("reference_pressure", 101325.0), "pressure", "coupling.reference_pressure")
        self.seen = {}  # face id -> distance where it was first seen
        self.wave = None

    def see(self, s):
        """The waves at the faces of a new surface."""
        ray = np.linalg.norm(s.centre - self.centre, axis=1)
        for face, distance in zip(s.face_id.tolist(), ray.tolist()):
            self.seen.setdefault(face, distance)
        distance = np.array([self.seen[face] for face in s.face_id.tolist()])
        Z = distance / np.cbrt(self.charge)
        if s.window == 0 and len(Z) and (Z.min() < self.curves["nearest"] or Z.max() > kingery_bulmash.FARTHEST):
            raise Wrong(f"faces lie at {Z.min():.4g} to {Z.max():.4g} m/kg^(1/3) from the charge; the curves hold from "
                        f"{self.curves['nearest']} to {kingery_bulmash.FARTHEST:g}")
        self.wave = kingery_bulmash.Wave(self.curves, distance, self.charge)
        self.lip = (s.flags & breakwave_coupling.LIP) != 0

    def window_end(self, s):
        """Straight to the first arrival; small windows while the blast lasts; then whatever the solid wants."""
        t, w = s.t0 - self.start, self.wave
        if s.fixed or len(w.arrival) == 0 or t >= (w.arrival + w.duration).max():
            return s.t1_max
        if t < w.arrival.min():
            return min(s.t1_max, max(self.start + w.arrival.min(), np.nextafter(s.t0, np.inf)))
        return min(s.t1_max, s.t0 + (self.time_step or w.duration.min() / 50))

    def pressure(self, s, t1):
        ray = s.centre - self.centre
        cosine = -(s.normal * ray).sum(axis=1) / np.linalg.norm(ray, axis=1)
        t0, t1 = s.t0 - self.start, t1 - self.start
        over = self.wave.mean_pressure(cosine, t0, t1) if s.mean_pressure else self.wave.pressure(cosine, t1)
        return self.p0 + np.where(self.lip, 0.0, over)


def main():
    if len(sys.argv) != 2:
        print("usage: airblast.py case.toml", file=sys.stderr)
        return 2
    try:
        blast = Blast(sys.argv[1])
    except Wrong as error:
        print(f"[airblast] error: {sys.argv[1]}: {error}", file=sys.stderr)
        return 2
    with breakwave_coupling.Fluid("airblast", p_ref=blast.p0) as fluid:
        for s in fluid:
            if s.new_topology:
                try:
                    blast.see(s)
                except Wrong as error:
                    fluid.fail(f"{sys.argv[1]}: {error}", 2)
                if s.window == 0 and s.n_faces and fluid.rank == 0:
                    w = blast.wave
                    print(f"[airblast] {s.n_faces} faces; arrival {1e3 * (blast.start + w.arrival.min()):.4g} to {1e3 * (blast.start + w.arrival.max()):.4g} ms, "
                          f"incident {1e-6 * w.incident.max():.4g} MPa, reflected {1e-6 * w.reflected.max():.4g} MPa at the nearest", flush=True)
            t1 = blast.window_end(s)
            fluid.send(t1, blast.pressure(s, t1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
