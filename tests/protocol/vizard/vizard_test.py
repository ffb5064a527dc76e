#!/usr/bin/python3
"""Basilisk's vizInterface (basilisk.py) with hilcam in Vizard's place.

    vizard_test.py HILCAM
"""
import io
import json
import math
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import numpy
from PIL import Image

import basilisk

HILCAM = os.path.abspath(sys.argv[1])
HERE = pathlib.Path(__file__).resolve().parent
SCENARIO = HERE / "scenario.yaml"
os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")

WIDTH, HEIGHT, BITS = 128, 96, 12
VIEW_DEG = math.degrees(2 * math.atan(HEIGHT * 11e-6 / 2 / 2.5e-3))
# Of the simulation: its epoch, and its frame N, whose origin is not the Earth. Whole metres and eighths of them add up exactly.
EPOCH = dict(year=2001, month=3, day=20, hours=11, minutes=30, seconds=0.0)
EARTH, EARTH_VELOCITY = (1.5e11, -2e10, 7e9), (0.0, 29000.0, 125.0)
TARGET = (0.0, 42164000.0, 0.0)  # from the Earth


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def days_since_2000(elapsed_s):
    """Of the simulation's epoch, from 2000-01-01T12:00."""
    return 444 + (11.5 - 12) / 24 + elapsed_s / 86400


def sun_from_earth(elapsed_s):
    """Astronomical Almanac, low precision (0.01 deg), taken back to the equinox of 2000 by precession in longitude."""
    n = days_since_2000(elapsed_s)
    mean, anomaly = math.radians(280.460 + 0.9856474 * n), math.radians(357.528 + 0.9856003 * n)
    longitude = mean + math.radians(1.915 * math.sin(anomaly) + 0.020 * math.sin(2 * anomaly) - 1.397 * n / 36525)
    tilt = math.radians(23.439)
    return tuple(1.496e11 * x for x in (math.cos(longitude), math.cos(tilt) * math.sin(longitude),
                                        math.sin(tilt) * math.sin(longitude)))


def earth_turned(elapsed_s):
    """J2000 to the Earth's axes by its rotation angle (IAU 2000); precession of 15 months is 0.01 deg."""
    n = days_since_2000(elapsed_s)
    angle = 2 * math.pi * (0.7790572732640 + 1.00273781191135448 * n)
    c, s = math.cos(angle), math.sin(angle)
    return (c, s, 0, -s, c, 0, 0, 0, 1)


# Attitudes of the spacecraft that has the cameras; camera 1 looks along its own +z, camera 2 stands upside down beside it.
SIGMA_CB = {1: (0.0, 0.0, 0.0), 3: (0.0, 0.0, 1.0)}
CAMERA_AT = {1: (0.0, 0.0, 0.0), 3: (0.5, 0.0, 0.25)}


def looking_at_target(turned_rad=0.0):
    """sigma_BN of a body whose +z is N's -x (towards the target), +x is N's +y, +y is N's -z; turned about its z."""
    # The quaternion, N from B, of the two turns.
    c, s = math.cos(turned_rad / 2), math.sin(turned_rad / 2)
    w, x, y, z = 0.5, -0.5, -0.5, 0.5
    q = (w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s)
    return tuple(v / (1 + q[0]) for v in q[1:])


def quaternion(sigma):
    s2 = sum(v * v for v in sigma)
    return ((1 - s2) / (1 + s2), *(2 * v / (1 + s2) for v in sigma))


def update(frame, elapsed_s, distance_m, sigma, **parts):
    eye = add(add(TARGET, EARTH), (distance_m, 0.0, 0.0))
    fields = dict(
        celestialBodies=[basilisk.body("sun", add(EARTH, sun_from_earth(elapsed_s))),
                         basilisk.body("earth", EARTH, EARTH_VELOCITY, earth_turned(elapsed_s))],
        spacecraft=[basilisk.spacecraft("eye", eye, EARTH_VELOCITY, sigma),
                    basilisk.spacecraft("target", add(TARGET, EARTH), EARTH_VELOCITY)],
        cameras=[basilisk.camera(n, SIGMA_CB[n], parentName="eye", cameraPos_B=CAMERA_AT[n], fieldOfView=VIEW_DEG,
                                 resolution=[WIDTH, HEIGHT]) for n in (1, 3)])
    if frame == 1:
        fields.update(epoch=EPOCH, settings=dict(ambient=0.5, skybox="black"))
    fields.update(parts)
    return basilisk.message(frame, elapsed_s * 1e9, **fields)


