# SPDX-License-Identifier: Apache-2.0
"""Sod's tube by OpenFOAM's rhoCentralFoam, as a user of it would set it up: Kurganov's flux, van Leer's limiter, Courant number 0.2 as in its tutorials.
Its own programs must be in the PATH (Debian: apt install openfoam)."""
import pathlib
import re
import shutil
import subprocess

import numpy as np

from verification.case import BUILD, RunFailed

HEAD = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"
SIDES = ("left", "right", "empty")


def is_installed():
    return bool(shutil.which("rhoCentralFoam") and shutil.which("blockMesh"))


def write(folder, name, text, kind="dictionary"):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEAD.format(kind=kind, name=path.name) + text)


def field(name, dimensions, values, kind):
    sides = "".join(f"{side} {{ type {'empty' if side == 'empty' else 'zeroGradient'}; }} " for side in SIDES)
    inside = f"nonuniform List<scalar> {len(values)} ({' '.join(f'{v:.17g}' for v in values)})" if kind == "volScalarField" else "uniform (0 0 0)"
    return f"dimensions [{dimensions}];\ninternalField {inside};\nboundaryField {{ {sides} }}\n"


def shock_tube(n, left, right, x0, t):
    """Densities of n cells on [0, 1] at t, gamma = 1.4, both sides at rest at first, and the solver's processor seconds."""
    folder = pathlib.Path(BUILD) / "bench" / f"rho_central_foam_{n}"
    shutil.rmtree(folder, ignore_errors=True)
    x = (np.arange(n) + 0.5) / n
    state = np.where(x[:, None] < x0, np.array(left), np.array(right))
    h = 1.0 / n
    write(folder, "system/controlDict", f"application rhoCentralFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {t!r}; deltaT {0.01 / n!r};\n"
          f"writeControl adjustable; writeInterval {t!r}; writePrecision 12; timePrecision 12; adjustTimeStep yes; maxCo 0.2; maxDeltaT 1;\n")
    write(folder, "system/fvSchemes", "fluxScheme Kurganov;\nddtSchemes { default Euler; }\ngradSchemes { default Gauss linear; }\n"
          "divSchemes { default none; div(tauMC) Gauss linear; }\nlaplacianSchemes { default Gauss linear corrected; }\n"
          "interpolationSchemes { default linear; reconstruct(rho) vanLeer; reconstruct(U) vanLeerV; reconstruct(T) vanLeer; }\nsnGradSchemes { default corrected; }\n")
    write(folder, "system/fvSolution", 'solvers { "(rho|rhoU|rhoE)" { solver diagonal; } }\n')
    write(folder, "system/blockMeshDict", f"convertToMeters 1;\nvertices ((0 0 0) (1 0 0) (1 {h} 0) (0 {h} 0) (0 0 {h}) (1 0 {h}) (1 {h} {h}) (0 {h} {h}));\n"
          f"blocks (hex (0 1 2 3 4 5 6 7) ({n} 1 1) simpleGrading (1 1 1));\nedges ();\nboundary ( left {{ type patch; faces ((0 4 7 3)); }} right {{ type patch; faces ((1 2 6 5)); }}\n"
          "empty { type empty; faces ((0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); } );\n")
    # units in which the gas constant is 1: T = p/rho
    write(folder, "constant/thermophysicalProperties", "thermoType { type hePsiThermo; mixture pureMixture; transport const; thermo hConst; equationOfState perfectGas; specie specie;\n"
          "energy sensibleInternalEnergy; }\nmixture { specie { molWeight 8314.4621; } thermodynamics { Cp 3.5; Hf 0; } transport { mu 0; Pr 1; } }\n")
    write(folder, "constant/turbulenceProperties", "simulationType laminar;\n")
    write(folder, "0/p", field("p", "1 -1 -2 0 0 0 0", state[:, 2], "volScalarField"), "volScalarField")
    write(folder, "0/T", field("T", "0 0 0 1 0 0 0", state[:, 2] / state[:, 0], "volScalarField"), "volScalarField")
    write(folder, "0/U", field("U", "0 1 -1 0 0 0 0", None, "volVectorField"), "volVectorField")
    text = ""
    for program in ("blockMesh", "rhoCentralFoam"):
        done = subprocess.run([program], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=3600)
        text = done.stdout
        (folder / f"{program}.log").write_text(text)
        if done.returncode != 0:
            raise RunFailed(f"{program} ended with {done.returncode}: see {folder}")
    seconds = float(re.findall(r"ExecutionTime = ([0-9.e+-]+) s", text)[-1])
    last = max((p for p in folder.iterdir() if re.fullmatch(r"[0-9.e+-]+", p.name)), key=lambda p: float(p.name))
    return read(last / "p") / read(last / "T"), seconds


def read(path):
    inside = re.search(r"internalField\s+nonuniform List<scalar>\s+\d+\s*\(([^)]*)\)", path.read_text())
    return np.array([float(v) for v in inside.group(1).split()])
