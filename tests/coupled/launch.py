# SPDX-License-Identifier: Apache-2.0
"""What tests that start MPI share: mpirun's environment and a pair that is started and looked at."""
import csv
import os
import pathlib
import shutil
import subprocess

ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1",
                   OMPI_MCA_hwloc_base_binding_policy="none", OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_fcoll="dynamic_gen2",
                   OMP_WAIT_POLICY="passive", OMP_NUM_THREADS="1", BREAKWAVE_PROGRESS="off")


failed = False


def report(name, fault):
    """One line of a test: fault is empty, or says what is wrong."""
    global failed
    failed |= bool(fault)
    print(f"{'FAILED' if fault else 'ok':6} {name}  {fault}", flush=True)


def work_in(folder):
    """An empty folder, from here on the current one."""
    shutil.rmtree(folder, ignore_errors=True)
    pathlib.Path(folder).mkdir(parents=True)
    os.chdir(folder)


def mpirun(*programs, timeout=60):
    """(exit code, text) of (ranks, word, word, ...) started together; a run that hangs has no exit code."""
    words = ["mpirun"]
    for ranks, *command in programs:
        words += ([":"] if len(words) > 1 else []) + ["-n", str(ranks), *map(str, command)]
    try:
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=timeout)
    except subprocess.TimeoutExpired as hung:
        return None, f"hangs: {hung.stdout} {hung.stderr}"
    return done.returncode, done.stdout + done.stderr


def history(name):
    """Columns of a history table, by the name without its unit."""
    with open(name, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return {title.split(" [")[0]: [float(row[i]) for row in rows[1:]] for i, title in enumerate(rows[0])}
