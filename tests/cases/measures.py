"""What hilcam makes of a file that somebody else might bring: one short run of the program each, and the figure that it gives.

A measure returns text or numbers. Where hilcam refuses the file it returns "refused: " and the message.
"""
import json
import pathlib
import re
import subprocess
import tempfile

import numpy

SECONDS = 60
FLAT_CAMERA = """\
{width_px: 48, height_px: 48, pitch_um: 10, focal_length_mm: %s, f_number: 8, transmission: 0.8, quantum_efficiency: 0.5,
         full_well_e: 1000000, read_noise_e: 0, gain_e_dn: 300, bits: 12, exposure_ms: 0.1, frame_rate_hz: 1, exposure_range_ms: [0.01, 100]}"""
QUAD = """\
time_utc: 2026-03-20T12:00:00Z
seed: 1
origin: {kind: free}
sun: {direction: [0.3, 0.1, 1], distance_au: 1}
camera: %(camera)s
camera_pose: {position_m: [%(middle)s, 0, 20], attitude: look_at, look_at_m: [%(middle)s, 0, 0], up: [0, 1, 0]}
objects:
  - {name: thing, mesh: "%(mesh)s", pose: {position_m: [0, 0, 0]}}
quality: reference
"""
ORBIT = """\
time_utc: %(time)s
seed: 1
origin: {kind: earth_center}
camera: %(camera)s
camera_motion: {kind: %(kind)s, %(source)s, attitude: %(attitude)s}
quality: fast
earth: {visible: false}
"""
GROUND = """\
time_utc: 2026-03-20T12:00:00Z
seed: 1
origin: {kind: body_fixed, body: %(body)s, longitude_deg: %(longitude)s, latitude_deg: %(latitude)s, height_km: 100}
camera: %(camera)s
camera_pose: {attitude: nadir}
terrain: {globe: {body: %(body)s, maps: [{file: "%(map)s", holes: fill%(keys)s}]}, material: lunar_regolith}
quality: fast
"""


class Program:
    """The program under test, and a folder for what it reads and writes."""

    def __init__(self, hilcam, folder):
        self.hilcam, self.folder = hilcam, pathlib.Path(folder)

    def run(self, *arguments):
        """Returns the exit status and what was printed, the messages apart. A program that a signal ended is a failure of the test's."""
        done = subprocess.run([self.hilcam, *map(str, arguments)], capture_output=True, text=True, timeout=SECONDS, errors="replace")
        assert done.returncode in (0, 1, 2), f"status {done.returncode} of {arguments}: {done.stderr[-500:]}"
        return done.returncode, done.stdout, done.stderr

    def refusal(self, messages):
        return "refused: " + messages.strip().splitlines()[0].replace(str(self.folder), "")[:500]

    def scenario(self, text):
        config = self.folder / "scenario.yaml"
        config.write_text(text)
        return config

    def fits(self, text, *arguments):
        """Returns the electrons of the scenario's picture, or a refusal."""
        picture = self.folder / "picture.fits"
        status, _, messages = self.run("render", self.scenario(text), "--stage", "electrons", "--out", picture, "--overwrite", *arguments)
        if status:
            return self.refusal(messages)
        data = picture.read_bytes()
        header = data[:next(at for at in range(0, len(data), 2880) if b"END     " in [data[at + i:at + i + 8] for i in range(0, 2880, 80)]) + 2880]
        size = [int(re.search(rb"NAXIS%d *= *(\d+)" % axis, header).group(1)) for axis in (2, 1)]
        return numpy.frombuffer(data, ">f4", size[0] * size[1], len(header)).reshape(size).astype(float)


def mesh(program, file):
    """Returns size [m], triangles and area [m2] that `hilcam mesh` prints, with its remarks, or a refusal."""
    status, printed, messages = program.run("mesh", file)
    if status:
        return program.refusal(messages)
    sides = re.search(r"size +(\S+) x (\S+) x (\S+) m", printed)
    return {"size": tuple(float(side) for side in sides.groups()), "triangles": int(re.search(r"triangles +(\d+)", printed).group(1)),
            "area": sum(float(area) for area in re.findall(r"triangles +(\S+) m2", printed)), "said": printed + messages}


def row(program, file, middle=0.0, width=2.0, parts=2):
    """Returns the light of each of `parts` equal parts of a plate lit from the front, left to right, over that of a white plate."""
    camera = FLAT_CAMERA % (480 * 20 / (width * 1000) * 0.8)
    text = QUAD % {"camera": camera, "middle": middle, "mesh": file}
    picture = program.fits(text)
    if isinstance(picture, str):
        return picture
    white = program.fits(text.replace('mesh: "%s"' % file, 'mesh: "%s"' % white_plate(program, middle, width)))
    lines, left, right = picture[20:28], 48 * 0.1, 48 * 0.9
    edges = numpy.linspace(left, right, parts + 1)
    spans = [slice(int(edges[i] + 2), int(edges[i + 1] - 1)) for i in range(parts)]
    return tuple(round(float(lines[:, span].mean() / white[20:28, 6:42].mean()), 3) for span in spans)


def white_plate(program, middle, width):
    """Writes a plate of reflectance 0.8 as wide as the one it is compared with, which is how a mesh without a material looks, and returns its file."""
    file = program.folder / "white.obj"
    left, right = middle - width / 2, middle + width / 2
    file.write_text("mtllib white.mtl\nusemtl white\n" + "".join(f"v {x} {y} 0\n" for x, y in ((left, -1), (right, -1), (right, 1), (left, 1))) + "f 1 2 3 4\n")
    (program.folder / "white.mtl").write_text("newmtl white\nKd 1 1 1\nillum 1\n")
    return file


def pose(program, kind, source, time="2026-03-20T12:05:30Z", attitude="{law: nadir}"):
    """Returns place [m] and attitude (scalar first) of a camera that a file moves, from the truth of its picture, at the scenario's time, or a refusal."""
    text = ORBIT % {"camera": FLAT_CAMERA % 50, "kind": kind, "source": source, "time": time, "attitude": attitude}
    truth = program.folder / "truth"
    status, _, messages = program.run("render", program.scenario(text), "--set", "camera.exposure_ms=0.01", "--out", program.folder / "p.tiff", "--truth", truth, "--overwrite")
    if status:
        return program.refusal(messages)
    record = json.loads((truth / "p.truth.jsonl").read_text().splitlines()[1])
    return record | {"place": numpy.array(record["pose"]["position_m"]), "turn": numpy.array(record["pose"]["attitude_wxyz"]), "said": messages}


def height(program, file, longitude, latitude, body="moon", keys=""):
    """Returns the height [m] of a place on the ground of a map, or a refusal."""
    text = GROUND % {"camera": FLAT_CAMERA % 50, "body": body, "longitude": longitude, "latitude": latitude, "map": file, "keys": keys}
    status, printed, messages = program.run("ground", program.scenario(text), "--list", "heights", "--at", longitude, latitude, "--within-m", 1, "--spacing-m", 1)
    if status:
        return program.refusal(messages)
    lines = [line.split(",") for line in printed.splitlines()[1:]]
    middle = min(lines, key=lambda line: abs(float(line[2])) + abs(float(line[3])))
    return round(float(middle[4]), 1)


def checked(program, scenario):
    """Returns what `hilcam check` says of a scenario, given as text."""
    status, printed, messages = program.run("check", program.scenario(scenario))
    return program.refusal(messages) if status else printed + messages
