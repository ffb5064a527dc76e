#!/usr/bin/python3
"""tools/flight_software_example in a closed loop with the running program, in lockstep: it settles below a tenth of a pixel.

    approach_test.py HILCAM FLIGHT_EXAMPLE OUT_DIR

The truth comes from a second camera at the same place with the same boresight, whose detector has no noise but the
photons' own: of its frames the centre of all light is taken, without a threshold. After the flight this camera is put on
the rail again, its boresight on the target's origin, once upright and once upside down: half the difference of the two
places is where the centre of light is from the origin, half their sum how far the picture's middle is from the boresight
(surveyors' two faces). With that the poses alone say where the centre of light was throughout the flight.

OUT_DIR keeps log, truth and plot.
"""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[2]
EXAMPLE = SOURCE / "tools/flight_software_example"
sys.path[:0] = [str(HERE.parent / "gige"), str(EXAMPLE)]
from bench import Emulator  # noqa: E402
from hilcam_client import Client, Expose, Ping, Pose  # noqa: E402
import plot_error  # noqa: E402

ADDRESS = "127.0.23.15"
SIDE_PX = 384
OFFSET_DN = 64
REFERENCES = 36  # places on the rail

# The example's camera with 16 bits, 4 DN per electron, and none of its detector's errors.
TRUTH = """
more_cameras:
  - camera:
      width_px: 384
      height_px: 384
      pitch_um: 5.5
      focal_length_mm: 25
      f_number: 8
      transmission: 0.9
      quantum_efficiency: [[0.40, 0.38], [0.50, 0.57], [0.60, 0.58], [0.72, 0.43], [0.95, 0.08]]
      full_well_e: 15000
      gain_dn_e: 4
      offset_dn: 64
      bits: 16
      exposure_ms: 0.3
      frame_rate_hz: 5
    outputs:
      files: {{folder: "{folder}/light", format: raw}}
"""


def scenario(folder):
    text = (EXAMPLE / "approach.yaml").read_text()
    text = text.replace("../../configs", str(SOURCE / "configs")).replace("camera: camera.yaml", f"camera: {EXAMPLE}/camera.yaml")
    file = pathlib.Path(folder) / "approach.yaml"
    file.write_text(text + TRUTH.format(folder=folder))
    return file


def centre_of_light(folder, frame):
    """From the picture's middle, of all light in it [px]."""
    light = numpy.fromfile(pathlib.Path(folder, f"light/frame_{frame:08d}.raw"), "<u2").reshape(SIDE_PX, SIDE_PX)
    light = light.astype(float) - OFFSET_DN
    place = numpy.arange(SIDE_PX) - (SIDE_PX - 1) / 2
    return numpy.array([light.sum(0) @ place, light.sum(1) @ place]) / light.sum()


def fly(emulator, log, *options):
    """The example's summary."""
    result = subprocess.run([EXAMPLE_PROGRAM, "--camera", ADDRESS, "--commands", f"127.0.0.1:{emulator.port}", "--log",
                             str(log), *map(str, options)], capture_output=True, text=True, timeout=1200)
    if result.returncode != 0:
        raise AssertionError(result.stderr + emulator.log())
    return json.loads(result.stdout)


