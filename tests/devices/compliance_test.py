#!/usr/bin/python3
"""v4l2-compliance finds no more wrong with a device that hilcam feeds than with the idle module: what fails there is the
module's, and listed in tests/devices/baseline."""
import os
import re
import unittest

import bench
from bench import DEVICE, Emulator, Loopback, run

NAME = "v4l2loopback-" + ".".join(map(str, bench.version())) + ".txt"
BASELINE = bench.SOURCE / "tests/devices/baseline" / NAME


def failures(text):
    """Names of the tests that fail."""
    return sorted(set(re.findall(r"test (.*): FAIL", text)))


def idle():
    """The module with nobody, and with a producer that is not hilcam: what it makes of both directions."""
    with Loopback():
        found = set(failures(run("v4l2-compliance", "-d", DEVICE, seconds=120)[1]))
    with Loopback():
        import subprocess
        producer = subprocess.Popen(["ffmpeg", "-v", "error", "-nostdin", "-re", "-f", "lavfi", "-i",
                                     "testsrc=size=160x120:rate=8", "-pix_fmt", "gray", "-f", "v4l2", DEVICE])
        try:
            bench.wait_until(lambda: "Video Capture" in run("v4l2-ctl", "-d", DEVICE, "--info")[1], 30, "the producer")
            found |= set(failures(run("v4l2-compliance", "-d", DEVICE, "-s", seconds=240)[1]))
        finally:
            producer.kill()
            producer.wait()
    return sorted(found)


class Compliance(unittest.TestCase):
    def test_no_failure_that_the_module_alone_has_not(self):
        if os.environ.get("BASELINE"):
            BASELINE.write_text("".join(f"{name}\n" for name in idle()))
            print(f"stored {BASELINE}")
        if not BASELINE.exists():
            self.skipTest(f"no {BASELINE.name}: tools/check-devices --baseline compliance makes it")
        known = BASELINE.read_text().splitlines()
        with Loopback(), Emulator("outputs.v4l2.format=GREY") as emulator:
            text = run("v4l2-compliance", "-d", DEVICE, "-s", seconds=240)[1]
            emulator.stop()
        print(text)
        self.assertRegex(text, r"Total for .*: \d+, Succeeded")
        self.assertEqual([name for name in failures(text) if name not in known], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
