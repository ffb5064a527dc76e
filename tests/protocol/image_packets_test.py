#!/usr/bin/python3
"""Frames as space packets, read by a reader written from the standards (tools/client/hilcam_read_packets.py), by the XTCE file and by the
COSMOS target: bit for bit what outputs.files writes, over each transport, in each compression, with packets lost.

    image_packets_test.py HILCAM SOURCE_DIR [--frames 1000]

So many frames over each transport; 200 without.
"""
import ctypes.util
import json
import pathlib
import random
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
sys.path[:0] = [str(SOURCE / "tools/client"), str(SOURCE / "tests/protocol/client")]
import hilcam_read_packets as r  # noqa: E402
from packet_readers import Cosmos, Xtce  # noqa: E402

SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
GROUND = SOURCE / "tools/ground_systems"
FRAMES = int(sys.argv[sys.argv.index("--frames") + 1]) if "--frames" in sys.argv else 200
SIDE = 64
APID = 272
SMALL = (f"camera.width_px={SIDE}", f"camera.height_px={SIDE}", "camera.focal_length_mm=0.7", "objects.0.generate.triangles=5000",
         "camera.frame_rate_hz=400", "camera.frame_rate_range_hz=[1, 1000]")
LIBRARIES = {"ccsds_121": "libaec.so.0", "jpeg_ls": "libcharls.so.2", "jpeg_2000": "libopenjp2.so.7"}


def sets(*values):
    return [word for value in values for word in ("--set", value)]


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def has_library(payload):
    try:
        ctypes.CDLL(LIBRARIES.get(payload, "libc.so.6"))
        return True
    except OSError:
        return False


class Collector(threading.Thread):
    """Takes the bytes of a socket until the sender ends."""

    def __init__(self, open_socket):
        super().__init__(daemon=True)
        self.open_socket, self.data = open_socket, bytearray()

    def run(self):
        with self.open_socket() as s:
            while data := s.recv(1 << 16):
                self.data += data


class Datagrams(threading.Thread):
    """Takes datagrams until stop()."""

    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.2)
        self.port, self.all, self.stopping = self.socket.getsockname()[1], [], False

    def run(self):
        while True:
            try:
                self.all.append(self.socket.recv(65535))
            except socket.timeout:
                if self.stopping:
                    return

    def stop(self):
        self.stopping = True
        self.join()
        self.socket.close()


