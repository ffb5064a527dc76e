#!/usr/bin/python3
"""hilcam and the simulator 42, of which speaker.py has the socket.

    ip42_test.py HILCAM
"""
import json
import math
import os
import pathlib
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

import numpy
from PIL import Image

from speaker import Speaker, after, orbit, spacecraft, time_line

HILCAM = os.path.abspath(sys.argv[1])
HERE = pathlib.Path(__file__).resolve().parent
SCENARIO = HERE / "scenario.yaml"
os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")

WIDTH, HEIGHT = 128, 96
FOCAL_PX = 2.5e-3 / 11e-6
# The reference orbit. Whole metres add up exactly.
ORBIT = (0.0, 42164000.0, 0.0)
EYE = (30.0, 0.0, 0.0)  # from the orbit
# The camera's x is N's +y, its y N's -z, its z N's -x: 42 has the scalar last.
LOOKING = (-0.5, -0.5, 0.5, 0.5)
STILL = ((0, 0, 0, 1), (0, 0, 0))


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def product(a, b):
    """Of quaternions with the scalar last."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz)


def turn(axis, angle_rad):
    s = math.sin(angle_rad / 2)
    return (axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle_rad / 2))


def message(elapsed_s, target=(0, 0, 0), bodies=(STILL,), eye=EYE, eye_attitude=LOOKING, velocity=(0, 0, 0)):
    """Both spacecraft and their orbit, after so many seconds of the simulation."""
    return (time_line(after(elapsed_s)) + spacecraft(0, eye, bodies=((eye_attitude, (0, 0, 0)),), sun=None) +
            spacecraft(1, target, velocity, bodies, sun=None) + orbit(0, ORBIT, (0, 0, 0)))


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Hilcam:
    """`hilcam run` on the test's scenario in a folder of its own."""

    def __init__(self, folder, *sets, arguments=()):
        self.folder, self.port = pathlib.Path(folder), free_port()
        self.report_file, self.log_file = self.folder / "report.json", self.folder / "log"
        command = [HILCAM, "run", str(SCENARIO), "--report", str(self.report_file), *arguments]
        for value in (f"commands.ip42.port={self.port}", f"outputs.files.folder={folder}/frames", *sets):
            command += ["--set", value]
        with self.log_file.open("w") as log:
            self.process = subprocess.Popen(command, stderr=log, stdout=log, cwd=folder)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def connect(self):
        try:
            return Speaker(self.port)
        except ConnectionRefusedError:
            raise AssertionError(self.log_file.read_text()) from None

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.ended()

    def ended(self):
        assert self.process.wait(60) == 0, self.log_file.read_text()
        return json.loads(self.report_file.read_text())

    def said(self):
        """What is wrong, without who is connected and how many lines are not used."""
        lines = [line.split("ip42: ", 1)[1] for line in self.log_file.read_text().splitlines() if "ip42: " in line]
        return [line for line in lines if "is connected" not in line and "lines of each step" not in line]

    def picture(self, number):
        return numpy.array(Image.open(self.folder / "frames" / f"frame_{number:08}.png"))

    def names(self):
        return sorted(p.name for p in (self.folder / "frames").glob("frame_*.png"))


def figures(report):
    """Of the output that knows when a frame is done."""
    own = [o for o in report["outputs"] if o["name"] == "ip42 camera 1"]
    return own[0]["frames"], own[0]


def rendered(folder, elapsed_s, *sets):
    """`hilcam render`: the first frame of a run."""
    file = pathlib.Path(folder) / "reference.png"
    command = [HILCAM, "render", str(SCENARIO), "--out", str(file), "--set", f"time_utc={after(elapsed_s).isoformat()}Z"]
    for value in sets:
        command += ["--set", value]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    return numpy.array(Image.open(file))


def pose(position, attitude):
    x, y, z, w = attitude
    return f"{{position_m: {list(position)}, attitude_wxyz: [{w}, {x}, {y}, {z}]}}"


