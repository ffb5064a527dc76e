#!/usr/bin/python3
"""42 itself flies two spacecraft past each other; hilcam's pictures follow them. Where $HILCAM_42 names 42's program, in its own folder.

    itself_test.py HILCAM
    itself_test.py HILCAM --figure FILE.png [SECONDS]    the plot of docs/42.md
"""
import json
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import numpy
from PIL import Image

from tap import Tap

HILCAM = os.path.abspath(sys.argv[1])
HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("HILCAM_42", "")
sys.path.insert(0, str(HERE.parents[2] / "tools/ip42"))
from make_case import Case  # noqa: E402
os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")

FOCAL_PX = 5e-3 / 5.5e-6
MIDDLE = (256.0, 192.0)  # the boresight, in px from the first pixel's corner
RADIUS_M = 0.5


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def write_ball(path, rows=48):
    """A ball of radius RADIUS_M with smooth normals."""
    lines = []
    for i in range(rows + 1):
        for j in range(2 * rows):
            theta, phi = numpy.pi * i / rows, numpy.pi * j / rows
            x, y, z = numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)
            lines += [f"v {RADIUS_M * x:.9f} {RADIUS_M * y:.9f} {RADIUS_M * z:.9f}", f"vn {x:.9f} {y:.9f} {z:.9f}"]

    def vertex(i, j):
        k = i * 2 * rows + j % (2 * rows) + 1
        return f"{k}//{k}"
    for i in range(rows):
        for j in range(2 * rows):
            if i > 0:
                lines.append(f"f {vertex(i, j)} {vertex(i + 1, j)} {vertex(i, j + 1)}")
            if i < rows - 1:
                lines.append(f"f {vertex(i, j + 1)} {vertex(i + 1, j)} {vertex(i + 1, j + 1)}")
    path.write_text("\n".join(lines) + "\n")


def values(message, name):
    return numpy.array([float(v) for v in re.search(re.escape(name) + r" = \[([^\]]*)\]", message)[1].split()])


def commanded_px(message):
    """Of the middle of the lit part of the ball by 42's own state: C_BN of the camera's body by its quaternion (scalar last), then a pinhole."""
    x, y, z, w = values(message, "SC[0].B[0].qn")
    to_body = numpy.array([[w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)],
                           [2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)],
                           [2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z]])
    place = to_body @ (values(message, "SC[1].PosR") - values(message, "SC[0].PosR"))
    # The lit part of the ball as the camera sees it: what 42's Sun lights by a twentieth, by equal areas of the picture.
    to_eye, sun = -place / numpy.linalg.norm(place), values(message, "SC[0].svb")
    k = numpy.arange(20000) + 0.5
    z, phi = 1 - k / 10000, numpy.pi * (1 + 5 ** 0.5) * k
    out = numpy.stack([numpy.sqrt(1 - z * z) * numpy.cos(phi), numpy.sqrt(1 - z * z) * numpy.sin(phi), z], axis=1)
    weight = numpy.where(out @ sun > 0.05, numpy.clip(out @ to_eye, 0, None), 0)
    at = place + RADIUS_M * out
    middle = (weight[:, None] * at[:, :2] / at[:, 2:]).sum(axis=0) / weight.sum()
    return numpy.array(MIDDLE) + FOCAL_PX * middle, place[2]


def seen_px(picture):
    """Of what is brighter than the background by a twentieth of the brightest: most of the ball's outline, as the Earth lights its dark side."""
    dark = int(numpy.median(picture))
    y, x = numpy.nonzero(picture > dark + (int(picture.max()) - dark) / 20)
    return numpy.array([x.mean() + 0.5, y.mean() + 0.5])


