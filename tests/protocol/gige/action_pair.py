#!/usr/bin/python3
"""Two cameras that expose at one scheduled ACTION command: how far apart, and how far from the instant.

    action_pair.py HILCAM [--actions 10000] [--rate-hz 100] [--cameras processes|one] [--clock tai|monotonic]

Each camera has a GigE Vision client of its own that takes its frames with chunks; a third program sends the actions to
everyone, each with the instant at which the exposures shall begin, and counts the answers. The truth that each emulator
writes beside its frames says when the middle of each exposure was, by CLOCK_MONOTONIC, and where the camera was in a motion
of constant velocity: two instants that do not come from the GigE Vision side. Prints figures and histograms.
"""
import argparse
import collections
import contextlib
import json
import math
import pathlib
import socket
import statistics
import sys
import tempfile
import threading
import time

import gvcp_client as g
from bench import Emulator
from genicam_client import Features
from gvsp_client import StreamReceiver
from hilcam_client import Clock, Pose

ADDRESSES, CLIENTS, SENDER = ("127.0.77.1", "127.0.77.2"), ("127.0.77.101", "127.0.77.102"), "127.0.77.103"
EVERYBODY = "127.255.255.255"
DEVICE, GROUP, MASK = 0x48494C43, 0x11, 0x1
AHEAD_NS = 60_000_000  # how long before its instant an action is sent
SPEED_M_S = 100.0
BASE_M = 1.0  # of two cameras on one body, along the world's x with the attitude (1, 0, 0, 0)
# 64 x 64 px, direct light: quick enough for any machine. The rate is that of free run, before actions are waited for.
SMALL = ("camera.width_px=64", "camera.height_px=64", "camera.focal_length_mm=0.7", "camera.exposure_ms=1",
         "camera.frame_rate_range_hz=[1, 500]", "camera.frame_rate_hz=20", "objects.0.generate.triangles=5000",
         "quality.path_model=direct")
SECOND = ("{name: second, width_px: 64, height_px: 64, pitch_um: 5.5, focal_length_mm: 0.7, f_number: 8, quantum_efficiency: 0.5,"
          " full_well_e: 13500, read_noise_e: 5, gain_dn_e: 0.29, offset_dn: 64, bits: 12, exposure_ms: 1, frame_rate_hz: 20,"
          " frame_rate_range_hz: [1, 500]}")


