#!/usr/bin/python3
"""A free run with nothing in its cache folder: frames come before the table of directions is made, and are those of a
run that waited for it from the moment that the program names.

    light_test.py HILCAM SOURCE_DIR
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from PIL import Image

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"


class Run:
    """hilcam run that writes its frames; time stands, so that they differ by their noise alone, which the seed decides."""

    def __init__(self, folder, *extra):
        self.frames, self.log = folder / "frames", folder / "log"
        arguments = [
            HILCAM, "run", SCENARIO, "--duration", "280", "--set", "quality.path_model=cached", "--set", "quality.probes=15000", "--set",
             "clock.paused=true", "--set", "camera.frame_rate_hz=10", "--set", f"outputs.files.folder={self.frames}",
             *extra]
        with self.log.open("w") as log:
            self.process = subprocess.Popen(arguments, stderr=log, env=os.environ | {"HILCAM_CACHE": str(folder / "cache")})

    def wait_for(self, what):
        while not what():
            if self.process.poll() is not None:
                raise RuntimeError("the run has ended: " + self.log.read_text())
            time.sleep(0.05)

    def ids(self):
        # The newest one may still be being written.
        return sorted(int(re.search(r"(\d+)", f.stem)[1]) for f in self.frames.glob("*.png"))[:-1] if self.frames.exists() else []

    def picture(self, number):
        return Image.open(self.frames / f"frame_{number:08d}.png")

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=30)
        return self.log.read_text()

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()


class Light(unittest.TestCase):
    def run_in(self, name, *extra):
        folder = tempfile.TemporaryDirectory(prefix="hilcam_light_" + name)
        self.addCleanup(folder.cleanup)
        run = Run(pathlib.Path(folder.name), *extra)
        self.addCleanup(run.kill)
        return run

    def test_frames_come_before_the_light_and_then_are_those_of_a_run_that_waited(self):
        beside = self.run_in("beside")
        said = lambda: re.search(r"light between surfaces is kept after frame (\d+)", beside.log.read_text())
        beside.wait_for(said)
        last_without = int(said()[1])
        beside.wait_for(lambda: len([i for i in beside.ids() if i > last_without]) >= 6)
        log = beside.stop()
        self.assertIn("light between surfaces is made beside the run", log)
        self.assertGreaterEqual(last_without, 1)

        waited = self.run_in("waited", "--set", "loop.wait_for_light=true")
        waited.wait_for(lambda: len(waited.ids()) > 0 and waited.ids()[-1] >= beside.ids()[-1])
        self.assertNotIn("beside the run", waited.stop())

        both = set(beside.ids()) & set(waited.ids())
        before, after = [i for i in both if i <= last_without], [i for i in both if i > last_without]
        self.assertGreaterEqual(len(before), 1)
        self.assertGreaterEqual(len(after), 3)
        for number in before:
            self.assertIn("no_kept_light", beside.picture(number).text["faults"])
            self.assertNotEqual(beside.picture(number).tobytes(), waited.picture(number).tobytes(), number)
        for number in after:
            self.assertEqual(beside.picture(number).tobytes(), waited.picture(number).tobytes(), number)
            self.assertEqual(beside.picture(number).text, waited.picture(number).text)
        for number in waited.ids():
            self.assertNotIn("no_kept_light", waited.picture(number).text.get("faults", ""))

    def test_so_many_frames_are_all_with_it(self):
        run = self.run_in("frames", "--frames", "3")
        self.assertEqual(run.process.wait(timeout=250), 0)
        for picture in run.frames.glob("*.png"):
            self.assertNotIn("no_kept_light", Image.open(picture).text.get("faults", ""))
        self.assertEqual(len(list(run.frames.glob("*.png"))), 3)

    def test_what_is_prepared_is_there_when_the_run_begins(self):
        with tempfile.TemporaryDirectory(prefix="hilcam_prepare_") as folder:
            def hilcam(*arguments):
                return subprocess.run(
                    [HILCAM, *arguments, "--set", "quality.path_model=cached", "--set", "quality.probes=15000"], capture_output=True,
                    text=True, timeout=280, env=os.environ | {"HILCAM_CACHE": folder})
            first = hilcam("prepare", SCENARIO)
            self.assertEqual(first.returncode, 0, first.stderr)
            self.assertIn("protocol_test is ready: 1 tables of light made, 0 were on disk", first.stdout)
            self.assertIn("0 tables of light made, 1 were on disk", hilcam("prepare", SCENARIO).stdout)
            run = hilcam("run", SCENARIO, "--duration", "0.5")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertNotIn("beside the run", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
