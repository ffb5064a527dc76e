#!/usr/bin/python3
"""A camera with another's face (docs/camera_face.md), as Aravis and GStreamer see it.

    face_test.py HILCAM [--all] [--only NAME] [tests ...]

Without --all: two small descriptions of the tests' own, and bad input. --all: also every description in ../shared/data/genicam
(17 of real cameras, which are not shipped), with a table of what was found. Skips what is not there.
"""
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile

from bench import SOURCE, Emulator, tool

sys.path.insert(0, str(SOURCE / "tools"))
from camera_face.commands import bound, camera_values  # noqa: E402
from camera_face.description import Description, DescriptionError  # noqa: E402
from camera_face.formula import Formula, FormulaError  # noqa: E402
from camera_face.roles import Camera  # noqa: E402

OWN = pathlib.Path(__file__).parent / "face"
REAL = SOURCE.parent / "shared/data/genicam"
HERE = pathlib.Path(__file__).parent
BIND = SOURCE / "tools/hilcam-camera-face"
SCENARIO = SOURCE / "tests/protocol/gige/face/scenario.yaml"
HILCAM = sys.argv[1]
ADDRESS = "127.0.23.30"
# Sensors that a description itself tells, by which it limits the window; the others take any.
SENSORS = {"TIS_dmk_33GX174": (1920, 1200), "FLIR_A35": (320, 256), "JAI_RM-6740GE": (640, 480), "FLIR_SC6700": (640, 512),
           "Baumer_HXG20": (640, 480)}
SENSOR = (640, 480)
COLOUR = {"Sony_CVC_EH6300": "GR BG"}  # sends colours alone
BLACK = 64 / 4096  # the scenario's camera: offset_dn of 12 bits


def bind(xml, out, *arguments):
    return subprocess.run([str(BIND), "bind", str(xml), str(SCENARIO), "-o", str(out), *map(str, arguments)],
                          capture_output=True, text=True, timeout=120)


def run_hilcam(*sets):
    command = [HILCAM, "run", str(SCENARIO), "--frames", "1", "--set", f"outputs.gige.interface={ADDRESS}"]
    for value in sets:
        command += ["--set", value]
    return subprocess.run(command, capture_output=True, text=True, timeout=120)


class Face:
    """A running camera with the face of a description."""

    def __init__(self, xml, folder, sensor=SENSOR, pattern=""):
        self.xml, self.folder, self.table = xml, pathlib.Path(folder), pathlib.Path(folder) / "face.json"
        width, height = sensor
        begin = time.monotonic()
        colour = ["--set", f"color_filter={{pattern: {pattern}}}"] if pattern else []
        filters = [f"camera.color_filter.pattern={pattern}", "camera.color_filter.filters=generic_rgb"] if pattern else []
        made = bind(xml, self.table, "--set", f"width_px={width}", "--set", f"height_px={height}", *colour)
        self.bind_s = time.monotonic() - begin
        if made.returncode:
            raise RuntimeError(made.stderr)
        self.said = made.stdout
        self.emulator = Emulator(HILCAM, ADDRESS, folder, f"camera.width_px={width}", f"camera.height_px={height}",
                                 f"outputs.gige.genicam_file={xml}", f"outputs.gige.face_file={self.table}",
                                 *filters, scenario=SCENARIO)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.emulator.stop()

    def client(self):
        """What face_client.py found, or how it ended."""
        result = subprocess.run(["/usr/bin/python3", str(HERE / "face_client.py"), ADDRESS, str(BLACK)], capture_output=True,
                                text=True, timeout=280)
        if result.returncode:
            return {"crash": f"status {result.returncode}: {result.stderr.strip()[-300:]}"}
        return json.loads(result.stdout.strip().splitlines()[-1])

    def values(self):
        """Lines of `arv-tool values`, or how it ended."""
        program = tool("arv-tool")
        if program is None:
            return None
        result = subprocess.run([program, "-a", ADDRESS, "values"], capture_output=True, text=True, timeout=120)
        return result.stdout.count("\n") if result.returncode == 0 else f"status {result.returncode}"

    def pipeline(self):
        """Whether GStreamer takes three frames; None: it is not installed."""
        if shutil.which("gst-launch-1.0") is None:
            return None
        result = subprocess.run(["gst-launch-1.0", "-q", "aravissrc", f"camera-name={ADDRESS}", "num-buffers=3", "!",
                                 "fakesink"], capture_output=True, text=True, timeout=60)
        return "yes" if result.returncode == 0 and "ERROR" not in result.stderr else result.stderr.strip()[-200:]


