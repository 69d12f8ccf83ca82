#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The smallest useful fluid: gas at rest around the solid that answers each wall with a plane wave, p = p0 + rho c (v . n).

    mpirun -n 1 build/bin/csd case.toml : -n 1 python3 run/fluids/acoustic.py [time step, s]
"""
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "coupling" / "python"))
from breakwave_coupling import Fluid  # noqa: E402

P0, RHO, C = 101325.0, 1.225, 340.3
dt = float(sys.argv[1]) if len(sys.argv) > 1 else 1e-5
with Fluid("acoustic", p_ref=P0) as fluid:
    for s in fluid:
        t1 = s.t1_max if s.fixed else min(s.t0 + dt, s.t1_max)
        speed = (s.wall_velocity(t1) * s.normal).sum(axis=1)  # of the faces, towards the gas
        fluid.send(t1, P0 + RHO * C * speed, impedance=RHO * C)
