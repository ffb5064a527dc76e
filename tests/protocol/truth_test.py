#!/usr/bin/python3
"""Truth from outside: files beside a rendered picture, and lines over TCP from a running camera.

    truth_test.py HILCAM SOURCE_DIR
"""
import json
import math
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
PORT = 15612
sys.path.insert(0, str(SOURCE / "tools/client"))
import hilcam_client  # noqa: E402

LOOKING = hilcam_client.look_at((22, 15, 7), (0, 0, 0))


def rotated(wxyz, v):
    """v turned by a unit quaternion."""
    w, q = wxyz[0], wxyz[1:]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    t = [2 * c for c in cross(q, v)]
    return [v[i] + w * t[i] + cross(q, t)[i] for i in range(3)]


class Truth(unittest.TestCase):
    def check(self, t):
        """What must hold of any frame of the scenario, by its own figures."""
        target = t["objects"][0]
        self.assertEqual(target["name"], "target")
        # The camera looks at the world's origin, where the target is.
        camera = t["pose"]["position_m"]
        self.assertAlmostEqual(target["distance_m"], math.dist(camera, target["position_m"]), places=6)
        in_camera = [p - c for p, c in zip(target["position_m"], camera)]
        back = rotated(t["pose"]["attitude_wxyz"], target["position_camera_m"])
        for a, b in zip(in_camera, back):
            self.assertAlmostEqual(a, b, places=6)
        x, y, z = target["position_camera_m"]
        fx, fy = t["image"]["focal_length_px"]
        cx, cy = t["image"]["principal_point_px"]
        self.assertAlmostEqual(target["center_px"][0], cx + fx * x / z, places=4)
        self.assertAlmostEqual(target["center_px"][1], cy + fy * y / z, places=4)
        # Both say the same of the Sun.
        sun = rotated(t["pose"]["attitude_wxyz"], t["sun"]["direction_camera"])
        for a, b in zip(sun, t["sun"]["direction"]):
            self.assertAlmostEqual(a, b, places=9)
        self.assertGreater(target["visible_px"], 100)
        # Nothing is before it; where its box stays inside the frame, all of it is visible.
        left, top, width, height = target["silhouette_box_px"]
        inside = left >= 0 and top >= 0 and left + width <= t["image"]["width_px"] and top + height <= t["image"]["height_px"]
        if inside:
            self.assertEqual(target["visible_fraction"], 1)
        else:
            self.assertLess(target["visible_fraction"], 1)
        self.assertEqual([b["name"] for b in t["bodies"]][0], "sun")

    def test_a_picture_with_its_truth(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            subprocess.run([HILCAM, "render", SCENARIO, "--out", folder / "with.png", "--truth", folder / "truth"],
                           check=True, timeout=120)
            subprocess.run([HILCAM, "render", SCENARIO, "--out", folder / "without.png"], check=True, timeout=120)
            self.assertEqual((folder / "with.png").read_bytes(), (folder / "without.png").read_bytes())
            header, line = (json.loads(line) for line in (folder / "truth/with.truth.jsonl").read_text().splitlines())
            self.assertEqual(header["run"]["scenario"], "protocol_test")
            self.assertEqual(header["run"]["seed"], 3)
            self.check(line)
            picture = (folder / "truth/with.truth.exr").read_bytes()
            self.assertEqual(picture[:4], bytes([0x76, 0x2F, 0x31, 0x01]))  # OpenEXR's magic number
            for channel in (b"object.ID", b"range.D", b"depth.Z", b"normal.X", b"position.Z"):
                self.assertIn(channel + b"\0", picture[:4096])

    def test_a_runs_labels_are_not_lost(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            sets = ["--set", f"outputs.truth.folder={folder}/labels", "--set", f"outputs.files.folder={folder}/frames"]

            def run(*more):
                return subprocess.run([HILCAM, "run", SCENARIO, *sets, *more], capture_output=True, text=True, timeout=120)

            def lines():
                return [json.loads(line) for line in (folder / "labels/truth.jsonl").read_text().splitlines()]

            report = folder / "report.json"
            self.assertEqual(run("--frames", "5", "--report", report).returncode, 0)
            first = lines()
            self.assertEqual(first[0]["run"]["id"], json.loads(report.read_text())["run"])
            self.assertEqual(len(first), 6)
            again = run("--frames", "2")
            self.assertEqual(again.returncode, 2, again.stderr)
            self.assertIn("frames', which holds 5 files of another run", again.stderr)
            again = run("--frames", "2", "--set", "outputs.files.overwrite=true")
            self.assertEqual(again.returncode, 2, again.stderr)
            self.assertIn("labels', which holds a file of another run ('truth.jsonl')", again.stderr)
            self.assertEqual(len(list((folder / "frames").iterdir())), 5)
            check = subprocess.run([HILCAM, "check", SCENARIO, *sets], capture_output=True, text=True, timeout=120)
            self.assertIn("outputs.files.folder: found", check.stdout)
            picture = subprocess.run([HILCAM, "render", SCENARIO, "--out", folder / "view.png", "--truth", folder / "labels"],
                                     capture_output=True, text=True, timeout=120)
            self.assertEqual(picture.returncode, 0, picture.stderr)
            self.assertEqual(lines(), first)
            self.assertEqual(run("--frames", "2", "--set", "outputs.files.overwrite=true", "--set",
                                 "outputs.truth.overwrite=true").returncode, 0)
            self.assertEqual(len(lines()), 3)
            self.assertNotEqual(lines()[0]["run"]["id"], first[0]["run"]["id"])
            self.assertEqual(len(list((folder / "frames").iterdir())), 2)

    def test_a_line_has_the_keys_of_the_page(self):
        page = (SOURCE / "docs/truth.md").read_text()

        def keys(heading):
            """Of the first column of the table behind some words: 'a.b', '.c' are ['a.b', 'a.c']."""
            table = page[page.index(heading):].split("\n\n", 2)[1]
            rows = re.findall(r"^\| (`.*?) \|", table, re.MULTILINE)
            found = []
            for row in rows:
                first = ""
                for name in re.findall(r"`([^`]+)`", row):
                    first = first or name.rpartition(".")[0]
                    found.append(first + name if name.startswith(".") else name)
            return set(found)

        def check(found, heading, where, optional=(), more=()):
            wanted = keys(heading) | set(more)
            self.assertGreater(len(wanted), 4, heading)
            self.assertEqual(wanted - set(found) - set(optional), set(), where)
            self.assertEqual(set(found) - wanted, set(), where)

        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([HILCAM, "render", SCENARIO, "--out", f"{folder}/a.png", "--truth", folder],
                           check=True, timeout=120)
            line = json.loads(pathlib.Path(f"{folder}/a.truth.jsonl").read_text().splitlines()[1])
        self.assertEqual(line["version"], 1)
        nested = [f"{key}.{inner}" for key in ("image", "pose", "sun") for inner in line[key]]
        check([key for key in line if key not in ("image", "pose", "sun")] + nested,
              "Each frame has one JSON object", "a line",
              {"height_above_ground_m", "craters", "boulders", "ground_left_out", "image.distortion_x",
               "image.distortion_y"})
        target, sun = line["objects"][0], line["bodies"][0]
        of_bodies = {"equatorial_radius_m", "polar_radius_m"}
        seen = keys("`visibility` (true by default) adds these:")
        check(target, "An object or a body has these keys:", "an object", of_bodies, seen)
        self.assertEqual(seen - set(target), set())
        self.assertEqual(of_bodies - set(sun), set())
        self.assertEqual(set(sun) - keys("An object or a body has these keys:") - seen, set())
        if line["stars"]:
            check(line["stars"][0], "A star has these keys:", "a star")

    def test_a_frame_that_stale_poses_leave_dark_has_no_line(self):
        with tempfile.TemporaryDirectory() as folder:
            for when_stale, frames in (("black", [1, 3]), ("hold", [1, 2, 3])):
                truth = pathlib.Path(folder) / when_stale
                process = subprocess.Popen([
                    HILCAM, "run", SCENARIO, "--frames", "3", "--set", "mode=lockstep",
                    "--set", f"outputs.truth.folder={truth}", "--set", f"commands.udp.port={PORT}",
                    "--set", "commands.poses={stale_after_s: 0.5, when_stale: " + when_stale + "}",
                ], stderr=subprocess.PIPE, text=True)
                try:
                    self.order_frames(process)
                finally:
                    process.kill()
                    process.communicate(timeout=30)
                lines = [json.loads(line) for line in (truth / "truth.jsonl").read_text().splitlines()[1:]]
                self.assertEqual([line["frame"] for line in lines], frames, when_stale)

    def order_frames(self, process):
        """Two frames, the second one long after the only pose, and a third with a new one."""
        with hilcam_client.Client(f"127.0.0.1:{PORT}", timeout_s=30) as client:
            start = self.answered(process, client, hilcam_client.Ping()).simulated_tai_ns
            for at_s, is_posed in ((0.1, True), (2, False), (3, True)):
                time_ns = start + round(at_s * 1e9)
                if is_posed:
                    client.send(hilcam_client.Pose(0, time_ns, (22, 15, 7), attitude_wxyz=LOOKING))
                client.send(hilcam_client.Expose(1, time_ns))
        process.wait(timeout=60)

    def answered(self, process, client, command):
        for _ in range(600):
            if process.poll() is not None:
                self.fail(process.stderr.read())
            try:
                return client.send(command, timeout_s=0.1)
            except hilcam_client.NoAnswer:
                pass
        self.fail("the camera does not answer")
        return None

    def test_a_running_cameras_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            report = pathlib.Path(folder) / "report.json"
            process = subprocess.Popen([HILCAM, "run", SCENARIO, "--set", f"outputs.truth.port={PORT}", "--duration", "60",
                                        "--report", report], stderr=subprocess.PIPE, text=True)
            try:
                client = self.connect(process)
                lines = client.makefile()
                frames = []
                for _ in range(5):
                    t = json.loads(lines.readline())
                    self.check(t)
                    frames.append(t)
                ids = [t["frame"] for t in frames]
                self.assertEqual(ids, sorted(set(ids)))
                # Both clocks run alike.
                self.assertEqual(frames[-1]["time_tai_ns"] - frames[0]["time_tai_ns"],
                                 frames[-1]["monotonic_ns"] - frames[0]["monotonic_ns"])
            finally:
                process.terminate()
                process.communicate(timeout=30)
            outputs = {o["name"]: o for o in json.loads(report.read_text())["outputs"]}
            self.assertGreaterEqual(outputs["truth"]["frames"], 5)
            self.assertGreater(outputs["truth"]["truth_ms"], 0)

    def connect(self, process):
        for _ in range(600):
            if process.poll() is not None:
                self.fail(process.stderr.read())
            try:
                client = socket.create_connection(("127.0.0.1", PORT), timeout=30)
                return client
            except ConnectionRefusedError:
                time.sleep(0.1)
        self.fail("the camera does not open its port")
        return None


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
