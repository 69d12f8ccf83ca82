# SPDX-License-Identifier: Apache-2.0
"""The fluid's half of a coupled run in Python, over libbreakwave_coupling (breakwave_coupling.h has units and shapes).

    import breakwave_coupling
    with breakwave_coupling.Fluid("my fluid") as fluid:
        for s in fluid:                              # one window of time a pass, until the solid has finished
            t1 = min(s.t0 + 1e-6, s.t1_max)          # the window's end is the fluid's choice
            fluid.send(t1, p)                        # absolute pressure [Pa] of each face of s

    mpirun -n 1 csd case.toml : -n 1 python3 my_fluid.py

MPI is started by the library; mpi4py is not needed. An exception inside the `with` ends both programs with its text.
The library is looked for in $BREAKWAVE_COUPLING_LIBRARY, in the installation or build that this file belongs to, then where the
system's loader looks.
"""
import ctypes
import os
import pathlib
import sys
import traceback

import numpy as np

ABI = 1                              # of the library: FSI_ABI, whose structs are below
LIP, THIN = 1, 2                     # flags of a face: lip of a crack; open shell, wet on both sides
SCHEMES = {None: 0, "fluid_first": 1, "box1": 2, "concurrent": 3}
_f64, _i64, _i32, _int = ctypes.c_double, ctypes.c_int64, ctypes.c_int32, ctypes.c_int
_doubles, _longs, _ints = ctypes.POINTER(_f64), ctypes.POINTER(_i64), ctypes.POINTER(_i32)


class _Options(ctypes.Structure):
    _fields_ = [("program", ctypes.c_char_p), ("version", ctypes.c_char_p), ("units", ctypes.c_char_p), ("p_ref", _f64), ("t0", _f64),
                ("t_end", _f64), ("lower", _f64 * 3), ("upper", _f64 * 3), ("scheme", _int), ("silence_limit", _f64), ("join_limit", _f64),
                ("port_file", ctypes.c_char_p)]


class _Surface(ctypes.Structure):
    _fields_ = [("window", _i64), ("topo_version", _i64), ("n_nodes", _i64), ("n_faces", _i64), ("t0", _f64), ("t1_max", _f64),
                ("dt_stable", _f64), ("new_topology", _int), ("last", _int), ("mean_pressure", _int), ("x", _doubles), ("v", _doubles),
                ("x_wall", _doubles), ("quads", _ints), ("node_id", _longs), ("node_parent", _longs), ("face_id", _longs),
                ("body", _ints), ("flags", _ints), ("area", _doubles), ("centre", _doubles), ("fixed", _int)]


_BOOKS = ["mass", "energy", "momentum", "mass_covered", "mass_uncovered", "energy_covered", "energy_uncovered", "dry_faces", "dry_area"]


class _Load(ctypes.Structure):
    _fields_ = [("t1", _f64), ("p", _doubles), ("traction", _doubles), ("impedance", _doubles), ("stop", _int), ("mass", _f64),
                ("energy", _f64), ("momentum", _f64 * 3), ("mass_covered", _f64), ("mass_uncovered", _f64), ("energy_covered", _f64),
                ("energy_uncovered", _f64), ("dry_faces", _i64), ("dry_area", _f64), ("dt_next", _f64)]


