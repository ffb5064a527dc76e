"""Basilisk's own vizInterface, compiled from a checkout (basilisk_driver.cpp), with the face of basilisk.VizInterface."""
import math
import pathlib
import shlex
import subprocess
import unittest

import basilisk

HERE = pathlib.Path(__file__).resolve().parent
SOURCES = ("simulation/vizard/vizInterface/vizInterface.cpp", "architecture/_GeneralModuleFiles/sys_model.cpp",
           "architecture/utilities/moduleIdGenerator/moduleIdGenerator.cpp", "architecture/utilities/bskLogging.cpp",
           "architecture/utilities/linearAlgebra.c", "architecture/utilities/rigidBodyKinematics.c")
PROTO = "utilities/vizProtobuffer/vizMessage.proto"


def build(checkout, folder):
    """The driver, compiled; the checkout is not written to."""
    source, folder = pathlib.Path(checkout).resolve() / "src", pathlib.Path(folder)
    subprocess.run(["protoc", f"--proto_path={source}", f"--cpp_out={folder}", PROTO], check=True)
    packages = ["pkg-config", "eigen3", "libzmq", "protobuf"]
    flags = shlex.split(subprocess.run([*packages, "--cflags"], check=True, capture_output=True, text=True).stdout)
    libraries = shlex.split(subprocess.run([*packages, "--libs"], check=True, capture_output=True, text=True).stdout)
    objects = []
    for file in [source / name for name in SOURCES] + [(folder / PROTO).with_suffix(".pb.cc"), HERE / "basilisk_driver.cpp"]:
        objects.append(folder / (file.name + ".o"))
        compiler = ["gcc"] if file.suffix == ".c" else ["g++", "-std=c++20"]
        subprocess.run([*compiler, "-w", "-O0", f"-I{folder}", f"-I{source}", *flags, "-c", file, "-o", objects[-1]], check=True)
    subprocess.run(["g++", *objects, "-o", folder / "driver", *libraries, "-pthread"], check=True)
    return folder / "driver"


class VizInterface:
    """Tells the driver the world of each update, in Basilisk's messages, and lets it step."""

    def __init__(self, driver, port, live=False):
        self.live, self.start = live, f"reset {port} {int(live)}"
        self.input = basilisk.CLASSES["VizInput"]()
        self.process = subprocess.Popen([driver], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def close(self):
        self.process.kill()
        self.process.communicate()

    def reset(self):
        """Basilisk connects once it knows its spacecraft and cameras: in the first step."""
        return b"PONG"

    def step(self, update, image_ids=()):
        self._tell_world(update, image_ids)
        if self.start:
            self._say(self.start)
            assert self._line() == [b"ready"]
            self.start = None
        self._say(f"step {int(update.currentTime.simTimeElapsed)}")
        pictures = {}
        while (line := self._line())[0] == b"image":
            pictures[int(line[1])] = self.process.stdout.read(int(line[2]))
        self.input.frameNumber = int(line[1])
        if self.live and self.input.frameNumber < 0:
            raise unittest.SkipTest("this version of Basilisk asks for no user's input")
        return pictures

    def end(self, update):
        self._say("last")
        if self._line() != [b"can", b"end"]:
            raise unittest.SkipTest("this version of Basilisk does not end Vizard")
        self.step(update)

    def _say(self, line):
        self.process.stdin.write(line.encode() + b"\n")
        self.process.stdin.flush()

    def _line(self):
        line = self.process.stdout.readline().split()
        if not line:
            raise basilisk.Stopped(f"vizInterface ended with status {self.process.wait()}")
        return line

    def _tell_world(self, update, image_ids):
        def numbers(*values):
            return " ".join(repr(float(v)) for v in values)
        if update.HasField("epoch"):
            e = update.epoch
            self._say(f"epoch {e.year} {e.month} {e.day} {e.hours} {e.minutes} {e.seconds}")
        for kind, things in (("body", update.celestialBodies), ("spacecraft", update.spacecraft)):
            for thing in things:
                name = thing.bodyName if kind == "body" else thing.spacecraftName
                self._say(f'{kind} "{name}" {numbers(*thing.position, *thing.velocity, *thing.rotation)}')
        for camera in update.cameras:
            sigma_cb = basilisk.add_mrp(camera.cameraDir_B, (-1 / 3, -1 / 3, 1 / 3))  # vizInterface turns it itself
            self._say(f'camera {camera.cameraID} "{camera.parentName}" {int(camera.cameraID in image_ids)} '
                      f"{numbers(*camera.cameraPos_B, *sigma_cb, math.radians(camera.fieldOfView))} "
                      f"{camera.resolution[0]} {camera.resolution[1]}")
