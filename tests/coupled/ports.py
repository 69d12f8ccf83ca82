#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""csd and a fluid program, each started by an mpirun of its own, meet by a port file: the same bits as in one mpirun, in either order; what goes wrong.
    ports.py BUILD_FOLDER SOURCE_FOLDER FOLDER_FOR_RESULTS"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import launch
from launch import ENVIRONMENT, mpirun, report

BUILD, SOURCE, OUT = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
CSD, CFD, PYTHON, LIMIT = BUILD / "bin" / "csd", BUILD / "bin" / "cfd", "/usr/bin/python3", 5.0  # s from accident to end; below 2 on an idle machine
launch.work_in(OUT)


def case(name, *changes, join='join = "port"\nport_file = "port"\n'):
    text = (SOURCE / "run" / "cases" / "piston" / "case.toml").read_text(encoding="utf-8")
    text = re.sub(r'directory = ".*"', f'directory = "{name}"', text)
    for old, new in changes + (("[coupling]\n", "[coupling]\n" + join), ('end = "1 ms"', 'end = "0.2 ms"')):
        if old not in text:
            if old.startswith("end"):
                continue
            raise RuntimeError(f"{old} is not in the case")
        text = text.replace(old, new)
    pathlib.Path(f"{name}.toml").write_text(text, encoding="utf-8")
    return f"{name}.toml"


def start(ranks, *command, server=True):
    words = ["mpirun", *(["--ompi-server", "file:server"] if server else []), "-n", ranks, *command]
    return subprocess.Popen([str(w) for w in words], env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)


def end(process):
    """Exit code, text, and when it ended."""
    try:
        text = process.communicate(timeout=60)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return None, "hangs: " + process.communicate()[0], time.monotonic()
    return process.returncode, text, time.monotonic()


def history(name):
    return pathlib.Path(name, "solid_history.csv").read_bytes()


def meet(name, first, second, wait=0.0, stale=False):
    """Both end well, with the bits of the pair in one mpirun."""
    if stale:
        pathlib.Path("port").write_text("BWCOUPL 1\nhost localhost\ntcp 1\ntoken 0123456789abcdef\nmpi none\n")
    one = start(*first)
    time.sleep(wait)
    two = start(*second)
    ends = end(one), end(two)
    if any(code != 0 for code, *_ in ends):
        return report(name, f"exit codes {[code for code, *_ in ends]}\n{ends[0][1]}{ends[1][1]}")
    report(name, "other bits" if history("apart") != history("together") else "the port file is still there" if pathlib.Path("port").exists() else "")


def accident(name, victim, survivor):
    """One program is killed: the other, in an mpirun of its own, says so and ends."""
    pair = {program: start(1, BUILD / "bin" / program, case("long", ('end = "1 ms"', 'end = "1000 s"'))) for program in ("csd", "cfd")}
    while all(p.poll() is None for p in pair.values()) and not pathlib.Path("long/coupling_history.csv").exists():
        time.sleep(0.02)
    time.sleep(0.1)
    members = subprocess.run(["ps", "-o", "pid=,comm=", "-g", str(pair[victim].pid)], capture_output=True, text=True).stdout.split("\n")
    killed = time.monotonic()
    for line in members:
        if line.strip() and line.split()[1] == victim:
            os.kill(int(line.split()[0]), signal.SIGKILL)
    code, text, at = end(pair[survivor])
    end(pair[victim])
    shutil.rmtree("long", ignore_errors=True)
    said = re.search(rf"\[{survivor}\] error: FAILED in window \d+.*{victim} died without a word", text)
    report(f"{name}: exit code {code}, {at - killed:.2f} s", "" if code == 77 and said and at - killed < LIMIT else text)


server = subprocess.Popen(["ompi-server", "--no-daemonize", "-r", "server"])
try:
    while not pathlib.Path("server").exists():
        time.sleep(0.05)
    code, text = mpirun((1, CSD, case("together", join="")), (1, CFD, "together.toml"))
    report("in one mpirun", "" if code == 0 else text)
    file = case("apart")
    meet("solid first", (1, CSD, file), (1, CFD, file), wait=0.5, stale=True)
    meet("fluid first, an old port file is there, 2 ranks", (2, CFD, file), (1, CSD, file), wait=0.5, stale=True)
    accident("cfd killed", "cfd", "csd")
    accident("csd killed", "csd", "cfd")
    fluid = pathlib.Path("fluid.py")
    fluid.write_text(f"import sys\nsys.path.append('{SOURCE}/coupling/python')\nfrom breakwave_coupling import Fluid\n"
                     "with Fluid('py', p_ref=0.0, port_file='port') as fluid:\n    for s in fluid:\n"
                     "        if s.window == 3:\n            raise ValueError('no such thing')\n        fluid.send(s.t1_max, 1e5)\n", encoding="utf-8")
    one, two = start(1, CSD, file), start(1, PYTHON, fluid)
    (code, text, _), (other, said, _) = end(one), end(two)
    report(f"Python fluid that fails: exit codes {code}, {other}",
           "" if code == other == 1 and "py (rank 0) FAILED in window 3" in text and "ValueError: no such thing" in text else text + said)
    pathlib.Path("strange").write_text("hello\n")
    waiting = [(name, start(1, program, case(name, ("[coupling]\n", '[coupling]\njoin_limit = "1 s"\n'), join=f'join = "port"\nport_file = "{file}"\n')), said)
               for name, program, file, said in (
                   ("csd_alone", CSD, "nobody", "no fluid program came within 1 s"),
                   ("cfd_alone", CFD, "nowhere", r"no solid program was found by it \(there is no such file\) within 1 s"),
                   ("cfd_with_another_file", CFD, "strange", "it is no port file"))]
    for name, process, said in waiting:
        code, text, _ = end(process)
        report(f"{name}: exit code {code}", "" if code == 73 and re.search(said, text) else text)
    report("a port file that nobody came to", "is still there" if pathlib.Path("nobody").exists() else "")
finally:
    server.terminate()
    server.wait()
one, two = start(1, CSD, file, server=False), start(1, CFD, file, server=False)
ends = end(one), end(two)
report(f"without ompi-server: exit codes {ends[0][0]}, {ends[1][0]}",
       "" if ends[0][0] == ends[1][0] == 73 and "ompi-server --no-daemonize" in ends[1][1] and "the other program ended while" in ends[0][1] else ends[0][1] + ends[1][1])
sys.exit(launch.failed)
