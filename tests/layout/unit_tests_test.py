#!/usr/bin/python3
"""Each unit of the program is reached by a test, and each unit test is part of a program.

    unit_tests_test.py           prints units that no test reaches, unit tests that no program has, and false lines of unit_tests.txt
    unit_tests_test.py FILE.md   also writes a table to FILE.md: tests by unit

A unit is a header with its source. Its tests are the one of its name, then those that include its header. A unit without either is
tested through other units: by the tests that unit_tests.txt names for it, then by those whose includes lead to its header.
"""
import collections
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
BY_HAND = TOP / "tests/layout/unit_tests.txt"
LAYERS = ("emulator", "io", "sensor", "render")
MOST_NAMED, MOST_REACHED = 5, 3
IS_TEST = re.compile(r"^TEST(_F|_P)?\(|LLVMFuzzerTestOneInput|extremes\.h", re.MULTILINE)
HEAD = """# Units and their tests

Each row names tests of a unit, which is a header with its source: first the test of its name, then tests that
include the header, at most five. Tests in brackets reach the unit through other units. Names are paths below
`tests/`; those without an ending are below `tests/unit/`. `tests/layout/unit_tests_test.py` makes this file.
"""


def includes(path):
    """Includes in quotes; a name without a folder is that of a neighbour."""
    beside = path.relative_to(TOP).parent.as_posix()
    return [name if "/" in name else f"{beside}/{name}" for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE)]


def name_of(test):
    """The name that the table has for a test's file."""
    if test.startswith("tests/unit/") and test.endswith(".cpp"):
        return test[len("tests/unit/"):-len(".cpp")]
    return test[len("tests/"):]


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
        """The unit's own header; without one, the first header of the same room that the source includes."""
        if unit + ".h" in self.includes:
            return unit + ".h"
        return next((h for h in self.includes[unit + ".cpp"] if room_of(h) == room_of(unit)), None)

    def steps_from(self, headers):
        """Steps to each header that a test reaches: including a header reaches its source, and what both include is one step further."""
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
        """The test of the unit's name, then tests that include its header, those of the same room first."""
        own = [t for t in (f"tests/unit/{unit}_test.cpp",) if t in self.tests]
        far = lambda test: room_of(test) != f"tests/unit/{room_of(unit)}"
        direct = sorted(set(self.direct[self.header[unit]]) - set(own), key=lambda t: (far(t), t))
        return [name_of(t) for t in own + direct][:MOST_NAMED]

    def reached(self, unit):
        """Tests that reach the unit through others: of the same room first, then with the same first word in the name, then the nearest."""
        header, begin = self.header[unit], stem_of(unit).split("_")[0]
        far = lambda test: room_of(test) != f"tests/unit/{room_of(unit)}"
        order = sorted((far(t), begin not in stem_of(t).split("_"), steps[header], t) for t, steps in self.steps.items() if header in steps)
        return [name_of(t) for *_, t in order[:MOST_REACHED]]


def forgotten():
    """Unit tests that no program of tests/CMakeLists.txt has."""
    listed = (TOP / "tests/CMakeLists.txt").read_text()
    names = [p.relative_to(TOP / "tests/unit").as_posix() for p in sorted((TOP / "tests/unit").rglob("*_test.cpp"))]
    return [name for name in names if not re.search(rf"\s{re.escape(name.split('/', 1)[1])}\b", listed)]


def by_hand():
    """What unit_tests.txt says: tests by unit."""
    tests, test = collections.defaultdict(list), ""
    for line in BY_HAND.read_text().splitlines():
        if line.startswith("    "):
            room, names = line.split(":")
            for name in names.split():
                tests[f"{room.strip()}/{name}"].append(test)
        elif not line.startswith("#"):
            test = line.strip()
    return tests


def false_lines(tree, hand):
    """Units of unit_tests.txt that are gone or need no line, and tests that are gone."""
    wrong = [f"{unit} is no unit" for unit in hand if unit not in tree.units]
    wrong += [f"{unit} has tests that include it" for unit in hand if unit in tree.units and tree.named(unit)]
    return wrong + [f"tests/{test} is not there" for test in sorted({t for tests in hand.values() for t in tests}) if not (TOP / "tests" / test).is_file()]


def table(tree, through):
    lines, room = [HEAD], None
    for unit in tree.units:
        if room_of(unit) != room:
            room = room_of(unit)
            lines.append(f"{'' if lines[-1] == HEAD else chr(10)}## {room}\n\n| unit | tests |\n| --- | --- |")
        named = tree.named(unit)
        tests = ", ".join(f"`{name}`" for name in named or through[unit])
        lines.append(f"| `{stem_of(unit)}` | {tests if named or not tests else f'({tests})'} |")
    return "\n".join(lines) + "\n"


def main():
    tree, hand = Tree(), by_hand()
    through = {unit: list(dict.fromkeys([name_of("tests/" + t) for t in hand.get(unit, [])] + tree.reached(unit)))[:MOST_REACHED] for unit in tree.units}
    if len(sys.argv) > 1:
        pathlib.Path(sys.argv[1]).write_text(table(tree, through))
    named = [unit for unit in tree.units if tree.named(unit)]
    faults = [f"{unit}: no test reaches it; tests/layout/unit_tests.txt may name one" for unit in tree.units if unit not in named and not through[unit]]
    faults += [f"tests/layout/unit_tests.txt: {line}" for line in false_lines(tree, hand)]
    faults += [f"tests/unit/{name} is not in tests/CMakeLists.txt" for name in forgotten()]
    print(f"{len(tree.units)} units: {len(named)} with a test of their name or that includes them; {len(faults)} faults")
    print("\n".join(faults))
    return 1 if faults else 0


sys.exit(main())
