#!/usr/bin/python3
"""`hilcam bench`, its --error and --soak, and tools/performance-curves on small scenarios: their files and messages, not their figures.

    bench_test.py HILCAM SOURCE_DIR
"""
import argparse
import csv
import importlib.machinery
import importlib.util
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from pages import has_matplotlib, page_without_matplotlib, stands_alone

sys.dont_write_bytecode = True  # tools stay as they are
HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
PERCENTILES = ("p50", "p99", "p99.9", "max")
# Fast enough for any machine: 20 Hz are not the question.
SMALL = ("--set", "camera.width_px=64", "--set", "camera.height_px=48", "--set", "camera.focal_length_mm=0.7",
         "--set", "objects.0.generate.triangles=5000", "--set", "camera.frame_rate_hz=20")


def hilcam(*arguments):
    return subprocess.run([HILCAM, *map(str, arguments)], capture_output=True, text=True, timeout=120)


def rows_of(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


class Soak(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name) / "soak"
        cls.result = hilcam("bench", SCENARIO, *SMALL, "--soak", 4, "--slice-s", 0.5, "--out", cls.folder)
        assert cls.result.returncode == 0, cls.result.stderr
        cls.report = json.loads((cls.folder / "soak.json").read_text())
        cls.rows = rows_of(cls.folder / "soak.csv")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_a_slice_has_all_figures(self):
        self.assertEqual(len(self.rows), 8)
        self.assertEqual(len(self.report["slices"]), 8)
        for row, s in zip(self.rows, self.report["slices"]):
            self.assertEqual(float(row["frames"]), s["frames"])
            self.assertGreater(s["memory_mb"], 1)
            for figure in ("work", "interval", "latency"):
                values = [s[figure + "_ms"][which] for which in PERCENTILES]
                self.assertEqual(values, sorted(values))
                for which, value in zip(PERCENTILES, values):
                    self.assertAlmostEqual(float(row[f"{figure}_{which}_ms"]), value, delta=1e-4)

    def test_slices_follow_one_another_and_make_the_whole(self):
        slices, whole = self.report["slices"], self.report["whole"]
        for a, b in zip(slices, slices[1:]):
            self.assertAlmostEqual(a["start_s"] + a["length_s"], b["start_s"], delta=1e-6)
        for count in ("frames", "deadline_misses"):
            self.assertEqual(sum(s[count] for s in slices), whole[count])
        self.assertAlmostEqual(sum(s["length_s"] for s in slices), whole["length_s"], delta=1e-6)
        self.assertGreater(whole["frames"], 0)
        # At its own rate, not as fast as it goes: no more frames than there is time for, and one more at an end.
        self.assertLessEqual(whole["frames"], 20 * whole["length_s"] + 2)
        self.assertGreater(whole["latency_ms"]["p50"], 0)

    def test_says_in_a_line_what_it_found(self):
        lines = self.result.stdout.splitlines()
        self.assertEqual(len(lines), 1)
        self.assertEqual(lines[0], self.report["text"])
        for words in ("frames in 4 s", "memory ", " MB (trend ", "latency ", "p99 "):
            self.assertIn(words, lines[0])

    def test_the_page_stands_alone(self):
        page = (self.folder / "index.html").read_text()
        self.assertIn(self.report["text"], page)
        stands_alone(self, page)
        if not has_matplotlib():
            self.assertIn("Matplotlib is missing", self.result.stderr)
            self.skipTest("Matplotlib is missing: no plot to look at")
        self.assertEqual(page.count("<svg"), 1)
        self.assertTrue((self.folder / "soak.svg").read_text().startswith("<?xml"))

    def test_without_matplotlib_there_is_a_message_and_a_page(self):
        page = page_without_matplotlib(self, SOURCE / "tools/hilcam-plot-soak", self.folder,
                                       pathlib.Path(self.temporary.name) / "bare")
        self.assertIn("No plot", page)

    def test_ended_early_it_writes_what_there_is(self):
        folder = pathlib.Path(self.temporary.name) / "early"
        with subprocess.Popen([HILCAM, "bench", SCENARIO, *SMALL, "--soak", "600", "--slice-s", "0.5", "--out", folder],
                              stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
            self.assertIn("soaking", process.stderr.readline())
            time.sleep(4)
            process.send_signal(signal.SIGINT)
            out, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, error)
        slices = json.loads((folder / "soak.json").read_text())["slices"]
        self.assertGreater(len(slices), 0)
        self.assertLess(len(slices), 1200)

    def test_bad_input_is_status_2(self):
        for needle, arguments in (("--soak requires --out", ("--soak", 1)),
                                  ("--out requires --soak", ("--out", self.folder)),
                                  ("--soak", ("--soak", 0, "--out", self.folder)),
                                  ("--sensor excludes --soak", ("--soak", 1, "--out", self.folder, "--sensor"))):
            result = hilcam("bench", SCENARIO, *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(needle, result.stderr)


class Speed(unittest.TestCase):
    def test_processor_time_and_rays_by_kind(self):
        result = hilcam("bench", SCENARIO, *SMALL, "--runs", 1, "--frames", 10, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        told = json.loads(result.stdout)
        # No more than all cores have in the time of the run, which is longer than that of the frames.
        self.assertGreater(told["core_ms_per_frame"], 0)
        self.assertLess(told["core_ms_per_frame"], 20e3)
        self.assertEqual(set(told["rays"]), {"primary", "shadow", "bounce_shadow", "lamp", "path"})
        for kind in ("primary", "shadow", "path"):
            self.assertGreater(told["rays"][kind], 0, kind)
        text = hilcam("bench", SCENARIO, *SMALL, "--runs", 1, "--frames", 2).stdout
        self.assertIn("core-ms a frame", text)
        self.assertIn("shadow behind a bounce", text)

    def test_variants_take_turns(self):
        arguments = (*SMALL, "--runs", 2, "--frames", 10, "--variant", "quality.path_model=direct; quality.buffer_samples=16")
        result = hilcam("bench", SCENARIO, *arguments, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        first, cheaper = json.loads(result.stdout)
        self.assertEqual(first["core_ms_ratio"], {"median": 1, "least": 1, "most": 1})
        self.assertEqual(cheaper["variant"], "quality.path_model=direct; quality.buffer_samples=16")
        self.assertEqual(cheaper["rays"]["path"], 0)
        self.assertGreater(cheaper["core_ms_ratio"]["median"], 0)
        self.assertLessEqual(cheaper["core_ms_ratio"]["least"], cheaper["core_ms_ratio"]["most"])
        self.assertIn("(as it is)", hilcam("bench", SCENARIO, *arguments).stdout)
        wrong = hilcam("bench", SCENARIO, *SMALL, "--variant", "quality.nonsense=1")
        self.assertEqual(wrong.returncode, 2, wrong.stderr)
        self.assertIn("nonsense", wrong.stderr)

    def test_a_camera_that_cannot_fly_around_is_bad_input(self):
        # Above the target along the axis of the circle.
        result = hilcam("bench", SCENARIO, *SMALL, "--set", "camera_pose={position_m: [0, 0, 30]}")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("circle: the start must be off the axis", result.stderr)


class Error(unittest.TestCase):
    FIGURES = ("error_sigma_p99", "error_sigma_rms", "within_half_sigma_fraction", "false_lights", "centroid_shift_px",
               "photometric_error_fraction", "ssim", "scatter_sigma_p99", "scatter_sigma_rms")

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def bench(self, *arguments, scene=SMALL):
        # References in a cache of its own; meshes are where the other tests have them.
        cache = pathlib.Path(self.temporary.name)
        for mesh in pathlib.Path(os.environ["HILCAM_CACHE"]).glob("*.glb"):
            (cache / mesh.name).exists() or (cache / mesh.name).symlink_to(mesh)
        return subprocess.run([HILCAM, "bench", SCENARIO, *scene, "--error", "--views", "2", *map(str, arguments)],
                              capture_output=True, text=True, timeout=120, env=os.environ | {"HILCAM_CACHE": str(cache)})

    def test_views_have_all_figures_and_references_are_kept(self):
        first = self.bench("--reference-frames", 4, "--json")
        self.assertEqual(first.returncode, 0, first.stderr)
        report = json.loads(first.stdout)
        self.assertEqual([view["angle_deg"] for view in report["views"]], [0, 180])
        for figures in (*report["views"], report["all_views"]):
            for name in self.FIGURES:
                self.assertTrue(math.isfinite(figures[name]), name)
                self.assertGreaterEqual(figures[name], 0, name)
            self.assertIsNone(figures["limb_error_px"])  # no limb in view
            self.assertGreater(figures["lit_px"], 0)
            self.assertGreater(figures["error_sigma_rms"], 0)
        self.assertEqual([view["reference"]["frames"] for view in report["views"]], [4, 4])
        a, b = (view["position_m"] for view in report["views"])
        self.assertAlmostEqual(a[0] + b[0], 0, delta=1e-6)  # on the other side
        self.assertAlmostEqual(a[2] - b[2], 0, delta=1e-6)  # about z
        self.assertAlmostEqual(sum(view["false_lights"] for view in report["views"]), report["all_views"]["false_lights"])
        self.assertEqual(first.stderr.count("kept as"), 2)

        again = self.bench("--reference-frames", 4, "--json")
        self.assertEqual(json.loads(again.stdout), report)
        self.assertNotIn("kept as", again.stderr)
        file = next(pathlib.Path(self.temporary.name).glob("reference_*.bin"))
        file.write_bytes(file.read_bytes()[:-8])
        repaired = self.bench("--reference-frames", 4)
        self.assertEqual(repaired.stderr.count("kept as"), 1)
        rows = repaired.stdout.splitlines()[-3:]
        self.assertEqual([row.split()[0] for row in rows], ["0", "180", "all"])
        self.assertEqual([row.split()[6] for row in rows], ["-"] * 3, repaired.stdout)

    def test_where_nothing_is_seen_there_are_no_figures(self):
        dark = (*SMALL[:6], "--set", "sun.spectrum=0", "--set", "objects=[]")
        result = self.bench("--reference-frames", 4, "--json", scene=dark)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("nan", result.stdout.lower())
        told = json.loads(result.stdout)
        self.assertEqual(len(told["views"]), 1)  # around nothing
        for figures in (*told["views"], told["all_views"]):
            self.assertEqual(figures["false_lights"], 0)
            self.assertEqual([figures[name] for name in self.FIGURES if name not in ("false_lights", "ssim")], [None] * 7)

    def test_bad_input_is_status_2(self):
        for needle, arguments in (("accepted: a power of two from 4 to 65536", ("--error", "--reference-frames", 6)),
                                  ("--views requires --error", ("--views", 2)),
                                  ("--frames excludes --error", ("--error", "--frames", 2))):
            result = hilcam("bench", SCENARIO, *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(needle, result.stderr)


class Curves(unittest.TestCase):
    def run_tool(self, folder, *arguments):
        return subprocess.run([SOURCE / "tools/performance-curves", HILCAM, "--out", folder, "--runs", "1", "--frames", "2",
                               *arguments], capture_output=True, text=True, timeout=300)

    def test_each_curve_has_its_points(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            result = self.run_tool(folder, "--curve", "triangles=1000,5000", "--curve", "pixels=64,96", "--curve", "objects=1,4",
                                   "--curve", "stars=0,2000")
            self.assertEqual(result.returncode, 0, result.stderr)
            rows = {name: rows_of(folder / f"{name}.csv") for name in ("triangles", "pixels", "objects", "stars")}
            tables = (folder / "curves.md").read_text()
            for name in rows:
                self.assertEqual((folder / f"{name}.png").exists(), has_matplotlib())
        counts = {name: [(row["series"], int(row["value"])) for row in rows[name]] for name in rows}
        self.assertEqual(counts, {
            "triangles": [("satellite", 5000), ("satellite, no levels of detail", 5000), ("sphere", 1000), ("sphere", 5000)],
            "pixels": [("satellite", 64), ("satellite", 96)], "objects": [("satellites", 1), ("satellites", 4)],
            "stars": [("over the sky", 0), ("over the sky", 2000), ("in the picture", 0), ("in the picture", 2000)]})
        for row in rows["triangles"]:  # met within 1 %; the sphere by whole rows
            self.assertAlmostEqual(int(row["triangles"]) / int(row["value"]), 1, delta=0.05)
            # A fifth; from 50 m the silhouette is 2.6 % more than the great circle, the polygon of 1000 triangles 0.6 % less;
            # the guard band of 28 px counts as picture.
            if row["series"] == "sphere":
                self.assertAlmostEqual(float(row["coverage"]), 0.2 * 1.026 / (1 + 2 * 28 / 1024) ** 2, delta=0.003)
        self.assertEqual([int(row["width_px"]) for row in rows["pixels"]], [64, 96])
        self.assertEqual([round(int(row["triangles"]) / 5000) for row in rows["objects"]], [1, 4])
        self.assertAlmostEqual(float(rows["objects"][0]["coverage"]), float(rows["objects"][1]["coverage"]), delta=0.02)
        self.assertEqual(float(rows["stars"][0]["coverage"]), 0)
        for name in rows:
            self.assertIn(f"## {name[0].upper()}", tables)
        self.assertIn("medians of 1 runs of 2 frames", tables)

    def test_more_pixels_are_the_same_view(self):
        loader = importlib.machinery.SourceFileLoader("performance_curves", str(SOURCE / "tools/performance-curves"))
        tool = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
        loader.exec_module(tool)
        fields = set()
        for width in tool.VALUES["pixels"]:
            _, sets = tool.pixels_point(argparse.Namespace(quality="quality.yaml"), None, "satellite", width)
            values = dict(word.split("=") for word in sets)
            self.assertEqual(values["camera.width_px"], values["camera.height_px"])
            fields.add(round(int(values["camera.width_px"]) / float(values["camera.focal_length_mm"]), 9))
        self.assertEqual(len(fields), 1)

    def test_bad_input_says_what_is_accepted(self):
        with tempfile.TemporaryDirectory() as folder:
            for needle, curve in (("'moons' is no curve; accepted: triangles, pixels, objects, stars", "moons"),
                                  ("whole numbers with commas", "stars=many"), ("objects: 0 is too few", "objects=0")):
                result = self.run_tool(folder, "--curve", curve)
                self.assertEqual(result.returncode, 2)
                self.assertIn(needle, result.stderr)


if __name__ == "__main__":
    os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")
    unittest.main(argv=[sys.argv[0]], verbosity=2)
