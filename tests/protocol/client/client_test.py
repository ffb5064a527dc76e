#!/usr/bin/python3
"""The clients of tools/client beside hilcam's own codec, byte for byte, and against the running program.

    client_test.py HILCAM VECTORS_C VECTORS_CPP TALK
"""
import dataclasses
import os
import pathlib
import random
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import pose_stream
import hilcam_client as h

VALUES = 400  # of each command and answer, in each dialect
DIALECTS = (h.HILCAM, h.CFS)
SPECIAL = (0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, float("inf"),
           float("-inf"), float("nan"))
I64 = (0, 1, -1, -2**63, 2**63 - 1)


def ask(program, lines):
    result = subprocess.run([program], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True, timeout=120)
    return result.stdout.splitlines()


def bits(value):
    """The number as vectors.c has it."""
    if isinstance(value, float):
        return f"{struct.unpack('>Q', struct.pack('>d', value))[0]:x}"
    return f"{int(value) & 0xFFFFFFFFFFFFFFFF:x}"


class Values:
    """Random ones, and those at the ends of their types now and then."""

    def __init__(self, seed):
        self.rng = random.Random(seed)

    def unsigned(self, width):
        return self.rng.choice((0, 1, 2**width - 1, self.rng.getrandbits(width), self.rng.getrandbits(width)))

    def i64(self):
        return self.rng.choice((*I64, self.rng.getrandbits(64) - 2**63, self.rng.getrandbits(62)))

    def f64(self):
        if self.rng.random() < 0.2:
            return self.rng.choice(SPECIAL)
        value = struct.unpack(">d", struct.pack(">Q", self.rng.getrandbits(64)))[0]
        return value if value == value else 0.25  # a signalling NaN may turn quiet in any register

    def vector(self, count=3):
        return tuple(self.f64() for _ in range(count))

    def command(self, kind):
        """(command, its numbers)."""
        if kind is h.Pose:
            c = h.Pose(self.unsigned(16), self.i64(), self.vector(), self.vector(), self.vector(4), self.vector())
            return c, (c.object, c.time_tai_ns, *c.position_m, *c.velocity_m_s, *c.attitude_wxyz, *c.rate_rad_s)
        if kind is h.Settings:
            mask, values = self.rng.randrange(8), self.vector()
            return h.Settings(*(v if mask >> i & 1 else None for i, v in enumerate(values))), (mask, *values)
        if kind is h.Joint:
            numbers = (self.unsigned(16), self.unsigned(16), self.i64(), self.f64(), self.f64())
        elif kind is h.Fault:
            # hilcam's own encoder writes a rate of 1 and no more where all faults end.
            numbers = (self.rng.choice(list(h.FAULTS.values())), self.f64(), self.f64(), self.unsigned(64), self.unsigned(64),
                       self.f64()) if self.rng.random() < 0.9 else (0, 1.0, 0.0, 0, 0, 0.0)
        elif kind is h.Lamp:
            numbers = (self.unsigned(16), self.i64(), self.f64())
        elif kind is h.Expose:
            numbers = (self.unsigned(16), self.i64())
        elif kind is h.Mode:
            numbers = (self.rng.random() < 0.5, self.unsigned(16))
        elif kind is h.Clock:
            numbers = (self.rng.randrange(5), self.i64(), self.f64(), self.i64())
        elif kind is h.Subscribe:
            told = (self.rng.random() < 0.5, self.rng.random() < 0.5)
            return h.Subscribe(*told), (told[0] | told[1] << 1,)
        else:
            numbers = (self.unsigned(64),) if kind is h.Ping else ()
        return kind(*numbers), numbers

    def answer(self, kind):
        count = self.unsigned(14)
        if kind is h.Acknowledgement:
            reason = "".join(self.rng.choice("abc XYZ.09'é") for _ in range(self.rng.choice((0, 1, 40, 48))))
            function, clock, at_ns = self.rng.randrange(128), None, self.i64()
            if self.rng.random() < 0.3:
                function = h.Clock.FUNCTION
                clock = h.ClockReading(self.i64(), self.i64(), self.i64(), self.f64(), self.i64(), at_ns)
            return h.Acknowledgement(function, self.rng.randrange(256), self.unsigned(32), self.unsigned(64), at_ns, reason,
                                     count, clock)
        if kind is h.FrameReport:
            return h.FrameReport(self.unsigned(8), self.unsigned(64), self.i64(), self.i64(), self.f64(), self.f64(),
                                 self.unsigned(32), self.unsigned(32), self.i64(), self.i64(), self.unsigned(64),
                                 self.unsigned(32), count)
        return h.Housekeeping(self.rng.randrange(3), self.rng.randrange(2), self.i64(), self.i64(), self.f64(),
                              self.unsigned(64), self.f64(), *(self.unsigned(64) for _ in range(4)), *self.vector(),
                              self.unsigned(32), self.unsigned(32), count)


