#!/usr/bin/python3
"""`hilcam clone` on edges, chessboards and lag of hidden cameras. Edges and boards are rendered by hilcam with another focal
length, distortion and wavefront error than the data sheet has; darks, flats and lag are made by NumPy.

    clone_optics_test.py HILCAM SOURCE_DIR
"""
import json
import math
import os
import pathlib
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
quality: fast
loop: {levels: fixed}
"""
COLUMNS, ROWS, SIDE_M = 9, 6, 0.1  # inner corners


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
exposure_range_ms: [0.0001, 1000]
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
        distance = random.uniform(0.95, 1.35)
        position = distance * numpy.array([math.sin(lean) * math.cos(turn), math.sin(lean) * math.sin(turn), math.cos(lean)])
        at = [random.uniform(-0.25, 0.25), random.uniform(-0.18, 0.18), 0]
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

    def camera_of(self, hidden, name, exposure_ms=0.05):
        file = self.folder / f"{name}_camera.yaml"
        file.write_text(hidden.yaml(exposure_ms))
        return file

    def boards(self, frames, hidden, name, seed, count=12, mesh="board.obj", series=f"chessboard_{COLUMNS}x{ROWS}"):
        camera = self.camera_of(hidden, name)
        for i, pose in enumerate(poses(seed, count)):
            render(self.folder, camera, self.folder / mesh, pose, seed * 100 + i, frames / series / f"{i:02d}.png")

    def test_one(self):
        hidden = Hidden(1)
        frames = self.frames("one")
        self.boards(frames, hidden, "one", 1)
        result, out = self.clone(frames)
        print(result.stderr, out.read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
