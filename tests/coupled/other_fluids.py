#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Other programs in place of cfd, through libbreakwave_coupling: Python and C against exact answers and against csd's own blast load; how they fail.

other_fluids.py <build folder> <source folder> <folder for results>
"""
import math
import pathlib
import re
import shutil
import subprocess
import sys

import launch
from launch import history, mpirun, report

BUILD, SOURCE, OUT = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
CSD, PYTHON, FLUIDS = BUILD / "bin" / "csd", "/usr/bin/python3", SOURCE / "run" / "fluids"
sys.path.append(str(FLUIDS))
import kingery_bulmash  # noqa: E402

OUT.mkdir(parents=True, exist_ok=True)
SLAB = """
[time]
end = "1 ms"
[output]
directory = "{out}"
[[solid.body]]
name = "slab"
mesh = {{kind = "box", lower = [0, 0, 0], upper = ["10 mm", "10 mm", "10 mm"], cells = [1, 1, 1]}}
material = {{kind = "neo_hooke", density = 100, young_modulus = "1 GPa", poisson_ratio = 0.0}}
velocity = [1.0, 0.0, 0.0]
[solid.wet]
faces = ["x_lower"]
"""


def write_case(name, text):
    (OUT / name).mkdir(exist_ok=True)
    file = OUT / name / "case.toml"
    file.write_text(text.format(out=OUT / name) if "{out}" in text else text, encoding="utf-8")
    return file


def slab(name, *fluid, ranks=(1, 1)):
    """A slab of 1 kg/m^2 that flies away from the gas at 1 m/s: rho c is all that pulls it back, v = exp(-rho c t/m)."""
    case = write_case(name, SLAB)
    code, text = mpirun((ranks[0], CSD, case), (ranks[1], *fluid))
    if code != 0:
        return report(name, f"exit code {code}\n{text}")
    v, exact = history(OUT / name / "solid_history.csv")["momentum x"][-1] / 1e-4, math.exp(-1.225 * 340.3 * 1e-3)
    defect = max(history(OUT / name / "coupling_history.csv")["impulse_defect"])
    report(f"{name}: v(1 ms) {v:.6f}, exact {exact:.6f}", "" if abs(v / exact - 1) < 1e-4 and defect < 1e-12 else f"off; impulse defect {defect}")


def blast():
    """The plate under airblast.py and under csd's own load: the same curves, the same plate."""
    text = (SOURCE / "run" / "cases" / "plate" / "case.toml").read_text(encoding="utf-8")
    text = text.replace('end = "2 ms"', 'end = "0.4 ms"').replace('fields_every = "0.25 ms"', "")
    coupled = write_case("plate", re.sub(r"run/out/plate", str(OUT / "plate"), text))
    own = text[:text.index("[fluid]")].replace('[solid.wet]\nfaces = ["z_upper"]', '[[solid.load]]\nkind = "blast"\nfaces = ["z_upper"]\n'
                                               'centre = [0, 0, "404 mm"]\ncharge = "0.5 kg"')
    alone = write_case("plate_alone", own.replace("run/out/plate", str(OUT / "plate_alone")))
    for code, said in mpirun((1, CSD, coupled), (1, PYTHON, FLUIDS / "airblast.py", coupled)), mpirun((1, CSD, alone)):
        if code != 0:
            return report("plate", f"exit code {code}\n{said}")
    a, b = history(OUT / "plate" / "solid_history.csv"), history(OUT / "plate_alone" / "solid_history.csv")
    for column in "middle.z", "kinetic_energy", "external_work":
        name = next(title for title in a if re.sub(r"[ ._:]", "", title) == re.sub(r"[ ._:]", "", column))
        ratio = a[name][-1] / b[name][-1] - 1
        report(f"plate: {name} of airblast.py over that of csd's own blast: 1 {ratio:+.1e}", "" if abs(ratio) < 2e-3 else "they differ")


def curves():
    """The coefficients in Python are those of the C++ header."""
    header = (SOURCE / "csd" / "load" / "kingery_bulmash.h").read_text(encoding="utf-8")
    numbers = [sorted(float(n) for n in re.findall(r"-?\d*\.\d+(?:e-?\d+)?", text)) for text in (
        header[header.index("namespace free_air"):header.index("}  // namespace hemisphere")],
        (FLUIDS / "kingery_bulmash.py").read_text(encoding="utf-8").split("FREE_AIR")[1].split("def curve")[0])]
    report("coefficients of Kingery and Bulmash", "" if numbers[0] == numbers[1] and len(numbers[0]) > 150 else "two different sets")
    wave = kingery_bulmash.Wave(kingery_bulmash.FREE_AIR, kingery_bulmash.np.array([1.0, 5.0]), 1.0)
    impulse = wave.mean_pressure(kingery_bulmash.np.ones(2), 0.0, 1.0)
    published = 1e-3 * 1e3 * kingery_bulmash.curve(kingery_bulmash.FREE_AIR["reflected_impulse"], kingery_bulmash.np.array([1.0, 5.0]))
    report("impulse of the whole blast against the curve", "" if abs(impulse / published - 1).max() < 1e-9 else f"{impulse} {published}")