def _load_library():
    name, root = "libbreakwave_coupling.so", pathlib.Path(__file__).resolve().parents[2]
    named = os.environ.get("BREAKWAVE_COUPLING_LIBRARY")
    near = [root / "build" / "lib" / name, *sorted(root.parent.glob(f"lib*/{name}")), *sorted(root.parent.glob(f"lib/*/{name}"))]
    path = named or next((str(file) for file in near if file.exists()), name)
    library = ctypes.CDLL(path, mode=ctypes.RTLD_GLOBAL)  # global: MPI's own plug-ins need MPI's symbols
    if not hasattr(library, "fsi_abi") or library.fsi_abi() != ABI:
        raise ImportError(f"{path} has another binary interface than this module (fsi_abi() {ABI}): take both from one installation")
    handle = ctypes.c_void_p
    for function, result, *arguments in (
            ("fsi_defaults", None, ctypes.POINTER(_Options)), ("fsi_version", ctypes.c_char_p),
            ("fsi_fluid_open", handle, ctypes.POINTER(_Options)), ("fsi_t_end", _f64, handle),
            ("fsi_recv_surface", _int, handle, ctypes.POINTER(_Surface)), ("fsi_wall_velocity", None, handle, _f64, _doubles, _doubles),
            ("fsi_send_load", None, handle, ctypes.POINTER(_Load)), ("fsi_fail", None, handle, _int, ctypes.c_char_p),
            ("fsi_poll", None, handle), ("fsi_close", None, handle), ("fsi_rank", _int, handle), ("fsi_size", _int, handle),
            ("fsi_comm", _int, handle), ("fsi_sum", None, handle, _doubles, _i64)):
        entry = getattr(library, function)
        entry.restype, entry.argtypes = result, arguments
    return library


def _array(values, shape, name):
    """Contiguous doubles of that shape; a scalar fills it."""
    values = np.asarray(values, dtype=np.float64)
    if values.ndim and values.shape != shape:
        raise ValueError(f"{name} has the shape {values.shape}, {shape} was expected")
    return np.ascontiguousarray(np.broadcast_to(values, shape))


def _pointer(values):
    return None if values is None else values.ctypes.data_as(_doubles)


class Surface:
    """The solid's wet surface at t0. Arrays are views, valid until the next window: copy what you keep.

    window, topo_version, t0 [s], t1_max [s], dt_stable [s], new_topology, last, mean_pressure (p shall be the window's mean),
    fixed (the window must end at t1_max)
    x [n, 3] m, v [n, 3] m/s (announced), x_wall [n, 3] m (the fluid's wall at t0), node_id [n], node_parent [n]
    quads [m, 4], face_id [m], body [m], flags [m], area [m, 3] m^2 (vector into the fluid), centre [m, 3] m
    """

    def __init__(self, fluid, raw):
        self._fluid = fluid
        for name in ("window", "topo_version", "n_nodes", "n_faces", "t0", "t1_max", "dt_stable"):
            setattr(self, name, getattr(raw, name))
        for name in ("new_topology", "last", "mean_pressure", "fixed"):
            setattr(self, name, bool(getattr(raw, name)))
        n, m = self.n_nodes, self.n_faces
        for name, shape in (("x", (n, 3)), ("v", (n, 3)), ("x_wall", (n, 3)), ("quads", (m, 4)), ("node_id", (n,)), ("node_parent", (n,)),
                            ("face_id", (m,)), ("body", (m,)), ("flags", (m,)), ("area", (m, 3)), ("centre", (m, 3))):
            values = getattr(raw, name)
            setattr(self, name, np.ctypeslib.as_array(values, shape) if shape[0] else np.empty(shape, dtype=values._type_))

    @property
    def normal(self):
        """[m, 3] unit normals into the fluid (zero for a face without area)."""
        size = np.linalg.norm(self.area, axis=1, keepdims=True)
        return self.area / np.where(size > 0, size, 1)

    def wall_velocity(self, t1):
        """[m, 3] m/s, velocity of the faces of the fluid's wall in a window that ends at t1."""
        return self._velocity(t1, self.n_faces, False)

    def node_velocity(self, t1):
        """[n, 3] m/s, the same at the nodes."""
        return self._velocity(t1, self.n_nodes, True)

    def _velocity(self, t1, n, of_nodes):
        values = np.empty((n, 3))
        _library().fsi_wall_velocity(self._fluid._handle, t1, *((_pointer(values), None) if of_nodes else (None, _pointer(values))))
        return values


def _library():
    if not hasattr(_library, "it"):
        _library.it = _load_library()
    return _library.it