APIDS = {h.Acknowledgement: 0x101, h.FrameReport: 0x102, h.Housekeeping: 0x103}


def words_of(answer):
    """Kind, count and fields as vectors.c prints them; the reason by its bytes."""
    numbers = {f.name: getattr(answer, f.name) for f in dataclasses.fields(answer)}
    words = [f"{APIDS[type(answer)]:x}", bits(numbers.pop("count"))]
    if not isinstance(answer, h.Acknowledgement):
        return [*words, *map(bits, numbers.values())]
    reason, clock = numbers.pop("reason"), numbers.pop("clock")
    read = (clock.arrival_tai_ns, clock.arrival_monotonic_ns, clock.departure_monotonic_ns, clock.scale,
            clock.stands_at_tai_ns) if clock else ()
    return [*words, *map(bits, numbers.values()), *map(bits, read), reason.encode().hex()]


def encoded_by_hilcam(answers, dialect):
    """Packets, from the program's own encoder."""
    lines = []
    for answer in answers:
        apid, count, *fields = words_of(answer)
        if isinstance(answer, h.Acknowledgement):
            fields[-1] = f"reason {fields[-1]}"
        lines.append(" ".join(["answer", str(DIALECTS.index(dialect)), apid, count, *fields]))
    return [bytes.fromhex(line) for line in ask(CPP, lines)]


class Encoders(unittest.TestCase):
    def test_all_three_write_the_same_bytes(self):
        values = Values(1)
        for dialect in DIALECTS:
            lines, mine = [], []
            for kind in h.COMMANDS:
                for _ in range(VALUES):
                    command, numbers = values.command(kind)
                    camera, sequence = values.unsigned(16), values.unsigned(32)
                    lines.append(" ".join(["encode", str(DIALECTS.index(dialect)), f"{camera:x}", f"{sequence:x}",
                                           f"{kind.FUNCTION:x}", *map(bits, numbers)]))
                    mine.append(h.encode(command, sequence, camera, dialect).hex())
            hilcams, cs = ask(CPP, lines), ask(C, lines)
            self.assertEqual(len(hilcams), len(h.COMMANDS) * VALUES)
            for line, python, c, hilcam in zip(lines, mine, cs, hilcams, strict=True):
                self.assertEqual(python, hilcam, line)
                self.assertEqual(c, hilcam, line)

    def test_they_have_every_command_of_the_document(self):
        text = (pose_stream.SOURCE / "docs/protocol.md").read_text()
        documented = {int(number): name for heading in re.findall(r"^### (\d.*)$", text, re.M)
                      for number, name in re.findall(r"(\d+) (\w+)", heading.split("(")[0])}
        self.assertEqual(documented, {kind.FUNCTION: kind.__name__.lower() for kind in h.COMMANDS})
        header = (pose_stream.SOURCE / "tools/client/hilcam_client.h").read_text()
        for name in documented.values():
            self.assertIn(f"hilcam_encode_{name}(", header)

    def test_the_documents_examples(self):
        text = (pose_stream.SOURCE / "docs/protocol.md").read_text()
        examples = {5: h.Ping(0x1122334455667788), 6: h.Settings(exposure_s=0.002),
                    7: h.Fault("packet_drop", rate=0.02, duration_s=30), 8: h.Expose(3), 9: h.Mode(True, 5),
                    10: h.Subscribe(True, True), 11: h.Clock(h.Clock.SCALE, 1_000_000_000, scale=0.5),
                    12: h.Lamp(2, 1_500_000_000, 0.5)}
        for sequence, command in examples.items():
            self.assertIn("\n    " + h.encode(command, sequence).hex(" ").upper() + "\n", text)
        self.assertIn("\n    " + h.encode(h.Ping(0x1122334455667788), 5, dialect=h.CFS).hex(" ").upper() + "\n", text)

    def test_faults_have_the_programs_names_and_numbers_in_its_order(self):
        named = [(name, int(number)) for name, number in re.findall(r"(\w+):(\d+)", ask(CPP, ["faults"])[0])]
        self.assertEqual(list(h.FAULTS.items()), named)
        header = (pose_stream.SOURCE / "tools/client/hilcam_client.h").read_text()
        in_header = re.findall(r"HILCAM_FAULT_(\w+) = (\d+)", header)
        self.assertEqual([(name.lower(), int(number)) for name, number in in_header], [("none", 0), *named])