def middle_of(picture):
    """Of the box around what is brighter than half of the brightest [px]."""
    y, x = numpy.nonzero(picture > (int(picture.max()) + int(numpy.median(picture))) / 2)
    return (x.min() + x.max()) / 2, (y.min() + y.max()) / 2


class Frames(unittest.TestCase):
    def test_a_frame_shows_the_state_of_its_instant(self):
        """Bit for bit what `hilcam render` makes of the same poses and angles; places are those of the orbit plus the spacecraft's own."""
        base = turn((0.6, 0, 0.8), 0.7)
        north, south = math.radians(40), math.radians(-110)
        bodies = ((base, (0, 0, 0)), (product(base, turn((0, 1, 0), north)), (0, 0, 0)), (product(base, turn((0, 1, 0), south)), (0, 0, 0)))
        table = ("commands.ip42.bodies=[{body: 'SC[0].B[0]', moves: camera}, {body: 'SC[1].B[0]', moves: target}, "
                 "{body: 'SC[1].B[1]', moves: target, joint: 1}, {body: 'SC[1].B[2]', moves: target, joint: 2}]")
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder, table) as hilcam:
            speaker = hilcam.connect()
            speaker.step(message(60.25, (0, 2, -1), bodies))
            report = hilcam.stop()
            expected = rendered(folder, 60.25, "camera_pose=" + pose(add(ORBIT, EYE), LOOKING),
                                "objects.0.pose=" + pose(add(ORBIT, (0, 2, -1)), base),
                                f"objects.0.joints.0.angle_deg={math.degrees(north)}", f"objects.0.joints.1.angle_deg={math.degrees(south)}")
            numpy.testing.assert_array_equal(hilcam.picture(1), expected)
            self.assertGreater(int(expected.max()), 3 * int(numpy.median(expected)))  # there is something in it
            still = rendered(folder, 60.25, "camera_pose=" + pose(add(ORBIT, EYE), LOOKING),
                             "objects.0.pose=" + pose(add(ORBIT, (0, 2, -1)), base))
            self.assertGreater(numpy.abs(expected.astype(int) - still).max(), 20)  # the wings make a difference
            self.assertEqual(report["commands"]["refused"], 0)
            self.assertEqual(hilcam.said(), [])

    def test_pictures_follow_the_bodies(self):
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder) as hilcam:
            speaker = hilcam.connect()
            places = [(0, 0.5 * k, 0.3 * k) for k in range(-8, 9)]
            for k, place in enumerate(places):
                speaker.step(message(0.1 * k, place))
            report = hilcam.stop()
            self.assertEqual(figures(report)[0], len(places))
            first = middle_of(hilcam.picture(1))
            for k, place in enumerate(places):
                x, y = middle_of(hilcam.picture(k + 1))
                # 3.8 px a step to the right and 2.3 up. The box has whole pixels.
                self.assertAlmostEqual(x - first[0], FOCAL_PX / 30 * (place[1] - places[0][1]), delta=1.5)
                self.assertAlmostEqual(y - first[1], -FOCAL_PX / 30 * (place[2] - places[0][2]), delta=1.5)

    def test_the_same_stream_gives_the_same_frames_and_so_does_a_recording(self):
        pictures = []
        with tempfile.TemporaryDirectory() as top:
            for run in ("one", "two"):
                folder = pathlib.Path(top) / run
                folder.mkdir()
                with Hilcam(folder, arguments=("--record", f"{folder}/run.hrec")) as hilcam:
                    speaker = hilcam.connect()
                    for k in range(12):
                        if run == "two" and k % 3 == 0:
                            time.sleep(0.03)  # at another pace
                        speaker.step(message(0.1 * k, (0, 0.4 * k, 0), ((turn((0, 0, 1), 0.1 * k), (0, 0, 1.0)),), velocity=(0, 4.0, 0)))
                    hilcam.stop()
                    pictures.append([hilcam.picture(k + 1) for k in range(12)])
            numpy.testing.assert_array_equal(pictures[0], pictures[1])
            replayed = pathlib.Path(top) / "replayed"
            replayed.mkdir()
            with Hilcam(replayed, arguments=("--replay", f"{top}/one/run.hrec", "--fast")) as hilcam:
                hilcam.ended()
                numpy.testing.assert_array_equal([hilcam.picture(k + 1) for k in range(12)], pictures[0])

    def test_not_every_step_needs_a_frame(self):
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder, "commands.ip42.steps_per_frame=5") as hilcam:
            speaker = hilcam.connect()
            for k in range(16):
                speaker.step(message(0.1 * k))
            report = hilcam.stop()
            self.assertEqual((len(hilcam.names()), figures(report)[1]["steps"]), (4, 16))


