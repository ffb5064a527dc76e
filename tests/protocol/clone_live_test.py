#!/usr/bin/python3
"""`hilcam clone ADDRESS` takes flats and darks from a camera, which another hilcam plays, and clones it.

    clone_live_test.py HILCAM SOURCE_DIR
"""
import json
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import plate

try:
    import gi
    gi.require_version("Aravis", "0.8")
    from gi.repository import Aravis
except (ImportError, ValueError):
    print("skipped: needs gir1.2-aravis-0.8")
    sys.exit(77)

HILCAM = sys.argv[1]
ADDRESS, PORT = "127.0.78.1", 5078
SHEET = """name: lab-camera
width_px: 96
height_px: 64
pitch_um: 5.5
focal_length_mm: 25
f_number: 4
quantum_efficiency: [[0.4, 0.4], [0.55, 0.6], [0.8, 0.3]]
full_well_e: 10000
read_noise_e: 7
gain_dn_e: 0.35
offset_dn: 64
bits: 12
exposure_ms: 2
exposure_range_ms: [0.01, 2000]
frame_rate_hz: 100
frame_rate_range_hz: [0.1, 200]
"""
TRUTH = {"gain_dn_e": 0.33, "read_noise_e": 6.2, "full_well_e": 10300}
DEVICES = f"""commands: {{udp: {{port: {PORT}}}}}
outputs: {{gige: {{interface: {ADDRESS}, serial: LIVE}}}}
"""


class CloneLive(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "sheet.yaml").write_text(SHEET)
        real = SHEET
        for key, value in {**TRUTH, "offset_dn": 71}.items():
            real = "\n".join(f"{key}: {value}" if line.startswith(f"{key}:") else line for line in real.splitlines()) + "\n"
        (cls.folder / "real.yaml").write_text(real)
        plate.write(cls.folder, "real.yaml", 2.2, DEVICES)
        cls.log = open(cls.folder / "run.log", "w+")
        cls.camera = subprocess.Popen([HILCAM, "run", "plate.yaml"], cwd=cls.folder, stderr=cls.log, stdout=cls.log)
        for _ in range(100):
            if subprocess.run([HILCAM, "send", "--to", f"127.0.0.1:{PORT}", "ping"], capture_output=True).returncode == 0:
                break
            time.sleep(0.2)

    @classmethod
    def tearDownClass(cls):
        cls.camera.send_signal(signal.SIGINT)
        cls.camera.wait(20)
        cls.log.close()
        cls.temporary.cleanup()

    def look(self, x, z):
        """A command that points the camera at a place of the plane y = 0."""
        return shlex.join([HILCAM, "send", "--to", f"127.0.0.1:{PORT}", "pose", "--position-m", "0", "0", "20", "--look-at-m", str(x),
                           "0", str(z), "--up", "0", "1", "0"])

    def clone(self, out, *more, answers=""):
        return subprocess.run([HILCAM, "clone", ADDRESS, "--like", "sheet.yaml", "--out", out, "--count", "16", "--json", *more],
                              cwd=self.folder, capture_output=True, text=True, timeout=280, input=answers)

    def test_a_camera_is_cloned_from_its_address(self):
        result = self.clone("mine.yaml", "--light", self.look(0, 0), "--cover", self.look(100, 20))
        self.assertEqual(result.returncode, 0, result.stderr)
        figures = json.loads(result.stdout[result.stdout.index("\n{\n"):])["figures"]
        for key, truth in TRUTH.items():
            figure = figures[key]
            self.assertIsNotNone(figure["measured"], key)
            self.assertLess(abs(figure["measured"] - truth), 4 * figure["uncertainty"], f"{key}: {figure}")
        folders = sorted(path.name.split("_")[0] for path in (self.folder / "mine_frames").iterdir())
        self.assertEqual((folders.count("flat"), folders.count("dark")), (11, 4))
        # The same frames again, as a folder.
        again = subprocess.run([HILCAM, "clone", "mine_frames", "--like", "sheet.yaml", "--out", "again.yaml"], cwd=self.folder,
                               capture_output=True, text=True, timeout=120)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("+-", (self.folder / "again.yaml").read_text())
        taken = self.clone("mine.yaml")
        self.assertEqual(taken.returncode, 2, taken.stderr)
        self.assertIn("mine_frames: found files in it; accepted: a new folder", taken.stderr)

    def test_nobody_answers(self):
        result = self.clone("silent.yaml", "--frames", "silent")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("nobody answers; accepted: Enter, or --yes", result.stderr)
        self.assertIn("no frames of 127.0.78.1", result.stderr)

    def test_no_camera_there(self):
        result = subprocess.run([HILCAM, "clone", "127.0.78.99", "--like", "sheet.yaml", "--out", "none.yaml", "--yes"], cwd=self.folder,
                                capture_output=True, text=True, timeout=60)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("127.0.78.99", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
