#!/usr/bin/python3
"""tools/landing_example in a closed loop with the running program, in lockstep: it lands where it chose to, on ground without hazards.

    landing_test.py HILCAM LANDING_EXAMPLE OUT_DIR

The judge is the ground's truth (tools/landing_example/judge_landing.py). The first frames of a second flight are the same to the last bit.
OUT_DIR keeps the log.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[2]
EXAMPLE = SOURCE / "tools/landing_example"
sys.path.insert(0, str(HERE.parent / "gige"))
from bench import Emulator  # noqa: E402

ADDRESS = "127.0.23.16"
SCENARIO = EXAMPLE / "landing.yaml"


def site_axes():
    out = subprocess.run([HILCAM, "ground", SCENARIO, "--list", "axes"], check=True, capture_output=True, text=True).stdout
    return out.splitlines()[1].split(",")[3:]


def fly(log, *options):
    """The example's summary."""
    with tempfile.TemporaryDirectory() as folder:
        with Emulator(HILCAM, ADDRESS, folder, "mode=lockstep", scenario=SCENARIO) as emulator:
            result = subprocess.run([EXAMPLE_PROGRAM, "--camera", ADDRESS, "--commands", f"127.0.0.1:{emulator.port}", "--axes", *site_axes(),
                                     "--log", str(log), *map(str, options)], capture_output=True, text=True, timeout=800)
            if result.returncode != 0:
                raise AssertionError(result.stderr + emulator.log())
            return json.loads(result.stdout)


class Landing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.log = OUT / "landing.csv"
        cls.summary = fly(cls.log)
        judged = subprocess.run([EXAMPLE / "judge_landing.py", SCENARIO, cls.log, "--hilcam", HILCAM], check=True, capture_output=True, text=True)
        cls.judged = json.loads(judged.stdout)
        print(cls.summary, cls.judged)

    def test_lands_where_it_chose_to(self):
        self.assertTrue(self.summary["landed"])
        self.assertEqual(self.summary["lost"], 0)
        self.assertLess(self.judged["landing_error_m"], 0.1)

    def test_the_ground_there_has_no_hazards(self):
        self.assertLess(self.judged["slope_deg"], 8)
        self.assertLess(self.judged["roughness_m"], 0.2)
        self.assertGreater(self.judged["nearest_stone_m"], 1.5)

    def test_a_second_flight_is_the_same_to_the_last_bit(self):
        again = OUT / "again.csv"
        fly(again, "--frames", 12)
        lines = again.read_text().splitlines()
        self.assertEqual(len(lines), 13)
        self.assertEqual(self.log.read_text().splitlines()[:13], lines)


if __name__ == "__main__":
    HILCAM, EXAMPLE_PROGRAM, OUT = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    OUT.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=sys.argv[:1])
