# SPDX-License-Identifier: Apache-2.0
"""Reads what the programs write: VTKHDF 1.0 files with their .series, history tables, summaries. Arrays are numpy, SI."""
import csv
import json
import pathlib

import h5py
import numpy as np


def series(directory, name):
    """[(time, path)] of the files `name`_*.vtkhdf in the order of time; name is "solid" or "fluid"."""
    directory = pathlib.Path(directory)
    for index in sorted(directory.glob(f"{name}*.series")):
        entries = json.loads(index.read_text())["files"]
        return sorted((float(entry["time"]), directory / entry["name"]) for entry in entries)
    return [(float(number), path) for number, path in enumerate(sorted(directory.glob(f"{name}_*.vtkhdf")))]


def history(path):
    """Columns of a CSV by name; a unit in the header, "t [s]", is dropped from the name."""
    with open(path, newline="") as file:
        rows = [row for row in csv.reader(file) if row]
    names = [column.split("[")[0].strip() for column in rows[0]]
    if len(rows) == 1:
        return {name: np.empty(0) for name in names}
    table = {}
    for name, column in zip(names, zip(*rows[1:])):
        try:
            table[name] = np.array([float(value) if value else np.nan for value in column])
        except ValueError:
            table[name] = np.array(column)
    return table


def units(path):
    """Units of the columns of a CSV, by name without unit."""
    with open(path, newline="") as file:
        header = next(csv.reader(file))
    return {column.split("[")[0].strip(): column.split("[")[1].rstrip("] ") if "[" in column else "" for column in header}


def summary(directory, name):
    path = pathlib.Path(directory) / f"{name}_summary.json"
    return json.loads(path.read_text()) if path.exists() else {}


def gauges(directory):
    """What each gauge of the fluid measured, by its name."""
    path = pathlib.Path(directory) / "fluid_gauges.json"
    return {gauge["name"]: gauge for gauge in json.loads(path.read_text())["gauges"]}


class Solid:
    """points [n,3], hex [m,8], cell and point: dictionaries of arrays."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            root = file["VTKHDF"]
            self.points = root["Points"][()].astype(float)
            nodes = root["Connectivity"][()]
            parts = root["NumberOfConnectivityIds"][()]  # a part for each rank, with its own node numbers
            first = np.concatenate([[0], np.cumsum(root["NumberOfPoints"][()])[:-1]])
            self.hex = (nodes + np.repeat(first, parts)).reshape(-1, 8)
            self.cell = {name: data[()] for name, data in root.get("CellData", {}).items()}
            self.point = {name: data[()] for name, data in root.get("PointData", {}).items()}

    SIDES = np.array([[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]])

    def boundary(self):
        """Quads [k,4] that belong to one element only, outward, and the element of each."""
        quads = self.hex[:, self.SIDES].reshape(-1, 4)
        owner = np.repeat(np.arange(len(self.hex)), 6)
        keys = np.sort(quads, axis=1)
        order = np.lexsort(keys.T[::-1])
        ordered = keys[order]
        same = np.zeros(len(order), dtype=bool)
        equal = (ordered[1:] == ordered[:-1]).all(axis=1)
        same[1:] |= equal
        same[:-1] |= equal
        single = order[~same]
        single.sort()
        return quads[single], owner[single]

    def pieces(self):
        """Number of the connected piece of each element: elements that share a node belong together."""
        parent = np.arange(len(self.points))
        hexes = self.hex
        while True:  # label propagation by minima, with pointer jumping
            low = parent[hexes].min(axis=1)
            new = parent.copy()
            np.minimum.at(new, hexes.ravel(), np.repeat(low, 8))
            new = new[new]
            if (new == parent).all():
                break
            parent = new
        _, label = np.unique(parent[hexes[:, 0]], return_inverse=True)
        return label


class Fluid:
    """Blocks of an OverlappingAMR file: levels of (spacing, boxes, data by name)."""

    def __init__(self, path):
        self.levels = []
        with h5py.File(path, "r") as file:
            root = file["VTKHDF"]
            self.origin = np.array(root.attrs["Origin"], dtype=float)
            number = 0
            while f"Level{number}" in root:
                level = root[f"Level{number}"]
                data = {name: values[()] for name, values in level.get("CellData", {}).items()}
                self.levels.append((np.array(level.attrs["Spacing"], dtype=float), level["AMRBox"][()], data))
                number += 1
        self.names = sorted(self.levels[0][2])
        box = np.concatenate([boxes for _, boxes, _ in self.levels[:1]])
        self.spacing = self.levels[-1][0]
        factor = np.rint(self.levels[0][0] / self.spacing).astype(int)
        self.lower_index = box[:, 0::2].min(axis=0) * factor
        self.shape = (box[:, 1::2].max(axis=0) + 1) * factor - self.lower_index

    def lower(self):
        return self.origin + self.lower_index * self.spacing

    def upper(self):
        return self.lower() + self.shape * self.spacing

    def centres(self, axis):
        return self.lower()[axis] + (np.arange(self.shape[axis]) + 0.5) * self.spacing[axis]

    def _paint(self, name, keep=None, at=None):
        """Values on the finest grid as [i,j,k]; with keep/at only the plane of cells that holds the position `at` of axis `keep`."""
        shape = self.shape.copy()
        if keep is not None:
            plane = int(np.clip(np.floor((at - self.lower()[keep]) / self.spacing[keep]), 0, shape[keep] - 1))
            shape[keep] = 1
        out = np.full(shape, np.nan)
        for spacing, boxes, data in self.levels:
            if name not in data:
                continue
            factor = np.rint(spacing / self.spacing).astype(int)
            offset = 0
            for box in boxes:
                low, high = box[0::2], box[1::2] + 1
                n = high - low
                size = int(np.prod(n))
                first, last = low * factor - self.lower_index, high * factor - self.lower_index
                if keep is not None and not first[keep] <= plane < last[keep]:
                    offset += size
                    continue
                values = data[name][offset:offset + size].reshape(n[::-1]).transpose(2, 1, 0)
                offset += size
                where = [slice(a, b) for a, b in zip(first, last)]
                if keep is not None:
                    inside = (plane - first[keep]) // factor[keep]
                    values = np.take(values, [inside], axis=keep)
                    where[keep] = slice(0, 1)
                for axis in range(3):
                    if axis != keep and factor[axis] > 1:
                        values = np.repeat(values, factor[axis], axis=axis)
                out[tuple(where)] = values
        return out

    def array(self, name):
        return self._paint(name)

    def plane(self, name, axis, position):
        """2-D array of the other two axes in their order."""
        return self._paint(name, axis, position).squeeze(axis)