class Decoders(unittest.TestCase):
    def test_all_answers_come_back_as_they_went(self):
        values = Values(2)
        for dialect in DIALECTS:
            answers = [values.answer(kind) for kind in APIDS for _ in range(VALUES)]
            packets = encoded_by_hilcam(answers, dialect)
            cs = ask(C, [f"decode {DIALECTS.index(dialect)} {packet.hex()}" for packet in packets])
            for answer, packet, c in zip(answers, packets, cs, strict=True):
                self.assertEqual(words_of(h.decode(packet, dialect)), words_of(answer))
                self.assertEqual(c.split(), [word for word in words_of(answer) if word])

    def test_damaged_packets_are_none(self):
        values = Values(3)
        damaged = []
        for packet in encoded_by_hilcam([values.answer(kind) for kind in APIDS for _ in range(50)], h.HILCAM):
            for _ in range(10):
                bit = values.rng.randrange(8 * len(packet))
                flipped = bytearray(packet)
                flipped[bit // 8] ^= 1 << bit % 8
                damaged.append(bytes(flipped))
            damaged += [packet[:values.rng.randrange(1, len(packet))], packet + b"\0"]
        for packet, c in zip(damaged, ask(C, [f"decode 0 {packet.hex()}" for packet in damaged]), strict=True):
            self.assertIsNone(h.decode(packet), packet.hex())
            self.assertEqual(c, "0", packet.hex())

    def test_random_bytes_are_judged_alike(self):
        """Lengths, bodies and kinds at random, with a right CRC; vectors.c is built with sanitizers."""
        values, packets = Values(5), []
        for _ in range(3000):
            kind = values.rng.choice((1, 2, 3, 4))
            size = values.rng.choice((0, 1, 9, 25, 26, 27, 66, 80, 108, 122, 123, 162, values.rng.randrange(248)))
            body = bytes((values.rng.choice((1, 1, 1, 0)), kind - 1)) + values.rng.randbytes(size)
            body = body[:size]
            if kind == 1 and size >= 26 and values.rng.random() < 0.8:
                body = body[:24] + (size - 26).to_bytes(2, "big") + body[26:]
            elif kind == 1 and size >= 66:
                body = body[:1] + b"\x8b" + body[2:24] + (size - 66).to_bytes(2, "big") + body[26:]
            packet = struct.pack(">HHH", 0x0900 | kind, values.rng.getrandbits(16), (size + 1) & 0xFFFF) + body
            packets.append(packet + h.crc16(packet).to_bytes(2, "big"))
        packets += [b"", b"\x09"] + [values.rng.randbytes(values.rng.randrange(1, 300)) for _ in range(1000)]
        for dialect in (0, 1):
            cs = ask(C, [f"decode {dialect} {packet.hex()}" for packet in packets])
            kinds = [h.decode(packet, DIALECTS[dialect]) for packet in packets]
            for packet, c, mine in zip(packets, cs, kinds, strict=True):
                self.assertEqual(c.split()[0], f"{APIDS[type(mine)]:x}" if mine else "0", packet.hex())
            if dialect == 0:
                self.assertGreater(sum(kind is not None for kind in kinds), 100)
            ask(C, [f"find {dialect} {packet.hex()}" for packet in packets])

    def test_both_find_the_packets_of_a_stream(self):
        for dialect in DIALECTS:
            values = Values(4)
            answers = [values.answer(values.rng.choice(list(APIDS))) for _ in range(60)]
            stream = b""
            for packet in encoded_by_hilcam(answers, dialect):
                # A sync marker, bytes of no packet (with a header's first byte among them), or nothing between.
                stream += values.rng.choice((b"", b"\x1a\xcf\xfc\x1d", b"\x09\x09\x00\xff", bytes(5))) + packet
            cutter, got, at = h.Cutter(dialect), [], 0
            while at < len(stream):
                piece = values.rng.randrange(1, 200)
                got += cutter.take(stream[at:at + piece])
                at += piece
            self.assertEqual([words_of(a) for a in got], [words_of(a) for a in answers])
            found = []
            while True:
                begin, length = (int(word, 16) for word in ask(C, [f"find {DIALECTS.index(dialect)} {stream[:4096].hex()}"])[0].split())
                if length == 0:
                    break
                found.append(words_of(h.decode(stream[begin:begin + length], dialect)))
                stream = stream[begin + length:]
            self.assertEqual(found, [words_of(a) for a in answers])


class Filters(unittest.TestCase):
    """Four instants of each exchange, made from clocks that are known."""

    def test_the_true_offset_lies_within_the_error_and_all_three_agree(self):
        rng, lines, expected = random.Random(7), [], []
        for _ in range(300):
            offset, scale = rng.randrange(-10**15, 10**15), rng.choice((1.0, 0.1, 10.0, 0.5))
            tai_0, stands = rng.randrange(10**18), rng.choice((2**63 - 1, 10**18 + 10**9))
            own, numbers, filter = rng.randrange(10**15), [], h.ClockFilter()
            for _ in range(rng.randrange(1, 20)):
                there, busy, back = (round(rng.expovariate(1e-5)) for _ in range(3))
                t1 = own
                t2, t3 = t1 + there + offset, t1 + there + busy + offset
                t4 = t1 + there + busy + back
                simulated = [min(tai_0 + round(scale * (t - offset - 10**14)), stands) for t in (t2, t3)]
                reading = h.ClockReading(simulated[0], t2, t3, scale, stands, simulated[1])
                self.assertTrue(filter.take(t1, t4, reading))
                numbers += [t1, t4, simulated[0], t2, simulated[1], t3, scale, stands]
                own = t4 + rng.randrange(10**9)
            at = own + rng.randrange(10**10)
            got, delay, error = filter.estimate(at)
            self.assertLessEqual(abs(got - offset), error + 1)
            self.assertLessEqual(delay / 2, error)
            # Simulated time is exact but for the offset's error, which it has by its scale.
            true = min(filter.reading.departure_tai_ns + scale * (at + offset - filter.reading.departure_monotonic_ns), stands)
            self.assertLessEqual(abs(filter.simulated_tai_ns(at) - true), scale * (error + 1) + 256)  # doubles of 1e18
            lines.append(" ".join(["filter", *map(bits, [at, *numbers])]))
            expected.append((got, delay, filter.simulated_tai_ns(at)))
        for program in (C, CPP):
            for line, mine, answer in zip(lines, expected, ask(program, lines), strict=True):
                words = [int(word, 16) for word in answer.split()]
                theirs = [word - 2**64 if word >= 2**63 else word for word in words]
                for a, b in zip(mine, theirs, strict=True):
                    self.assertLessEqual(abs(a - b), 16, line)  # rounding: of halves, and by the scale

    def test_what_cannot_be_is_not_taken(self):
        reading = h.ClockReading(0, 1000, 2000, 1.0, 2**63 - 1, 0)
        filter = h.ClockFilter()
        with self.assertRaisesRegex(h.NoAnswer, "no exchange"):
            filter.simulated_tai_ns(0)
        self.assertFalse(filter.take(500, 400, reading))
        self.assertFalse(filter.take(0, 999, reading))  # back sooner than it was answered
        self.assertTrue(filter.take(0, 1000, reading))
        self.assertEqual(filter.estimate(1000), (1000, 0, 0.0))
        self.assertFalse(filter.take(0, 5000, dataclasses.replace(reading, departure_monotonic_ns=900)))


class Running(unittest.TestCase):
    """Five seconds of a thousand poses a second; pose_stream.py runs longer."""

    def check_stream(self, client, transport, dialect=h.HILCAM):
        figures, problems = pose_stream.stream(HILCAM, client, transport, dialect, 5, 1000, TALK)
        self.assertEqual(problems, [], figures)
        self.assertEqual(figures["answered"], 5000)
        self.assertGreater(figures["frames_with_a_new_pose"], 10)
        self.assertGreater(figures["housekeeping"], 2)

    def test_c_over_udp(self):
        self.check_stream("c", "udp")

    def test_c_over_tcp(self):
        self.check_stream("c", "tcp")

    def test_c_over_udp_as_cfs(self):
        self.check_stream("c", "udp", h.CFS)

    def test_python_over_udp(self):
        self.check_stream("python", "udp")

    def test_python_over_tcp(self):
        self.check_stream("python", "tcp")

    def test_python_over_tcp_as_cfs(self):
        self.check_stream("python", "tcp", h.CFS)

    def test_silence_and_refusals_are_named(self):
        port = pose_stream.free_port()
        with h.Client(f"127.0.0.1:{port}") as client, self.assertRaisesRegex(h.NoAnswer, f"no acknowledgement from 127.0.0.1:{port}"):
            client.send(h.Ping(), timeout_s=0.05, tries=2)
        with self.assertRaisesRegex(h.NoAnswer, "is 'hilcam run' up"):
            h.Client(f"tcp:127.0.0.1:{port}")


    def test_who_never_reads_is_not_waited_for(self):
        with socket.create_server(("127.0.0.1", 0)) as server, \
                h.Client(f"tcp:127.0.0.1:{server.getsockname()[1]}", timeout_s=0.2) as client:
            with self.assertRaisesRegex(h.NoAnswer, "took no more commands for 0.2 s"):
                for _ in range(1_000_000):  # 132 MB: more than any kernel's buffers
                    client.post(h.Pose())

    def test_what_is_no_endpoint_is_refused(self):
        for endpoint in ("127.0.0.1", "tcp:127.0.0.1", "127.0.0.1:", "127.0.0.1:70000", ":5010", "udp:127.0.0.1:x"):
            with self.assertRaisesRegex(ValueError, "accepted: ADDRESS:PORT"):
                h.Client(endpoint)


    def test_the_shells_sender_takes_its_first_number_from_its_clock(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as server:
            server.bind(("127.0.0.1", 0))
            server.settimeout(20)
            numbers = []
            for _ in range(4):  # a program of its own each
                to = f"127.0.0.1:{server.getsockname()[1]}"
                subprocess.run([HILCAM, "send", "--to", to, "--timeout-ms", "50", "ping"], capture_output=True)
                numbers.append(struct.unpack(">I", server.recv(100)[10:14])[0])
                server.setblocking(False)
                try:
                    while server.recv(100):  # it asks again
                        pass
                except BlockingIOError:
                    server.settimeout(20)
        self.assertNotIn(0, numbers)
        # Each begins anew for who counts gaps: no step forwards by 2^20 or less.
        steps = [b - a & 0xFFFFFFFF for a, b in zip(numbers, numbers[1:])]
        self.assertGreater(min(steps), 1 << 20, numbers)

    def test_a_fault_of_some_frames_strikes_so_many_from_now_on(self):
        black = 1 << list(h.FAULTS).index("image_black")
        with pose_stream.running(HILCAM) as to, h.Client(to, timeout_s=10) as client:
            client.send(h.Subscribe(frame_reports=True))
            struck, seen = [], 0
            while seen < 40:
                report = client.receive(10)
                self.assertIsNotNone(report)
                if isinstance(report, h.FrameReport):
                    seen += 1
                    struck += [seen] if report.faults & black else []
                    if seen == 10:
                        client.send(h.Fault("image_black", frames=3))
            self.assertEqual(len(struck), 3, struck)


class Time(unittest.TestCase):
    """Simulated time of the running program, by the Python client."""

    def test_it_is_asked_for_scaled_paused_and_stepped(self):
        for dialect in DIALECTS:
            with pose_stream.running(HILCAM, dialect) as to, h.Client(to, dialect=dialect, timeout_s=10) as client:
                clock = client.clock()
                offset_ns, delay_ns, error_ns = clock.estimate(time.monotonic_ns())
                self.assertLessEqual(abs(offset_ns), error_ns)  # one machine, one clock
                self.assertGreater(delay_ns, 0)
                with self.assertRaisesRegex(h.Refused, "not now"):
                    client.step_time(1)
                slow = client.scale_time(0.25)
                self.assertEqual(slow.scale, 0.25)
                time.sleep(0.2)
                later = client.clock(1).reading
                self.assertAlmostEqual((later.departure_tai_ns - slow.departure_tai_ns) /
                                       (later.departure_monotonic_ns - slow.departure_monotonic_ns), 0.25, delta=1e-6)
                stood = client.pause_time()
                self.assertEqual(stood.departure_tai_ns, stood.stands_at_tai_ns)
                client.step_time(10_000_000)
                client.step_time(5_000_000)
                time.sleep(0.2)  # 15 ms at a quarter of the speed: 60 ms
                self.assertEqual(client.clock(1).reading.departure_tai_ns, stood.departure_tai_ns + 15_000_000)
                went_on = client.resume_time()
                self.assertEqual(went_on.stands_at_tai_ns, 2**63 - 1)
                self.assertEqual(went_on.scale, 0.25)
                self.assertGreaterEqual(went_on.departure_tai_ns, stood.departure_tai_ns + 15_000_000)
                for command in (h.Clock(9), h.Clock(h.Clock.SCALE, scale=0.0), h.Clock(h.Clock.STEP, step_ns=0)):
                    with self.assertRaisesRegex(h.Refused, "is not"):
                        client.send(command)

    def test_a_flight_from_the_shell_notices_a_change_of_scale(self):
        with pose_stream.running(HILCAM) as to, h.Client(to, timeout_s=10) as client:
            fly = subprocess.Popen([HILCAM, "send", "--to", to, "fly", "--from-m", "22", "15", "7", "--rate-hz", "20", "--duration-s",
                                    "4"], stdout=subprocess.PIPE, text=True)
            time.sleep(1)
            client.scale_time(0.1)
            self.assertIn("80 poses sent, 80 accepted", fly.communicate(timeout=60)[0])
            client.send(h.Subscribe(frame_reports=True))
            while not isinstance(report := client.receive(10), h.FrameReport):
                self.assertIsNotNone(report)
            # It asks every half second; who does not is 2.7 s ahead by now.
            ahead_ns = report.pose_time_tai_ns - client.clock(1).reading.departure_tai_ns
            self.assertLess(ahead_ns, 0.6e9)

    def test_time_tags_that_go_back_are_told(self):
        with pose_stream.running(HILCAM) as to, h.Client(to, timeout_s=10) as client:
            now_ns = client.clock().simulated_tai_ns(time.monotonic_ns())
            self.assertEqual(client.send(h.Pose(0, now_ns)).reason, "")
            self.assertEqual(client.send(h.Pose(0, now_ns - 500_000_000)).reason, "")  # late
            self.assertEqual(client.send(h.Pose(0, now_ns - 5_000_000_000)).reason, "time went back")
            self.assertEqual(client.send(h.Pose(0, now_ns - 4_000_000_000)).reason, "")
            with self.assertRaisesRegex(h.Refused, "time out of range"):
                client.send(h.Pose(0, now_ns - 3700 * 10**9))
    def test_silence_and_tags_that_went_back_are_logged_and_counted(self):
        stale = "commands.poses.stale_after_s=0.5"
        with tempfile.TemporaryDirectory() as folder, \
                pose_stream.Emulator(HILCAM, pose_stream.ADDRESS, folder, stale) as emulator, \
                emulator.client() as client:
            now_ns = client.clock().simulated_tai_ns(time.monotonic_ns())
            for back_s in (0, 5, 10):  # two of them go back
                client.send(h.Pose(0, now_ns - back_s * 10**9))
            log, until = "", time.monotonic() + 20
            while "no pose for" not in log and time.monotonic() < until:
                log = emulator.log()
                time.sleep(0.1)
            time.sleep(1)  # it goes on to be silent
            self.assertEqual(emulator.log().count("no pose for 0.5 s"), 1, emulator.log())
            self.assertNotIn("poses come again", emulator.log())
            until = time.monotonic() + 20
            while "poses come again" not in emulator.log() and time.monotonic() < until:
                client.send(h.Pose(0))
                time.sleep(0.1)
            for _ in range(5):
                client.send(h.Pose(0))
                time.sleep(0.1)
            self.assertEqual(emulator.log().count("poses come again"), 1, emulator.log())
            self.assertIn("time tags of", emulator.log())
            self.assertEqual(emulator.stop()["poses"], {"went_back": 2})


class Reports(unittest.TestCase):
    """What telemetry says of the running program."""

    def until(self, client, wanted):
        """The first packet of telemetry that is wanted."""
        until = time.monotonic() + 30
        while time.monotonic() < until:
            packet = client.receive(10)
            if packet is not None and wanted(packet):
                return packet
        self.fail("there is none")
        return None

    def test_a_latency_is_of_the_first_frame_with_a_new_command(self):
        with pose_stream.running(HILCAM) as to, h.Client(to, timeout_s=10) as client:
            client.send(h.Subscribe(frame_reports=True))
            before = self.until(client, lambda p: isinstance(p, h.FrameReport))
            self.assertEqual((before.pose_sequence, before.latency_ns), (0, -1))
            newest = client.send(h.Pose(0, 0, (22, 15, 7))).sequence
            shown = [self.until(client, lambda p: isinstance(p, h.FrameReport) and p.pose_sequence == newest)
                     for _ in range(5)]
            self.assertGreater(shown[0].latency_ns, 0)
            self.assertEqual([report.latency_ns for report in shown[1:]], [-1] * 4)

    def test_housekeeping_is_of_all_cameras_once_a_second(self):
        pair = pose_stream.SOURCE / "tests/protocol/pair_scenario.yaml"
        with tempfile.TemporaryDirectory() as folder, \
                pose_stream.Emulator(HILCAM, "127.0.23.15", folder, f"outputs.files.folder={folder}/left",
                                     "more_cameras.0.outputs.gige.interface=127.0.23.16",
                                     f"more_cameras.0.outputs.files.folder={folder}/right",
                                     scenario=pair) as emulator, \
                emulator.client() as client:
            client.send(h.Subscribe(housekeeping=True))
            client.send(h.Fault("frame_drop"), camera=2)
            client.send(h.Fault("packet_drop"), camera=2)
            client.send(h.Fault("packet_drop"), camera=1)
            client.send(h.Stop(), camera=2)
            is_housekeeping = lambda p: isinstance(p, h.Housekeeping)  # noqa: E731
            told = [self.until(client, is_housekeeping) for _ in range(3)]
            self.assertEqual((told[-1].mode, told[-1].running, told[-1].faults), (0, 1, 2))
            for one, next_one in zip(told, told[1:]):
                # Each at its second, or left out where the machine is too busy.
                seconds = (next_one.monotonic_ns - one.monotonic_ns) * 1e-9
                self.assertLess(abs(seconds - max(1, round(seconds))), 0.5, seconds)
            client.send(h.Stop(), camera=1)
            time.sleep(0.5)  # what had begun is out
            self.until(client, is_housekeeping)
            last = self.until(client, is_housekeeping)
            self.assertEqual((last.running, last.frame_rate_hz), (0, 0))
            cameras = [camera["frames"] for camera in emulator.stop()["cameras"]]
            self.assertGreater(min(cameras), 0)
            self.assertEqual(last.frames, sum(cameras))


if __name__ == "__main__":
    HILCAM, C, CPP, TALK = sys.argv[1:5]
    unittest.main(argv=[sys.argv[0], *sys.argv[5:]], verbosity=2)
