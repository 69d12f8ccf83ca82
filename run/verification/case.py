# SPDX-License-Identifier: Apache-2.0
"""The list of cases, the rows they yield, and how they run the programs."""
import collections
import json
import math
import os
import pathlib
import re
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("BREAKWAVE_BUILD", ROOT / "build"))
WORK = BUILD / "verify"
Entry = collections.namedtuple("Entry", "name quick meaning run")
CASES = {}
FINEST = False  # --all: cases that refine add their finest mesh


class RunFailed(Exception):
    """A program ended with an error, or left something out."""


def case(name, quick=False):
    """Registers a generator of rows; its docstring's first line is the meaning."""
    def register(function):
        CASES[name] = Entry(name, quick, function.__doc__.strip().split("\n")[0], function)
        return function
    return register


def finest():
    """True where the finest meshes are asked for too."""
    return FINEST


# --- rows ---------------------------------------------------------------------------------------------------------------------------
def row(quantity, measured, reference, error, band, seconds=None):
    measured, error = float(measured), float(error)
    result = dict(quantity=quantity, measured=measured, reference=float(reference), error=error, band=float(band),
                  **{"pass": bool(math.isfinite(measured) and error <= band)})
    if seconds is not None:
        result["seconds"] = round(seconds, 2)
    return result


def close(quantity, measured, reference, band, seconds=None):
    """Relative error at most band."""
    return row(quantity, measured, reference, abs(measured - reference) / abs(reference), band, seconds)


def near(quantity, measured, reference, band, seconds=None):
    """Absolute error at most band."""
    return row(quantity, measured, reference, abs(measured - reference), band, seconds)


def at_most(quantity, measured, limit, seconds=None):
    """measured <= limit; the reference is 0."""
    return row(quantity, measured, 0, abs(measured), limit, seconds)


def at_least(quantity, measured, limit, seconds=None):
    return row(quantity, measured, limit, max(0.0, limit - measured), 0, seconds)


def between(quantity, measured, low, high, seconds=None):
    return row(quantity, measured, (low + high) / 2, abs(measured - (low + high) / 2), (high - low) / 2 * (1 + 1e-12), seconds)


# --- running ------------------------------------------------------------------------------------------------------------------------
Result = collections.namedtuple("Result", "directory seconds output code")


def run(name, text, ranks="1+1", threads=0, only=None, expect=0, words=()):
    """Runs a case given as text in build/verify/<name>; words: for the programs; returns its output folder, wall seconds and
    printed text."""
    work = WORK / re.sub(r"[^A-Za-z0-9_.-]", "_", name)
    out = work / "out"
    if out.exists():
        for path in sorted(out.rglob("*"), reverse=True):
            path.unlink() if path.is_file() else path.rmdir()
    out.mkdir(parents=True, exist_ok=True)
    file = work / "case.toml"
    file.write_text(text)
    command = [str(ROOT / "run" / "breakwave"), str(file), "--ranks", ranks, "--build", str(BUILD)]
    command += ["--threads", str(threads)] if threads else []
    command += ["--only", only] if only else []
    command += ["--", *words] if words else []
    start = time.monotonic()
    done = subprocess.run(command, cwd=work, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=3600)
    seconds = time.monotonic() - start
    (work / "log.txt").write_text(done.stdout)
    if done.returncode != expect:
        lines = [line for line in done.stdout.strip().split("\n") if line and not line.startswith(("run:", "cluster:", "     "))]
        tail = "\n".join(lines[-4:])
        raise RunFailed(f"{file} ended with {done.returncode}, not {expect}:\n{tail}")
    return Result(out, seconds, done.stdout, done.returncode)


def output(every_field="0", every_history="0", directory="out"):
    return f'[output]\ndirectory = "{directory}"\nfields_every = "{every_field}"\nhistory_every = "{every_history}"\nexact = true\n'


def unit_tests(room, pattern):
    """Runs GoogleTest cases; {test name: (passed, {recorded property: value}, seconds)}."""
    binary = BUILD / "bin" / f"unit_{room}"
    if not binary.exists():
        raise RunFailed(f"{binary} is missing: bash run/setup.sh --tests builds it")
    WORK.mkdir(parents=True, exist_ok=True)
    report = WORK / f"unit_{room}.json"
    report.unlink(missing_ok=True)
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    subprocess.run([str(binary), f"--gtest_filter={pattern}", f"--gtest_output=json:{report}"], stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL, env=environment, cwd=WORK)
    if not report.exists():
        raise RunFailed(f"{binary} --gtest_filter={pattern} ended without a report")
    known = {"name", "file", "line", "status", "result", "timestamp", "time", "classname", "failures", "value_param", "type_param"}
    tests = {}
    for suite in json.loads(report.read_text())["testsuites"]:
        for test in suite["testsuite"]:
            if test["status"] != "RUN":
                continue
            values = {key: value for key, value in test.items() if key not in known}
            tests[f"{suite['name']}.{test['name']}"] = ("failures" not in test, values, float(test["time"].rstrip("s")))
    if not tests:
        raise RunFailed(f"unit_{room} has no test {pattern}")
    return tests


def unit_rows(room, pattern, values=()):
    """Rows for the tests: recorded values named in `values` ({property: band} below which they must stay), else the count that failed."""
    tests = unit_tests(room, pattern)
    rows = []
    values = dict(values)
    for name, (_, recorded, seconds) in tests.items():
        for key, value in recorded.items():
            try:
                number = float(value)
            except (TypeError, ValueError):
                continue
            if key in values:
                rows.append(at_most(f"{name.split('.')[1]}: {key}", number, values[key], seconds))
    failures = [name for name, (passed, _, _) in tests.items() if not passed]
    rows.append(row(f"{len(tests)} unit tests {pattern}, failing", len(failures), 0, len(failures), 0, sum(t[2] for t in tests.values())))
    return rows
