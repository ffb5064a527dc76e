#!/usr/bin/python3
"""The Python package (tools/python): a bench and its frames, a campaign as tables and arrays, conventions; installed by pip.

    python_test.py HILCAM SOURCE_DIR
"""
import datetime
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy
from PIL import Image

HILCAM, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
sys.path.insert(0, str(SOURCE / "tools/python"))
import hilcam  # noqa: E402

SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"


class Conventions(unittest.TestCase):
    def test_forms_of_an_attitude_are_those_of_the_page(self):
        """docs/conventions.md has one attitude in all forms: hilcam itself takes the matrix and the MRP for the same quaternion."""
        draw = numpy.random.default_rng(5)
        for _ in range(200):
            q = draw.normal(size=4)
            q /= numpy.linalg.norm(q)
            q = q if q[0] > 0 else -q
            self.assertLess(numpy.abs(hilcam.attitude_from_dcm(hilcam.dcm_of(q)) - q).max(), 1e-12)
            self.assertLess(numpy.abs(hilcam.attitude_from_mrp(hilcam.mrp_of(q)) - q).max(), 1e-12)
            self.assertLessEqual(numpy.linalg.norm(hilcam.mrp_of(q)), 1 + 1e-12)
            v = draw.normal(size=3)
            # R(q) v = v + 2 w (u x v) + 2 u x (u x v), u the vector part.
            u = q[1:]
            self.assertLess(numpy.abs(hilcam.rotate(q, v) - (v + 2 * q[0] * numpy.cross(u, v) + 2 * numpy.cross(u, numpy.cross(u, v)))).max(), 1e-12)
        for angle in (math.pi, 3.0, 1e-9):
            q = (math.cos(angle / 2), 0, 0, math.sin(angle / 2))
            self.assertAlmostEqual(hilcam.attitude_from_dcm(hilcam.dcm_of(q))[3], q[3], 12)

    def test_forms_are_hilcams_own(self):
        q = (0.36, 0.48, -0.64, 0.48)
        with tempfile.TemporaryDirectory() as folder:
            def seen(**keys):
                attitude = ", ".join(f"{k}: {v}" for k, v in keys.items())
                out = pathlib.Path(folder) / "p.png"
                subprocess.run([HILCAM, "render", SCENARIO, "--set", f"camera_pose={{position_m: [0, 0, 50], {attitude}}}", "--out", out,
                                "--truth", folder, "--overwrite"], check=True, capture_output=True)
                return hilcam.read_truth(pathlib.Path(folder) / "p.truth.jsonl")[0].attitude_wxyz
            expected = seen(attitude_wxyz=list(q))
            self.assertLess(numpy.abs(numpy.array(expected) - q).max(), 1e-9)
            self.assertLess(numpy.abs(numpy.array(seen(attitude_mrp=hilcam.mrp_of(q).tolist())) - expected).max(), 1e-9)
            self.assertLess(numpy.abs(numpy.array(seen(attitude_dcm=hilcam.dcm_of(q).reshape(-1).tolist())) - expected).max(), 1e-9)

    def test_times(self):
        self.assertEqual(hilcam.tai_ns_of_utc("2026-03-20T14:00:00Z"), (1774015200 + 37) * 10**9)
        self.assertEqual(hilcam.tai_ns_of_utc("1972-01-01T00:00:00Z"), (63072000 + 10) * 10**9)
        # The first instant after the leap second at the end of 2016, and the last before it.
        self.assertEqual(hilcam.tai_ns_of_utc("2017-01-01T00:00:00Z") - hilcam.tai_ns_of_utc("2016-12-31T23:59:59Z"), 2 * 10**9)
        for text in ("2026-03-20T14:00:00.25+00:00", "2016-12-31T23:59:59+00:00", "1985-07-01T00:00:00+00:00"):
            self.assertEqual(hilcam.utc_of_tai_ns(hilcam.tai_ns_of_utc(text)), datetime.datetime.fromisoformat(text.replace(".25", ".250000")))
        self.assertRaises(ValueError, hilcam.tai_ns_of_utc, "1971-12-31T00:00:00Z")


