# SPDX-License-Identifier: Apache-2.0
"""The rows of run/bench, by group."""
import os
import re
import statistics
import subprocess
import sys

from verification import fluid, fluid_levels, reference, solid
from verification.case import BUILD, ROOT, WORK, RunFailed, output, run

from . import precision, precision_flow
from .row import row

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402

CORES = len(os.sched_getaffinity(0))
THREADS = (1, CORES) if CORES > 1 else (1,)
MACHINE = {}


def build(target):
    done = subprocess.run(["cmake", "--build", str(BUILD), "--target", target], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        raise RunFailed(f"{target} could not be built:\n{done.stdout[-1500:]}")


def machine():
    """FMA peak and triad."""
    build("bench_machine")
    text = subprocess.run([str(BUILD / "bin" / "bench_machine")], check=True, stdout=subprocess.PIPE, text=True,
                          env=os.environ | {"OMP_NUM_THREADS": str(CORES)}).stdout
    MACHINE.update((key, float(value)) for key, value in (line.split() for line in text.splitlines()))
    rows = [row("fma_peak", MACHINE["fma_peak_1"], "GF/s"), row("triad", MACHINE["triad_1"], "GB/s")]
    if CORES > 1:
        rows += [row("fma_peak", MACHINE["fma_peak_all"], "GF/s", CORES), row("triad", MACHINE["triad_all"], "GB/s", CORES)]
    return rows


def rate(directory, program, wanted):
    """A rate of the summary, in millions a second."""
    rates = fields.summary(directory, program).get("rates", {})
    for name, value in rates.items():
        if wanted in name:
            return value / 1e6
    raise RunFailed(f"{program}_summary.json has no rate of {wanted}: {', '.join(rates)}")


# --- solid ------------------------------------------------------------------------------------------------------------------------------
def solid_rows(name, text):
    result = []
    for threads in THREADS:
        done = run(f"bench_{name}_{threads}", text, threads=threads, only="solid")
        result.append(row(name, rate(done.directory, "solid", "element"), "M element-steps/s", threads))
        result.append(row(f"{name}_best", rate(done.directory, "solid", "best_element"), "M element-steps/s", threads))
        last = done
    return result, last


def bar(steps, material=solid.COPPER, filter="off", across=8, along=80, extra=""):
    """The bar of S7, 15,360 elements; its foot keeps to the wall."""
    return (f"[time]\nend = \"80 us\"\nmax_steps = {steps}\n" + output("0 s", "1 us")
            + f'[[solid.body]]\nname = "bar"\nmesh = {{kind = "cylinder", radius = "3.2 mm", length = "32.4 mm", across = {across}, along = {along}}}\n'
            + 'velocity = [0.0, 0.0, "-227 m/s"]\n' + material + '[[solid.condition]]\nkind = "roller"\nnodes = "lower"\nnormal = [0.0, 0.0, 1.0]\n'
            + f'[solid.filter]\nkind = "{filter}"\n' + extra)


JOHNSON_COOK = 'material = {library = "copper OFHC"}\n'
# a hex with eight points: Jacobians, volume, step bound, forces 530; a point: cofactors 32, det A 14, root 29, J A 45, b 30, deviator 19, yield 14, force 36
ELASTIC_FLOP = 2300
# a cell of one gas, each done once: kernel 424 (slopes 105, the rest half step and three faces), primitives 20, update and step bound 14; counted
# with a number type that counts + - * / and roots: minima, comparisons and choices are left out, and so is what is done again for ghosts
AIR_FLOP = 458


def share_of_peak(name, rows):
    """Elastic operations alone over the machine's fused multiply-adds: a lower bound where there is flow. Best over best: the peak is the
    best of several tries, so the rate is that of the best quarter of a second."""
    return [peak_share(name, r["value"], ELASTIC_FLOP) for r in rows if r["threads"] == 1 and r["name"].endswith("_best")]


def peak_share(name, rate, flop):
    """rate [1e6/s] of something that takes `flop` operations."""
    return row(f"{name}_share_of_peak", rate * 1e-3 * flop / MACHINE["fma_peak_1"], "of FMA peak")


def taylor_j2():
    """Taylor bar of S7, J2, no filter; with the self-adjoint filter; two threads over two pinned copies with one"""
    result, _ = solid_rows("taylor_j2", bar(2000))
    filtered, _ = solid_rows("taylor_j2_filter", bar(2000, filter="self_adjoint"))
    return result + share_of_peak("taylor_j2", result) + filtered + copies("taylor_j2", bar(2000), "solid")


def copies(name, text, program, by_ranks=False):
    """As many copies as cores, each on its own core with one thread, at the same time; all threads in one run just after, and with by_ranks as many
    ranks: three times in turn, the medians."""
    if CORES < 2:
        return []
    environment = os.environ | dict(item.split("=", 1) for item in subprocess.run(
        [str(ROOT / "run" / "breakwave"), "--environment"], check=True, stdout=subprocess.PIPE, text=True).stdout.split())

    binary, item = ("csd", "element") if program == "solid" else ("cfd", "cell")

    def together():
        folders, running = [], []
        for core in sorted(os.sched_getaffinity(0)):
            work = WORK / f"bench_copy_{core}"
            work.mkdir(parents=True, exist_ok=True)
            (work / "case.toml").write_text(text)
            folders.append(work / "out")
            running.append(subprocess.Popen([str(BUILD / "bin" / binary), "case.toml", "--threads", "1"], cwd=work, env=environment,
                                            preexec_fn=lambda core=core: os.sched_setaffinity(0, {core}), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        if any([process.wait() for process in running]):
            raise RunFailed("a copy failed")
        return sum(rate(folder, program, item) for folder in folders)

    def shared(kind, **how):
        return rate(run(f"bench_copies_{kind}", text, only=program, **how).directory, program, item)
    kinds = {"threads": {"threads": CORES}} | ({"ranks": {"threads": 1, "ranks": str(CORES)}} if by_ranks else {})
    turns = [(together(), {kind: shared(kind, **how) for kind, how in kinds.items()}) for _ in range(3)]
    unit = "M element-steps/s" if program == "solid" else "M cell-updates/s"
    rows = [row(f"{name}_copies", statistics.median(all_copies for all_copies, _ in turns), unit, CORES)]
    for kind in kinds:
        threads, ranks = (CORES, 1) if kind == "threads" else (1, CORES)
        rows.append(row(f"{name}_{kind}_over_copies", statistics.median(rates[kind] / all_copies for all_copies, rates in turns), "ratio", threads, ranks))
    return rows


def taylor_jc():
    """The same bar, Johnson-Cook (OFHC copper), rate, temperature and heating"""
    return solid_rows("taylor_jc", bar(2000, JOHNSON_COOK))[0]


def taylor_seconds():
    """The whole bar to 80 us, wall seconds: one step for all elements, and local time steps"""
    result = []
    for name, extra in (("taylor_seconds", ""), ("taylor_seconds_local", "[solid.time_step]\nlevels = 3\n")):
        for threads in THREADS:
            done = run(f"bench_{name}_{threads}", bar(0, extra=extra), threads=threads, only="solid")
            result.append(row(name, fields.summary(done.directory, "solid")["wall_seconds"], "s", threads))
    return result


def block(steps, material, velocity):
    return (f"[time]\nend = \"1 s\"\nmax_steps = {steps}\n" + output("0 s", "1 s")
            + '[[solid.body]]\nname = "block"\nmesh = {kind = "box", lower = [0, 0, 0], upper = ["80 mm", "80 mm", "80 mm"], cells = [80, 80, 80]}\n'
            + f"velocity = {velocity}\n" + material
            + '[[solid.condition]]\nkind = "rigid_wall"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n')


def block_elastic():
    """A block of 512,000 elements, elastic"""
    elastic = 'material = {kind = "neo_hooke", density = "8930 kg/m^3", young_modulus = "117 GPa", poisson_ratio = 0.35}\n'
    result, _ = solid_rows("block_elastic", block(60, elastic, [0.0, 0.0, -1.0]))
    return result + share_of_peak("block_elastic", result)


def block_j2():
    """The same block, J2; bytes an element"""
    result, last = solid_rows("block_j2", block(60, solid.COPPER, [0.0, 0.0, -100.0]))
    summary = fields.summary(last.directory, "solid")
    return result + [row("bytes_per_element", summary["peak_memory_bytes"] / 512000, "B, peak of the process", THREADS[-1])]


# --- fluid ------------------------------------------------------------------------------------------------------------------------------
def ranks():
    """Ranks of one thread each, the bits of one rank: Taylor bar and a block of 64,000; share of exchange and waiting; memory of the first rank"""
    result = []
    cube_64k = ('[time]\nend = "1 s"\nmax_steps = 200\n' + output("0 s", "1 s")
                + '[[solid.body]]\nname = "block"\nmesh = {kind = "box", lower = [0, 0, 0], upper = ["40 mm", "40 mm", "40 mm"], cells = [40, 40, 40]}\n'
                + 'velocity = [0.0, 0.0, "-100 m/s"]\n' + solid.COPPER
                + '[[solid.condition]]\nkind = "roller"\nnodes = "z_lower"\nnormal = [0.0, 0.0, 1.0]\n')
    for name, text in (("taylor", bar(1000)), ("taylor_filter", bar(1000, filter="self_adjoint")), ("block_64k", cube_64k)):
        for n in THREADS:
            done = run(f"bench_ranks_{name}_{n}", text, ranks=str(n), threads=1, only="solid")
            summary = fields.summary(done.directory, "solid")
            result.append(row(f"ranks_{name}", rate(done.directory, "solid", "element"), "M element-steps/s", 1, n))
            result.append(row(f"ranks_{name}_memory", summary["peak_memory_bytes"] / 2**20, "MiB", 1, n))
            if n > 1:
                result.append(row(f"ranks_{name}_exchange", 100 * summary["values"]["exchange_share"], "%", 1, n))
    return result


def cube(n, steps, materials, regions):
    return (f"[time]\nend = \"1 s\"\nmax_steps = {steps}\n" + output("0 s", "1 s")
            + f"[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = [{n}, {n}, {n}]\n" + materials + regions)


def fluid_rows(name, text):
    return [row(name, rate(run(f"bench_{name}_{threads}", text, threads=threads, only="fluid").directory, "fluid", "cell"), "M cell-updates/s", threads)
            for threads in THREADS]


def busy(name, density):
    """Something going on in every block: a small random-like pattern of boxes in motion."""
    return "".join(fluid.region(f'{{kind = "box", lower = [{x!r}, {y!r}, {z!r}], upper = [{x + .25!r}, {y + .25!r}, {z + .25!r}]}}', name, density,
                                1e5 * (1 + 0.4 * ((i * 7 + 3) % 5)), [30.0 * ((i * 5) % 3 - 1), 20.0 * ((i * 3) % 4 - 2), 10.0 * (i % 3)])
                   for i, (x, y, z) in enumerate((x / 4, y / 4, z / 4) for x in range(4) for y in range(4) for z in range(4)))


def air_64():
    """Air, 64^3, every block busy; its operations over the machine's; two threads and two ranks over two pinned copies"""
    text = cube(64, 200, fluid.material("air", reference.GAS), busy("air", 1.2))
    rows = fluid_rows("air_64", text)
    return rows + [peak_share("air_64", rows[0]["value"], AIR_FLOP)] + copies("air_64", text, "fluid", by_ranks=True)


def air_128():
    """Air, 128^3, every block busy"""
    return fluid_rows("air_128", cube(128, 40, fluid.material("air", reference.GAS), busy("air", 1.2)))


def jwl_air_64():
    """Products and air side by side in every block, 64^3"""
    tnt = reference.JWL_SETS["TNT"]
    text = fluid.material("TNT", tnt) + fluid.material("air", reference.GAS)
    sheets = fluid.region('{kind = "everywhere"}', "air", 1.2, 1e5)
    for k in range(16):
        sheets += fluid.region(f'{{kind = "box", lower = [-1.0, -1.0, {(k + .25) / 16!r}], upper = [2.0, 2.0, {(k + .75) / 16!r}]}}', "TNT", 50.0, 1e5,
                               [100.0, 50.0 * (k % 3 - 1), 80.0 * (k % 2)])
    return fluid_rows("jwl_air_64", cube(64, 100, text, sheets))


def three_64():
    """Products, helium and air side by side in every block, 64^3"""
    text = fluid.material("TNT", reference.JWL_SETS["TNT"]) + fluid.material("helium", reference.IdealGas(1.67)) + fluid.material("air", reference.GAS)
    sheets = fluid.region('{kind = "everywhere"}', "air", 1.2, 1e5)
    for k in range(16):
        for name, density, low, high in (("TNT", 50.0, .1, .4), ("helium", 0.17, .4, .7)):
            sheets += fluid.region(f'{{kind = "box", lower = [-1.0, -1.0, {(k + low) / 16!r}], upper = [2.0, 2.0, {(k + high) / 16!r}]}}', name, density, 1e5,
                                   [100.0, 50.0 * (k % 3 - 1), 80.0 * (k % 2)])
    return fluid_rows("three_64", cube(64, 100, text, sheets))


def quiescent_share():
    """Cost of a block at rest over a busy block's"""
    air = fluid.material("air", reference.GAS)
    rest = run("bench_rest", cube(128, 200, air, fluid.region('{kind = "everywhere"}', "air", 1.2, 1e5)), threads=1, only="fluid")
    busy_run = run("bench_air_64_1", cube(64, 100, air, busy("air", 1.2)), threads=1, only="fluid")

    def per_cell_step(result, cells):
        summary = fields.summary(result.directory, "fluid")
        return step_seconds(summary) / summary["steps"] / cells
    return [row("quiescent_share", per_cell_step(rest, 128 ** 3) / per_cell_step(busy_run, 64 ** 3), "of a busy block")]


def amr_overhead():
    """A blast in air on 3 levels to 128^3: share of the step in ghosts and fluxes between levels, in looking and in changing the grid"""
    text = fluid_levels.with_levels(fluid_levels.blast_text(128, 4e-4), 2, [128] * 3).replace("block = 8", "block = 16")
    rows = []
    for threads in THREADS:
        summary = fields.summary(run(f"bench_levels_{threads}", text, threads=threads, only="fluid").directory, "fluid")
        rows += [row("amr_overhead", summary["values"]["levels_share"], "of the step", threads),
                 row("amr_rate", summary["rates"]["cell_updates_per_second"] / 1e6, "M cell-updates/s", threads)]
    return rows


def step_seconds(summary):
    """Seconds of the timer called "step", wherever it stands."""
    def walk(timers):
        for name, timer in timers.items():
            if name == "step":
                return timer["seconds"]
            inside = walk(timer.get("inside", {}))
            if inside is not None:
                return inside
        return None
    seconds = walk(summary["timers"])
    return seconds if seconds is not None else summary["wall_seconds"]


# --- wall -------------------------------------------------------------------------------------------------------------------------------
def moving_sphere_overhead():
    """A sphere that moves through 64^3 busy cells: extra time over no body"""
    air = fluid.material("air", reference.GAS)
    base = cube(64, 100, air, busy("air", 1.2))
    body = ('[[fluid.body]]\nname = "ball"\nshape = {kind = "sphere", centre = [0.5, 0.5, 0.5], radius = 0.2}\n'
            'motion = {kind = "velocity", value = [30.0, 20.0, 10.0]}\n')
    seconds = [step_seconds(fields.summary(run(f"bench_{name}", text, threads=1, only="fluid").directory, "fluid"))
               for name, text in (("no_sphere", base), ("sphere", base + body))]
    return [row("moving_sphere_overhead", seconds[1] / seconds[0] - 1, "of the run without it")]


def geometry_share_200k():
    """Two balls of 98,304 quads each moving through 216^3 cells, all busy: share of the step in cutting the grid and in covered and uncovered cells"""
    air = fluid.material("air", reference.GAS)
    balls = "".join(f'[[fluid.body]]\nname = "ball{i}"\nfacet = 1e-4\nshape = {{kind = "sphere", centre = [{x}, 0.5, 0.5], radius = 0.2}}\n'
                    f'motion = {{kind = "velocity", value = [{v}, 20.0, 10.0]}}\n' for i, (x, v) in enumerate(((0.25, 30.0), (0.75, -30.0))))
    rows = []
    for threads in THREADS:
        timers = fields.summary(run(f"bench_balls_{threads}", cube(216, 6, air, busy("air", 1.2)) + balls, threads=threads, only="fluid").directory, "fluid")["timers"]
        geometry = timers["walls"]["seconds"] + timers["covered and uncovered cells"]["seconds"]
        rows.append(row("geometry_share_200k", geometry / (geometry + timers["flow"]["seconds"]), "of the step", threads))
    return rows


# --- coupling ---------------------------------------------------------------------------------------------------------------------------
def exchange(faces, ranks=1):
    build("bench_exchange")
    binary = str(BUILD / "bin" / "bench_exchange")
    line = subprocess.run([str(ROOT / "run" / "breakwave"), "--environment"], check=True, stdout=subprocess.PIPE, text=True).stdout
    environment = os.environ | dict(item.split("=", 1) for item in line.split())
    done = subprocess.run(["mpirun", "-n", str(ranks), binary, "solid", str(faces), ":", "-n", str(ranks), binary, "fluid", str(faces)], env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    values = {}
    for text in done.stdout.splitlines():
        parts = text.split()
        if len(parts) == 2 and parts[0] in ("geometry_ms", "geometry_best_ms", "full_ms", "full_best_ms", "wait_cpu_share", "late_ms"):
            values[parts[0]] = float(parts[1])
    if done.returncode or len(values) != 6:
        raise RunFailed(f"bench_exchange: {done.stdout[-400:]}")
    return values


def exchange_20k_ms():
    """One exchange of 20,000 faces, geometry only and full, each also of the fastest window; processor share of the side that waits"""
    values = exchange(20000)
    return [row("exchange_20k_ms", values["geometry_ms"], "ms", 1, 2), row("exchange_20k_best_ms", values["geometry_best_ms"], "ms", 1, 2),
            row("exchange_20k_full_ms", values["full_ms"], "ms", 1, 2), row("exchange_20k_full_best_ms", values["full_best_ms"], "ms", 1, 2),
            row("wait_cpu_share", values["wait_cpu_share"], "of a core", 1, 2)]


def exchange_after_nap_ms():
    """20,000 faces, a fluid that sleeps for 0.4 s in each window: from its waking to all ranks of the solid; 1+1, 2+2"""
    return [row("exchange_after_nap_ms", exchange(20000, ranks)["late_ms"], "ms", 1, 2 * ranks) for ranks in (1, 2)]


def exchange_200k_ms():
    """The same, 200,000 faces"""
    values = exchange(200000)
    return [row("exchange_200k_ms", values["full_ms"], "ms", 1, 2), row("exchange_200k_best_ms", values["full_best_ms"], "ms", 1, 2),
            row("exchange_200k_geometry_ms", values["geometry_ms"], "ms", 1, 2)]


def exchange_share(size, end, with_start):
    """Seconds of the weapon's run to `end`, with or without its start up to the fluid's first answer; of them those of messages (each window as dear as
    one with new connectivity, or as the run's own sends if they took longer) and of surface, forces and books of the interface; faces"""
    text = (ROOT / "run" / "cases" / "weapon" / f"{size}.toml").read_text()
    done = run(f"bench_weapon_{size}", re.sub(r'"run/out/weapon\w*"', '"out"', text), words=("--end", end))
    summary = fields.summary(done.directory, "solid")
    timers, fluid_timers = summary["timers"], fields.summary(done.directory, "fluid")["timers"]
    waited = fields.history(done.directory / "coupling_history.csv")["waited"]
    faces = int(re.search(r"faces +(\d+) at the end", done.output).group(1))
    seconds = done.seconds if with_start else summary["wall_seconds"] - timers["handshake"]["seconds"] - waited[0]
    sending = timers["send surface"]["seconds"] + fluid_timers["send loads"]["seconds"]
    messages = max(1e-3 * exchange(faces)["full_ms"] * len(waited), sending)
    return seconds, messages, timers["surface"]["seconds"] + timers["ledger"]["seconds"], faces


def exchange_share_weapon():
    """The weapon at demo size to 60 us: share of messages, surface, forces and books of the interface in the wall time"""
    seconds, messages, apply, faces = exchange_share("case", "60 us", with_start=True)
    return [row("exchange_share_weapon", (messages + apply) / seconds, f"of the run, {faces} faces", CORES, 2),
            row("exchange_share_messages", messages / seconds, "of the run", CORES, 2)]


def exchange_share_paper():
    """The same at the paper's size to 8 us, without its start"""
    seconds, messages, apply, faces = exchange_share("paper", "8 us", with_start=False)
    return [row("exchange_share_paper", (messages + apply) / seconds, f"of the run, {faces} faces", CORES, 2),
            row("exchange_share_paper_messages", messages / seconds, "of the run", CORES, 2)]


GROUPS = {"solid": [taylor_j2, taylor_jc, taylor_seconds, block_elastic, block_j2, ranks], "fluid": [air_64, air_128, jwl_air_64, three_64, quiescent_share, amr_overhead],
          "wall": [moving_sphere_overhead, geometry_share_200k], "coupling": [exchange_20k_ms, exchange_after_nap_ms, exchange_200k_ms, exchange_share_weapon, exchange_share_paper], "precision": precision.MAKERS + precision_flow.FLUID + precision_flow.WALL}
STUDIES = {"solid": precision.MAKERS, "fluid": precision_flow.FLUID, "wall": precision_flow.WALL}  # of precision, by room
