#!/usr/bin/python3
"""`hilcam tradeoff` on a small scenario: its files, its determinism, its messages.

    tradeoff_test.py HILCAM SOURCE_DIR
"""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from pages import has_matplotlib, page_without_matplotlib, stands_alone

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
# A picture of few pixels, with the Earth's limb in none of them.
SMALL = ("--set", "camera.width_px=64", "--set", "camera.height_px=48", "--set", "camera.focal_length_mm=0.7",
         "--set", "objects.0.generate.triangles=5000", "--reference-frames", "4")
ERRORS = ("error_sigma_p99", "error_sigma_rms", "within_half_sigma_fraction", "false_lights", "centroid_shift_px",
          "photometric_error_fraction", "limb_error_px", "ssim")


def tradeoff(folder, *arguments, hilcam=HILCAM):
    return subprocess.run([hilcam, "tradeoff", str(SCENARIO), "--out", str(folder), *SMALL, *map(str, arguments)],
                          capture_output=True, text=True, timeout=300)


class Tradeoff(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name) / "first"
        cls.result = tradeoff(cls.folder, "--combinations", 6, "--frame-ms", 1000, "--error-sigma", 1000)
        assert cls.result.returncode == 0, cls.result.stderr
        cls.report = json.loads((cls.folder / "tradeoff.json").read_text())
        with open(cls.folder / "tradeoff.csv", newline="") as file:
            cls.rows = list(csv.DictReader(file))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_the_csv_has_a_line_for_each_setting(self):
        settings = self.report["settings"]
        self.assertEqual(len(self.rows), len(settings))
        self.assertGreater(len(settings), 20)
        self.assertEqual([row["kind"] for row in self.rows].count("own"), 1)
        self.assertIn("combination", {row["kind"] for row in self.rows}, self.result.stderr)
        for row, setting in zip(self.rows, settings):
            for figure in ERRORS + ("frame_ms", "render_ms"):
                self.assertIn(figure, row)
                if setting[figure] is None:
                    self.assertEqual(row[figure], "")
                else:
                    self.assertAlmostEqual(float(row[figure]), setting[figure], delta=1e-5 * abs(setting[figure]))
                    self.assertTrue(math.isfinite(setting[figure]))
            self.assertLessEqual(setting["render_ms"], setting["frame_ms"])
            self.assertIsNone(setting["limb_error_px"])  # no limb in view: not applicable
            self.assertIsNotNone(setting["centroid_shift_px"])
        self.assertEqual(self.rows[0]["depth"], "2")

    def test_nothing_beats_the_front(self):
        settings = self.report["settings"]
        for s in settings:
            beaten = any(o["frame_ms"] <= s["frame_ms"] and o["error_sigma_p99"] <= s["error_sigma_p99"] and
                         (o["frame_ms"], o["error_sigma_p99"]) != (s["frame_ms"], s["error_sigma_p99"]) for o in settings)
            self.assertEqual(s["front"], not beaten, s)

    def test_recommends_what_was_asked_for(self):
        settings, found = self.report["settings"], self.report["recommended"]
        self.assertEqual(settings[found["within_frame_ms"]]["error_sigma_p99"],
                         min(s["error_sigma_p99"] for s in settings if s["frame_ms"] <= 1000))
        self.assertEqual(settings[found["within_error_sigma"]]["frame_ms"], min(s["frame_ms"] for s in settings))
        self.assertIn("least error within 1000.00 ms: setting", self.result.stdout)

    def test_presets_are_quality_files(self):
        for name in ("realtime", "balanced", "reference"):
            result = subprocess.run([HILCAM, "check", SCENARIO, "--set", f"quality={self.folder / (name + '.yaml')}"],
                                    capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_the_reference_tells_its_own_error(self):
        reference = self.report["reference"]
        self.assertEqual(reference["frames"], 4)
        self.assertGreater(reference["standard_error_sigma"]["p99"], 0)
        self.assertIn("standard error", self.result.stdout)
        # A single frame of the scenario's own quality is farther off than the mean of four far better ones.
        self.assertGreater(self.report["settings"][0]["error_sigma_p99"], reference["standard_error_sigma"]["p99"])

    def test_what_it_will_take_is_said_first(self):
        lines = self.result.stderr.splitlines()
        first = next(i for i, line in enumerate(lines) if "single changes and up to 6 combinations in 600 s" in line)
        frame = next(i for i, line in enumerate(lines) if "a frame of the reference takes" in line)
        setting = next(i for i, line in enumerate(lines) if " sigma  " in line)
        self.assertTrue(first < frame < setting, lines)

    def test_errors_are_the_same_every_time(self):
        again = pathlib.Path(self.temporary.name) / "again"
        result = tradeoff(again, "--combinations", 0, "--set", "threads=1")
        self.assertEqual(result.returncode, 0, result.stderr)
        first = {tuple(s["set"]): s for s in self.report["settings"]}
        common = 0
        for s in json.loads((again / "tradeoff.json").read_text())["settings"]:
            if tuple(s["set"]) in first:
                common += 1
                for figure in ERRORS:
                    self.assertEqual(s[figure], first[tuple(s["set"])][figure], (s["changes"], figure))
        self.assertGreater(common, 30)

    def test_a_value_of_the_reference_can_be_replaced(self):
        folder = pathlib.Path(self.temporary.name) / "replaced"
        result = tradeoff(folder, "--budget-s", "0.001", "--reference-set", "quality.max_depth=3")
        self.assertEqual(result.returncode, 0, result.stderr)
        changed = json.loads((folder / "tradeoff.json").read_text())["reference"]["set"]
        self.assertIn("quality.max_depth=3", changed)
        self.assertNotIn("quality.max_depth=8", changed)
        self.assertIn("quality.max_depth=8", self.report["reference"]["set"])
        self.assertIn("max_depth: 3\n", (folder / "reference.yaml").read_text())

    def test_the_page_stands_alone(self):
        page = (self.folder / "index.html").read_text()
        self.assertIn("Pareto front", page)
        stands_alone(self, page)
        if not has_matplotlib():
            self.assertIn("Matplotlib is missing", self.result.stderr)
            self.skipTest("Matplotlib is missing: no plots to look at")
        self.assertEqual(page.count("<svg"), 5)  # without a limb
        for title in ("Error of the picture, all settings", "Centroid of the target", "Light of the target", "one knob at a time"):
            self.assertIn(title, page)  # as a comment of the plot's own
        self.assertTrue((self.folder / "error.svg").read_text().startswith("<?xml"))

    def test_without_matplotlib_there_is_a_message_and_a_page(self):
        page = page_without_matplotlib(self, SOURCE / "tools/hilcam-plot-tradeoff", self.folder,
                                       pathlib.Path(self.temporary.name) / "bare")
        self.assertIn("Pareto front", page)


class Limb(unittest.TestCase):
    def test_a_planets_limb_is_measured(self):
        # 20,000 km above the Earth's lit side, its limb some 20 deg from the middle of the picture.
        scenario = {
            "name": "limb", "time_utc": "2026-03-20T12:00:00Z", "origin": {"kind": "earth_center"},
            "camera": {"name": "wide", "width_px": 96, "height_px": 96, "pitch_um": 5.5, "focal_length_mm": 0.5,
                       "f_number": 8, "quantum_efficiency": 0.5, "full_well_e": 13500, "read_noise_e": 5, "gain_dn_e": 0.29,
                       "bits": 12, "exposure_ms": 0.05, "frame_rate_hz": 30},
            "camera_pose": {"position_m": [26000000, 0, 0], "attitude": "look_at", "look_at_m": [0, 0, 0]},
            "spectrum_edges_um": [0.4, 0.7], "quality": {"guard_px": 16},
        }
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "limb.yaml"
            file.write_text(json.dumps(scenario))
            out = pathlib.Path(folder) / "out"
            result = subprocess.run([HILCAM, "tradeoff", file, "--out", out, "--reference-frames", "4", "--combinations", "4"],
                                    capture_output=True, text=True, timeout=300)
            self.assertEqual(result.returncode, 0, result.stderr)
            settings = json.loads((out / "tradeoff.json").read_text())["settings"]
        for s in settings:
            self.assertIsNotNone(s["limb_error_px"], s["changes"])
            self.assertLess(s["limb_error_px"], 0.5, s["changes"])
            self.assertIsNone(s["centroid_shift_px"], "there is no target")


class Messages(unittest.TestCase):
    def refused(self, needle, *arguments, scenario=SCENARIO):
        result = subprocess.run([HILCAM, "tradeoff", str(scenario), *map(str, arguments)], capture_output=True, text=True,
                                timeout=120)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn(needle, result.stderr)

    def test_bad_input_is_status_2(self):
        with tempfile.TemporaryDirectory() as folder:
            self.refused("--out is required")
            self.refused("none.yaml: no such file", "--out", folder, scenario="none.yaml")
            self.refused("--frame-ms", "--out", folder, "--frame-ms", "-1")
            self.refused("--error-sigma", "--out", folder, "--error-sigma", "0")
            self.refused("--runs", "--out", folder, "--runs", "4")
            self.refused("unknown key", "--out", folder, "--set", "quality.depth=3")
            self.refused("there is no error to measure", "--out", folder, *SMALL, "--set",
                         "camera.quantum_efficiency=1e-6")

    def test_a_folder_that_cannot_be_made_is_told_before_anything_is_measured(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "file"
            file.write_text("")
            result = tradeoff(file / "out")
            self.assertEqual(result.returncode, 1)
            self.assertIn("file/out: cannot be made", result.stderr)
            self.assertNotIn("reference", result.stderr)


if __name__ == "__main__":
    os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")
    unittest.main(argv=[sys.argv[0]], verbosity=2)
