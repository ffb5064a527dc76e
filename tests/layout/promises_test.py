#!/usr/bin/python3
"""Each promise of the interfaces has an id of its own and a test that is there.

A promise is an item of a page's list, which ends with its test: - **ABC-001** sentence `file` `Suite.Test`. The file is below
tests; it has as much of its path as tells it from others of its name. In Python, Suite is the class.
"""
import ast
import pathlib
import re
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PAGES = tuple(f"docs/{page}.md" for page in ("protocol", "genicam", "ptp", "packets", "shared_memory", "recording", "truth"))
ITEM = re.compile(r"^- \*\*([A-Z]+-\d+)\*\*((?:.|\n(?=  \S))*)", re.MULTILINE)
TEST = re.compile(r"^ (\S.*\S)\s+`([\w./]+)`\s+`(\w+)\.(\w+)`$", re.DOTALL)


def promises(text):
    """(id, file, suite, test) of each item; file None: the item has another form."""
    for name, rest in ITEM.findall(text):
        found = TEST.match(rest)
        yield (name, *found.groups()[1:]) if found else (name, None, None, None)


def has_test(path, suite, test):
    text = path.read_text()
    if path.suffix == ".cpp":
        return re.search(rf"^TEST(_F|_P)?\(\s*{suite},\s*{test}\)", text, re.MULTILINE) is not None
    classes = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ClassDef) and node.name == suite)
    return any(isinstance(part, ast.FunctionDef) and part.name == test for node in classes for part in node.body)


def faults_of(text, tests):
    """A line for each promise that nothing holds, and for each id that is there twice."""
    faults, ids = [], set()
    for name, file, suite, test in promises(text):
        if name in ids:
            faults.append(f"{name}: is there twice")
        ids.add(name)
        paths = sorted(tests.rglob(file)) if file else []
        if file is None:
            faults.append(f"{name}: found another form than - **id** promise `file` `Suite.Test`")
        elif len(paths) != 1:
            faults.append(f"{name}: {len(paths)} files below tests are named {file}; accepted: 1")
        elif not has_test(paths[0], suite, test):
            faults.append(f"{name}: {file} has no {suite}.{test}")
    return faults


class Promises(unittest.TestCase):
    def test_each_has_its_test(self):
        text = "\n".join((SOURCE / page).read_text() for page in PAGES)
        self.assertEqual(faults_of(text, SOURCE / "tests"), [])
        self.assertGreater(len(list(promises(text))), 40)

    def test_each_page_has_some(self):
        for page in PAGES:
            self.assertTrue(list(promises((SOURCE / page).read_text())), page)

    def test_what_is_wrong_is_found(self):
        def item(name, test):
            return f"- **{name}** A promise\n  of two lines.\n  {test}\n"

        good = "`promises_test.py` `Promises.test_each_has_its_test`"
        self.assertEqual(faults_of(item("AB-1", good), SOURCE / "tests"), [])
        for text, fault in ((item("AB-1", good) + item("AB-1", good), "AB-1: is there twice"),
                            (item("AB-1", "a test"), "AB-1: found another form"),
                            (item("AB-1", "`none.cpp` `A.B`"), "AB-1: 0 files"),
                            (item("AB-1", "`promises_test.py` `Promises.test_none`"), "has no Promises.test_none"),
                            (item("AB-1", "`promises_test.py` `Other.test_each_has_its_test`"), "has no Other."),
                            (item("AB-1", "`command_codec_test.cpp` `Crc16.IsNothing`"), "has no Crc16.IsNothing")):
            self.assertIn(fault, "\n".join(faults_of(text, SOURCE / "tests")))


if __name__ == "__main__":
    unittest.main(verbosity=2)
