#!/usr/bin/python3
"""How long frames take through v4l2loopback, in a machine that is emulated: figures of order, not of hardware."""
import unittest

import numpy

import bench
from bench import DEVICE, Emulator, Loopback, run

FRAMES = 1000


class Latency(unittest.TestCase):
    def measure(self, what, io):
        with Loopback(), Emulator(f"outputs.v4l2.io={io}", "camera.frame_rate_hz=25", files=False) as emulator:
            status, text = run(bench.TOOLS / "frame_reader", DEVICE, FRAMES, seconds=400)
            self.assertEqual(status, 0, text)
            emulator.stop()
        times = numpy.array([float(line.split()[0]) for line in text.splitlines()])[4:]  # the first were there before the reader
        self.assertGreater(times.min(), 0)
        p50, p99, p999 = numpy.percentile(times, [50, 99, 99.9]) / 1e3
        print(f"latency v4l2loopback {'.'.join(map(str, bench.version()))} io={io}, {what}: p50 {p50:.3f} ms, "
              f"p99 {p99:.3f} ms, p99.9 {p999:.3f} ms of {len(times)} frames", flush=True)

    def test_from_the_module_to_the_reader(self):
        self.measure("the module's time to DQBUF's return", "write")

    def test_from_the_exposure_to_the_reader(self):
        self.measure("middle of the exposure to DQBUF's return", "mmap")


if __name__ == "__main__":
    unittest.main(verbosity=2)
