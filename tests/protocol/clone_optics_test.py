#!/usr/bin/python3
"""`hilcam clone` on edges, chessboards and lag of hidden cameras. Edges and boards are rendered by hilcam with another focal
length, distortion and wavefront error than the data sheet has; darks, flats and lag are made by NumPy.

    clone_optics_test.py HILCAM SOURCE_DIR
"""
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy

HILCAM = sys.argv[1]
WIDTH, HEIGHT, BITS = 400, 300, 12
K, NOISE, BLACK, FULL = 0.3, 5.0, 60.0, 11000.0
SHEET = f"""name: sheet
source: a made-up sheet
width_px: {WIDTH}
height_px: {HEIGHT}
pitch_um: 5
f_number: 4
cos_power: 0
quantum_efficiency: [[0.52, 0], [0.521, 0.6], [0.579, 0.6], [0.58, 0]]
full_well_e: {FULL}
gain_dn_e: {K}
offset_dn: {BLACK}
read_noise_e: {NOISE}
bits: {BITS}
exposure_ms: 1
"""
SCENE = """name: board
time_utc: 2026-03-20T14:00:00Z
origin: {kind: free}
sun: {direction: [0, 0, 1], distance_au: 1}
camera: CAMERA
camera_pose: {position_m: [0, 0, 20], attitude: look_at, look_at_m: [0, 0, 0], up: [0, 1, 0]}
objects:
  - name: board
    mesh: MESH
    materials:
      surfaces:
        - {name: white, material: {model: lambert, reflectance: 0.8}}
        - {name: black, material: {model: lambert, reflectance: 0.1}}
spectrum_edges_um: [0.52, 0.55, 0.58]
quality: {visibility: rays, samples_per_axis: 8, path_model: direct, max_depth: 1}
loop: {levels: fixed}
"""
COLUMNS, ROWS, SIDE_M = 9, 6, 0.04  # inner corners


class Hidden:
    """A camera that the clone is not told: its keys from a seed."""

    def __init__(self, seed):
        draw = numpy.random.default_rng(seed).uniform
        self.focal_length_mm = draw(3.2, 3.8)
        self.k1, self.k2 = draw(-0.28, -0.18), draw(0.06, 0.12)
        self.p1, self.p2 = draw(0.001, 0.003), draw(-0.003, -0.001)
        self.x, self.y = WIDTH / 2 + draw(-8, 8), HEIGHT / 2 + draw(-8, 8)
        self.wavefront_nm = draw(35, 70)

    def yaml(self, exposure_ms):
        return SHEET.replace("exposure_ms: 1\n", "") + f"""exposure_ms: {exposure_ms}
exposure_range_ms: [0.001, 1000]
focal_length_mm: {self.focal_length_mm}
distortion: [{self.k1}, {self.k2}, {self.p1}, {self.p2}]
principal_point_px: [{self.x}, {self.y}]
wavefront_rms_nm: {self.wavefront_nm}
"""


def rectangle(lines, left, bottom, right, top, material):
    first = sum(line.startswith("v ") for line in lines) + 1
    lines += [f"v {x} {y} 0" for x, y in ((left, bottom), (right, bottom), (right, top), (left, top))]
    lines += [f"usemtl {material}", f"f {first} {first + 1} {first + 2} {first + 3}"]


def chessboard(columns, rows):
    """Squares about the origin with a white border."""
    lines = []
    for y in range(-1, rows + 2):
        for x in range(-1, columns + 2):
            border = x in (-1, columns + 1) or y in (-1, rows + 1)
            left, bottom = (x - (columns + 1) / 2) * SIDE_M, (y - (rows + 1) / 2) * SIDE_M
            rectangle(lines, left, bottom, left + SIDE_M, bottom + SIDE_M, "white" if border or (x + y) % 2 else "black")
    return "\n".join(lines) + "\n"


