#!/usr/bin/python3
"""tools/flight_software_example in a closed loop with the running program, in lockstep: it settles below a tenth of a pixel.

    approach_test.py HILCAM FLIGHT_EXAMPLE OUT_DIR

The truth comes from a second camera at the same place with the same boresight, whose detector has no noise but the
photons' own: of its frames the centre of all light is taken, without a threshold. OUT_DIR keeps log, truth and plot.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[2]
EXAMPLE = SOURCE / "tools/flight_software_example"
sys.path[:0] = [str(HERE.parent / "gige"), str(EXAMPLE)]
from bench import Emulator  # noqa: E402
import plot_error  # noqa: E402

ADDRESS = "127.0.23.15"
SIDE_PX = 384
EVERY_NTH = 5  # frame of the second camera is kept
OFFSET_DN = 64

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
      files: {{folder: "{folder}/light", format: raw, every_nth: {every_nth}}}
"""


def scenario(folder):
    text = (EXAMPLE / "approach.yaml").read_text()
    text = text.replace("../../configs", str(SOURCE / "configs")).replace("camera: camera.yaml", f"camera: {EXAMPLE}/camera.yaml")
    file = pathlib.Path(folder) / "approach.yaml"
    file.write_text(text + TRUTH.format(folder=folder, every_nth=EVERY_NTH))
    return file


def centre_of_light(file):
    """From the boresight, of all light in the picture [px]."""
    light = numpy.fromfile(file, "<u2").reshape(SIDE_PX, SIDE_PX).astype(float) - OFFSET_DN
    place = numpy.arange(SIDE_PX) - (SIDE_PX - 1) / 2
    return (light.sum(0) @ place) / light.sum(), (light.sum(1) @ place) / light.sum()


def fly(folder, log, *options):
    """(the example's summary, hilcam's report)."""
    with Emulator(HILCAM, ADDRESS, folder, "mode=lockstep", scenario=scenario(folder)) as emulator:
        result = subprocess.run([EXAMPLE_PROGRAM, "--camera", ADDRESS, "--commands", f"127.0.0.1:{emulator.port}", "--log",
                                 str(log), *map(str, options)], capture_output=True, text=True, timeout=1200)
        if result.returncode != 0:
            raise AssertionError(result.stderr + emulator.log())
        return json.loads(result.stdout), emulator.stop()


class Approach(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.log_file = OUT / "approach.csv"
        with tempfile.TemporaryDirectory() as folder:
            cls.summary, cls.report = fly(folder, cls.log_file)
            files = sorted(pathlib.Path(folder, "light").glob("frame_*.raw"))
            lines = ["frame,error_x_px,error_y_px"]
            lines += [",".join(map(str, (int(file.stem.split("_")[1]), *centre_of_light(file)))) for file in files]
        cls.light_file = OUT / "light.csv"
        cls.light_file.write_text("\n".join(lines) + "\n")
        cls.log = plot_error.Log(cls.log_file)
        cls.light = plot_error.light_error(cls.light_file, cls.log)
        cls.figures = cls.log.figures()
        print(json.dumps({**cls.summary, **cls.figures}), flush=True)
        try:
            plot_error.plot(cls.log, cls.light, OUT / "approach.png")
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

    def test_it_settles_by_the_poses(self):
        self.assertLess(self.figures["pose_rms_px"], 0.1)

    def test_it_settles_on_the_true_light(self):
        _, places, settled = self.light
        self.assertGreaterEqual(settled.sum(), 70)
        self.assertLess(plot_error.rms(places[settled]), 0.1)

    def test_the_centroid_is_that_of_the_true_light(self):
        times, places, settled = self.light
        at = numpy.searchsorted(self.log.time_s, times)
        wrong = (self.log.measured_px[at] - places)[settled]
        self.assertLess(plot_error.rms(wrong), 0.05)

    def test_the_boresight_is_where_the_flight_software_takes_it_to_be(self):
        # Half a pixel is what a confusion of pixels' centres and edges makes.
        self.assertLess(numpy.abs(self.figures["boresight_error_px"]).max(), 0.1)

    def test_a_second_run_is_the_same_to_the_last_bit(self):
        with tempfile.TemporaryDirectory() as folder:
            again = pathlib.Path(folder) / "again.csv"
            fly(folder, again, "--frames", 40)
            first, second = self.log_file.read_text().splitlines(), again.read_text().splitlines()
            self.assertEqual(len(second), 41)
            self.assertEqual(second, first[:41])


if __name__ == "__main__":
    HILCAM, EXAMPLE_PROGRAM, OUT = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    OUT.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