def failures():
    bad = OUT / "bad.py"
    for name, body, code_wanted, words in (
            ("exception", "raise ValueError('no such thing')", 1, [r"\[csd\] error: py \(rank 0\) FAILED.*ValueError: no such thing", "Traceback"]),
            ("shape", "fluid.send(s.t1_max, [1.0, 2.0])", 1, [r"shape \(2,\), \(1,\) was expected"]),
            ("not a number", "fluid.send(s.t1_max, float('nan'))", 69, ["P of face 0 is nan"]),
            ("beyond t1_max", "fluid.send(s.t1_max * 1.1, 1e5)", 69, ["LOAD: t1 = .* is not in"]),
            ("exit", "sys.exit(0)", None, [r"\[csd\] error: "]),
            ("no answer", "continue", 1, ["has not been answered by fsi_send_load"]),
            ("fail", "fluid.fail('lost patience', 7)", 7, ["lost patience"])):
        bad.write_text(f"import sys\nsys.path.append('{SOURCE}/coupling/python')\nimport breakwave_coupling\n"
                       f"with breakwave_coupling.Fluid('py') as fluid:\n    for s in fluid:\n        {body}\n", encoding="utf-8")
        code, text = mpirun((1, CSD, write_case("failures", SLAB)), (1, PYTHON, bad))
        missing = [w for w in words if not re.search(w, text)]
        wrong = code in (0, None) or code_wanted not in (None, code) or missing
        report(f"Python fluid, {name}: exit code {code}", f"expected {code_wanted}; not said: {missing}\n{text}" if wrong else "")
    code, text = mpirun((1, PYTHON, FLUIDS / "acoustic.py"))
    report("Python fluid alone", "" if code == 73 and "no solid program" in text else f"exit code {code}\n{text}")
    wrong = write_case("wrong", SLAB + '[fluid]\nprogram = "x"\n[fluid.charge]\ncentre = [0, 0, 1]\nmass = "1 kilo"\n')
    code, text = mpirun((1, CSD, wrong), (1, PYTHON, FLUIDS / "airblast.py", wrong))
    report("airblast.py, wrong unit", "" if code == 2 and "fluid.charge.mass" in text else f"exit code {code}\n{text}")


def from_the_text_alone():
    """A client that knows MPI and PROTOCOL.md, nothing else."""
    program = OUT / "raw_gas"
    done = subprocess.run(["mpicc", "-Wall", "-o", str(program), str(SOURCE / "tests" / "coupled" / "raw_client" / "gas.c"), "-lm"], capture_output=True, text=True)
    if done.returncode != 0:
        return report("C program from PROTOCOL.md", done.stderr)
    slab("C program from PROTOCOL.md", program)


def installed():
    """cmake --install, then a C program by the CMake package, and the flags of pkg-config."""
    prefix, client = OUT / "prefix", OUT / "c_client"
    shutil.rmtree(prefix, ignore_errors=True)
    shutil.rmtree(client, ignore_errors=True)
    for command in (["cmake", "--install", BUILD, "--prefix", prefix],
                    ["cmake", "-G", "Ninja", "-S", SOURCE / "tests" / "coupled" / "c_client", "-B", client, f"-DCMAKE_PREFIX_PATH={prefix}"],
                    ["cmake", "--build", client]):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            return report("installed library", f"{command}\n{done.stdout}{done.stderr}")
    slab("C program by the CMake package", client / "gas")
    pc = next(prefix.rglob("breakwave_coupling.pc"))
    text = pc.read_text(encoding="utf-8")
    paths = {name: value for name, value in re.findall(r"^(\w+)=(.*)$", text, re.M)}
    library = pathlib.Path(paths["libdir"].replace("${pcfiledir}", str(pc.parent)))
    include = pathlib.Path(paths["includedir"].replace("${libdir}", str(library)))
    there = (library / "libbreakwave_coupling.so").exists() and (include / "breakwave_coupling.h").exists()
    linked = subprocess.run(["ldd", client / "gas"], capture_output=True, text=True).stdout
    abi = re.search(r"#define FSI_ABI (\d+)", (include / "breakwave_coupling.h").read_text(encoding="utf-8")).group(1)
    report("name of the library", "" if f"libbreakwave_coupling.so.{abi} =>" in linked else linked)
    report("pkg-config file", "" if there and "-lbreakwave_coupling" in text else text)
    module = next(prefix.rglob("breakwave_coupling.py")).parent
    done = subprocess.run([PYTHON, "-c", "import breakwave_coupling as b; b._library(); print(b.version())"], cwd=module, capture_output=True, text=True)
    report("installed Python module", "" if done.returncode == 0 else done.stderr)


slab("Python", PYTHON, FLUIDS / "acoustic.py")
slab("Python, two ranks", PYTHON, FLUIDS / "acoustic.py", ranks=(1, 2))
curves()
blast()
failures()
from_the_text_alone()
installed()
sys.exit(launch.failed)