def edge(tilt_deg):
    """Two half planes; the border between them passes the origin, tilted from the vertical."""
    along = numpy.array([math.sin(math.radians(tilt_deg)), math.cos(math.radians(tilt_deg))])
    across = numpy.array([along[1], -along[0]])
    lines = []
    for side, material in ((-1, "white"), (1, "black")):
        corners = [(0, -1), (side, -1), (side, 1), (0, 1)]
        if side < 0:
            corners.reverse()
        first = sum(line.startswith("v ") for line in lines) + 1
        lines += ["v %.9f %.9f 0" % tuple(40 * (a * across + b * along)) for a, b in corners]
        lines += [f"usemtl {material}", f"f {first} {first + 1} {first + 2} {first + 3}"]
    return "\n".join(lines) + "\n"


def write_pgm(file, pixels):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(f"P5\n{pixels.shape[1]} {pixels.shape[0]}\n65535\n".encode() + pixels.astype(">u2").tobytes())


def hilcam(*arguments, timeout=240):
    return subprocess.run([HILCAM, *map(str, arguments)], capture_output=True, text=True, timeout=timeout)


def poses(seed, count):
    """Places on a dome over the board, with the board in all parts of the picture: position, the point looked at, up."""
    random = numpy.random.default_rng(seed + 1000)
    out = []
    for i in range(count):
        turn, lean = 2 * math.pi * i / count + random.uniform(-0.2, 0.2), math.radians(random.uniform(12, 38))
        distance = random.uniform(1.0, 1.4)
        position = distance * numpy.array([math.sin(lean) * math.cos(turn), math.sin(lean) * math.sin(turn), math.cos(lean)])
        at = [random.uniform(-0.1, 0.1), random.uniform(-0.07, 0.07), 0]
        roll = random.uniform(-0.3, 0.3)
        out.append((position, at, [math.sin(roll), math.cos(roll), 0]))
    return out


def render(folder, camera, mesh, pose, seed, out, *more):
    out.parent.mkdir(parents=True, exist_ok=True)
    scene = folder / "scene.yaml"
    scene.write_text(SCENE.replace("CAMERA", str(camera)).replace("MESH", str(mesh)))
    position, at, up = pose
    pose_text = lambda values: "[" + ", ".join(f"{value:.9f}" for value in values) + "]"
    result = hilcam("render", scene, "--set", f"camera_pose.position_m={pose_text(position)}", "--set",
                    f"camera_pose.look_at_m={pose_text(at)}", "--set", f"camera_pose.up={pose_text(up)}", "--set", f"seed={seed}",
                    *more, "--out", out)
    assert result.returncode == 0, result.stderr


def darks_and_flats(folder, seed=7):
    random = numpy.random.default_rng(seed)

    def frame(electrons):
        charge = numpy.minimum(random.poisson(electrons, (HEIGHT, WIDTH)), FULL) + NOISE * random.standard_normal((HEIGHT, WIDTH))
        return numpy.clip(numpy.floor(K * charge + BLACK + 0.5), 0, 2 ** BITS - 1)

    for i in range(8):
        write_pgm(folder / "dark_1ms" / f"{i}.pgm", frame(0))
    for share in (0.05, 0.3, 0.6, 0.9):
        for i in range(4):
            write_pgm(folder / f"flat_{share:g}ms" / f"{i}.pgm", frame(FULL * share * 0.95))
    return frame