def version():
    return _library().fsi_version().decode()


class Fluid:
    """Joins the run and shakes hands. Read and check your input before.

    program, version, units: for people. p_ref [Pa]: the case's coupling.reference_pressure. t0 [s]. t_end [s]: 0 = no opinion.
    lower, upper [m]: box of the fluid's domain. scheme: None, "fluid_first", "box1", "concurrent". Limits in s.
    port_file: the case's coupling.port_file if csd was started apart, by an mpirun of its own.
    """

    def __init__(self, program, *, version="", units="SI", p_ref=101325.0, t0=0.0, t_end=0.0, lower=(-1e30,) * 3, upper=(1e30,) * 3,
                 scheme=None, silence_limit=600.0, join_limit=120.0, port_file=None):
        self._handle = None
        options = _Options()
        _library().fsi_defaults(ctypes.byref(options))
        options.program, options.version, options.units = program.encode(), version.encode(), units.encode()
        options.p_ref, options.t0, options.t_end, options.scheme = p_ref, t0, t_end, SCHEMES[scheme]
        options.lower, options.upper = (_f64 * 3)(*lower), (_f64 * 3)(*upper)
        options.silence_limit, options.join_limit = silence_limit, join_limit
        options.port_file = os.fsencode(port_file) if port_file else None
        self._handle = _library().fsi_fluid_open(ctypes.byref(options))
        self.rank, self.size = _library().fsi_rank(self._handle), _library().fsi_size(self._handle)
        self.t_end = _library().fsi_t_end(self._handle)
        self._surface, self._raw = None, _Surface()

    def receive(self):
        """The next Surface; None: the solid has finished."""
        there = _library().fsi_recv_surface(self._handle, ctypes.byref(self._raw))
        self._surface = Surface(self, self._raw) if there else None
        return self._surface

    def __iter__(self):
        while (surface := self.receive()) is not None:
            yield surface

    def send(self, t1, p, *, traction=None, impedance=None, stop=False, dt_next=0.0, **books):
        """Answers the surface in hand. p [m] Pa, absolute; traction [m, 3] Pa; impedance [m] kg/(m^2 s); dt_next [s]: the step that
        the fluid would take next; books: mass, energy, momentum,
        mass_covered, mass_uncovered, energy_covered, energy_uncovered, dry_faces, dry_area of the header."""
        m = self._surface.n_faces
        p = _array(p, (m,), "p")
        traction = None if traction is None else _array(traction, (m, 3), "traction")
        impedance = None if impedance is None else _array(impedance, (m,), "impedance")
        load = _Load(t1=t1, p=_pointer(p), traction=_pointer(traction), impedance=_pointer(impedance), stop=bool(stop), dt_next=dt_next)
        for name, value in books.items():
            if name not in _BOOKS:
                raise TypeError(f"send: unknown argument '{name}'; the books are {', '.join(_BOOKS)}")
            setattr(load, name, (_f64 * 3)(*value) if name == "momentum" else value)
        _library().fsi_send_load(self._handle, ctypes.byref(load))

    def sum(self, values):
        """The sum of an array over the fluid's ranks, the same bits on all."""
        values = np.array(values, dtype=np.float64)
        _library().fsi_sum(self._handle, _pointer(values), values.size)
        return values

    def poll(self):
        """Ends the program here if the solid has failed (rank 0, in long computations)."""
        _library().fsi_poll(self._handle)

    def fail(self, text, code=1):
        """Ends both programs with this reason and exit code."""
        sys.stdout.flush()
        sys.stderr.flush()
        _library().fsi_fail(self._handle, code, text.encode())

    def close(self):
        """After the solid has finished."""
        if self._handle:
            _library().fsi_close(self._handle)
        self._handle = None

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if error is not None:
            traceback.print_exception(kind, error, trace)
            self.fail(f"{kind.__name__}: {error}")
        self.close()