def tai_minus_monotonic_ns():
    """By the fastest of many readings."""
    best = None
    for _ in range(200):
        before = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
        tai = time.clock_gettime_ns(time.CLOCK_TAI)
        took = time.clock_gettime_ns(time.CLOCK_MONOTONIC) - before
        if best is None or took < best[0]:
            best = (took, tai - before - took // 2)
    return best[1]


@contextlib.contextmanager
def two_cameras(hilcam, folder, in_one):
    """The emulators; the truth of the cameras is in the folders left and right."""
    truth = [pathlib.Path(folder) / name for name in ("left", "right")]
    with contextlib.ExitStack() as stack:
        def start(address, serial, *values):
            return stack.enter_context(Emulator(hilcam, address, folder, *SMALL, *values, serial=serial))
        if in_one:
            second = (f"more_cameras=[{{camera: {SECOND}, position_m: [{BASE_M}, 0, 0], outputs: {{gige: {{interface: {ADDRESSES[1]}, "
                      f"serial: PAIR2}}, truth: {{folder: {truth[1]}, when_slow: wait}}}}}}]")
            emulators = [start(ADDRESSES[0], "PAIR1", f"outputs.truth={{folder: {truth[0]}, when_slow: wait}}", second)]
        else:
            emulators = [start(address, f"PAIR{i + 1}", f"outputs.truth={{folder: {truth[i]}, when_slow: wait}}") for i, address in enumerate(ADDRESSES)]
        yield emulators


def move(emulator):
    """The camera moves along +x from now on at SPEED_M_S, as one pose says; the pose's time tag [ns TAI]."""
    with emulator.client() as client:
        tag = client.send(Clock(sender_ns=time.monotonic_ns()), tries=5).clock.simulated_tai_ns(time.monotonic_ns())
        client.send(Pose(time_tai_ns=tag, position_m=(22, 15, 7), attitude_wxyz=(1, 0, 0, 0),
                         velocity_m_s=(SPEED_M_S, 0, 0)), tries=5)
    return tag


class ActionCamera:
    """A camera that waits for actions, and a thread that takes its frames."""

    def __init__(self, address, bind, tai, group=GROUP):
        self.client = g.GvcpClient(address, bind)
        self.client.control()
        self.features = Features(self.client)
        self.chunks = {}
        self.exposure_ns = round(self.features.get("ExposureTime") * 1000)
        self._set_up(tai, group)
        self.stream = StreamReceiver(self.client, bind).open()
        self.frames, self.stopping = [], False
        self.features.execute("AcquisitionStart")
        self.thread = threading.Thread(target=self._take, daemon=True)
        self.thread.start()

    def _set_up(self, tai, group):
        f = self.features
        self.client.write_registers((g.ACTION_DEVICE_KEY, DEVICE), (g.ACTION_GROUP_KEY, group), (g.ACTION_GROUP_MASK, MASK))
        f.set("PtpEnable", tai)
        f.set("TriggerSelector", "FrameStart")
        f.set("TriggerSource", "Action1")
        f.set("TriggerMode", "On")
        f.set("ChunkModeActive", True)
        for name in ("Timestamp", "FrameID", "ExposureMid"):
            f.set("ChunkSelector", name)
            f.set("ChunkEnable", True)
        self.chunks = f.chunk_ids()

    def _take(self):
        while not self.stopping:
            frame = self.stream.next_frame(0.2)
            if frame is not None:
                self.frames.append(frame)

    def values(self, frame):
        """(frame's number, ChunkTimestamp [ns], ChunkExposureMid [ns])."""
        return [int.from_bytes(frame.chunks[self.chunks[f"Chunk{name}"][0]], "big")
                for name in ("FrameID", "Timestamp", "ExposureMid")]

    def close(self):
        self.stopping = True
        self.thread.join()
        self.features.execute("AcquisitionStop")
        self.features.set("TriggerMode", "Off")
        self.features.set("PtpEnable", False)
        self.stream.close()
        self.client.release()
        self.client.close()


class ActionSender:
    """Sends actions to everyone and collects their answers: request id -> {camera's address: status}."""

    def __init__(self, clock):
        self.clock = clock
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        self.socket.bind((SENDER, 0))
        self.answers = collections.defaultdict(dict)
        self.thread = threading.Thread(target=self._listen, daemon=True)
        self.stopping = False
        self.thread.start()

    def _listen(self):
        self.socket.settimeout(0.1)
        while not self.stopping:
            try:
                datagram, sender = self.socket.recvfrom(65535)
            except TimeoutError:
                continue
            answer = g.Answer.of(datagram)
            if answer.code == g.ACTION + 1:
                self.answers[answer.request_id][sender[0]] = answer.status

    def send(self, request_id, at_ns, group=GROUP, to=EVERYBODY):
        payload = g.action_payload(DEVICE, group, MASK, at_ns)
        self.socket.sendto(g.command_bytes(g.ACTION, payload, g.ACKNOWLEDGE | g.SCHEDULED, request_id), (to, g.PORT))

    def series(self, count, period_ns):
        """Sends so many, each AHEAD_NS before its instant; the first instant [ns of the clock]. Request ids from 1."""
        first = time.clock_gettime_ns(self.clock) + 2 * AHEAD_NS
        for i in range(count):
            at = first + i * period_ns
            time.sleep(max(0, at - AHEAD_NS - time.clock_gettime_ns(self.clock)) * 1e-9)
            self.send(1 + i % 65535, at)
        time.sleep(2 * AHEAD_NS * 1e-9 + 0.5)
        return first

    def close(self):
        self.stopping = True
        self.thread.join()
        self.socket.close()


def truth_of(folder):
    """Frame's number -> its line."""
    with open(pathlib.Path(folder) / "truth.jsonl") as file:
        next(file)
        return {line["frame"]: line for line in map(json.loads, file)}


Exposure = collections.namedtuple("Exposure", "begin stamp truth shown")  # ns after the action's instant; shown: see measure()


def measure(hilcam, count, rate_hz, in_one, tai):
    """For each camera: action's number -> Exposure; how often the actions had which answers; the emulators' reports.

    begin: the time stamp's, less half an exposure. stamp: the chunk's time stamp less the middle of the exposure in the
    truth. truth: that middle less half an exposure. shown: the instant at which the camera was where the truth has it, less
    the instant that ChunkExposureMid says."""
    period_ns = round(1e9 / rate_hz)
    clock = time.CLOCK_TAI if tai else time.CLOCK_MONOTONIC
    with tempfile.TemporaryDirectory() as folder:
        with two_cameras(hilcam, folder, in_one) as emulators:
            tags = [move(emulator) for emulator in emulators]
            cameras = [ActionCamera(address, bind, tai) for address, bind in zip(ADDRESSES, CLIENTS)]
            time.sleep(0.5)
            sender = ActionSender(clock)
            offset_ns = tai_minus_monotonic_ns() if tai else 0
            first = sender.series(count, period_ns)
            for _ in range(100):
                if all(len(camera.frames) >= count for camera in cameras):
                    break
                time.sleep(0.05)
            for closed in (sender, *cameras):
                closed.close()
            reports = [emulator.stop() for emulator in emulators]
        exposures = []
        for i, (camera, name) in enumerate(zip(cameras, ("left", "right"))):
            truth, tag = truth_of(pathlib.Path(folder) / name), tags[i % len(tags)]
            half_ns, found = camera.exposure_ns // 2, {}
            for frame in camera.frames:
                number, stamp, mid_tai = camera.values(frame)
                line = truth[number]
                true_mid = line["monotonic_ns"] + offset_ns
                action = round((stamp - half_ns - first) / period_ns)
                shown_ns = 1e9 * (line["pose"]["position_m"][0] - 22 - (i * BASE_M if in_one else 0)) / SPEED_M_S
                at = first + action * period_ns
                found[action] = Exposure(stamp - half_ns - at, stamp - true_mid, true_mid - half_ns - at, shown_ns - (mid_tai - tag))
            exposures.append(found)
    answered = collections.Counter(tuple(sorted(sender.answers.get(1 + i % 65535, {}).items())) for i in range(count))
    return exposures, answered, reports


def summary(values_ns):
    values = sorted(values_ns)
    return (f"mean {statistics.fmean(values) * 1e-3:+.3f} us, standard deviation {statistics.pstdev(values) * 1e-3:.3f} us, "
            f"{values[0] * 1e-3:+.3f} to {values[-1] * 1e-3:+.3f} us")


def histogram(values_ns):
    """Lines of text: by decades of the absolute value."""
    edges = [0, 1, 10, 100, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, math.inf]
    counts = [0] * (len(edges) - 1)
    for value in values_ns:
        counts[next(i for i in range(len(counts)) if edges[i] <= abs(value) < edges[i + 1])] += 1
    longest = max(counts)
    return "\n".join(f"  {edges[i]:>9} to {edges[i + 1]:>9} ns {count:>7} {'#' * round(50 * count / longest)}"
                     for i, count in enumerate(counts) if count)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hilcam")
    parser.add_argument("--actions", type=int, default=10_000)
    parser.add_argument("--rate-hz", type=float, default=100)
    parser.add_argument("--cameras", choices=("processes", "one"), default="processes")
    parser.add_argument("--clock", choices=("tai", "monotonic"), default="tai")
    options = parser.parse_args()
    (left, right), answered, reports = measure(options.hilcam, options.actions, options.rate_hz, options.cameras == "one",
                                      options.clock == "tai")
    both = sorted(set(left) & set(right))
    print(f"{options.actions} actions at {options.rate_hz:g} Hz: {len(left)} and {len(right)} exposures, {len(both)} of both")
    for answers, count in answered.most_common(5):
        print(f"  {count} actions answered by {', '.join(f'{a}: 0x{s:04X}' for a, s in answers) or 'nobody'}")
    for camera in (camera for report in reports for camera in report.get("cameras") or [report]):
        gige = next(output for output in camera["outputs"] if output["name"].startswith("gige"))
        print(f"  {gige['name']}: {camera['frames']} frames, {gige['frames']} sent, {gige['dropped']} lost, "
              f"{camera['deadline_misses']} exposures missed or late")
    if not both:
        sys.exit("no action exposed both")
    for label, values in (("between the two, by the truth", [left[i].truth - right[i].truth for i in both]),
                          ("between the two, by their time stamps", [left[i].begin - right[i].begin for i in both]),
                          ("from the instant, by the truth", [e[i].truth for e in (left, right) for i in both]),
                          ("time stamp less the truth's middle", [e[i].stamp for e in (left, right) for i in both]),
                          ("place in the truth less ChunkExposureMid", [e[i].shown for e in (left, right) for i in both])):
        print(f"{label}: {summary(values)}\n{histogram(values)}")


if __name__ == "__main__":
    main()