def pixels(picture):
    return numpy.array(Image.open(io.BytesIO(picture)))


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Vizard:
    """`hilcam run` on the test's scenario in a folder of its own."""
    client = basilisk.VizInterface  # what connects

    def __init__(self, folder, *sets):
        self.folder, self.port = pathlib.Path(folder), free_port()
        self.report_file, self.log_file = self.folder / "report.json", self.folder / "log"
        command = [HILCAM, "run", str(SCENARIO), "--report", str(self.report_file)]
        for value in (f"commands.vizard.address=tcp://127.0.0.1:{self.port}", f"outputs.files.folder={folder}/first",
                      f"more_cameras.0.outputs.files.folder={folder}/second", *sets):
            command += ["--set", value]
        with self.log_file.open("w") as log:
            self.process = subprocess.Popen(command, stderr=log, stdout=log, cwd=folder)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def connect(self, **options):
        client = self.client(self.port, **options)
        assert client.reset() == b"PONG"
        return client

    def peak_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(status.split("VmHWM:")[1].split()[0]) / 1000

    def remarks(self):
        return [line.split("vizard: ", 1)[1] for line in self.log_file.read_text().splitlines() if "vizard: " in line]

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.ended()

    def ended(self):
        assert self.process.wait(60) == 0, self.log_file.read_text()
        return json.loads(self.report_file.read_text())


