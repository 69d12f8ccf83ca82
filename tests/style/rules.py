#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Rules of the source tree that a compiler does not see. Exit 1 and one line per offence: file:line: rule.

- common <- coupling <- {csd, cfd}; csd and cfd never see each other
- kernel headers (material, element, eos, mix, scheme, wall treatment) see common/math and their own room's concepts only
- OpenMP pragmas in common/parallel only; MPI calls in common and coupling only
- no bare std::cout, std::cerr, printf or exit outside the programs' main and common/app
- the SPDX line comes first; no #ifdef of a feature
File and function lengths are reported (build/lengths.md), not enforced.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOMS = ["common", "coupling", "csd", "cfd"]
MAY_SEE = {"common": {"common"}, "coupling": {"common", "coupling"}, "csd": {"common", "coupling", "csd"},
           "cfd": {"common", "coupling", "cfd"}}
# folder of kernels -> folders that its headers may include, besides common/math
KERNELS = {"csd/material": {"csd/material"}, "csd/element": {"csd/element", "csd/material"},
           "cfd/eos": {"cfd/eos"}, "cfd/mix": {"cfd/mix", "cfd/eos"}, "cfd/scheme": {"cfd/scheme", "cfd/mix", "cfd/eos"}}
# headers in those folders that run kernels over blocks, and are none themselves
DRIVERS = {"csd/element/blocks.h", "csd/element/elements.h", "csd/element/lanes.h", "csd/element/filter.h", "csd/element/results.h",
           "csd/element/resting.h", "csd/element/time_step.h"}
PLAIN_DATA = {"cfd/amr/patch.h"}  # layouts without behaviour, which kernels may see too
SOURCE = (".h", ".cpp")


def sources(*folders):
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in SOURCE and path.is_file():
                yield path


def room_of(path):
    return path.relative_to(ROOT).parts[0]


def strip_comments(text):
    """Code only; comments and strings become blanks, so that line numbers stay."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group(0))
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def check(path):
    relative = path.relative_to(ROOT)
    text = path.read_text(encoding="utf-8")
    lines = text.split("\n")
    code = strip_comments(text).split("\n")
    room, folder = room_of(path), relative.parent.as_posix()
    if lines[0] != "// SPDX-License-Identifier: Apache-2.0":
        yield 1, "the first line must be '// SPDX-License-Identifier: Apache-2.0'"
    kernel = KERNELS.get(folder) if path.suffix == ".h" and relative.as_posix() not in DRIVERS else None
    for number, (line, bare) in enumerate(zip(lines, code), 1):
        include = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', line)
        if include and room in MAY_SEE:
            target = include.group(2)
            if include.group(1) == '"' and target.split("/")[0] not in MAY_SEE[room]:
                yield number, f"{room} must not see {target}"
            if kernel is not None and include.group(1) == '"':
                seen = pathlib.PurePosixPath(target).parent.as_posix()
                if target in DRIVERS:
                    yield number, f"a kernel header must not see {target}"
                elif seen != "common/math" and seen not in kernel and target not in PLAIN_DATA:
                    yield number, f"a kernel header of {folder} sees common/math and {', '.join(sorted(kernel))} only, not {target}"
            if kernel is not None and target in ("mpi.h", "omp.h", "hdf5.h", "iostream", "cstdio"):
                yield number, f"a kernel header must not see <{target}>"
            if target == "omp.h" and room != "common":
                yield number, "OpenMP belongs to common"
        if room not in MAY_SEE:
            continue
        if re.match(r"\s*#\s*pragma\s+omp\s+(?!simd)", line) and folder != "common/parallel":
            yield number, "OpenMP pragmas belong to common/parallel"
        if re.search(r"\bMPI_[A-Z][a-z_]+\s*\(", bare) and room not in ("common", "coupling"):
            yield number, "MPI calls belong to common and coupling"
        if folder != "common/app" and path.name != "main.cpp":
            if re.search(r"\bstd::(cout|cerr)\b|(?<![\w:.])(printf|puts)\s*\(|\bstd::(printf|puts)\s*\(", bare):
                yield number, "print through common/app, not std::cout or printf"
            if re.search(r"(?<![\w.:>])(std::)?(exit|abort|_Exit|quick_exit)\s*\(", bare):
                yield number, "throw an error of common/app/error.h instead of ending the program"
        if re.match(r"\s*#\s*(ifdef|ifndef|if\s+!?\s*defined)\b(?!.*__)", line) and not re.search(r"SOURCE_DIR|NDEBUG", line):
            yield number, "no feature #ifdef: a model is chosen by the input"


def function_lengths(path):
    """Rough: a body is what stands between a line that ends in '{' at depth of namespace or class and its '}'."""
    depth, stack = 0, []
    for number, line in enumerate(strip_comments(path.read_text(encoding="utf-8")).split("\n"), 1):
        opens = re.search(r"\)\s*(const|noexcept|override|->[^{]*|\s)*\{\s*$", line)
        for character in line:
            if character == "{":
                depth += 1
                stack.append((number, bool(opens) and not re.match(r"\s*(if|for|while|switch|else|do)\b", line), line.strip()))
            elif character == "}" and stack:
                depth -= 1
                start, is_function, head = stack.pop()
                if is_function and number - start > 0 and not any(s[1] for s in stack):
                    yield number - start + 1, start, head


def main():
    offences = 0
    for path in sources(*ROOMS, "tests", "run"):
        for line, rule in check(path):
            offences += 1
            print(f"{path.relative_to(ROOT)}:{line}: {rule}")
    for path in [p for folder in ("run", "tests", ".ci") for p in sorted((ROOT / folder).rglob("*")) if p.is_file()]:
        if path.suffix in (".md", ".cmake", ".toml", ".py", ".sh") and re.search(r"^(<{7} |>{7} )", path.read_text(encoding="utf-8"), re.M):
            offences += 1
            print(f"{path.relative_to(ROOT)}: a merge was left half done")
        if path.suffix in (".sh", ".py") or path.relative_to(ROOT).as_posix() in ("run/verify", "run/bench", "run/breakwave", ".ci/run"):
            head = path.read_text(encoding="utf-8").split("\n")[:2]
            if "# SPDX-License-Identifier: Apache-2.0" not in head:
                offences += 1
                print(f"{path.relative_to(ROOT)}:2: the SPDX line must stand in the first two lines")
    files = [(len(p.read_text(encoding="utf-8").split("\n")) - 1, p) for p in sources(*ROOMS)]
    functions = sorted(((n, p, start, head) for _, p in files for n, start, head in function_lengths(p)), key=lambda f: f[:3], reverse=True)
    report = ["# Lengths (aims: files about 400 lines, functions 60, kernels 120)", "", "| lines | file |", "|---|---|"]
    report += [f"| {n} | {p.relative_to(ROOT)} |" for n, p in sorted(files, reverse=True)[:25]]
    report += ["", "| lines | function | |", "|---|---|---|"]
    report += [f"| {n} | {p.relative_to(ROOT)}:{start} | `{head[:90]}` |" for n, p, start, head in functions[:25]]
    (ROOT / "build").mkdir(exist_ok=True)
    (ROOT / "build" / "lengths.md").write_text("\n".join(report) + "\n", encoding="utf-8")
    counts = sorted(n for n, _ in files) or [0]
    lengths = sorted(f[0] for f in functions) or [0]
    print(f"{len(files)} files, median {counts[len(counts) // 2]}, longest {counts[-1]} lines; "
          f"{len(functions)} functions of several lines, {sum(n > 60 for n in lengths)} over 60, longest {lengths[-1]} (build/lengths.md)")
    if offences:
        print(f"{offences} offences")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