class Benches(unittest.TestCase):
    def test_a_bench_gives_frames_for_commands_and_its_report(self):
        with tempfile.TemporaryDirectory() as folder:
            values = {"mode": "lockstep", "outputs.files.folder": folder, "outputs.truth.folder": folder, "outputs.truth.layers": ["depth", "object"]}
            with hilcam.Bench(SCENARIO, values, frames=2, program=HILCAM) as bench:
                with hilcam.Client(bench.tcp, timeout_s=30) as camera:
                    for n, place in enumerate([(22, 15, 7), (40, 0, 0)]):
                        now = bench.start_tai_ns + n * 10**9
                        camera.send(hilcam.Pose(time_tai_ns=now, position_m=place, attitude_wxyz=hilcam.look_at(place, (0, 0, 0))))
                        camera.send(hilcam.Expose(time_tai_ns=now))
                self.assertEqual(bench.wait(60)["frames"], 2)
            frames = hilcam.read_truth(pathlib.Path(folder) / "truth.jsonl")
            self.assertEqual([f.frame for f in frames], [1, 2])
            self.assertEqual(frames[1].position_m, (40.0, 0.0, 0.0))
            self.assertAlmostEqual(frames[1].objects[0].position_camera_m[2], 40, 6)
            self.assertEqual(frames[0].time_tai_ns, bench.start_tai_ns)
            self.check_layers(pathlib.Path(folder) / "truth_00000002.exr", frames[1])

    def check_layers(self, file, truth):
        layers = hilcam.read_exr(file)
        self.assertEqual(set(layers), {"object.ID", "depth.Z"})
        mask = layers["object.ID"] == 1
        self.assertEqual(mask.sum(), truth.objects[0].visible_px)
        self.assertTrue(numpy.isinf(layers["depth.Z"][layers["object.ID"] == 0]).all())
        try:
            import OpenImageIO as oiio
        except ImportError:
            return
        image = oiio.ImageBuf(str(file))
        pixels = image.get_pixels(oiio.FLOAT)
        # As floats it scales whole numbers, so depth alone is compared.
        self.assertTrue(numpy.array_equal(pixels[..., list(image.spec().channelnames).index("depth.Z")], layers["depth.Z"]))

    def test_parts_of_the_light_are_layers_that_sum_to_the_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "parts.exr"
            subprocess.run([HILCAM, "render", SCENARIO, "--stage", "radiance", "--parts", "--out", file], check=True, capture_output=True)
            layers = hilcam.read_exr(file)
        self.assertGreater(max(map(len, layers)), 31)  # names that OpenEXR calls long
        parts = [layers[name] for name in layers if name.endswith(".R")]
        self.assertGreater(len(parts), 10)
        self.assertGreater(layers["direct.sun.R"].max(), 0)
        image_parts = sum(layers[name].astype(float) for name in layers if name.endswith(".R") and name != "points.R")
        self.assertLess(numpy.abs(image_parts - layers["R"]).max(), 1e-5 * layers["R"].max())

    def test_a_bench_that_cannot_be_says_why(self):
        with self.assertRaisesRegex(hilcam.BenchFailed, "camera.exposure_ms: found '-1'"):
            with hilcam.Bench(SCENARIO, {"camera.exposure_ms": -1}, program=HILCAM):
                pass


