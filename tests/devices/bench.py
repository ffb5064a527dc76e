"""What the device tests share: the running emulator, its own files as the truth, modules, other programs."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import numpy
from PIL import Image

HILCAM = pathlib.Path(os.environ["HILCAM"])
SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tools/client"))
SCENARIO = SOURCE / "tests/devices/camera.yaml"
MODULE = pathlib.Path(os.environ.get("V4L2LOOPBACK", ""))  # the v4l2loopback.ko to test with
TOOLS = pathlib.Path(os.environ.get("DEVICE_TOOLS", ""))
WIDTH, HEIGHT, BITS = 160, 120, 12
DEVICE = "/dev/video0"


def run(*command, seconds=60):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=seconds,
                            errors="replace")
    return result.returncode, result.stdout + result.stderr


def wait_until(condition, seconds=60, what="what is waited for"):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"{what} did not come within {seconds} s")
        time.sleep(0.05)


class Loopback:
    """v4l2loopback, loaded afresh: its formats and buffers outlive programs."""

    def __init__(self, **parameters):
        self.parameters = {"devices": 1, "video_nr": 0, "exclusive_caps": 1, "max_buffers": 4,
                           "card_label": "hilcam", **parameters}

    def __enter__(self):
        run("modprobe", "videodev")
        status, text = run("insmod", MODULE, *(f"{key}={value}" for key, value in self.parameters.items()))
        assert status == 0, text
        wait_until(lambda: os.path.exists(DEVICE), 10, DEVICE)
        return self

    def __exit__(self, *_):
        for _ in range(50):  # a reader that was killed may still be closing
            if run("rmmod", "v4l2loopback")[0] == 0:
                return
            time.sleep(0.1)
        raise AssertionError("v4l2loopback does not unload: someone has the device open")


def version():
    name = MODULE.stem.split("-")[-1]
    return tuple(int(number) for number in name.split("."))


class Emulator:
    """hilcam run with a V4L2 output, writing each frame to a file too."""

    def __init__(self, *settings, device=DEVICE, files=True, more=()):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir="/dev/shm"))
        self.frames, self.report_file = self.folder / "frames", self.folder / "report.json"
        self.command = [str(HILCAM), "run", str(SCENARIO), "--report", str(self.report_file), *more]
        settings, self.device = list(settings), device
        if device:
            settings.append(f"outputs.v4l2.device={device}")
        if files:
            settings.append(f"outputs.files.folder={self.frames}")
        for setting in settings:
            self.command += ["--set", setting]
        self.log = self.folder / "log"

    def __enter__(self):
        with self.log.open("w") as log:
            self.process = subprocess.Popen(self.command, stderr=log)
        wait_until(lambda: "running" in self.text() or self.process.poll() is not None, 60, "the emulator")
        assert self.process.poll() is None, self.text()
        if self.device:  # a camera to others from the first frame on
            wait_until(lambda: "Video Capture" in run("v4l2-ctl", "-d", self.device, "--info")[1], 20, "the first frame")
        return self

    def text(self):
        return self.log.read_text()

    def stop(self, status=0):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=60)
        assert self.process.returncode == status, self.text()
        return json.loads(self.report_file.read_text())

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def numbers(self):
        """The digital numbers of every frame by its id, from the files."""
        found = {}
        for path in sorted(self.frames.iterdir()):
            found[int(path.stem.split("_")[1])] = numpy.asarray(Image.open(path)).astype(numpy.uint16)
        return found


def wire(name, dn):
    """A frame of a camera without colour filters in V4L2's formats, written down once more from their definitions."""
    grey = (dn >> (BITS - 8)).astype(numpy.uint8)
    if name in ("GREY", "BAYER8"):
        return grey.tobytes()
    if name == "Y16":
        return (dn << (16 - BITS)).astype("<u2").tobytes()
    if name == "BAYER10":
        return (dn >> 2).astype("<u2").tobytes()
    if name == "BAYER12":
        return dn.astype("<u2").tobytes()
    if name == "RGB24":
        return numpy.repeat(grey[..., None], 3, axis=2).tobytes()
    if name == "YUYV":
        return numpy.stack([grey, numpy.full_like(grey, 128)], axis=2).tobytes()
    raise KeyError(name)


def ids_of(data, format_name, numbers, rows=0, row_at_top=False):
    """Which frames the bytes are. Every one must be a frame of the files, byte by byte, in rising order."""
    truth = {wire(format_name, dn): frame for frame, dn in numbers.items()}
    picture = len(next(iter(truth)))
    line = picture // HEIGHT
    size = picture + rows * line
    assert len(data) % size == 0 and data, f"{len(data)} bytes are not whole frames of {size}"
    ids = []
    for at in range(0, len(data), size):
        frame = data[at:at + size]
        content = frame[rows * line:] if row_at_top else frame[:picture]
        assert content in truth, f"frame {at // size} read is none of the {len(truth)} that were written"
        ids.append(truth[content])
    assert all(a < b for a, b in zip(ids, ids[1:])), f"order of frames: {ids}"
    return ids


def skip_unless(program):
    if not shutil.which(program):
        print(f"skipped: {program} is missing", file=sys.stderr)
        return False
    return True
