"""Basilisk's side of the Vizard protocol, as its vizInterface speaks it: messages, their order and parts.

Field numbers and types are of AVSLab/basilisk, src/utilities/vizProtobuffer/vizMessage.proto; they are written down here a second
time, as a test that shared a file with the program would share its mistakes. The order of requests, and the camera's rotation, are
those of src/simulation/vizard/vizInterface/vizInterface.cpp.
"""
import struct

import zmq
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

D, I32, I64, U64, BOOL, STRING, MESSAGE = 1, 5, 3, 4, 8, 9, 11  # FieldDescriptorProto.Type

MESSAGES = {
    "EpochDateTime": [("year", 1, I32), ("month", 2, I32), ("day", 3, I32), ("hours", 4, I32), ("minutes", 5, I32),
                      ("seconds", 6, D)],
    "TimeStamp": [("frameNumber", 1, I64), ("simTimeElapsed", 2, D)],
    "CelestialBody": [("bodyName", 1, STRING), ("position", 2, [D]), ("velocity", 3, [D]), ("rotation", 4, [D]), ("mu", 5, D),
                      ("radiusEq", 6, D), ("radiusRatio", 7, D), ("modelDictionaryKey", 8, STRING)],
    "Spacecraft": [("spacecraftName", 1, STRING), ("position", 2, [D]), ("velocity", 3, [D]), ("rotation", 4, [D]),
                   ("spacecraftSprite", 9, STRING), ("modelDictionaryKey", 13, STRING), ("logoTexture", 16, STRING),
                   ("parentSpacecraftName", 19, STRING)],
    "CameraConfig": [("cameraID", 1, I64), ("parentName", 2, STRING), ("fieldOfView", 3, D), ("resolution", 4, [I64]),
                     ("updateCameraParameters", 5, BOOL), ("cameraPos_B", 7, [D]), ("cameraDir_B", 8, [D]), ("renderRate", 9, U64),
                     ("skybox", 10, STRING), ("postProcessingOn", 11, I64), ("ppFocalLength", 14, D), ("renderMode", 16, I64),
                     ("depthMapClippingPlanes", 17, [D]), ("showHUDElementsInImage", 18, I32)],
    "VizSettingsPb": [("ambient", 1, D), ("skybox", 11, STRING)],
    "LiveVizSettingsPb": [("relativeOrbitChief", 2, STRING), ("terminateVizard", 3, BOOL)],
    "VizMessage": [("currentTime", 1, "TimeStamp"), ("celestialBodies", 2, ["CelestialBody"]), ("spacecraft", 3, ["Spacecraft"]),
                   ("cameras", 4, ["CameraConfig"]), ("settings", 7, "VizSettingsPb"), ("epoch", 8, "EpochDateTime"),
                   ("liveSettings", 10, "LiveVizSettingsPb")],
    "VizInput": [("frameNumber", 1, I64)],
}


def _classes():
    file = descriptor_pb2.FileDescriptorProto(name="vizard_test.proto", package="viz", syntax="proto3")
    for name, fields in MESSAGES.items():
        message = file.message_type.add(name=name)
        for field, number, kind in fields:
            repeated = isinstance(kind, list)
            kind = kind[0] if repeated else kind
            f = message.field.add(name=field, number=number, label=3 if repeated else 1)
            f.type = MESSAGE if isinstance(kind, str) else kind
            if isinstance(kind, str):
                f.type_name = ".viz." + kind
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    factory = message_factory.MessageFactory(pool)
    return {name: factory.GetPrototype(pool.FindMessageTypeByName("viz." + name)) for name in MESSAGES}


CLASSES = _classes()


def add_mrp(first, second):
    """MRPs of the rotation `first` followed by `second`: Schaub & Junkins (2018), eq. (3.152), the inner set."""
    def dot(a, b):
        return sum(x * y for x, y in zip(a, b))
    cross = [second[1] * first[2] - second[2] * first[1], second[2] * first[0] - second[0] * first[2],
             second[0] * first[1] - second[1] * first[0]]
    f2, s2 = dot(first, first), dot(second, second)
    scale = 1 / (1 + f2 * s2 - 2 * dot(first, second))
    out = [scale * ((1 - f2) * s + (1 - s2) * f - 2 * c) for f, s, c in zip(first, second, cross)]
    norm2 = dot(out, out)
    return [-x / norm2 for x in out] if norm2 > 1 else out