class Flight:
    """The example while it flies."""

    def __init__(self, emulator, log, *options):
        self.log = pathlib.Path(log)
        self.process = subprocess.Popen([EXAMPLE_PROGRAM, "--camera", ADDRESS, "--commands", f"127.0.0.1:{emulator.port}", "--log",
                                         str(log), *map(str, options)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def frames(self):
        return max(self.log.read_text().count("\n") - 1, 0) if self.log.exists() else 0

    def await_frames(self, count):
        until = time.monotonic() + 60
        while self.frames() < count and self.process.poll() is None and time.monotonic() < until:
            time.sleep(0.1)
        if self.frames() < count:
            raise AssertionError(f"{self.frames()} frames, not {count}: {self.end()}")

    def end(self):
        """(exit status, standard output, standard error) once it is over."""
        out, error = self.process.communicate(timeout=60)
        return self.process.returncode, out, error


def look_at_the_origin(emulator, log, rows):
    """Two frames from each place: rolled as the flight was there, and upside down."""
    with Client(f"127.0.0.1:{emulator.port}", timeout_s=20) as client:
        time_ns = client.send(Ping()).simulated_tai_ns
        off_rad = log.origin_px() / plot_error.FOCAL_PX
        for row in rows:
            # The flight's attitude, turned by the little that its boresight is off the origin; hilcam makes the norm 1.
            (w, x, y, z), (a, b) = log.attitude[row], off_rad[row] / 2
            w, x, y, z = w + x * b - y * a, x - w * b - z * a, y + w * a - z * b, z + x * a + y * b
            for attitude in ((w, x, y, z), (-z, y, -x, w)):  # a half turn about the boresight
                time_ns += 200_000_000
                client.send(Pose(0, time_ns, tuple(log.position_m[row]), attitude_wxyz=attitude))
                client.send(Expose(1, time_ns))


class Approach(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        log_file, light_file, reference_file = OUT / "approach.csv", OUT / "light.csv", OUT / "reference.csv"
        with tempfile.TemporaryDirectory() as folder:
            with Emulator(HILCAM, ADDRESS, folder, "mode=lockstep", scenario=scenario(folder)) as emulator:
                cls.summary = fly(emulator, log_file)
                cls.log = log = plot_error.Log(log_file)
                first = numpy.flatnonzero(log.settled)[0]
                at = numpy.linspace(first, len(log.frame) - 1, REFERENCES).round().astype(int)
                look_at_the_origin(emulator, log, at)
                cls.report = emulator.stop()
            lines = ["frame,error_x_px,error_y_px"]
            lines += [f"{frame},{x},{y}" for frame in log.frame[::5] for x, y in [centre_of_light(folder, frame)]]
            light_file.write_text("\n".join(lines) + "\n")
            faces = numpy.array([[centre_of_light(folder, log.frame[-1] + 1 + 2 * i + face) for face in (0, 1)]
                                 for i in range(REFERENCES)])
        cls.middle_px = (faces[:, 0] + faces[:, 1]) / 2
        place_m = (faces[:, 0] - faces[:, 1]) / 2 * log.range_m[at, None] / plot_error.FOCAL_PX
        numpy.savetxt(reference_file, numpy.column_stack([log.range_m[at], place_m]), delimiter=",", header="range_m,x_m,y_m",
                      comments="")
        cls.light = plot_error.light_error(light_file, log)
        cls.reference = plot_error.read_reference(reference_file)
        cls.figures = log.figures(cls.light, cls.reference)
        print(json.dumps({**cls.summary, **cls.figures}), flush=True)
        try:
            plot_error.plot(log, cls.light, cls.reference, OUT / "approach.png")
        except ImportError:
            print("no plot: python3-matplotlib is missing", flush=True)

    def test_every_frame_arrived_and_showed_the_target(self):
        self.assertEqual(self.summary, {"frames": 501, "target_found": 501, "frames_lost": 0})
        self.assertEqual(self.report["commands"]["lost"], 0)
        self.assertEqual(self.report["commands"]["refused"], 0)

    def test_it_began_far_off(self):
        self.assertGreater(self.figures["first_px"], 80)
        self.assertGreater(self.log.range_m[0], 1990)
        self.assertLess(self.log.range_m[-1], 510)

    def test_it_settles_as_the_flight_software_sees_it(self):
        self.assertEqual(self.figures["settled_frames"], 351)
        self.assertLess(self.figures["measured_rms_px"], 0.1)

    def test_it_settles_on_the_true_light(self):
        self.assertGreaterEqual(self.light[2].sum(), 70)
        self.assertLess(self.figures["light_rms_px"], 0.1)

    def test_it_settles_by_the_poses(self):
        self.assertLess(self.figures["pose_rms_px"], 0.1)

    def test_the_centroid_is_that_of_the_true_light(self):
        times, places, settled = self.light
        at = numpy.searchsorted(self.log.time_s, times)
        wrong = (self.log.measured_px[at] - places)[settled]
        self.assertLess(plot_error.rms(wrong), 0.05)

    def test_the_boresight_is_the_pictures_middle(self):
        # A confusion of pixels' centres and edges would be half a pixel; the mean of 36 pairs has the error of their scatter.
        error = self.middle_px.std(axis=0, ddof=1) / len(self.middle_px)**0.5
        print("the picture's middle from the boresight [px]:", self.middle_px.mean(axis=0), "+-", error, flush=True)
        self.assertLess(numpy.abs(self.middle_px.mean(axis=0)).max(), 0.02)

    def test_a_second_run_is_the_same_to_the_last_bit(self):
        with tempfile.TemporaryDirectory() as folder:
            again = pathlib.Path(folder) / "again.csv"
            with Emulator(HILCAM, ADDRESS, folder, "mode=lockstep", scenario=scenario(folder)) as emulator:
                fly(emulator, again, "--frames", 40)
            first, second = (OUT / "approach.csv").read_text().splitlines(), again.read_text().splitlines()
            self.assertEqual(len(second), 41)
            self.assertEqual(second, first[:41])


class Ends(unittest.TestCase):
    def test_ctrl_c_leaves_whole_lines_and_gives_the_camera_back(self):
        with tempfile.TemporaryDirectory() as folder, \
                Emulator(HILCAM, ADDRESS, folder, "mode=lockstep", scenario=scenario(folder)) as emulator:
            log = pathlib.Path(folder) / "log.csv"
            with Flight(emulator, log) as flight:
                flight.await_frames(3)
                flight.process.send_signal(signal.SIGINT)
                status, out, error = flight.end()
            self.assertEqual(status, 0, error)
            lines = log.read_text().splitlines()
            self.assertEqual(json.loads(out)["frames"], len(lines) - 1)
            self.assertEqual({line.count(",") for line in lines}, {12})
            # At once, not when the camera's heartbeat has run out.
            self.assertEqual(fly(emulator, log, "--frames", 2)["frames"], 2)

    def test_a_camera_that_goes_away_is_named(self):
        with tempfile.TemporaryDirectory() as folder, \
                Emulator(HILCAM, ADDRESS, folder, scenario=scenario(folder)) as emulator, \
                Flight(emulator, pathlib.Path(folder) / "log.csv", "--free-run") as flight:
            flight.await_frames(3)
            emulator.kill()
            status, _, error = flight.end()
            self.assertEqual(status, 1)
            self.assertRegex(error, "is 'hilcam run' up")

    def test_what_is_no_endpoint_is_refused(self):
        for endpoint in ("127.0.0.1", "127.0.0.1:", "127.0.0.1:70000", "127.0.0.1:50x", "localhost:5010", ":5010"):
            result = subprocess.run([EXAMPLE_PROGRAM, "--commands", endpoint, "--camera", ADDRESS], capture_output=True, text=True,
                                    timeout=60)
            self.assertEqual(result.returncode, 1)
            self.assertIn(f"'{endpoint}': accepted: an IPv4 ADDRESS:PORT", result.stderr)


if __name__ == "__main__":
    HILCAM, EXAMPLE_PROGRAM, OUT = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    OUT.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
