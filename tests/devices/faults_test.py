#!/usr/bin/python3
"""Starts tests/devices/v4l2_faults.cpp with the module freshly loaded for each test."""
import unittest

from bench import HILCAM, Loopback, run

PROGRAM = HILCAM.parent / "v4l2_faults"


class Faults(unittest.TestCase):
    def test_all(self):
        names = [line.strip() for line in run(PROGRAM, "--gtest_list_tests")[1].splitlines() if line.startswith("  ")]
        self.assertGreaterEqual(len(names), 5)
        for name in names:
            with self.subTest(name), Loopback():
                status, text = run(PROGRAM, f"--gtest_filter=*.{name}")
                print(text, flush=True)
                self.assertEqual(status, 0)
                self.assertIn("[       OK ]", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
