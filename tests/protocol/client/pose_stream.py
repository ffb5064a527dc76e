#!/usr/bin/python3
"""Poses at a steady rate from both clients to a running program: none lost, none reordered, none shown late.

    pose_stream.py HILCAM [--client c|python|all] [--to udp|tcp|all] [--dialect hilcam|cfs] [--seconds 600] [--rate-hz 1000]
                   [--talk PROGRAM]

Every pose must be accepted, its answers come in the order of sending, frames show ever newer poses with the time tags
they were sent with, and hilcam's own report must count as many commands as were sent, and none lost. Prints a line of JSON
for each run; exit status 1 when one failed. Without --talk the C client is compiled first (needs cc).
"""
import argparse
import contextlib
import json
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[2]
sys.path[:0] = [str(HERE.parent / "gige"), str(SOURCE / "tools/client")]
from bench import Emulator, free_port  # noqa: E402
from hilcam_client import (CFS, HILCAM, Acknowledgement, Client, Clock, Expose, Fault, FrameReport, Housekeeping, Joint, Mode,  # noqa: E402
                           Ping, Pose, Settings, Start, Stop, Subscribe)

ADDRESS = "127.0.23.14"
C_FLAGS = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O2")
MOST_UNANSWERED = 128  # as in talk.c
ALONG_X = (0.5**0.5, 0, 0.5**0.5, 0)  # turns +z to the world's +x


def compile_talk(folder):
    program = pathlib.Path(folder) / "talk"
    subprocess.run(["cc", *C_FLAGS, f"-I{SOURCE}", str(HERE / "talk.c"), "-o", str(program)], check=True)
    return program


class Flight:
    """What is known of the poses that were sent, and what is wrong with what comes back."""

    def __init__(self, first, dialect):
        self.first, self.mask = first, 0x3FFF if dialect == CFS else 0xFFFFFFFF
        self.tags_ns, self.answered, self.newest_shown, self.problems = [], 0, -1, []
        self.frames = self.fresh = self.housekeeping = self.dropped = 0
        self.next_count = {}

    def take(self, answer):
        if isinstance(answer, Acknowledgement):
            expected = self.first + self.answered & self.mask
            if not answer.accepted or answer.sequence != expected:
                self.problems.append(f"pose {expected}: {answer.sequence} {answer}")
            self.answered += 1
            return
        kind = type(answer)
        self.dropped += (answer.count - self.next_count.get(kind, answer.count)) & 0x3FFF
        self.next_count[kind] = answer.count + 1 & 0x3FFF
        if kind is Housekeeping:
            self.housekeeping += 1
        elif kind is FrameReport:
            self.frames += 1
            self.shown(answer)

    def shown(self, report):
        number = report.pose_sequence - self.first & self.mask
        if self.mask == 0x3FFF and self.newest_shown >= 0:  # 14 bits: the one next to what was shown before
            number = self.newest_shown + (number - self.newest_shown & self.mask)
        if number >= len(self.tags_ns):
            if self.newest_shown >= 0:
                self.problems.append(f"frame {report.frame} shows {report.pose_sequence}, which was not sent, or is older")
            return
        if number < self.newest_shown:
            self.problems.append(f"frame {report.frame} shows pose {number} after {self.newest_shown}")
        self.fresh += number > self.newest_shown
        self.newest_shown = number
        if self.tags_ns[number] != report.pose_time_tai_ns:
            self.problems.append(f"frame {report.frame}: pose {number} has the tag {report.pose_time_tai_ns}")


def every_command(client):
    """Each is answered as docs/protocol.md says, by a camera that runs free and has one object without joints."""
    assert client.send(Ping(0x0123456789ABCDEF)).token == 0x0123456789ABCDEF
    clock = client.send(Clock(sender_ns=-5))
    assert (clock.token, clock.clock.scale) == (2**64 - 5, 1.0), clock
    expected = [(Settings(exposure_s=0.0002, gain_db=0), 0), (Settings(gain_db=1e6), 6), (Stop(), 0), (Start(), 0),
                (Joint(1, 999), 7), (Fault("image_black", frames=1), 0), (Fault(), 0), (Expose(1), 10), (Mode(), 0),
                (Subscribe(frame_reports=True, housekeeping=True), 0)]
    for command, status in expected:
        answer = client.send(command, check=False)
        assert answer.status == status, f"{command}: {answer}"