class Connection(unittest.TestCase):
    def test_hilcam_asks_until_42_listens(self):
        """42 as SERVER: it takes one peer, and is started after hilcam."""
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder, "commands.ip42.role=client") as hilcam:
            while not hilcam.said():
                time.sleep(0.05)
            for run in range(2):
                speaker = Speaker(hilcam.port, serves=True)
                speaker.step(message(run))
                speaker.close()
            while len(hilcam.said()) < 3:
                time.sleep(0.05)
            report = hilcam.stop()
            self.assertEqual(figures(report)[0], 2)
            refused, first, second = hilcam.said()
            self.assertIn("42 does not answer at 127.0.0.1", refused)
            for gone in (first, second):
                self.assertEqual(gone, "42 went away after 1 steps; it is waited for")

    def test_its_end_may_be_hilcams(self):
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder, "commands.ip42.stay=false") as hilcam:
            speaker = hilcam.connect()
            speaker.step(message(0))
            speaker.close()
            self.assertEqual(hilcam.ended()["frames"], 1)

    def test_another_run_goes_back_in_time(self):
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder) as hilcam:
            for _ in range(2):
                speaker = hilcam.connect()
                for k in range(3):
                    speaker.step(message(k, (0, k, 0)))
                speaker.close()
            report = hilcam.stop()
            self.assertEqual(figures(report)[0], 6)
            for k in (1, 2, 3):  # noise alone differs: frames 1 and 4 show the same
                self.assertLess(numpy.abs(hilcam.picture(k).astype(int) - hilcam.picture(k + 3)).mean(), 3)

    def test_outside_lockstep_the_answer_comes_at_once(self):
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder, "mode=free_run", "camera.frame_rate_hz=5") as hilcam:
            speaker = hilcam.connect()
            held = [speaker.step(message(0.1 * k, (0, 4, 0))) for k in range(200)]
            time.sleep(1.0)
            hilcam.stop()
            # Frames come every 200 ms.
            self.assertLess(statistics.median(held), 0.02)
            last = len(hilcam.names())
            self.assertGreaterEqual(last, 3)
            self.assertGreater(middle_of(hilcam.picture(last))[0], WIDTH / 2 + 20)  # 30 px to the right


class Hold(unittest.TestCase):
    def test_42_waits_for_the_frame_and_no_longer_than_it_is_told(self):
        """A camera that is far too slow for it: every step is answered in time, and what has no frame is counted."""
        slow = ("quality.samples_per_axis=8", "camera.width_px=1600", "camera.height_px=1200")
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder, *slow, "commands.ip42.hold_ms=30") as hilcam:
            speaker = hilcam.connect()
            held = [speaker.step(message(0.1 * k)) for k in range(12)]
            # Until the last frame is done.
            time.sleep(2)
            report = hilcam.stop()
            frames, own = figures(report)
            self.assertLess(max(held), 0.03 + 0.15)  # 150 ms for a busy machine
            self.assertGreaterEqual(own["late_frames"], 1)
            self.assertGreaterEqual(own["dropped_steps"], 1)
            self.assertEqual(frames + own["dropped_steps"], 12)
            self.assertEqual(report["commands"]["refused"], own["dropped_steps"])
            said = hilcam.said()
            self.assertEqual(len([line for line in said if line.startswith("a frame was not done within 30 ms")]), 1, said)
            self.assertEqual(len([line for line in said if line.startswith("a step has no frame")]), 1, said)

    def test_the_frame_is_done_when_42_goes_on(self):
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder) as hilcam:
            speaker = hilcam.connect()
            held = [speaker.step(message(0.1 * k)) for k in range(20)]
            report = hilcam.stop()
            frames, own = figures(report)
            self.assertEqual((frames, own["late_frames"], own["dropped_steps"]), (20, 0, 0))
            # hilcam's own figures are those of its peer, less the way there and back.
            self.assertLessEqual(own["held_max_ms"], 1e3 * max(held))
            self.assertGreater(own["held_p50_ms"], 0)


