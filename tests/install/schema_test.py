#!/usr/bin/python3
"""The shipped JSON Schemas: they are what the program prints, every shipped file names its own and keeps to it, and they refuse the
mistakes that a schema can see.

    schema_test.py HILCAM SOURCE
"""
import ast
import functools
import json
import pathlib
import re
import subprocess
import sys
import unittest

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
CONFIGS = SOURCE / "configs"
# A file's schema, and the section of `hilcam manual` that such a file holds.
SECTIONS = {
    "scenario": "",
    "campaign": "--campaign",
    "camera": "camera",
    "color_filter": "camera.color_filter",
    "quality": "quality",
    "materials": "objects.N.materials",
    "material": "objects.N.materials.surfaces.N.material",
}
# What a mistake of scenario_mistakes_test.cpp must be for a schema to see it: of keys, types, ranges, words. The others are about
# YAML itself, other files, times, or what keys are to each other.
VISIBLE = {
    "UnknownKey", "OtherUnit", "KeyMissing", "SectionMisspelt", "WordForNumber", "UnitInValue", "Percent",
    "FractionOfAPixel", "Negative", "TwoNumbers", "UnknownChoice", "FlagByWord", "SectionForList", "Nanometres", "NoOrigin",
}


class Yaml12(yaml.SafeLoader):
    """YAML 1.2's core schema, as editors and hilcam read it: 1e-3 is a number, off and dates are texts."""


Yaml12.yaml_implicit_resolvers = {}
for tag, pattern, first in (
        ("bool", r"true|false", "tf"),
        ("null", r"~|null|", "~n"),
        ("int", r"[-+]?[0-9]+", "-+0123456789"),
        ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", "-+.0123456789")):
    Yaml12.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), list(first) + ([""] if tag == "null" else []))


def read(text):
    return yaml.load(text, Yaml12)


@functools.cache
def validator(name):
    schema = json.loads((CONFIGS / f"schema/{name}.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def kind_of(path):
    if path.parent.name == "scenarios":
        return "scenario"
    if path.parent.name == "materials":
        return "materials" if path.name == "spacecraft.yaml" else "material"
    return {"cameras": "camera", "filters": "color_filter", "quality": "quality"}[path.parent.name]


class Schemas(unittest.TestCase):
    maxDiff = None

    def test_they_are_what_the_program_prints(self):
        for name, section in SECTIONS.items():
            printed = subprocess.run([HILCAM, "manual", *([section] if section else []), "--schema"], capture_output=True, text=True,
                                     check=True).stdout
            self.assertTrue((CONFIGS / f"schema/{name}.schema.json").read_text() == printed,
                            f"configs/schema/{name}.schema.json is another: hilcam manual {section} --schema > it")

    def test_every_shipped_file_names_its_schema_and_keeps_to_it(self):
        files = sorted(CONFIGS.glob("*/*.yaml"))
        self.assertGreater(len(files), 40)
        for path in files:
            first, name = path.read_text().split("\n", 1)[0], kind_of(path)
            self.assertEqual(first, f"# yaml-language-server: $schema=../schema/{name}.schema.json", path.name)
            errors = [f"{'.'.join(map(str, e.absolute_path))}: {e.message}" for e in validator(name).iter_errors(read(path.read_text()))]
            self.assertEqual(errors, [], path.name)

    def test_mistakes_that_a_schema_can_see_are_refused(self):
        source = (SOURCE / "tests/unit/emulator/scenario/scenario_mistakes_test.cpp").read_text()
        strings = r'((?:\s*"(?:[^"\\]|\\.)*")+)'
        base = ast.literal_eval("(" + re.search(r"kScenario =" + strings + ";", source)[1] + ")")
        table = re.findall(r'\{"(\w+)", (\d+),' + strings + ",", source)
        self.assertGreater(len(table), 40)
        check = validator("scenario")
        self.assertEqual(list(check.iter_errors(read(base))), [])
        found = set()
        for name, line, text in table:
            lines = base.split("\n")
            lines[int(line) - 1] = ast.literal_eval("(" + text + ")")
            try:
                document = read("\n".join(lines))
            except yaml.YAMLError:
                continue
            if not check.is_valid(document):
                found.add(name)
        self.assertEqual(sorted(VISIBLE - found), [], "not refused")

    def test_a_list_of_the_manual_has_every_key(self):
        keys = json.loads(subprocess.run([HILCAM, "manual", "--json"], capture_output=True, text=True, check=True).stdout)
        names = [k["key"] for k in keys]
        self.assertEqual(len(names), len(set(names)))
        # Folded in the table, not here.
        self.assertIn("more_cameras.N.camera.shutter.kind", names)
        shutter = next(k for k in keys if k["key"] == "camera.shutter.kind")
        self.assertEqual(shutter["kind"], "choice")
        self.assertIn("rolling", shutter["accepted"])
        one = subprocess.run([HILCAM, "manual", "camera.shutter"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(len(one.splitlines()), 2 + sum(n.startswith("camera.shutter") for n in names))
        wrong = subprocess.run([HILCAM, "manual", "camera.shuter"], capture_output=True, text=True)
        self.assertEqual((wrong.returncode, len(wrong.stderr.splitlines())), (2, 1), wrong.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