def python_flight(to, dialect, seconds, rate_hz):
    """(commands sent, of them to be refused, figures, problems)."""
    with Client(to, dialect=dialect, timeout_s=10) as client:
        every_command(client)
        commands = 12 + 8
        clock = client.clock(exchanges=8)
        flight, total = Flight(client.sequence, dialect), round(seconds * rate_hz)
        start = last_progress = time.monotonic()
        while flight.answered < total:
            now = time.monotonic()
            # As many as are due by now: what a busy machine delays is made up for, up to the window.
            while (len(flight.tags_ns) < total and len(flight.tags_ns) - flight.answered < MOST_UNANSWERED
                   and (now - start) * rate_hz >= len(flight.tags_ns)):
                tag_ns = clock.simulated_tai_ns(time.monotonic_ns())
                flight.tags_ns.append(tag_ns)
                client.post(Pose(0, tag_ns, (-30 - 0.001 * (now - start), 0, 0), (-0.001, 0, 0), ALONG_X))
                now = time.monotonic()
            answered, wait_s = flight.answered, 0.001
            while (answer := client.receive(wait_s)) is not None:
                flight.take(answer)
                wait_s = 0
            if flight.answered > answered:
                last_progress = now
            if now - last_progress > 10:
                flight.problems.append(f"{len(flight.tags_ns) - flight.answered} poses without an answer")
                break
        until = time.monotonic() + 2
        while flight.newest_shown < total - 1 and time.monotonic() < until:
            if (answer := client.receive(0.05)) is not None:
                flight.take(answer)
        if flight.newest_shown < total - 1:
            flight.problems.append("no frame shows the last pose")
    figures = {"commands": commands + len(flight.tags_ns), "poses": len(flight.tags_ns), "answered": flight.answered,
               "frames": flight.frames, "frames_with_a_new_pose": flight.fresh, "housekeeping": flight.housekeeping,
               "telemetry_dropped": flight.dropped, "problems": len(flight.problems)}
    return figures, flight.problems


def c_flight(talk, port, transport, dialect, seconds, rate_hz):
    result = subprocess.run([str(talk), "127.0.0.1", str(port), transport, "cfs" if dialect == CFS else "hilcam", str(seconds),
                             str(rate_hz)], capture_output=True, text=True)
    figures = json.loads(result.stdout) if result.stdout.strip() else {}
    problems = result.stderr.splitlines()
    if result.returncode != 0 and not problems:
        problems = [f"talk ended with {result.returncode}"]
    return figures, problems


@contextlib.contextmanager
def running(hilcam, dialect=HILCAM):
    """A program of its own, and where it listens by UDP."""
    with tempfile.TemporaryDirectory() as folder:
        sets = [] if dialect == HILCAM else [f"commands.udp.dialect={dialect}"]
        with Emulator(hilcam, ADDRESS, folder, *sets, dialect=dialect) as emulator:
            yield f"127.0.0.1:{emulator.port}"


def stream(hilcam, client, transport, dialect, seconds, rate_hz, talk=None):
    """Figures and problems of one run with a program of its own."""
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        sets = [] if dialect == HILCAM else [f"commands.udp.dialect={dialect}"]
        port = None
        if transport == "tcp":
            import socket
            with socket.socket() as s:
                s.bind(("127.0.0.1", 0))
                port = s.getsockname()[1]
            sets = [f"commands.tcp.port={port}", *([] if dialect == HILCAM else [f"commands.tcp.dialect={dialect}"])]
        emulator = stack.enter_context(Emulator(hilcam, ADDRESS, folder, *sets, dialect=dialect if transport == "udp" else HILCAM))
        port = port or emulator.port
        if client == "c":
            figures, problems = c_flight(talk or compile_talk(folder), port, transport, dialect, seconds, rate_hz)
        else:
            to = f"127.0.0.1:{port}" if transport == "udp" else f"tcp:127.0.0.1:{port}"
            figures, problems = python_flight(to, dialect, seconds, rate_hz)
        told = emulator.stop()["commands"]
    # hilcam's own count; of the pings that waited for its start it has heard one or more.
    pings = told["received"] - figures.get("commands", 0)
    if not 1 <= pings <= emulator.pings or told["refused"] != 3 or told["lost"] != 0:
        problems.append(f"hilcam counts {told}, of them {pings} pings, of {emulator.pings}")
    return {"client": client, "transport": transport, "dialect": dialect, "seconds": seconds, **figures, "report": told}, problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hilcam")
    parser.add_argument("--client", choices=("c", "python", "all"), default="all")
    parser.add_argument("--to", choices=("udp", "tcp", "all"), default="udp")
    parser.add_argument("--dialect", choices=("hilcam", "cfs"), default="hilcam")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--rate-hz", type=float, default=1000)
    parser.add_argument("--talk", help="the C client, compiled")
    options = parser.parse_args()
    failed = False
    for client in ("c", "python") if options.client == "all" else (options.client,):
        for transport in ("udp", "tcp") if options.to == "all" else (options.to,):
            figures, problems = stream(options.hilcam, client, transport, CFS if options.dialect == "cfs" else HILCAM,
                                       options.seconds, options.rate_hz, options.talk)
            print(json.dumps(figures), flush=True)
            for line in problems[:20]:
                print("  " + line, flush=True)
            failed = failed or bool(problems)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