def look_at(xml):
    with tempfile.TemporaryDirectory() as folder, Face(xml, folder, SENSORS.get(xml.stem, SENSOR), COLOUR.get(xml.stem, "")) as face:
        found = face.client()
        found["lines"], found["pipeline"] = face.values(), face.pipeline()
        found["bind_s"], found["said"] = round(face.bind_s, 2), face.said
        return found


def row_of(name, found):
    if "crash" in found:
        return f"| {name} | {found['crash']} |"
    acts = found["acts"]
    shown = " | ".join(str(acts[key]).split(":")[0] for key in ("start", "window", "exposure", "gain", "trigger", "format"))
    return (f"| {name} | {found['open_s']:.1f} | {found['available']} | {found['read']} | {len(found['wrong'])} | {shown} | "
            f"{len(found.get('formats', ()))} | {'yes' if found['pipeline'] == 'yes' else 'no'} |")


class FaceCase(unittest.TestCase):
    def judge(self, found, acts):
        self.assertNotIn("crash", found, found.get("crash"))
        self.assertLess(found["open_s"], 3)
        self.assertEqual(found["wrong"], {})
        self.assertGreater(found["read"], 10)
        self.assertEqual({key: found["acts"][key] for key in acts}, dict.fromkeys(acts, "yes"), found)
        if found["lines"] is not None:
            self.assertIsInstance(found["lines"], int, found["lines"])
            self.assertGreater(found["lines"], 10)
        if found["pipeline"] is not None:
            self.assertEqual(found["pipeline"], "yes")


def misses_of(found):
    """Returns the names of what failed."""
    if "crash" in found:
        return {found["crash"]}
    missed = {name for name, act in found["acts"].items() if str(act).startswith("no") and act != "none"}
    return missed | ({"wrong"} if found["wrong"] else set()) | ({"open"} if found["open_s"] >= 3 else set()) | \
        ({"pipeline"} if found["pipeline"] not in (None, "yes") else set())


class OwnDescriptions(FaceCase):
    """Constructions of both schemas, in two descriptions that were written for this test."""
    ALL = ("start", "window", "exposure", "gain", "trigger", "format")

    def test_schema_1_0_with_abs_and_raw_names(self):
        found = look_at(OWN / "example_1_0.xml")
        self.judge(found, self.ALL)
        self.assertEqual(found["formats"], ["Mono8", "Mono12", "Mono12Packed"])

    def test_a_list_of_shutter_times_is_an_exposure(self):
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "face.json"
            self.assertEqual(bind(OWN / "example_1_0.xml", table, "--set", "exposure_range_ms=[0.001, 10]").returncode, 0)
            rows = [row for row in json.loads(table.read_text())["rows"]
                    if row["feature"] == "ExposureTime" and "values" in row]
        self.assertEqual([row["values"] for row in rows], [[[3, 4000.0]]])  # 1/1 s is beyond hilcam's range

    def test_schema_1_1_with_structures_and_selectors_in_the_camera(self):
        found = look_at(OWN / "example_1_1.xml")
        self.judge(found, self.ALL)
        self.assertEqual(found["formats"], ["Mono8", "Mono10p", "Mono16"])


