#!/usr/bin/python3
"""How long a pose takes to a client: from its sending to the first packet, the last packet and the client's buffer.

    latency.py HILCAM [--scenario FILE] [--seconds 30] [--pose-rate-hz 200] [--start-m X Y Z] [--prefer latency|throughput]
               [--set KEY=VALUE]...

Poses are sent over UDP, true on arrival; each frame says in a chunk which pose is the newest it shows. For every pose
that a frame is the first to show: the time from the pose's arrival to that frame's first and last packet (the emulator's
own report) and from its sending to the frame in the hands of an Aravis program. The time includes the wait for the next
exposure: at a frame rate of f, poses arrive anywhere in the period 1/f. For every frame: from the middle of its exposure to
those hands. Prints a Markdown table with a row for each `loop.prefer`, or for the one asked for. The run waits for its kept
light, and all frames have the scenario's quality. The camera's circle begins where the scenario has it.
"""
import argparse
import math
import pathlib
import sys
import tempfile
import threading
import time

import gi
import yaml

import gvcp_client as g
from bench import Emulator, SCENARIO, percentile
from genicam_client import Features
from gvsp_client import chunks_of
from hilcam_client import Client, Pose

gi.require_version("Aravis", "0.8")
from gi.repository import Aravis  # noqa: E402

HEADER = ("| scenario | `loop.prefer` | frames | | first packet | last packet | client's buffer | from its exposure |\n"
          "|---|---|---|---|---|---|---|---|")
PREFERENCES = ("latency", "throughput")


def look_back(position):
    """An attitude (w, x, y, z) that looks from a position to the origin, up along the world's z."""
    def unit(v):
        length = math.sqrt(sum(c * c for c in v))
        return [c / length for c in v]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    z = unit([-c for c in position])
    x = unit(cross(z, [0, 0, 1]))
    y = cross(z, x)
    m = [[x[i], y[i], z[i]] for i in range(3)]  # columns: the body's axes in the world
    w = math.sqrt(max(0.0, 1 + m[0][0] + m[1][1] + m[2][2])) / 2
    if w > 0.1:
        return w, (m[2][1] - m[1][2]) / (4 * w), (m[0][2] - m[2][0]) / (4 * w), (m[1][0] - m[0][1]) / (4 * w)
    candidates = [1 + m[i][i] - m[(i + 1) % 3][(i + 1) % 3] - m[(i + 2) % 3][(i + 2) % 3] for i in range(3)]
    i = candidates.index(max(candidates))
    j, k = (i + 1) % 3, (i + 2) % 3
    q = [0.0] * 4
    q[1 + i] = math.sqrt(candidates[i]) / 2
    q[0] = (m[k][j] - m[j][k]) / (4 * q[1 + i])
    q[1 + j] = (m[j][i] + m[i][j]) / (4 * q[1 + i])
    q[1 + k] = (m[k][i] + m[i][k]) / (4 * q[1 + i])
    return tuple(q)


class Sender(threading.Thread):
    """Poses on a slow circle at a steady rate; sent_ns: sequence -> CLOCK_MONOTONIC."""

    def __init__(self, port, rate_hz, start):
        super().__init__(daemon=True)
        self.port, self.period_s, self.start_m, self.sent_ns, self.stopping = port, 1 / rate_hz, start, {}, False

    def run(self):
        radius, height = math.hypot(*self.start_m[:2]), self.start_m[2]
        begin = math.atan2(self.start_m[1], self.start_m[0])
        with Client(f"127.0.0.1:{self.port}") as client:
            client.sequence, due = 1, time.monotonic()
            while not self.stopping:
                sequence = client.sequence
                angle = begin + 0.02 * sequence * self.period_s
                position = (radius * math.cos(angle), radius * math.sin(angle), height)
                pose = Pose(position_m=position, attitude_wxyz=look_back(position))
                self.sent_ns[sequence] = time.monotonic_ns()
                client.post(pose)
                while client.receive() is not None:
                    pass  # acknowledgements
                # No rhythm with the frames: the wait is spread over half a period to one and a half.
                due += self.period_s * (0.5 + (sequence * 0.6180339887) % 1)
                time.sleep(max(0.0, due - time.monotonic()))


def measure(hilcam, scenario, prefer, seconds, rate_hz, sets=(), start=None, address="127.0.23.11"):
    """Latencies and times from an exposure's middle [ms, sorted], frames, of them failed, the emulator's report."""
    sets = (f"loop.prefer={prefer}", "loop.wait_for_light=true", "loop.levels=fixed", *sets)
    start = start or yaml.safe_load(scenario.read_text())["camera_pose"]["position_m"]
    with tempfile.TemporaryDirectory() as folder, Emulator(hilcam, address, folder, *sets, scenario=scenario) as emulator:
        camera = Aravis.Camera.new(address)
        camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)
        camera.set_chunks("FrameID,PoseSequence")
        with g.GvcpClient(address) as reader:
            chunk = Features(reader).chunk_ids()["ChunkPoseSequence"][0]
        stream = camera.create_stream(None, None)
        for _ in range(16):
            stream.push_buffer(Aravis.Buffer.new_allocate(camera.get_payload()))
        camera.start_acquisition()
        sender = Sender(emulator.port, rate_hz, start)
        sender.start()
        latencies_ms, ages_ms, shown, frames, failed = [], [], 0, 0, 0
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            buffer = stream.timeout_pop_buffer(2_000_000)
            now_ns = time.monotonic_ns()
            if buffer is None:
                continue
            frames += 1
            if buffer.get_status() == Aravis.BufferStatus.SUCCESS:
                ages_ms.append((now_ns - buffer.get_timestamp()) * 1e-6)
                sequence = int.from_bytes(chunks_of(buffer.get_data())[chunk], "big")
                if sequence > shown and sequence in sender.sent_ns:
                    latencies_ms.append((now_ns - sender.sent_ns[sequence]) * 1e-6)
                    shown = sequence
            else:
                failed += 1
            stream.push_buffer(buffer)
        camera.stop_acquisition()
        sender.stopping = True
        sender.join()
        del stream, camera
        report = emulator.stop()
    return sorted(latencies_ms), sorted(ages_ms), frames, failed, report


def rows(name, prefer, latencies_ms, ages_ms, frames, failed, report):
    told = report["latency_ms"]
    counted = f"{frames} at {report['frame_rate_hz']:.1f} Hz, {failed} failed, {report['deadline_misses']} exposures missed"
    lines = []
    for label, share in (("p50", 0.5), ("p99", 0.99), ("p99.9", 0.999)):
        packets = [f"{told[which][label]:.1f} ms" if label in told[which] else "" for which in ("first_packet", "last_packet")]
        cells = [name, prefer, counted] if not lines else ["", "", ""]
        at_client = [f"{percentile(of, share):.1f} ms" for of in (latencies_ms, ages_ms)]
        lines.append("| " + " | ".join([*cells, label, *packets, *at_client]) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hilcam")
    parser.add_argument("--scenario", type=pathlib.Path, default=SCENARIO)
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--pose-rate-hz", type=float, default=200)
    parser.add_argument("--start-m", type=float, nargs=3, help="where the camera's circle begins, instead")
    parser.add_argument("--prefer", choices=PREFERENCES)
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    print(HEADER)
    for prefer in [options.prefer] if options.prefer else PREFERENCES:
        result = measure(options.hilcam, options.scenario, prefer, options.seconds, options.pose_rate_hz, options.set,
                         options.start_m)
        print(rows(options.scenario.stem, prefer, *result), flush=True)
        if not result[0]:
            sys.exit("no frame showed a pose")


if __name__ == "__main__":
    main()
