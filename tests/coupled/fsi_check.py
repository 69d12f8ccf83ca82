#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""fsi-check on csd, cfd and the Python fluids, and on fluids with a typical mistake, which it must find.

fsi_check.py <build folder> <source folder> <folder for results> [all: every scenario of the Python fluid too]
"""
import pathlib
import re
import subprocess
import sys

BUILD, SOURCE, OUT = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
ALL = sys.argv[4:] == ["all"]
OUT.mkdir(parents=True, exist_ok=True)
PYTHON, FLUIDS = "/usr/bin/python3", SOURCE / "run" / "fluids"
LIMIT = ["--limit", "5"]  # s; below 2 on an idle machine
failed = False


def check(name, play, program, *options, wrong=()):
    """All scenarios as expected, but those of `wrong`: these and no others must be found."""
    global failed
    done = subprocess.run([str(w) for w in (BUILD / "bin" / "fsi-check", "--play", play, *LIMIT, *options, "--", *program)], capture_output=True, text=True)
    verdicts = {scenario: verdict for verdict, scenario in re.findall(r"^(ok|FAILED) +(\w+)", done.stdout, re.M)}
    found = {scenario for scenario, verdict in verdicts.items() if verdict == "FAILED"}
    bad = found != set(wrong) or not verdicts or (done.returncode == 0) != (not wrong)
    failed |= bad
    print(f"{'FAILED' if bad else 'ok':6} {name}: {len(verdicts)} scenarios, found wanting: {', '.join(sorted(found)) or 'none'}", flush=True)
    if bad:
        print(done.stdout + done.stderr)


GAS = f"""
[time]
end = "1 s"
[output]
directory = "{OUT}"
[fluid]
lower = [0, 0, 0]
upper = [1, 1, 1]
cells = [16, 16, 16]
[[fluid.material]]
name = "air"
library = "air"
[[fluid.region]]
shape = {{kind = "everywhere"}}
material = "air"
density = "1.225 kg/m^3"
pressure = "101325 Pa"
"""
(OUT / "gas.toml").write_text(GAS, encoding="utf-8")
plate = (SOURCE / "run" / "cases" / "plate" / "case.toml").read_text(encoding="utf-8").replace("run/out/plate", str(OUT))
(OUT / "plate.toml").write_text(plate, encoding="utf-8")
(OUT / "far.toml").write_text('[fluid.charge]\ncentre = [0, 0, 5]\nmass = "1 kg"\n', encoding="utf-8")
check("cfd", "solid", [BUILD / "bin" / "cfd", OUT / "gas.toml"])
check("csd", "fluid", [BUILD / "bin" / "csd", OUT / "plate.toml"])
(OUT / "apart.toml").write_text(GAS + f'[coupling]\njoin = "port"\nport_file = "{OUT}/port"\n', encoding="utf-8")
check("cfd by a port", "solid", [BUILD / "bin" / "cfd", OUT / "apart.toml"], "--port", OUT / "port", *([] if ALL else ["--only", "turned,nan,death"]))
(OUT / "beside.toml").write_text(plate + '[coupling]\nscheme = "concurrent"\n' if "[coupling]" not in plate else
                                 plate.replace("[coupling]\n", '[coupling]\nscheme = "concurrent"\n'), encoding="utf-8")
check("csd, concurrent", "fluid", [BUILD / "bin" / "csd", OUT / "beside.toml"], "--scheme", "concurrent", "--only", "rest,push,short_windows,stop,ranks_2,nan")
check("acoustic.py", "solid", [PYTHON, FLUIDS / "acoustic.py"], *([] if ALL else ["--only", "piston,split,fixed_window,degenerate,empty,vanish,ranks_2,nan,fail"]))
check("airblast.py before the blast arrives", "solid", [PYTHON, FLUIDS / "airblast.py", OUT / "far.toml"], "--only",
      "rest,degenerate,empty,vanish,short_windows")

for name, pressure, wrong in (
        ("gauge pressure", "1.225 * 340.3 * speed", {"rest", "piston", "split"}),
        ("normal into the solid", "101325 - 1.225 * 340.3 * speed", {"piston", "split"}),
        ("kilopascal", "101.325 + 1e-3 * 1.225 * 340.3 * speed", {"rest", "piston", "split"}),
        ("order of the first surface", "first if len(speed) == len(first) else numpy.resize(first, len(speed))", {"split"})):
    program = OUT / "wrong.py"
    program.write_text(f"import sys\nsys.path.append('{SOURCE}/coupling/python')\nimport numpy\nfrom breakwave_coupling import Fluid\nfirst = None\n"
                       "with Fluid('wrong') as fluid:\n    for s in fluid:\n"
                       "        speed = (s.wall_velocity(s.t1_max) * s.normal).sum(axis=1)\n"
                       "        first = 101325 + 1.225 * 340.3 * speed if first is None else first\n"
                       f"        fluid.send(s.t1_max, {pressure})\n", encoding="utf-8")
    check(f"a fluid with a mistake, {name}", "solid", [PYTHON, program], "--only", "rest,piston,split,t_end", wrong=wrong)
sys.exit(failed)