# What does not work, by description (docs/camera_face.md says why).
MISSES = {"Adimec_Q12A180CXP_1_1_5": {"wrong"}, "Baumer_HXG20": {"wrong"}}


class RealDescriptions(FaceCase):
    """Every description in ../shared/data/genicam."""

    def test_the_table(self):
        if "--all" not in sys.argv:
            self.skipTest("only with --all")
        files = sorted(REAL.glob("*.xml"))
        if not files:
            self.skipTest(f"{REAL} is not there")
        print("\n| description | open, s | available | right | wrong | start | window | exposure | gain | trigger | format | "
              "formats | GStreamer |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
        failed = {}
        for xml in files:
            if ONLY and ONLY not in xml.name:
                continue
            try:
                found = look_at(xml)
            except (RuntimeError, subprocess.TimeoutExpired, ValueError) as error:
                found = {"crash": str(error)[-300:]}
            print(row_of(xml.stem, found), flush=True)
            if VERBOSE:
                print("   ", json.dumps(found), flush=True)
            missed = misses_of(found)
            if missed != MISSES.get(xml.stem, set()):
                failed[xml.stem] = missed
        self.assertEqual(failed, {})


class Damage(unittest.TestCase):
    """Descriptions with lost nodes, other references, absurd numbers and formulas are bound, or refused with one line."""
    NUMBERS = ("0", "-1", "0xFFFFFFFF", "18446744073709551615", "1e400", "x", "", "4294967292", "3")
    FORMULAS = ("1/0", "FROM", "((", "A ? B", "2**9999", "TO*TO", "(1=1)?0:", "LN(0)")

    def damaged(self, text, draw):
        names = re.findall(r'Name="(\w+)"', text)
        for _ in range(draw.randrange(1, 6)):
            kind = draw.randrange(5)
            if kind == 4:
                at = draw.randrange(len(text))
                text = text[:at] + text[at + draw.randrange(200):]
                continue
            pattern, others = ((r"(<(\w+)>[^<]*</\2>)", ("",)), (r">(\w+)<", names), (r">(0x[0-9A-Fa-f]+|\d+)<", self.NUMBERS),
                               (r"<Formula\w*>([^<]*)<", self.FORMULAS))[kind]
            found = list(re.finditer(pattern, text))
            if found:
                place = draw.choice(found)
                text = text[:place.start(1)] + draw.choice(others) + text[place.end(1):]
        return text

    def test_no_damage_is_more_than_one_line(self):
        camera, draw, ends = Camera(camera_values(SCENARIO, [])), random.Random(5), []
        whole = [(OWN / name).read_text() for name in ("example_1_0.xml", "example_1_1.xml")]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "damaged.xml"
            for _ in range(60):
                file.write_text(self.damaged(draw.choice(whole), draw))
                try:
                    bound(Description(file), camera)
                    ends.append("bound")
                except DescriptionError as error:
                    self.assertNotIn("\n", str(error))
                    ends.append("refused")
        self.assertEqual(set(ends), {"bound", "refused"})


class BadInput(unittest.TestCase):
    """One clear line each, from the tool and from hilcam."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        self.xml = OWN / "example_1_1.xml"
        self.table = self.path / "face.json"
        self.assertEqual(bind(self.xml, self.table).returncode, 0)

    def refused(self, result, *parts):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        lines = [line for line in result.stderr.strip().splitlines() if line and not line.startswith("hilcam: loading ")]
        self.assertEqual(len(lines), 1, result.stderr)
        for part in parts:
            self.assertIn(part, lines[0])

    def bound(self, content, *parts, name="bad.xml"):
        file = self.path / name
        file.write_bytes(content)
        self.refused(bind(file, self.path / "out.json"), name, *parts)

    def with_table(self, change, *parts, xml=None):
        table = json.loads(self.table.read_text())
        change(table)
        file = self.path / "changed.json"
        file.write_text(json.dumps(table))
        self.refused(run_hilcam(f"outputs.gige.genicam_file={xml or self.xml}", f"outputs.gige.face_file={file}"), *parts)

    def test_the_tool_refuses_what_is_no_description(self):
        text = self.xml.read_bytes()
        self.bound(b"hello", "RegisterDescription")
        self.bound(text[:len(text) // 2], "is no XML that can be read")
        self.bound(b"<?xml version='1.0'?><svg/>", "begins with <svg>")
        self.bound(text.replace(b'SchemaMajorVersion="1"', b'SchemaMajorVersion="3"'), "schema 3.1", "1.0, 1.1")
        self.bound(b"PK\x03\x04 no zip", "is no zip")
        self.bound(b" " * (33 << 20), "accepted: at most")

    def test_the_tool_finds_a_loop_of_references(self):
        text = self.xml.read_text()
        looped = text.replace('<pVariable Name="N">RegVendorMode</pVariable>', '<pVariable Name="N">Curve</pVariable>')
        self.assertNotEqual(looped, text)
        self.bound(looped.encode(), "a loop of references", "Curve", "ModeIndex")

    def test_the_tool_refuses_other_mistakes(self):
        out = self.path / "out.json"
        self.refused(bind(self.xml, out, "--map", "Speed=Width"), "--map", "Speed=Width", "accepted")
        registers = self.path / "r.txt"
        registers.write_text("# hilcam registers 1\n0x10 zz\n")
        self.refused(bind(self.xml, out, "--registers", registers), "r.txt:2", "accepted")
        self.refused(bind(self.path / "none.xml", out), "none.xml", "No such file")

    def test_hilcam_refuses_another_description(self):
        other = OWN / "example_1_0.xml"
        self.with_table(lambda t: None, "was made of another description", "example_1_0.xml", "bind again", xml=other)

    def test_hilcam_refuses_a_camera_of_another_size(self):
        result = run_hilcam(f"outputs.gige.genicam_file={self.xml}", f"outputs.gige.face_file={self.table}",
                            "camera.width_px=128")
        self.refused(result, "640 x 480", "128 x 480", "bind again")

    def test_hilcam_refuses_a_damaged_table(self):
        self.with_table(lambda t: t["rows"][0]["at"].update(high=99), "rows[0]: at: high", "99", "0 to 63")
        self.with_table(lambda t: t["rows"].append(dict(t["rows"][0], feature="Height")), "overlaps")
        self.with_table(lambda t: t["rows"][0].update(feature="Colour"), "'Colour'", "docs/genicam.md")
        self.with_table(lambda t: t.update(hilcam_face=7), "hilcam_face", "7", "1")
        self.with_table(lambda t: t["memory"].append(["0x00", "xyz"]), "memory", "hexadecimal")
        file = self.path / "cut.json"
        file.write_text(self.table.read_text()[:500])
        self.refused(run_hilcam(f"outputs.gige.genicam_file={self.xml}", f"outputs.gige.face_file={file}"), "is no JSON")

    def test_hilcam_refuses_bad_descriptions_and_registers(self):
        cut = self.path / "cut.xml"
        cut.write_bytes(self.xml.read_bytes()[:-40])
        table = f"outputs.gige.face_file={self.table}"
        self.refused(run_hilcam(f"outputs.gige.genicam_file={cut}", table), "cut.xml", "it is cut")
        huge = self.path / "huge.xml"
        with huge.open("wb") as file:
            file.truncate(100 << 20)
        self.refused(run_hilcam(f"outputs.gige.genicam_file={huge}", table), "huge.xml", "104857600 bytes", "at most")
        registers = self.path / "r.txt"
        registers.write_text("# hilcam registers 1\n0x10 00000001\n0x10 00000002\n")
        self.refused(run_hilcam(f"outputs.gige.genicam_file={self.xml}", table, f"outputs.gige.registers_file={registers}"),
                     "r.txt", "0x00000010", "twice")
        self.refused(run_hilcam(f"outputs.gige.genicam_file={self.xml}"), "genicam_file", "face_file")


class Formulas(unittest.TestCase):
    """The tool's formulas, with values worked out by hand from the rules of the GenICam Standard 2.1.1, 2.8.13."""

    def value(self, text, whole=False, **variables):
        return Formula(text)(lambda name: variables[name], whole)

    def test_operators_bind_as_the_standard_says(self):
        self.assertEqual(self.value("1 + 2 * 3 ** 2"), 19)
        self.assertEqual(self.value("2 ** 3 ** 2", True), 512)
        self.assertEqual(self.value("6 & 3 = 3", True), 0)  # = binds before &
        self.assertEqual(self.value("A > 2 ? 10 : A < 1 ? 20 : 30", A=0), 20)
        self.assertEqual(self.value("(A=1) || (B<>2) && 0", A=1, B=2), 1)
        self.assertEqual(self.value("~A & 0xFF", True, A=0x0F), 0xF0)
        self.assertEqual(self.value("1 << 4 | 1", True), 17)

    def test_whole_numbers_divide_towards_zero_and_floats_do_not(self):
        self.assertEqual(self.value("7 / 2", True), 3)
        self.assertEqual(self.value("-7 / 2", True), -3)
        self.assertEqual(self.value("-7 % 2", True), -1)
        self.assertEqual(self.value("625 / 10"), 62.5)

    def test_what_has_no_value_is_an_error(self):
        for text in ("1 / 0", "LN(0)", "SQRT(0 - 1)", "1 +", "(1", "2 ** 99999", "1 << 99"):
            with self.assertRaises(FormulaError, msg=text):
                self.value(text)


class Files(unittest.TestCase):
    """The forms of a description: zipped, and with arv-tool's first line."""

    def test_a_zip_and_a_first_line_are_the_same_description(self):
        xml = OWN / "example_1_0.xml"
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            with zipfile.ZipFile(folder / "d.zip", "w", zipfile.ZIP_DEFLATED) as out:
                out.writestr("d.xml", xml.read_bytes())
            (folder / "line.xml").write_bytes(b"Example-OLD-0001 (127.0.0.1)\n" + xml.read_bytes())
            tables = []
            for file in (xml, folder / "d.zip", folder / "line.xml"):
                self.assertEqual(bind(file, folder / "t.json").returncode, 0)
                tables.append((folder / "t.json").read_text())
                result = run_hilcam(f"outputs.gige.genicam_file={file}", f"outputs.gige.face_file={folder}/t.json")
                self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(tables[0], tables[1])
            self.assertEqual(tables[0], tables[2])


class Record(unittest.TestCase):
    """A camera's registers, recorded from a hilcam that plays the real one, and played by a second."""

    def test_what_was_recorded_is_served(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            with Face(OWN / "example_1_1.xml", folder):
                result = subprocess.run([str(BIND), "record", ADDRESS, "-o", str(folder / "real.txt")], capture_output=True,
                                        text=True, timeout=60)
                self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual((folder / "real.xml").read_bytes().rstrip(), (OWN / "example_1_1.xml").read_bytes().rstrip())
            recorded = (folder / "real.txt").read_text()
            self.assertRegex(recorded, r"0x40000a00 0280")  # width 640
            again = bind(folder / "real.xml", folder / "again.json", "--registers", folder / "real.txt")
            self.assertEqual(again.returncode, 0, again.stderr)


if __name__ == "__main__":
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    ONLY = sys.argv[sys.argv.index("--only") + 1] if "--only" in sys.argv else ""
    VERBOSE = "--verbose" in sys.argv
    names = [a for a in sys.argv[2:] if not a.startswith("--") and a != ONLY]
    unittest.main(argv=[sys.argv[0], *names], verbosity=2)