def rendered(folder, distance_m, sigma, elapsed_s):
    """The first frame of `hilcam render` from where camera 1 is."""
    file = pathlib.Path(folder) / "reference.png"
    position = add(TARGET, (distance_m, 0.0, 0.0))
    result = subprocess.run(
        [HILCAM, "render", str(SCENARIO), "--out", str(file), "--set",
         f"camera_pose={{position_m: {list(position)}, attitude_wxyz: {list(quaternion(sigma))}}}", "--set",
         f"time_utc=2001-03-20T11:{30 + int(elapsed_s) // 60:02}:{elapsed_s % 60:06.3f}Z"], capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    return numpy.array(Image.open(file))


def written(folder, camera, number):
    return numpy.array(Image.open(pathlib.Path(folder) / camera / f"frame_{number:08}.png"))


def middle_of(picture):
    """Of the box around what is brighter than half of the brightest [px]; a glint of the Sun moves within it."""
    y, x = numpy.nonzero(picture > picture.max() / 2)
    return (x.min() + x.max()) / 2, (y.min() + y.max()) / 2


def png_form(picture):
    """Bits and colour type (0: gray) of its header."""
    return picture[24], picture[25]


class OpticalNavigation(unittest.TestCase):
    def test_a_scripts_images_are_the_cameras_frames(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            client = vizard.connect()
            sigma = looking_at_target()
            for frame in range(1, 12):  # what Vizard needs to warm up
                self.assertEqual(client.step(update(frame, 0.1 * frame, 20, sigma)), {})
            first = client.step(update(12, 60, 20, sigma), [1, 3])
            second = client.step(update(13, 120, 16, looking_at_target(0.5)), [1, 3])

            # All bits, in the upper ones.
            image = pixels(first[1])
            self.assertEqual((image.shape, png_form(first[1])), ((HEIGHT, WIDTH), (16, 0)))
            numpy.testing.assert_array_equal(image, rendered(folder, 20, sigma, 60) << (16 - BITS))
            self.assertGreater(image.max(), 3 * image.min())  # there is something in it
            report = vizard.stop()
            for number, pictures in enumerate((first, second), 1):
                numpy.testing.assert_array_equal(pixels(pictures[1]) >> 4, written(folder, "first", number))
                numpy.testing.assert_array_equal(pixels(pictures[3]) >> 4, written(folder, "second", number))
            self.assertEqual(vizard.remarks(), [])
            self.assertEqual(report["commands"]["refused"], 0)
            outputs = [o for c in report["cameras"] for o in c["outputs"] if o["name"].startswith("vizard")]
            self.assertEqual([(o["name"], o["frames"]) for o in outputs], [("vizard camera 1", 2), ("vizard camera 2", 2)])
            client.close()

    def test_the_pictures_axes_are_basilisks(self):
        """A target to the right of and below the boresight is to the right of and below the picture's middle, for either camera."""
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            client = vizard.connect()
            px = HEIGHT / 2 / math.tan(math.radians(VIEW_DEG) / 2)  # focal length [px]
            sigma = looking_at_target()
            middle = client.step(update(1, 1, 40, sigma), [1, 3])
            # The eye moves to the left (-x, N's -y) by 2 m and up (-y, N's +z) by 1 m.
            moved = update(2, 2, 40, sigma)
            for axis, shift_m in ((1, -2.0), (2, 1.0)):
                moved.spacecraft[0].position[axis] += shift_m
            pictures = client.step(moved, [1, 3])
            for camera, sign in ((1, 1), (3, -1)):  # the second is upside down
                before, after = middle_of(pixels(middle[camera])), middle_of(pixels(pictures[camera]))
                # 11.4 and 5.7 px. The box has whole pixels; half a metre of depth changes it by a quarter.
                self.assertAlmostEqual(after[0] - before[0], sign * px * 2 / 40, delta=1.0)
                self.assertAlmostEqual(after[1] - before[1], sign * px * 1 / 40, delta=1.0)
            client.close()

    def test_bytes_are_the_upper_bits(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder, "commands.vizard.depth=8_bits") as vizard:
            client = vizard.connect()
            picture = client.step(update(1, 60, 20, looking_at_target()), [1])[1]
            self.assertEqual(png_form(picture), (8, 0))
            numpy.testing.assert_array_equal(pixels(picture), rendered(folder, 20, looking_at_target(), 60) >> (BITS - 8))
            client.close()

    def test_a_mosaic_gives_colours(self):
        filters = ", ".join(f"{{name: {name}, transmission: {t}}}" for name, t in (("R", 1), ("G", 0.5), ("B", 0.25)))
        with tempfile.TemporaryDirectory() as folder, \
                Vizard(folder, f"camera.color_filter={{pattern: RG GB, filters: [{filters}]}}") as vizard:
            client = vizard.connect()
            picture = client.step(update(1, 60, 20, looking_at_target()), [1])[1]
            client.close()
            vizard.stop()
            self.assertEqual(png_form(picture), (8, 2))  # 2: red, green, blue
            image, mosaic = pixels(picture), written(folder, "first", 1) >> (BITS - 8)
            for channel, x, y in ((0, 0, 0), (1, 1, 0), (1, 0, 1), (2, 1, 1)):
                numpy.testing.assert_array_equal(image[y::2, x::2, channel], mosaic[y::2, x::2])

    def test_cameras_can_be_named(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder, "commands.vizard.cameras=[{id: 3, camera: 1}]") as vizard:
            client = vizard.connect()
            pictures = client.step(update(1, 60, 20, looking_at_target()), [1, 3])
            self.assertEqual(pictures[1], b"")
            self.assertEqual(pixels(pictures[3]).shape, (HEIGHT, WIDTH))
            self.assertEqual(len(vizard.remarks()), 1, vizard.remarks())
            client.close()


class Older(unittest.TestCase):
    def test_a_picture_asked_for_without_a_number_is_the_first_cameras(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            client = vizard.connect(is_numbered=False)
            picture = client.step(update(1, 60, 20, looking_at_target()), [1])[1]
            numpy.testing.assert_array_equal(pixels(picture), rendered(folder, 20, looking_at_target(), 60) << (16 - BITS))
            client.close()


class Runs(unittest.TestCase):
    def test_another_run_of_the_simulation_starts_at_its_own_beginning(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            means = []
            for _ in range(2):
                client = vizard.connect()
                for frame, elapsed_s in ((1, 60), (2, 120), (3, 180)):
                    image = pixels(client.step(update(frame, elapsed_s, 20, looking_at_target()), [1])[1])
                means.append(image.mean())
                client.close()  # with an answer to its PING still to come
            self.assertAlmostEqual(means[0] / means[1], 1, delta=0.01)  # noise alone: the same place and time
            self.assertEqual(vizard.remarks(), [])

    def test_runs_of_one_process_leave_their_connections(self):
        """vizInterface closes none: a campaign in one process has one more with each run."""
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            clients = []
            for _ in range(12):
                clients.append(vizard.connect())
                self.assertNotEqual(clients[-1].step(update(1, 60, 20, looking_at_target()), [1])[1], b"")
            self.assertEqual(vizard.remarks(), [])
            for client in clients:
                client.close()

    def test_live_stream_asks_for_input_and_gets_none(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            client = vizard.connect(live=True)
            client.step(update(1, 0.1, 20, looking_at_target()))
            self.assertEqual(client.input.frameNumber, 1)
            client.step(update(2, 60, 20, looking_at_target()), [1])
            self.assertEqual(client.input.frameNumber, 2)
            client.close()

    def test_the_simulators_end_is_hilcams(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            client = vizard.connect()
            client.step(update(1, 60, 20, looking_at_target()), [1])
            client.end(update(2, 61, 20, looking_at_target()))
            self.assertEqual(vizard.ended()["frames"], 1)
            client.close()


class BadInput(unittest.TestCase):
    def test_a_simulator_that_vanishes_leaves_no_trace(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            for _ in range(3):
                client = vizard.connect()
                client.socket.recv()
                client.socket.send_multipart([b"SIM_UPDATE", b"", b"", update(1, 1, 20, looking_at_target()).SerializeToString()])
                client.socket.recv()
                client.socket.send(b"REQUEST_IMAGE_1")
                client.close()
            client = vizard.connect()
            self.assertNotEqual(client.step(update(1, 60, 20, looking_at_target()), [1])[1], b"")
            client.close()
            vizard.stop()

    def test_it_is_named_once_answered_and_survived(self):
        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            client = vizard.connect()
            sigma = looking_at_target()
            nobody = update(2, 2, 20, sigma)
            nobody.cameras[0].parentName = "nobody"
            alone = update(3, 3, 20, sigma)
            del alone.spacecraft[1]
            strange = update(4, 4, 20, sigma)
            strange.spacecraft.add(**basilisk.spacecraft("other", (1.5e11, 0, 0)))
            strange.spacecraft[1].rotation[0] = float("nan")
            good = update(5, 5, 20, sigma)
            good.cameras[0].resolution[0] = 512
            good.celestialBodies[0].position[1] += 1e9  # atan(1e9 / 1.496e11) = 0.38 deg, and 0.01 of the formula

            self.assertEqual(client.step(update(1, 1, 20, sigma), [9])[9], b"")  # no such camera
            for _ in range(3):
                self.assertEqual(client.step(nobody, [1])[1], b"")
            self.assertNotEqual(client.step(alone, [1])[1], b"")
            client.socket.recv()
            for bad in (b"\x0a\x7f\x01", strange.SerializeToString()):
                self.assertEqual(client.ask(b"SIM_UPDATE", b"", b"", bad), [b"ERROR"])
                self.assertEqual(client.ask(b"REQUEST_IMAGE_1"), [bytes(4), b""])
            self.assertEqual(client.ask(b"SIM_UPDATE"), [b"ERROR"])
            self.assertEqual(client.ask(b"HELLO\x07"), [b"ERROR"])
            self.assertEqual(client.ask(b"REQUEST_IMAGE_one"), [bytes(4), b""])
            self.assertEqual(client.ask(*[b"x"] * 50), [b"ERROR"])
            client.socket.send(b"PING")
            self.assertNotEqual(client.step(good, [1])[1], b"")
            client.close()
            report = vizard.stop()
            told = "\n".join(vizard.remarks())
            for needle in ("camera 9: no picture, as SIM_UPDATE has no such camera", "no spacecraft 'nobody'",
                           "object 1 'target' stays where it is", "SIM_UPDATE: is no VizMessage (3 bytes)",
                           "spacecraft 'target': rotation: found a number that is not finite", "no picture before a SIM_UPDATE",
                           "SIM_UPDATE of 1 parts; accepted: 4", "a request 'HELLO '; accepted: PING", "no picture for 'one'",
                           "a request 'x'", "the simulation's picture is 512 x 96 px, the scenario's camera gives 128 x 96",
                           "body 'sun': the simulation has it 0.3"):
                self.assertEqual(told.count(needle), 1, f"{needle}\n{told}")
            self.assertEqual(len(vizard.remarks()), 12, told)
            self.assertEqual(report["commands"]["refused"], 12)  # a camera, three times nobody, eight asked here

    def test_messages_without_end_take_no_memory(self):
        greeting = (b"\xff" + bytes(8) + b"\x7f\x03\x00NULL").ljust(64, b"\0")
        ready = b"\x05READY\x0bSocket-Type\x00\x00\x00\x03REQ"
        part = b"\x03" + (1 << 20).to_bytes(8, "big") + bytes(1 << 20)  # long, and more to come

        def passed_on(port):
            """MiB of a message of 140 parts that are taken."""
            with socket.create_connection(("127.0.0.1", port)) as peer:
                peer.sendall(greeting + b"\x04" + bytes([len(ready)]) + ready)
                answer = b""
                while b"READY" not in answer:
                    answer += peer.recv(1000)
                peer.sendall(b"\x01\x00")
                for sent in range(140):
                    try:
                        peer.sendall(part)
                    except OSError:
                        return sent
            return 140

        with tempfile.TemporaryDirectory() as folder, Vizard(folder) as vizard:
            client = vizard.connect()
            self.assertNotEqual(client.step(update(1, 60, 20, looking_at_target()), [1])[1], b"")
            before = vizard.peak_mb()
            for _ in range(8):
                self.assertLess(passed_on(vizard.port), 40)  # 16, and what is in the sockets
            crowd = [socket.create_connection(("127.0.0.1", vizard.port)) for _ in range(200)]
            self.assertNotEqual(client.step(update(2, 61, 20, looking_at_target()), [1])[1], b"")
            vizard.connect().close()  # its PING has its answer, though none of the crowd has gone
            for peer in crowd:
                peer.close()
            self.assertLess(vizard.peak_mb() - before, 300)
            client.close()
            vizard.stop()
            self.assertEqual([line for line in vizard.remarks() if "a connection was ended" in line][1:], [])

    def test_what_the_scenario_cannot_do_is_said_at_once(self):
        def refused(needle, *sets):
            command = [HILCAM, "check", str(SCENARIO)]
            for value in sets:
                command += ["--set", value]
            result = subprocess.run(command, capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(needle, result.stderr)
        address = "commands.vizard.address=tcp://127.0.0.1:5556"
        refused("needs 'mode: lockstep'", address, "mode=free_run")
        refused("accepted: tcp://ADDRESS:PORT", "commands.vizard.address=127.0.0.1:5556")
        refused("id 3 is there twice", "commands.vizard.cameras=[{id: 3, camera: 1}, {id: 3, camera: 2}]")
        refused("camera: found 3; accepted: 1 to 2", "commands.vizard.cameras=[{id: 3, camera: 3}]")

    def test_an_address_that_is_taken_is_named(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket() as other:
            other.bind(("127.0.0.1", 0))
            other.listen()
            port = other.getsockname()[1]
            result = subprocess.run(
                [HILCAM, "run", str(SCENARIO), "--set", f"commands.vizard.address=tcp://127.0.0.1:{port}"], cwd=folder,
                capture_output=True, text=True, timeout=120)
            self.assertEqual(result.returncode, 1)
            self.assertIn(f"tcp://127.0.0.1:{port} cannot be listened at: TCP 127.0.0.1:{port} is taken", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