class BadInput(unittest.TestCase):
    def test_it_is_named_once_and_answered(self):
        good = message(5)
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder) as hilcam:
            speaker = hilcam.connect()
            speaker.step(good.replace("4.216400000000e+07", "nan"))
            speaker.step(good.replace("4.216400000000e+07", "4.2e+07x"))
            speaker.step("garbage\n" * 10)
            speaker.step("SC[0].x = [1 2 3]\n" * 10000)
            speaker.step("x" * 300000 + "\n")
            speaker.step(good.replace("Orb[0]", "Orb[1]"), end="[EOF]\n")  # no orbit: nothing moves, a frame comes
            speaker.step(message(6))
            speaker.close()
            cut = hilcam.connect()
            cut.socket.sendall(good.encode()[:500])
            cut.close()
            last = hilcam.connect()
            last.step(message(7))
            report = hilcam.stop()
            self.assertEqual(figures(report)[0], 3)
            self.assertEqual(report["commands"]["refused"], 5)
            said = hilcam.said()
            for begin in ("a message is not used: line 1", "a message is not used: line", "a message of more than 65536 bytes",
                          "42 sends no Orb[0].PosN", "42 went away after 7 steps", "42 went away after 0 steps"):
                if begin != "a message is not used: line 1":
                    self.assertEqual(len([line for line in said if line.startswith(begin)]), 1, (begin, said))
            self.assertIn("three finite numbers", said[0])

    def test_a_peer_that_sends_no_end_is_survived(self):
        with tempfile.TemporaryDirectory() as folder, Hilcam(folder) as hilcam:
            peer = hilcam.connect()
            for _ in range(200):
                peer.socket.sendall(b"y" * 100000)
            status = pathlib.Path(f"/proc/{hilcam.process.pid}/status").read_text()
            peak_mb = int(status.split("VmRSS:")[1].split()[0]) / 1000
            peer.socket.sendall(b"\n")
            peer.step("")
            peer.step(message(1))
            report = hilcam.stop()
            self.assertEqual(figures(report)[0], 1)
            self.assertLess(peak_mb, 1000)

    def test_a_scenario_says_what_is_wrong_with_its_table(self):
        for value, complaint in (("[{body: 'SC[0].G[0]'}]", "found 'SC[0].G[0]'; accepted: SC[n].B[k]"),
                                 ("[{body: 'SC[0].B[0]', moves: nobody}]", "found 'nobody'; accepted: camera, target"),
                                 ("[{body: 'SC[0].B[0]', moves: target, joint: 3}]", "found 3; accepted: 0 to 2"),
                                 ("[{body: 'SC[0].B[0]', moves: target, joint: 1}]", "needs a body that moves 'target' itself"),
                                 ("[]", "moves nothing")):
            result = subprocess.run([HILCAM, "run", str(SCENARIO), "--frames", "1", "--set", f"commands.ip42.bodies={value}"],
                                    capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(complaint, result.stderr)
        result = subprocess.run([HILCAM, "run", str(SCENARIO), "--frames", "1", "--set", "origin={kind: body_center, body: mars}"],
                                capture_output=True, text=True, timeout=60)
        self.assertIn("commands.ip42.pole_deg: is needed with an origin at mars", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
