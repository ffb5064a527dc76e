#!/usr/bin/python3
"""Tests are found from the unit: tests/units.md has a row for each unit of the program (a header with its source) and names tests of it.
And each unit test is part of a program.

    unit_tests_test.py            is the table whole and right? Prints what is not, and what a new unit's row would be.
    unit_tests_test.py --write    writes it anew.

A unit's tests are the one that bears its name, then those that include its header. Where there is neither, the row names tests that
reach it through other units: those of its room first, then those whose name begins as its own does, then the nearest. People may choose
others: --write keeps what stands there, as long as it is true. A test that starts the program may stand for any unit.
"""
import collections
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
TABLE = TOP / "tests/units.md"
LAYERS = ("emulator", "io", "sensor", "render")
MOST_NAMED, MOST_REACHED = 5, 3
IS_TEST = re.compile(r"^TEST(_F|_P)?\(|LLVMFuzzerTestOneInput|extremes\.h", re.MULTILINE)
HEAD = """# Units and their tests

Each row names tests of a unit, a header with its source: first the test that bears its name, then tests that include it, at most five.
Where there is neither, the tests reach it through other units and stand in brackets. Names are paths below `tests/`, those without an
ending below `tests/unit/`. `tests/layout/unit_tests_test.py` holds the table against the includes and writes it anew with `--write`; what
stands in brackets may be chosen by hand.
"""


def includes(path):
    """Those of ours; a name without a folder is that of a neighbour."""
    beside = path.relative_to(TOP).parent.as_posix()
    return [name if "/" in name else f"{beside}/{name}" for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE)]


def name_of(test):
    """Of a file below tests/, as the table has it."""
    if test.startswith("tests/unit/") and test.endswith(".cpp"):
        return test[len("tests/unit/"):-len(".cpp")]
    return test[len("tests/"):]


def path_of(name):
    return TOP / "tests" / (name if "." in name else f"unit/{name}.cpp")


def room_of(file):
    return file.rsplit("/", 1)[0]


def stem_of(file):
    return file.rsplit("/", 1)[1].split(".")[0]


class Tree:
    def __init__(self):
        files = [p for layer in LAYERS for p in (TOP / layer).rglob("*") if p.suffix in (".h", ".cpp")]
        self.includes = {p.relative_to(TOP).as_posix(): includes(p) for p in files + list((TOP / "tests").rglob("*.h"))}
        self.units = sorted({p.relative_to(TOP).with_suffix("").as_posix() for p in files}, key=lambda u: (room_of(u), u))
        self.tests = {p.relative_to(TOP).as_posix(): includes(p) for p in sorted((TOP / "tests").rglob("*.cpp")) if IS_TEST.search(p.read_text())}
        self.header = {unit: self.header_of(unit) for unit in self.units}
        self.sources = collections.defaultdict(list)
        for unit, header in self.header.items():
            self.sources[header] += [unit + ".cpp"] if unit + ".cpp" in self.includes else []
        self.direct = collections.defaultdict(list)
        for test, own in self.tests.items():
            for header in own:
                self.direct[header].append(test)
        self.steps = {test: self.steps_from(own) for test, own in self.tests.items()}

    def header_of(self, unit):
        """Its own, or the one of its room that declares what it defines: the first that it includes."""
        if unit + ".h" in self.includes:
            return unit + ".h"
        return next((h for h in self.includes[unit + ".cpp"] if room_of(h) == room_of(unit)), None)

    def steps_from(self, headers):
        """Headers that are reached, with how many steps it takes: who includes a header uses its sources, and what these include."""
        steps, edge = dict.fromkeys(headers, 1), list(headers)
        while edge:
            after = []
            for header in edge:
                for file in [header, *self.sources[header]]:
                    for further in self.includes.get(file, []):
                        if further not in steps:
                            steps[further] = steps[header] + 1
                            after.append(further)
            edge = after
        return steps

    def named(self, unit):
        """The test of that name, then those that include it; of these, the neighbours first."""
        own = [t for t in (f"tests/unit/{unit}_test.cpp",) if t in self.tests]
        far = lambda test: room_of(test) != f"tests/unit/{room_of(unit)}"
        direct = sorted(set(self.direct[self.header[unit]]) - set(own), key=lambda t: (far(t), t))
        return [name_of(t) for t in own + direct][:MOST_NAMED]

    def reached(self, unit):
        header, begin = self.header[unit], stem_of(unit).split("_")[0]
        far = lambda test: room_of(test) != f"tests/unit/{room_of(unit)}"
        order = sorted((far(t), begin not in stem_of(t).split("_"), steps[header], t) for t, steps in self.steps.items() if header in steps)
        return [name_of(t) for *_, t in order[:MOST_REACHED]]

    def reaches(self, name, unit):
        return name.endswith((".py", ".sh")) or self.header[unit] in self.steps.get(path_of(name).relative_to(TOP).as_posix(), {})


def forgotten():
    """Unit tests that are in no program: their folder and name stand in tests/CMakeLists.txt."""
    listed = (TOP / "tests/CMakeLists.txt").read_text()
    names = [p.relative_to(TOP / "tests/unit").as_posix() for p in sorted((TOP / "tests/unit").rglob("*_test.cpp"))]
    return [name for name in names if not re.search(rf"\s{re.escape(name.split('/', 1)[1])}\b", listed)]


def rows_of(text):
    """What the table says: tests by unit."""
    rows, room = {}, ""
    for line in text.splitlines():
        if line.startswith("## "):
            room = line[3:]
        match = re.fullmatch(r"\| `([a-z0-9_]+)` \| \(?(.*?)\)? \|", line)
        if match:
            rows[f"{room}/{match[1]}"] = re.findall(r"`([^`]+)`", match[2])
    return rows


def table(tree, old):
    lines, room = [HEAD], None
    for unit in tree.units:
        if room_of(unit) != room:
            room = room_of(unit)
            lines.append(f"{'' if lines[-1] == HEAD else chr(10)}## {room}\n\n| unit | tests |\n| --- | --- |")
        named = tree.named(unit)
        kept = [name for name in old.get(unit, []) if path_of(name).is_file() and tree.reaches(name, unit)]
        tests = ", ".join(f"`{name}`" for name in named or kept or tree.reached(unit))
        lines.append(f"| `{stem_of(unit)}` | {tests if named or not tests else f'({tests})'} |")
    return "\n".join(lines) + "\n"


def main():
    tree = Tree()
    was = TABLE.read_text() if TABLE.is_file() else ""
    now = table(tree, rows_of(was))
    if "--write" in sys.argv[1:]:
        TABLE.write_text(now)
        return 0
    named = sum(bool(tree.named(unit)) for unit in tree.units)
    untested = [unit for unit, tests in rows_of(now).items() if not tests]
    print(f"{len(tree.units)} units: {named} with a test of their name or that includes them, {len(untested)} without any test")
    for line in sorted(set(now.splitlines()) - set(was.splitlines())):
        print("tests/units.md lacks:", line)
    for line in sorted(set(was.splitlines()) - set(now.splitlines())):
        print("tests/units.md has what is not so:", line)
    for unit in untested:
        print(f"{unit}: no test reaches it")
    for name in forgotten():
        print(f"tests/unit/{name} is not in tests/CMakeLists.txt")
    if now != was:
        print("tests/layout/unit_tests_test.py --write writes it anew")
    return 1 if now != was or untested or forgotten() else 0


sys.exit(main())