class Shared(unittest.TestCase):
    NAME = f"hilcam_python_test_{os.getpid()}"
    PLACES = [(22, 15, 7), (40, 0, 0), (30, 20, 5)]

    def tearDown(self):
        pathlib.Path("/dev/shm", self.NAME).unlink(missing_ok=True)

    def exposed(self, camera, bench, number):
        place, now = self.PLACES[number], bench.start_tai_ns + number * 10**9
        camera.send(hilcam.Pose(time_tai_ns=now, position_m=place, attitude_wxyz=hilcam.look_at(place, (0, 0, 0))))
        camera.send(hilcam.Expose(time_tai_ns=now))

    def test_frames_lie_in_shared_memory_with_their_reports(self):
        with tempfile.TemporaryDirectory() as folder:
            values = {"mode": "lockstep", "outputs.shm.name": self.NAME, "outputs.files.folder": folder}
            with hilcam.Bench(SCENARIO, values, frames=3, program=HILCAM) as bench, hilcam.SharedFrames(self.NAME) as frames, \
                    hilcam.Client(bench.tcp, timeout_s=30) as camera:
                self.assertEqual((frames.newest, frames.has_ended, frames.slots), (0, False, 8))
                self.assertRaises(TimeoutError, frames.wait, 0, 0.05)
                seen = []
                for number, place in enumerate(self.PLACES):
                    self.exposed(camera, bench, number)
                    frame = next(frames.follow(number, timeout_s=60))
                    self.assertEqual((frame.number, frame.report.id), (number + 1, number + 1))
                    self.assertEqual(frame.report.exposure_mid_tai_ns, bench.start_tai_ns + number * 10**9)
                    self.assertLess(numpy.abs(numpy.array(frame.report.position_m) - place).max(), 1e-9)
                    self.assertLess(numpy.abs(numpy.array(frame.report.attitude_wxyz) - hilcam.look_at(place, (0, 0, 0))).max(), 1e-9)
                    self.assertFalse(frame.pixels.flags.writeable or frame.pixels.flags.owndata)
                    self.assertRaises(ValueError, frame.pixels.setflags, write=True)
                    seen.append(frame)
                bench.wait(60)
                self.assertTrue(frames.has_ended and all(frame.is_whole() for frame in seen))
                self.assertEqual(list(frames.follow(3)), [])
                for frame in seen:
                    written = numpy.asarray(Image.open(pathlib.Path(folder) / f"frame_{frame.number:08d}.png")).astype(int)
                    self.assertTrue(numpy.array_equal(written, frame.copy()))

    def test_a_frame_that_was_overtaken_is_told(self):
        values = {"mode": "free_run", "outputs.shm.name": self.NAME, "outputs.shm.slots": 2}
        with hilcam.Bench(SCENARIO, values, frames=8, program=HILCAM) as bench, hilcam.SharedFrames(self.NAME, wait_s=10) as frames:
            first = next(frames.follow(timeout_s=60))
            bench.wait(120)
            self.assertEqual(frames.newest, 8)
            self.assertFalse(first.is_whole())
            self.assertRaises(hilcam.Overtaken, first.copy)
            self.assertIsNone(frames.get(first.number))
            self.assertIsNotNone(frames.get(8))

    def test_what_a_killed_one_left_is_replaced(self):
        values = {"mode": "lockstep", "outputs.shm.name": self.NAME}
        with hilcam.Bench(SCENARIO, values, program=HILCAM) as killed:
            old = hilcam.SharedFrames(self.NAME)
            with self.assertRaisesRegex(hilcam.BenchFailed, f"which process {killed.process.pid} writes; accepted: a name of its own"):
                with hilcam.Bench(SCENARIO, values, program=HILCAM):
                    pass
            self.assertFalse(old.has_ended)
            killed.process.kill()
            killed.process.wait()
            self.assertTrue(old.has_ended)
            self.assertFalse(old.wait(0, timeout_s=60))
            self.assertEqual(list(old.follow(timeout_s=60)), [])
            with hilcam.Bench(SCENARIO, values, frames=1, program=HILCAM) as bench, hilcam.Client(bench.tcp, timeout_s=30) as camera:
                self.assertTrue(old.has_ended)
                with hilcam.SharedFrames(self.NAME) as frames:
                    self.assertEqual(frames.writer_pid, bench.process.pid)
                    self.exposed(camera, bench, 0)
                    self.assertTrue(frames.wait(0, 60))
            self.assertFalse(pathlib.Path("/dev/shm", self.NAME).exists())

    def test_what_is_none_of_ours_is_refused(self):
        path = pathlib.Path("/dev/shm", self.NAME)
        self.assertRaisesRegex(hilcam.SharedMemoryError, "no such shared memory: does hilcam run", hilcam.SharedFrames, self.NAME)
        for content, message in ((b"x" * 4096, "not a shared memory of hilcam's"), (bytes(4096), "not ready yet"),
                                 (b"HLCSHM 1" + (2).to_bytes(4, sys.byteorder) + bytes(4084), "version 2 of hilcam's shared memory; accepted: 1"),
                                 (b"HLCSHM 1" + (1).to_bytes(4, sys.byteorder) + bytes(4084), "figures do not fit its size")):
            path.write_bytes(content)
            self.assertRaisesRegex(hilcam.SharedMemoryError, message, hilcam.SharedFrames, self.NAME)
        with self.assertRaisesRegex(hilcam.BenchFailed, "a shared memory of another user|that hilcam has not made|outputs.shm.name"):
            path.write_bytes(b"x" * 4096)
            with hilcam.Bench(SCENARIO, {"outputs.shm.name": self.NAME}, program=HILCAM):
                pass
        self.assertEqual(path.read_bytes(), b"x" * 4096)
        with self.assertRaisesRegex(hilcam.BenchFailed, "outputs.shm.name: found 'a/b'; accepted: 1 to 200"):
            with hilcam.Bench(SCENARIO, {"outputs.shm.name": "a/b"}, program=HILCAM):
                pass


