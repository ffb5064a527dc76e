#!/usr/bin/python3
"""`hilcam clone` on frames that NumPy makes of a camera of its own: figures, maps, defects, page and mistakes.

    clone_test.py HILCAM SOURCE_DIR
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

from pages import has_matplotlib, stands_alone

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SIDE, BITS = 96, 12
# K in DN/e-, read noise in e-, black level in DN, dark current in e-/s at 20 C, which doubles in 6 K.
K, NOISE, BLACK, DARK, DOUBLING, FULL = 0.31, 6.5, 70.0, 80.0, 6.0, 11000.0
HOT, DEAD, BLINKING = [(10, 20), (70, 5)], [(33, 44)], [(50, 61)]  # x, y
HOT_E_S, BLINK_E = 900.0, 90.0
LIKE = f"""name: sheet
source: a made-up sheet
width_px: {SIDE}
height_px: {SIDE}
pitch_um: 5
focal_length_mm: 50
f_number: 4
cos_power: 0
quantum_efficiency: [[0.4, 0.3], [0.55, 0.6], [0.8, 0.2]]
full_well_e: 8000
gain_e_dn: 4
offset_dn: 40
read_noise_e: 3
bits: {BITS}
"""


class Unit:
    """One camera: its own pixels, from a seed."""

    def __init__(self):
        self.random = numpy.random.default_rng(20261130)
        self.offset_e = 5 * self.random.standard_normal((SIDE, SIDE))
        self.gain = 1 + 0.01 * self.random.standard_normal((SIDE, SIDE))
        self.dark = DARK * (1 + 0.15 * self.random.standard_normal((SIDE, SIDE)))
        for x, y in HOT:
            self.dark[y, x] += HOT_E_S
        for x, y in DEAD:
            self.gain[y, x] = 0

    def frame(self, number, exposure_s, temperature_c, light_e=0.0):
        mean = light_e * self.gain + self.dark * exposure_s * 2 ** ((temperature_c - 20) / DOUBLING)
        charge = numpy.minimum(self.random.poisson(numpy.maximum(mean, 0)), FULL)
        charge = charge + self.offset_e + NOISE * self.random.standard_normal((SIDE, SIDE))
        for x, y in BLINKING:
            charge[y, x] += BLINK_E * (0.5 if (number // 2) % 2 else -0.5)
        return numpy.clip(numpy.floor(K * charge + BLACK + 0.5), 0, 2 ** BITS - 1).astype(">u2")


def write_pgm(file, pixels):
    file.parent.mkdir(parents=True, exist_ok=True)
    height, width = pixels.shape
    file.write_bytes(f"P5\n{width} {height}\n65535\n".encode() + pixels.tobytes())


def laboratory(folder):
    unit = Unit()
    for celsius, exposures in ((20, (0.001, 0.02, 0.5)), (32, (0.001, 0.5))):
        for exposure in exposures:
            for i in range(32):
                write_pgm(folder / f"dark_{1e3 * exposure:g}ms_{celsius}c" / f"{i:03d}.pgm", unit.frame(i, exposure, celsius))
    for share in (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95):
        for i in range(32):
            write_pgm(folder / f"flat_{20 * share:g}ms_20c" / f"{i:03d}.pgm", unit.frame(i, 0.02 * share, 20, FULL * 0.95 * share))
    for i in range(8):
        write_pgm(folder / "flat_40ms_20c" / f"{i:03d}.pgm", unit.frame(i, 0.04, 20, FULL * 1.9))
    return unit


def read_fits(file):
    data = file.read_bytes()
    end = data.index(b"END" + b" " * 77)
    start = (end // 2880 + 1) * 2880
    return numpy.frombuffer(data, ">f4", SIDE * SIDE, start).reshape(SIDE, SIDE)


def hilcam(*arguments):
    return subprocess.run([HILCAM, *map(str, arguments)], capture_output=True, text=True, timeout=240)


def correlation(a, b, good):
    return numpy.corrcoef(a[good], b[good])[0, 1]


class Clone(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "like.yaml").write_text(LIKE)
        cls.unit = laboratory(cls.folder / "frames")
        cls.out = cls.folder / "mine.yaml"
        report = ["--report", cls.folder / "report"] if has_matplotlib() else []
        cls.result = hilcam("clone", cls.folder / "frames", "--like", cls.folder / "like.yaml", "--out", cls.out, "--json", *report)
        assert cls.result.returncode == 0, cls.result.stderr
        cls.report = json.loads(cls.result.stdout)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_figures_are_those_of_the_unit(self):
        # Four standard deviations of eleven figures: one false alarm in 10^3 draws, and the draw is fixed.
        good = numpy.ones((SIDE, SIDE), bool)
        for x, y in HOT + DEAD + BLINKING:
            good[y, x] = False
        truths = {"gain_dn_e": K, "read_noise_e": NOISE, "offset_dn": BLACK + K * self.unit.offset_e[good].mean(),
                  "dark_current_e_s": self.unit.dark[good].mean(), "dark_doubling_k": DOUBLING, "full_well_e": FULL,
                  "nonlinearity_a2": 0, "nonlinearity_a3": 0, "prnu_fraction": 0.01, "dsnu_e": 5, "dark_current_fraction": 0.15}
        for key, truth in truths.items():
            figure = self.report["figures"][key]
            self.assertIsNotNone(figure["measured"], key)
            self.assertLess(abs(figure["measured"] - truth), 4 * figure["uncertainty"], f"{key}: {figure}, made with {truth}")
        for key, most in (("gain_dn_e", 0.005), ("read_noise_e", 0.01), ("full_well_e", 0.01), ("dark_doubling_k", 0.02)):
            figure = self.report["figures"][key]
            self.assertLess(figure["uncertainty"], most * figure["measured"], key)

    def test_maps_are_those_of_the_unit(self):
        good = numpy.ones((SIDE, SIDE), bool)
        for x, y in HOT + DEAD + BLINKING:
            good[y, x] = False
        for name, truth, key in (("offset", self.unit.offset_e, "offset_map"), ("gain", self.unit.gain, "gain_map"),
                                 ("dark", self.unit.dark, "dark_map")):
            seen = correlation(read_fits(self.folder / f"mine_maps/{name}.fits"), truth, good)
            self.assertAlmostEqual(seen, self.report[key]["expected_correlation"], delta=0.02, msg=name)
            self.assertGreater(seen, 0.9, name)

    def test_defects_are_those_of_the_unit(self):
        rows = [line.split(",") for line in (self.folder / "mine_maps/defects.csv").read_text().splitlines() if line[:1] not in "#k"]
        found = {kind: sorted((int(x), int(y)) for k, x, y, _ in rows if k == kind) for kind in ("hot", "dead", "blinking")}
        self.assertEqual(found, {"hot": sorted(HOT), "dead": DEAD, "blinking": BLINKING})
        values = {(int(x), int(y)): float(value) for _, x, y, value in rows}
        for x, y in HOT:
            self.assertAlmostEqual(values[x, y] / self.unit.dark[y, x], 1, delta=0.05)
        self.assertAlmostEqual(values[BLINKING[0]] / BLINK_E, 1, delta=0.1)

    def test_the_camera_file_is_a_camera(self):
        text = self.out.read_text()
        self.assertIn("# +- ", text)
        self.assertIn("# --- What the frames do not tell: as of sheet", text)
        self.assertNotIn("gain_e_dn", text)
        result = hilcam("check", self.out)
        self.assertEqual(result.returncode, 0, result.stderr)

    @unittest.skipUnless(has_matplotlib(), "needs python3-matplotlib")
    def test_the_emulated_camera_is_measured_to_be_the_same(self):
        stands_alone(self, (self.folder / "report/index.html").read_text())
        emulated = json.loads((self.folder / "report/emulated.json").read_text())["figures"]
        for key in ("gain_dn_e", "offset_dn", "read_noise_e", "dark_current_e_s", "dark_doubling_k", "prnu_fraction", "dsnu_e"):
            real, made = self.report["figures"][key], emulated[key]
            sigma = (real["uncertainty"] ** 2 + made["uncertainty"] ** 2) ** 0.5
            self.assertLess(abs(made["measured"] - real["measured"]), 4 * sigma, key)

    def refused(self, *arguments):
        result = hilcam("clone", *arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        return result.stderr

    def test_mistakes_are_named(self):
        frames, like, out = self.folder / "frames", self.folder / "like.yaml", self.folder / "x.yaml"
        self.assertIn("accepted: a camera file, NAME.yaml", self.refused(frames, "--like", like, "--out", self.folder / "x.txt"))
        self.assertIn("is a scenario", self.refused(frames, "--like", "geo_inspection", "--out", out))
        self.assertIn(f"found frames of {SIDE} x {SIDE}; accepted: 1936 x 1216", self.refused(frames, "--like", "mv_imx249", "--out", out))
        self.assertIn("is no folder", self.refused(self.folder / "none", "--like", like, "--out", out))
        self.assertIn("accepted here: keys at the top", self.refused(frames, "--like", like, "--out", out, "--set", "defects.hot_fraction=1"))
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