class Case(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def command(self, *values, frames=FRAMES, when_slow="wait"):
        self.report = self.folder / "report.json"
        return [HILCAM, "run", str(SCENARIO), "--frames", str(frames), "--report", str(self.report),
                *sets(*SMALL, f"outputs.files.folder={self.folder}/frames", "outputs.files.format=raw", "outputs.files.when_slow=wait",
                      f"outputs.packets.when_slow={when_slow}", *(f"outputs.packets.{value}" for value in values))]

    def run_with(self, *values, **more):
        result = subprocess.run(self.command(*values, **more), capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stderr

    def sent(self, frames=FRAMES):
        """Frames' DN in bytes, as outputs.files has them, by their ids."""
        files = sorted((self.folder / "frames").glob("frame_*.raw"))
        self.assertEqual(len(files), frames)
        out = {int(file.stem.split("_")[1]): file.read_bytes() for file in files}
        self.assertGreater(len(set(out.values())), frames // 2, "frames differ")
        return out

    def read(self, packets, reader=None):
        """(whole frames, the others) of packets, by their ids."""
        reader = reader or r.Reader(APID)
        whole, others = {}, {}
        frames = [frame for packet in packets for frame in reader.take(packet)]
        for frame in frames + reader.rest():
            (whole if frame.is_whole() else others)[frame.first.frame] = frame
        return whole, others, reader

    def assert_same(self, whole, sent):
        for number, frame in whole.items():
            self.assertEqual((frame.first.width, frame.first.height, frame.first.bits), (SIDE, SIDE, 12))
            pixels = frame.pixels()
            if sys.byteorder == "big":
                pixels.byteswap()
            self.assertEqual(pixels.tobytes(), sent[number], f"frame {number}")

    def assert_all(self, packets, payload, frames=FRAMES):
        """All frames are there, bit for bit."""
        sent = self.sent(frames)
        whole, others, reader = self.read(packets)
        self.assertEqual((list(others), reader.lost, reader.bad), ([], 0, []))
        self.assertEqual(sorted(whole), sorted(sent))
        self.assertEqual({r.PAYLOADS[f.first.payload] for f in whole.values()}, {payload})
        self.assert_same(whole, sent)

    def output(self):
        report = json.loads(self.report.read_text())
        return next(o for o in report["outputs"] if o["name"].startswith("packets"))


class Loss(Case):
    def test_at_0_1_and_20_percent_lost_frames_are_named_and_none_is_wrong(self):
        receiver = Datagrams()
        receiver.start()
        self.run_with(f"port={receiver.port}", "rate_limit_mb_s=20")
        receiver.stop()
        packets, sent = receiver.all, self.sent()
        per_frame = -(-2 * SIDE * SIDE // (1400 - 6 - 64 - 2))
        self.assertEqual(len(packets), FRAMES * per_frame)
        for share in (0, 0.01, 0.2):
            draw = random.Random(f"{share}")
            kept = [(packet, draw.random() >= share) for packet in packets]
            # The last one tells of those that were lost before it.
            kept[-1] = (kept[-1][0], True)
            lost_of, seen = {}, set()
            for packet, keep in kept:
                number = r.parse_packet(packet).frame
                lost_of[number] = lost_of.get(number, 0) + (not keep)
                if keep:
                    seen.add(number)
            whole, others, reader = self.read([packet for packet, keep in kept if keep])
            first = next(i for i, (_, keep) in enumerate(kept) if keep)  # nobody can miss what came before
            self.assertEqual(reader.lost, sum(not keep for _, keep in kept[first:]))
            self.assertEqual(sorted(whole), sorted(n for n, lost in lost_of.items() if lost == 0))
            self.assertEqual(sorted(others), sorted(n for n, lost in lost_of.items() if lost and n in seen))
            self.assert_same(whole, sent)
            for number, frame in others.items():
                self.assertEqual(frame.first.segments - len(frame.segments), lost_of[number])
                missing = frame.missing()
                self.assertTrue(missing)
                rows = {row for a, b in missing for row in range(a, b + 1)}
                pixels = frame.pixels().tobytes()
                for row in set(range(SIDE)) - rows:  # raw pixels are placed without the others
                    self.assertEqual(pixels[2 * SIDE * row:2 * SIDE * (row + 1)], sent[number][2 * SIDE * row:2 * SIDE * (row + 1)])
            if share == 0:
                self.assertEqual(len(whole), FRAMES)
            else:
                self.assertTrue(others)

    def test_a_lost_packet_spoils_no_other_strip(self):
        self.run_with("transport=file", f"folder={self.folder}/packets", "payload=packed", "strip_rows=16", "packet_bytes=500", frames=20)
        packets = list(r.packets(str(self.folder / "packets")))
        sent = self.sent(20)
        draw = random.Random(1)
        # Of each frame one packet.
        by_frame = {}
        for packet in packets:
            by_frame.setdefault(r.parse_packet(packet).frame, []).append(packet)
        for number, own in by_frame.items():
            lost = draw.randrange(len(own))
            strip = r.parse_packet(own[lost]).first_row
            whole, others, _ = self.read([p for i, p in enumerate(own) if i != lost])
            self.assertFalse(whole)
            frame = others[number]
            for a, b in frame.missing():
                self.assertTrue(strip <= a <= b < strip + 16, (strip, a, b))
            pixels = frame.pixels().tobytes()
            for row in [row for row in range(SIDE) if not strip <= row < strip + 16]:
                self.assertEqual(pixels[128 * row:128 * (row + 1)], sent[number][128 * row:128 * (row + 1)])


class Transports(Case):
    def require(self, payload):
        if not has_library(payload):
            self.skipTest(f"{LIBRARIES[payload]} is not installed")

    def collect(self, open_socket, *values):
        collector = Collector(open_socket)
        collector.start()
        log = self.run_with(*values)
        collector.join(20)
        self.assertFalse(collector.is_alive())
        packets, left = (r.packets_of_spacewire if any("spacewire" in v for v in values) else r.packets_of_stream)(bytes(collector.data))
        self.assertEqual(left, b"")
        return packets, log

    @staticmethod
    def listening(family, where):
        listener = socket.socket(family, socket.SOCK_STREAM)
        listener.bind(where)
        listener.listen()

        def accept():
            with listener:
                return listener.accept()[0]
        return accept

    @staticmethod
    def connecting(family, where):
        """Connects as soon as hilcam listens."""
        def connect():
            end = time.monotonic() + 60
            while time.monotonic() < end:
                s = socket.socket(family, socket.SOCK_STREAM)
                try:
                    s.connect(where)
                    return s
                except (ConnectionRefusedError, FileNotFoundError):
                    s.close()
                    time.sleep(0.0005)
            raise TimeoutError("nobody listens")
        return connect

    def test_tcp_to_a_listener(self):
        self.require("ccsds_121")
        port = free_port()
        packets, _ = self.collect(self.listening(socket.AF_INET, ("127.0.0.1", port)), "transport=tcp", f"port={port}", "payload=ccsds_121")
        self.assert_all(packets, "ccsds_121")

    def test_unix_to_a_listener(self):
        path = str(self.folder / "socket")
        packets, _ = self.collect(self.listening(socket.AF_UNIX, path), "transport=unix", f"path={path}", "payload=packed")
        self.assert_all(packets, "packed")

    def check_server(self, family, where, payload, *values):
        """A client that connects during the run has the stream from the begin of a frame on."""
        packets, _ = self.collect(self.connecting(family, where), f"payload={payload}", *values)
        sent = self.sent()
        whole, others, reader = self.read(packets)
        self.assertEqual((list(others), reader.lost, reader.bad), ([], 0, []))
        self.assertGreater(len(whole), FRAMES * 0.9)
        self.assertEqual(sorted(whole), sorted(sent)[-len(whole):])
        self.assert_same(whole, sent)
        self.assertEqual(self.output()["frames"], len(whole))

    def test_tcp_server(self):
        self.require("jpeg_ls")
        port = free_port()
        self.check_server(socket.AF_INET, ("127.0.0.1", port), "jpeg_ls", "transport=tcp_server", f"port={port}")

    def test_unix_server(self):
        self.require("jpeg_2000")
        path = str(self.folder / "socket")
        self.check_server(socket.AF_UNIX, path, "jpeg_2000", "transport=unix_server", f"path={path}")

    def test_one_file(self):
        self.run_with("transport=file", f"folder={self.folder}/packets", "payload=raw_be", "crc=false")
        self.assert_all(r.packets(str(self.folder / "packets/packets.bin")), "raw_be")

    def test_a_file_a_frame(self):
        self.run_with("transport=files", f"folder={self.folder}/packets", "packet_bytes=65542")
        files = sorted((self.folder / "packets").glob("frame_*.bin"))
        self.assertEqual(len(files), FRAMES)
        for file in files[:20]:
            packet = file.read_bytes()
            self.assertEqual(r.parse_packet(packet).flags, 3, "one packet holds the frame")
        self.assert_all(r.packets(str(self.folder / "packets")), "raw_le")

    def test_spacewire_ccsds(self):
        port = free_port()
        cargo, _ = self.collect(self.listening(socket.AF_INET, ("127.0.0.1", port)), "transport=tcp", f"port={port}",
                                "spacewire={protocol: ccsds, path_address: [3, 1], target: 69, user_application: 23}")
        for packet in cargo[:50]:
            self.assertEqual(packet[:6], bytes([3, 1, 69, 2, 0, 23]))
        self.assert_all([r.unwrap_ccsds(packet) for packet in cargo], "raw_le")

    def test_spacewire_rmap(self):
        port = free_port()
        cargo, _ = self.collect(self.listening(socket.AF_INET, ("127.0.0.1", port)), "transport=tcp", f"port={port}",
                                "spacewire={protocol: rmap, target: 69, key: 32, initiator: 103, address: 2684354560, slots: 4, slot_bytes: 2048}")
        writes = [r.parse_rmap_write(packet) for packet in cargo]
        for i, write in enumerate(writes):
            self.assertEqual((write.target, write.instruction, write.key, write.initiator), (69, 0x64, 32, 103))
            self.assertEqual((write.transaction, write.address), (i & 0xFFFF, 0xA0000000 + 2048 * (i % 4)))
        self.assert_all([write.data for write in writes], "raw_le")

    def test_a_reader_that_stops_is_named_and_the_run_goes_on(self):
        port = free_port()
        with subprocess.Popen(self.command("transport=tcp_server", f"port={port}", "patience_s=0.2", "strip_rows=0", "packet_bytes=65000",
                                           frames=2000, when_slow="drop"), stderr=subprocess.PIPE, text=True) as process:
            lazy = self.connecting(socket.AF_INET, ("127.0.0.1", port))()
            with lazy:
                lazy.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                log = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 0, log)
        self.assertEqual(log.count("has read nothing for 200 ms and is disconnected"), 1, log)
        output = self.output()
        self.assertGreater(output["unwanted"], 0)
        self.assertEqual(output["frames"] + output["dropped"] + output["unwanted"], 2000)
        self.assertEqual(len(self.sent(2000)), 2000, "no frame waited for it")

    def test_udp_to_nobody_is_named_once(self):
        log = self.run_with(f"port={free_port(socket.SOCK_DGRAM)}", frames=100, when_slow="drop")
        self.assertEqual(log.count("nobody listens there"), 1, log)
        self.assertGreater(self.output()["unwanted"], 50)


class Bits121:
    """A decoder of CCSDS 121.0-B-3 for n > 8 bits, J = 16, r = 128, with the unit-delay predictor: as the Blue Book has it, slow."""

    J, R, SEGMENT_BLOCKS = 16, 128, 64

    def __init__(self, data, bits):
        self.bits, self.at = "".join(f"{byte:08b}" for byte in data), 0
        self.n, self.most = bits, (1 << bits) - 1

    def number(self, count):
        self.at += count
        return int(self.bits[self.at - count:self.at], 2) if count else 0

    def fundamental_sequence(self):
        end = self.bits.index("1", self.at)
        zeros, self.at = end - self.at, end + 1
        return zeros

    def blocks(self):
        """(reference sample or None, mapped prediction errors) of each block."""
        block = 0
        while True:
            first = block % self.R == 0
            option = self.number(4)
            low_entropy = self.number(1) if option == 0 else None
            reference = self.number(self.n) if first else None
            count = self.J - first
            if low_entropy == 0:
                zeros = self.fundamental_sequence() + 1
                left = min(self.R - block % self.R, self.SEGMENT_BLOCKS - block % self.R % self.SEGMENT_BLOCKS)
                run = left if zeros == 5 else zeros - (zeros > 5)
                for i in range(run):
                    yield (reference if i == 0 else None), [0] * (self.J - (first and i == 0))
                block += run
                continue
            if low_entropy == 1:
                errors = []
                for _ in range(self.J // 2):
                    m = self.fundamental_sequence()
                    beta = int(((8 * m + 1) ** 0.5 - 1) / 2)
                    second = m - beta * (beta + 1) // 2
                    errors += [beta - second, second]
                errors = errors[1:] if first else errors
            elif option == 15:
                errors = [self.number(self.n) for _ in range(count)]
            else:
                k = option - 1
                upper = [self.fundamental_sequence() for _ in range(count)]
                errors = [u << k | self.number(k) for u in upper]
            yield reference, errors
            block += 1

    def samples(self, count):
        out, last = [], 0
        for reference, errors in self.blocks():
            if reference is not None:
                last = reference
                out.append(last)
            for e in errors:
                theta = min(last, self.most - last)
                if e <= 2 * theta:
                    last += e // 2 if e % 2 == 0 else -(e + 1) // 2
                else:
                    last += e - theta if theta == last else theta - e
                out.append(last)
            if len(out) >= count:
                return out[:count]


class Standards(Case):
    def test_121_decodes_by_the_blue_book_alone(self):
        if not has_library("ccsds_121"):
            self.skipTest("libaec is not installed")
        self.run_with("transport=files", f"folder={self.folder}/packets", "payload=ccsds_121", frames=20)
        sent = self.sent(20)
        whole, _, _ = self.read(r.packets(str(self.folder / "packets")))
        self.assertEqual(len(whole), 20)
        for number, frame in whole.items():
            (first_row, rows, size), parts = next(iter(frame.strips.items()))
            self.assertEqual((first_row, rows), (0, SIDE))
            data = b"".join(parts[offset] for offset in sorted(parts))
            self.assertEqual(len(data), size)
            samples = Bits121(data, 12).samples(SIDE * SIDE)
            self.assertEqual(struct.pack(f"<{SIDE * SIDE}H", *samples), sent[number])

    def test_ground_systems_files_read_them(self):
        self.run_with("transport=file", f"folder={self.folder}/packets", "every_nth=2", frames=20)
        xtce, cosmos = Xtce(GROUND / "yamcs/hilcam.xml"), Cosmos(GROUND / "openc3-cosmos-hilcam/targets/HILCAM/cmd_tlm/tlm.txt")
        packets = list(r.packets(str(self.folder / "packets/packets.bin")))
        self.assertEqual(len({r.parse_packet(p).frame for p in packets}), 10, "each second one")
        for packet in packets:
            s = r.parse_packet(packet)
            container, parameters = xtce.answer(packet)
            name, items = cosmos.identify(packet)
            self.assertEqual((container, name), ("image_segment", "IMAGE_SEGMENT"))
            self.assertEqual((parameters["apid"], parameters["sequence_flags"], parameters["count"]), (s.apid, s.flags, s.count))
            for field, value in (("payload", s.payload), ("bits", s.bits), ("width", s.width), ("height", s.height), ("frame", s.frame),
                                 ("exposure_s", s.exposure_s), ("segment", s.segment), ("segments", s.segments), ("flags", 4),
                                 ("strip_offset", s.strip_offset), ("strip_bytes", s.strip_bytes), ("pixel_format", 0x01100005),
                                 ("data", s.data), ("first_row", s.first_row), ("rows", s.rows)):
                self.assertEqual(parameters[f"image_segment_{field}"], value, field)
                self.assertEqual(items[field.upper()], value, field)
            self.assertEqual(items["CRC"], int.from_bytes(packet[-2:], "big"))
            self.assertEqual(s.exposure_s, 0.00015)

    def test_times_are_those_of_truth(self):
        command = self.command("transport=file", f"folder={self.folder}/packets", frames=20)
        result = subprocess.run(command + sets(f"outputs.truth.folder={self.folder}/truth"), capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [json.loads(line) for line in (self.folder / "truth/truth.jsonl").read_text().splitlines()]
        times = {line["frame"]: line["time_tai_ns"] for line in lines if "frame" in line}
        whole, _, _ = self.read(r.packets(str(self.folder / "packets/packets.bin")))
        self.assertEqual(len(whole), 20)
        self.assertEqual({n: f.first.time_tai_ns for n, f in whole.items()}, {n: times[n] for n in whole})


class BadBytes(Case):
    def test_no_damage_makes_a_wrong_frame(self):
        self.run_with("transport=file", f"folder={self.folder}/packets", "packet_bytes=1000", frames=10)
        sent, draw = self.sent(10), random.Random(7)
        packets = list(r.packets(str(self.folder / "packets")))
        for _ in range(300):
            damaged = []
            for packet in packets:
                kind, packet = draw.randrange(8), bytearray(packet)
                if kind == 0:
                    for _ in range(draw.randrange(1, 4)):
                        packet[draw.randrange(len(packet))] ^= 1 << draw.randrange(8)
                elif kind == 1:
                    del packet[draw.randrange(len(packet)):]
                elif kind == 2:
                    damaged.append(bytes(packet))  # twice
                elif kind == 3 and damaged:
                    damaged.insert(draw.randrange(len(damaged)), bytes(packet))
                    continue
                damaged.append(bytes(packet))
            whole, _, reader = self.read(damaged, r.Reader(APID, patience=20))
            self.assertTrue(reader.bad)
            self.assert_same(whole, sent)

    def test_any_bytes_are_packets_or_refused(self):
        draw = random.Random(8)
        reader = r.Reader()
        for _ in range(3000):
            data = draw.randbytes(draw.randrange(200))
            self.assertEqual(reader.take(data), [])
            for parse in (r.parse_packet, r.unwrap_ccsds, r.parse_rmap_write):
                try:
                    parse(data)
                except r.BadPacket:
                    pass
        # Headers that are right, with payloads that are not.
        head = struct.pack(">HHH", 0x0800 | APID, 0xC000, 0)
        for payload in range(6):
            for _ in range(50):
                data = draw.randbytes(draw.randrange(1, 300))
                body = r.SECONDARY.pack(r.CUC_PREAMBLE, 0, 0, 1, payload, 12, 0, 1, 1, 8, 8, 0, 0, 0, 8, 0, draw.randrange(1 << 40), 0.1, 0, 1, 0,
                                        len(data)) + data
                frame, = reader.take(head[:4] + struct.pack(">H", len(body) - 1) + body)
                if payload in (r.RAW_LE, r.RAW_BE, r.PACKED):
                    try:
                        frame.pixels()
                    except r.BadPacket:
                        pass


class Tool(Case):
    def test_one_command_makes_pictures_of_packets(self):
        self.run_with("transport=file", f"folder={self.folder}/packets", frames=5)
        tool = [sys.executable, str(SOURCE / "tools/client/hilcam_read_packets.py")]
        result = subprocess.run([*tool, f"{self.folder}/packets", "--out", f"{self.folder}/pictures"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("5 frames whole, 0 not", result.stdout)
        for number, dn in self.sent(5).items():
            picture = (self.folder / f"pictures/frame_{number:08d}.pgm").read_bytes()
            head = b"P5\n%d %d\n4095\n" % (SIDE, SIDE)
            self.assertTrue(picture.startswith(head))
            values = struct.unpack(f">{SIDE * SIDE}H", picture[len(head):])
            self.assertEqual(struct.pack(f"<{SIDE * SIDE}H", *values), dn)
        # Without one of its packets.
        packets = list(r.packets(f"{self.folder}/packets"))
        (self.folder / "lossy.bin").write_bytes(b"".join(packets[:8] + packets[9:]))
        result = subprocess.run([*tool, f"{self.folder}/lossy.bin", "--out", f"{self.folder}/lossy", "--partial"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stdout, r"1 of 7 packets lost, rows \d+-\d+ missing")
        self.assertIn("4 frames whole, 1 not", result.stdout)
        self.assertEqual(len(list((self.folder / "lossy").glob("*_partial.pgm"))), 1)


if __name__ == "__main__":
    names = [a for a in sys.argv[3:] if a != "--frames" and not a.isdigit()]
    unittest.main(argv=[sys.argv[0], *names], verbosity=2)