class Flight:
    """42 for so many seconds of its time, with hilcam; what both said."""

    def __init__(self, folder, duration_s, steps_per_frame=1, sets=(), serves=False, scenario="flight.yaml"):
        self.folder, self.every = pathlib.Path(folder), steps_per_frame
        write_ball(self.folder / "ball.obj")
        scenario_file = self.folder / "flight.yaml"
        text = (HERE / scenario).read_text()
        scenario_file.write_text(text.replace("../vizard/", f"{HERE.parent}/vizard/").replace("../../../", f"{HERE.parents[2]}/"))
        port = free_port()
        self.tap = None if serves else Tap(port)
        home = pathlib.Path(PROGRAM).resolve().parent
        case = Case(home, f"hilcam_case_{os.getpid()}_{port}", port if serves else self.tap.port, serves, duration_s)
        sets = (f"commands.ip42.port={port}", f"commands.ip42.role={'client' if serves else 'server'}", "commands.ip42.stay=false", "commands.ip42.tolerance_deg=1", f"commands.ip42.steps_per_frame={steps_per_frame}",
                f"outputs.files.folder={folder}/frames", *sets)
        command = [HILCAM, "run", str(scenario_file), "--report", f"{folder}/report.json"]
        for value in sets:
            command += ["--set", value]
        self.log_file = self.folder / "log"
        try:
            with self.log_file.open("w") as log, (self.folder / "42.log").open("w") as log42:
                hilcam = subprocess.Popen(command, stdout=log, stderr=log)
                while not serves and "running" not in self.log_file.read_text() and hilcam.poll() is None:
                    time.sleep(0.05)  # 42 as a client ends when nobody listens
                begun = time.monotonic()
                self.status_42 = subprocess.run([str(pathlib.Path(PROGRAM).resolve()), case.folder.name], cwd=home, stdout=log42, stderr=log42,
                                                timeout=1500, check=False).returncode
                self.seconds = time.monotonic() - begun
                self.status = hilcam.wait(60)
        finally:
            case.remove()
        self.log = self.log_file.read_text()
        assert self.status == 0, self.log
        self.report = json.loads((self.folder / "report.json").read_text())
        outputs = self.report.get("outputs", []) + [o for c in self.report.get("cameras", []) for o in c["outputs"]]
        self.own = next(o for o in outputs if o["name"] == "ip42 camera 1")

    def remarks(self):
        """What is wrong, without who was connected and went."""
        lines = [line.split("ip42: ", 1)[1] for line in self.log.splitlines() if "ip42: " in line]
        return [line for line in lines if not any(word in line for word in ("is connected", "lines of each step", "went away", "does not answer"))]

    def picture(self, number):
        return numpy.array(Image.open(self.folder / "frames" / f"frame_{number:08}.png"))

    def centroids(self):
        """Commanded and seen, of each frame; and the distance."""
        shown = self.tap.messages[::self.every]
        commanded, away = zip(*(commanded_px(m) for m in shown))
        seen = [seen_px(self.picture(k + 1)) for k in range(len(shown))]
        return numpy.array(commanded), numpy.array(seen), numpy.array(away)


class Flies(unittest.TestCase):
    def test_pictures_follow_its_bodies(self):
        with tempfile.TemporaryDirectory() as folder:
            flight = Flight(folder, 300.0, 30)
            self.assertEqual((flight.status_42, flight.own["steps"], flight.own["frames"]), (0, 3001, 101))
            self.assertEqual((flight.own["late_frames"], flight.own["dropped_steps"]), (0, 0))
            commanded, seen, _ = flight.centroids()
            self.assertGreater(numpy.abs(commanded[-1] - commanded[0]).max(), 40)  # it moves
            # A third of a pixel: the edge of the ball's light is a pixel wide.
            self.assertLess(numpy.abs(seen - commanded).max(), 0.35)
            self.assertEqual(flight.remarks(), [])  # 42's Sun is hilcam's within a degree, too

    def test_its_joint_turns_the_wing(self):
        """42 as the server; its body 1 turns about y."""
        with tempfile.TemporaryDirectory() as folder:
            flight = Flight(folder, 20.0, 20, serves=True, scenario="scenario.yaml", sets=(
                "time_utc=2026-03-20T14:46:00Z",
                "commands.ip42.bodies=[{body: 'SC[0].B[0]', moves: camera}, {body: 'SC[1].B[0]', moves: target}, "
                "{body: 'SC[1].B[1]', moves: target, joint: 1}]"))
            self.assertEqual((flight.status_42, flight.own["frames"]), (0, 11))
            self.assertEqual(flight.remarks(), [])


def draw(path, duration_s):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    with tempfile.TemporaryDirectory() as folder:
        flight = Flight(folder, duration_s, 10)
        commanded, seen, away = flight.centroids()
        held_ms = 1e3 * numpy.array(flight.tap.held_s)
        held_ms = {"steps with a frame": held_ms[::10], "other steps": numpy.delete(held_ms, numpy.s_[::10])}
    off = seen - commanded
    print(f"{len(seen)} frames in {flight.seconds:.1f} s; {away[0]:.1f} m to {away[-1]:.1f} m; seen - commanded: "
          f"rms {numpy.sqrt((off ** 2).mean(axis=0)).round(3)} px, worst {numpy.abs(off).max():.3f} px")
    for name, ms in held_ms.items():
        print(f"42 stood still in {name}: p50 {numpy.percentile(ms, 50):.2f} ms, p99 {numpy.percentile(ms, 99):.2f} ms, worst {ms.max():.2f} ms")
    print(json.dumps(flight.own))
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.4))
    left.plot(*commanded.T, color="tab:blue", lw=4, alpha=0.4, label="commanded (42's state)")
    left.plot(*seen[::10].T, ".", color="black", ms=3, label="seen (every tenth frame)")
    left.set(xlabel="column [px]", ylabel="row [px]", xlim=(0, 512), ylim=(384, 0), title="middle of the other spacecraft")
    left.legend()
    t = 0.1 + numpy.arange(len(seen))
    right.plot(t, off[:, 0], lw=0.7, label="column")
    right.plot(t, off[:, 1], lw=0.7, label="row")
    right.set(xlabel="time in 42 [s]", ylabel="seen - commanded [px]", title="difference")
    right.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    if not PROGRAM:
        print("skipped: give $HILCAM_42, the program 42 in its own folder (docs/42.md)")
        sys.exit(77)
    if "--figure" in sys.argv:
        draw(sys.argv[3], float(sys.argv[4]) if len(sys.argv) > 4 else 480.0)
    else:
        unittest.main(argv=sys.argv[:1])