class Campaigns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        top = pathlib.Path(cls.temporary.name)
        (top / "t.csv").write_text("camera.exposure_ms\n0.1\n-1\n0.3\n")
        (top / "c.yaml").write_text(f"name: c\nscenario: {SCENARIO}\ncount: 3\ntable: t.csv\npictures: {{count: 2, flow: true, variance: true, layers: [object, position]}}\nlabels: [bop]\n")
        cls.campaign = hilcam.Campaign.make(top / "c.yaml", top / "out", program=str(HILCAM))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_results_are_tables(self):
        c = self.campaign
        self.assertEqual(len(c), 3)
        self.assertEqual(c.done.tolist(), [True, False, True])
        self.assertEqual(c.column("camera.exposure_ms").tolist(), [0.1, -1, 0.3])
        self.assertTrue(numpy.isnan(c.column("snr")[1]) and c.column("snr")[2] > c.column("snr")[0])
        self.assertIn("exposure_ms: found '-1'", c.failures()["000002"])
        self.assertEqual(c.table()["case"].tolist(), c.column("case").tolist())
        self.assertEqual([case.done for case in c], [True, False, True])

    def test_pictures_and_layers_are_arrays(self):
        c = self.campaign
        truth = c.truth(1)
        self.assertEqual(len(truth), 2)
        size = (truth[0].image.height_px, truth[0].image.width_px)
        self.assertEqual(c.image(1).shape, size)
        self.assertEqual(c.view(1, picture=1).shape[:2], size)
        mask = c.mask(1)
        self.assertEqual(int(mask.sum()), truth[0].objects[0].visible_px)
        self.assertTrue(numpy.array_equal(c.silhouette(1), mask))  # nothing stands before it
        layers = c.layers(1)
        self.assertTrue(numpy.array_equal(layers["object.ID"] == 1, mask))
        self.assertLess(numpy.abs(layers["position.Z"][mask] - truth[0].objects[0].position_camera_m[2]).max(), truth[0].objects[0].radius_m)
        self.assertEqual(c.flow(1).shape, size + (2,))
        self.assertGreater(c.image(1)[mask].mean(), c.image(1)[~mask].mean())
        self.assertEqual(c.variance(1).shape, size)
        self.assertGreater(c.variance(1)[mask].mean(), c.variance(1)[~mask].mean())
        self.assertRaises(FileNotFoundError, c.flow, 1, 1)


class Installed(unittest.TestCase):
    """Installed into a bare environment without a network, as on a bench's machine: neither setuptools nor numpy are there."""

    def test_pip_installs_it_from_the_tree_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            made = subprocess.run([sys.executable, "-m", "venv", f"{folder}/bare"], capture_output=True)
            if made.returncode:
                self.skipTest("python3-venv is missing")
            python = f"{folder}/bare/bin/python"
            bare = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
            result = subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-index", "--disable-pip-version-check",
                                     str(SOURCE / "tools/python")], capture_output=True, text=True, env=bare)
            self.assertEqual(result.returncode, 0, result.stderr)
            words = ("import hilcam, hilcam.client\n"
                     "print(hilcam.__version__, hilcam.__file__, hilcam.look_at((1, 0, 0), (0, 0, 0)))\n"
                     "try: hilcam.Campaign\n"
                     "except ImportError as error: print(error)\n")
            result = subprocess.run([python, "-c", words], capture_output=True, text=True, cwd=folder, env=bare)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue(result.stdout.startswith(f"{hilcam.__version__} {folder}/bare/lib/"), result.stdout)
            self.assertIn("hilcam.Campaign needs numpy", result.stdout)
            client, = pathlib.Path(folder).glob("bare/lib/*/site-packages/hilcam/client.py")
            self.assertFalse(client.is_symlink())
            removed = subprocess.run([python, "-m", "pip", "uninstall", "--quiet", "--yes", "hilcam"], capture_output=True, text=True, env=bare)
            self.assertEqual(removed.returncode, 0, removed.stderr)
            self.assertFalse(client.exists())

    def test_wheels_of_the_same_files_are_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            words = "import sys, wheel_of_hilcam as w; print(w.build_wheel(sys.argv[1])); print(w.build_sdist(sys.argv[1]))"
            wheels = set()
            for n in range(2):
                out = pathlib.Path(folder) / str(n)
                out.mkdir()
                names = subprocess.run([sys.executable, "-c", words, str(out)], cwd=SOURCE / "tools/python", check=True, capture_output=True,
                                       text=True).stdout.split()
                self.assertEqual(sorted(names), sorted(p.name for p in out.iterdir()))
                wheels.add((out / names[0]).read_bytes())
            self.assertEqual(len(wheels), 1)

    def test_its_version_is_the_programs(self):
        told = subprocess.run([HILCAM, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertTrue(told.startswith(f"hilcam {hilcam.__version__} ("), told)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
