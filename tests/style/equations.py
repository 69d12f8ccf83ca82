#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Where each equation of the paper stands in the code: reads tags such as `eq (8)`, `eqs (4)-(5)`, `Box 1` in comments and writes
build/equations.md. Exit 1 if an equation that the programs claim has no tag."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EQUATIONS = {
    1: "stored energy W = U(J) + W_bar(be_bar)", 2: "volumetric part U(J)", 3: "isochoric part W_bar", 4: "Kirchhoff stress tau = J p I + s",
    5: "pressure from U'(J)", 6: "deviator s = mu dev be_bar", 7: "yield condition", 8: "hardening sigma_Y + K alpha",
    9: "flow rule", 10: "rate of the equivalent plastic strain", 11: "Kuhn-Tucker conditions", 12: "consistency", 13: "return to the yield surface",
    14: "equation of motion M a = f_ext - f_int", 15: "internal force", 16: "node disconnection", 17: "Mott's fragment width",
    18: "travelling pressure front"}
NOT_YET = {17}  # belongs to the Mott rings, which are not built yet


def tags(line):
    comment = re.search(r"//(.*)", line)
    if not comment:
        return
    text = comment.group(1)
    if re.search(r"\bBox 1\b", text):
        yield "Box 1"
    for match in re.finditer(r"\beqs?\.?\s*((?:\(\d+\)(?:\s*(?:-|–|,|and|to)\s*)?)+)", text):
        part = match.group(1)
        for first, last in re.findall(r"\((\d+)\)\s*(?:-|–|to)\s*\((\d+)\)", part):
            yield from range(int(first), int(last) + 1)
        yield from (int(n) for n in re.findall(r"\((\d+)\)", part))


def main():
    places = {}
    for folder in ("coupling", "csd", "cfd"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            lines = path.read_text(encoding="utf-8").split("\n")
            for number, line in enumerate(lines, 1):
                for tag in tags(line):
                    places.setdefault(tag, []).append((path.relative_to(ROOT).as_posix(), number, line.strip()))
    report = ["# Equations of the paper in the code (made by tests/style/equations.py)", "", "| equation | what | where |", "|---|---|---|"]
    missing = []
    for tag, what in [*EQUATIONS.items(), ("Box 1", "the coupled loop")]:
        found = places.get(tag, [])
        unique = list(dict.fromkeys(f"{path}:{number}" for path, number, _ in found))
        report.append(f"| {tag} | {what} | {', '.join(unique) or '**missing**' if tag not in NOT_YET or unique else 'not built yet'} |")
        if not found and tag not in NOT_YET:
            missing.append(str(tag))
    unknown = [f"{place[0]}:{place[1]}: no equation ({tag}) in the paper" for tag, found in places.items() if tag != "Box 1" and tag not in EQUATIONS
               for place in found]
    (ROOT / "build").mkdir(exist_ok=True)
    (ROOT / "build" / "equations.md").write_text("\n".join(report) + "\n", encoding="utf-8")
    print("\n".join(unknown + ([f"no tag for: {', '.join(missing)}"] if missing else [])) or "every equation has its place (build/equations.md)")
    return 1 if missing or unknown else 0


if __name__ == "__main__":
    sys.exit(main())