def message(frame, elapsed_ns, **parts):
    """A VizMessage: keyword arguments are its other fields, dictionaries theirs."""
    return CLASSES["VizMessage"](currentTime={"frameNumber": frame, "simTimeElapsed": float(elapsed_ns)}, **parts)


def spacecraft(name, r_bn_n, v_bn_n=(0, 0, 0), sigma_bn=(0, 0, 0)):
    return {"spacecraftName": name, "position": r_bn_n, "velocity": v_bn_n, "rotation": sigma_bn}


def body(name, position, velocity=(0, 0, 0), dcm=(1, 0, 0, 0, 1, 0, 0, 0, 1)):
    return {"bodyName": name, "position": position, "velocity": velocity, "rotation": dcm, "mu": 398600.4418,
            "radiusEq": 6378.1366, "radiusRatio": 0.99664719}


def camera(number, sigma_cb, **parts):
    """vizInterface sends the rotation to Vizard's own camera axes: sigma_CB, then (1/3, 1/3, -1/3)."""
    return {"cameraID": number, "cameraDir_B": add_mrp(sigma_cb, (1 / 3, 1 / 3, -1 / 3)), "renderRate": 60 * 10**9,
            "skybox": "black", "updateCameraParameters": False, **parts}


class Stopped(Exception):
    """vizInterface ends the simulation with an error."""


class VizInterface:
    """The REQ side. Receives time out, so that no test hangs where Basilisk would.

    Versions until 2.1.4 had one camera and asked for its picture without a number (`is_numbered`)."""

    def __init__(self, port, live=False, is_numbered=True):
        self.live, self.is_numbered = live, is_numbered
        self.pinged = False
        self.context = zmq.Context()
        self.socket = self.context.socket(zmq.REQ)
        self.socket.linger = 0
        self.socket.rcvtimeo = 60_000
        self.socket.connect(f"tcp://0.0.0.0:{port}")  # its own default address

    def close(self):
        self.socket.close()
        self.context.term()

    def reset(self):
        self.socket.send(b"PING")
        pong = self.socket.recv()
        self.ping()
        return pong

    def ping(self):
        self.socket.send(b"PING")
        self.pinged = True

    def step(self, update, image_ids=()):
        """UpdateState(): the pictures asked for, by camera. An empty one is an image that is not valid."""
        self.send(update)
        if self.socket.recv() != b"OK":
            raise Stopped("Error processing SIM_UPDATE.")
        if self.live:
            self.input = self.request_input()
        pictures = {number: self.request_image(number) for number in image_ids}
        if not self.live:
            self.ping()
        return pictures

    def end(self, update):
        """The step that ends Vizard: no answer is waited for."""
        update.liveSettings.terminateVizard = True
        self.send(update)

    def send(self, update):
        if self.pinged:
            self.socket.recv()
        self.pinged = False
        self.socket.send_multipart([b"SIM_UPDATE", b"", b"", update if isinstance(update, bytes) else update.SerializeToString()])

    def request_input(self):
        self.socket.send(b"REQUEST_INPUT")
        status, answer = self.socket.recv_multipart()
        if status == b"ERROR":
            raise Stopped("Invalid request string.")
        return CLASSES["VizInput"].FromString(answer)

    def request_image(self, number):
        self.socket.send(b"REQUEST_IMAGE_%d" % number if self.is_numbered else b"REQUEST_IMAGE")
        length, image = self.socket.recv_multipart()
        if len(length) < 4 or struct.unpack(">i", length)[0] != len(image):
            raise Stopped("Vizard image response buffer length is invalid.")
        return image

    def ask(self, *parts):
        """Any request, for what Basilisk would not send."""
        self.socket.send_multipart(list(parts))
        return self.socket.recv_multipart()