class CloneOptics(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "sheet.yaml").write_text(SHEET + "focal_length_mm: 4\nwavefront_rms_nm: 20\n")
        (cls.folder / "board.obj").write_text(chessboard(COLUMNS, ROWS))
        (cls.folder / "larger.obj").write_text(chessboard(COLUMNS + 1, ROWS + 1))
        cls.base = cls.folder / "base"
        cls.frame = staticmethod(darks_and_flats(cls.base))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def frames(self, name):
        """A folder with the darks and flats."""
        return pathlib.Path(shutil.copytree(self.base, self.folder / name, copy_function=os.link))

    def clone(self, frames, *more):
        out = self.folder / f"{frames.name}.yaml"
        return hilcam("clone", frames, "--like", self.folder / "sheet.yaml", "--out", out, "--json", *more), out

    def camera_of(self, hidden, name, exposure_ms=0.18):
        file = self.folder / f"{name}_camera.yaml"
        file.write_text(hidden.yaml(exposure_ms))
        return file

    def boards(self, frames, hidden, name, seed, count=12, mesh="board.obj", series=f"chessboard_{COLUMNS}x{ROWS}"):
        camera = self.camera_of(hidden, name)
        for i, pose in enumerate(poses(seed, count)):
            render(self.folder, camera, self.folder / mesh, pose, seed * 100 + i, frames / series / f"{i:02d}.png")

    def refused(self, frames):
        result, out = self.clone(frames)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertFalse(out.exists())
        lines = [line for line in result.stderr.splitlines() if line.startswith("hilcam: ")]
        self.assertEqual(len(lines), 1, result.stderr)
        return lines[0]

    def test_hidden_lenses_come_back(self):
        checked, within = 0, 0
        for seed in (1, 2, 3):
            hidden, frames = Hidden(seed), self.frames(f"lens{seed}")
            self.boards(frames, hidden, f"lens{seed}", seed)
            (self.folder / "edge.obj").write_text(edge(5))
            camera = self.camera_of(hidden, "edge")
            for i in range(4):
                render(self.folder, camera, self.folder / "edge.obj", ([0, 0, 20], [0, 0, 0], [0, 1, 0]), seed * 100 + 50 + i,
                       frames / "edge" / f"{i}.png")
            result, out = self.clone(frames)
            self.assertEqual(result.returncode, 0, result.stderr)
            report = json.loads(result.stdout)
            truths = {"focal_length_mm": hidden.focal_length_mm, "principal_point_x_px": hidden.x, "principal_point_y_px": hidden.y,
                      "distortion_k1": hidden.k1, "distortion_k2": hidden.k2, "distortion_p1": hidden.p1, "distortion_p2": hidden.p2,
                      "distortion_k3": 0}
            for key, truth in truths.items():
                figure = report["figures"][key]
                if figure["measured"] is None:
                    self.assertIn(key, ("distortion_k2", "distortion_k3", "distortion_p1", "distortion_p2"))
                    continue
                sigmas = (figure["measured"] - truth) / figure["uncertainty"]
                print(f"seed {seed} {key}: {figure['measured']:.5g} +- {figure['uncertainty']:.2g}, made with {truth:.5g}: {sigmas:.1f}")
                self.assertLess(abs(sigmas), 5, key)
                checked, within = checked + 1, within + (abs(sigmas) <= 2)
            self.assertLess(report["figures"]["focal_length_mm"]["uncertainty"], 0.005 * hidden.focal_length_mm)
            for zone in report["field_zones"]:
                print(f"seed {seed} field {zone['field_fraction']:.2f}: {1e9 * zone['blur_m']:.1f} +- {1e9 * zone['uncertainty_m']:.1f} nm, "
                      f"made with {hidden.wavefront_nm:.1f}; misfit {zone['misfit']:.4f}")
                self.assertEqual(zone["kind"], "wavefront")
                self.assertLess(zone["misfit"], 0.03)
            self.assertGreater(len(report["field_zones"]), 1)
            text = out.read_text()
            self.assertIn("field_zones:", text)
            self.assertNotIn("\nwavefront_rms_nm", text)
            self.assertEqual(hilcam("check", out).returncode, 0)
        # 95 % of Gaussian errors; of twenty some are beyond.
        self.assertGreaterEqual(within, 0.8 * checked)

    def test_other_boards_are_refused(self):
        hidden, board = Hidden(1), f"chessboard_{COLUMNS}x{ROWS}"
        good = self.frames("good")
        self.boards(good, hidden, "good", 1, count=12)
        camera = self.camera_of(hidden, "good")
        straight = (numpy.array([0, 0, 1.2]), [0, 0, 0], [0, 1, 0])
        wanted = "accepted: the whole of a chessboard with 9 x 6 inner corners"

        def with_picture(name, camera, mesh, pose):
            frames = pathlib.Path(shutil.copytree(good, self.folder / name, copy_function=os.link))
            render(self.folder, camera, self.folder / mesh, pose, 1, frames / board / "99.png")
            return self.refused(frames)

        for name, mesh, pose in (("cut", "board.obj", (straight[0], [0.2, 0, 0], [0, 1, 0])), ("two", "larger.obj", straight),
                                 ("flat", "board.obj", (numpy.array([2.0, 0, 0.12]), [0, 0, 0], [0, 0, 1]))):
            message = with_picture(name, camera, mesh, pose)
            self.assertIn(f"{board}/99.png: found no such board; {wanted}", message)
        blurred = self.folder / "blurred.yaml"
        blurred.write_text(camera.read_text() + "defocus_um: 160\n")
        self.assertRegex(with_picture("blurred", blurred, "board.obj", straight), rf"{board}/99.png: found .*; {wanted}")
        few = self.frames("few")
        self.boards(few, hidden, "few", 1, count=3)
        self.assertIn("found 3 pictures; accepted: at least 5 poses", self.refused(few))
        parallel = self.frames("parallel")
        for i in range(5):
            place = numpy.array([0.05 * (i % 3 - 1), 0.05 * (i % 2), 1.2 + 0.05 * i])
            render(self.folder, camera, self.folder / "board.obj", (place, [place[0], place[1], 0], [0, 1, 0]), i,
                   parallel / board / f"{i}.png")
        self.assertIn("turn the board by 20 to 45 degrees", self.refused(parallel))
        nameless = self.frames("nameless")
        (good / board).rename(nameless / "chessboard")
        self.assertIn("found no number of corners in the name", self.refused(nameless))

    def test_other_edges_are_refused(self):
        camera = self.camera_of(Hidden(1), "tilt")
        camera.write_text(re.sub("distortion: .*\n", "", camera.read_text()))
        for tilt, found in ((0, "an edge at 0.0 degrees from the columns"), (45, "an edge at 4[45]..* degrees from")):
            frames = self.frames(f"tilt{tilt}")
            (self.folder / "tilt.obj").write_text(edge(tilt))
            render(self.folder, camera, self.folder / "tilt.obj", ([0, 0, 20], [0, 0, 0], [0, 1, 0]), 1, frames / "edge/0.png")
            self.assertRegex(self.refused(frames), f"{frames}/edge: found {found}.*; accepted: one straight edge")
        none = self.frames("none")
        write_pgm(none / "edge/0.pgm", self.frame(5000))
        self.assertIn("edge: found no edge in", self.refused(none))
        bright = self.frames("bright")
        write_pgm(bright / "edge/0.pgm", numpy.full((HEIGHT, WIDTH), 2 ** BITS - 1))
        self.assertIn("found 100.0 % of the numbers at the converter's end", self.refused(bright))

    def test_lag_is_reported_and_not_emulated(self):
        frames, left = self.frames("lag"), 0.03
        for i in range(40):
            light = 8000 if i < 8 else 8000 * left * 0.4 ** (i - 8)
            write_pgm(frames / "lag_1ms" / f"{i:02d}.pgm", self.frame(light))
        result, out = self.clone(frames)
        self.assertEqual(result.returncode, 0, result.stderr)
        figure = json.loads(result.stdout)["figures"]["lag_fraction"]
        self.assertLess(abs(figure["measured"] - left), 4 * figure["uncertainty"])
        self.assertLess(figure["uncertainty"], 1e-3)
        self.assertNotIn("lag_fraction:", out.read_text())
        dark = self.frames("dark_lag")
        for i in range(20):
            write_pgm(dark / "lag_1ms" / f"{i:02d}.pgm", self.frame(0))
        self.assertIn("lag_1ms: found no bright frame with 12 dark ones after it", self.refused(dark))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
