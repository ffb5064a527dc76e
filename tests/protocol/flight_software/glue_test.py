#!/usr/bin/python3
"""What docs/flight_software.md says, against the running program: the glue of tools/flight_software_glue in both dialects, and packets
as cFE 7.0 lays them out.

    glue_test.py HILCAM GLUE
"""
import json
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "client"))
import pose_stream  # noqa: E402  (finds the clients, too)
from bench import Emulator, free_port  # noqa: E402
import hilcam_client as h  # noqa: E402

ADDRESS = "127.0.23.15"
# As CFE_MSG_TelemetryHeader_t: primary header, 4 + 2 bytes of time, 4 spare.
TELEMETRY_HEADER = ">HHHIH4x"
CFE_EPOCH_TAI_S = 315532800  # 1980-01-01T00:00:00 after 1970-01-01T00:00:00, both TAI


def cfe_command(message_id, function_code, payload):
    """As CFE_MSG_Init, CFE_MSG_SetFcnCode and CFE_MSG_GenerateChecksum leave it: all bytes and 0xFF by exclusive or are 0."""
    packet = bytearray(struct.pack(">HHHBB", message_id, 0xC000, 8 + len(payload) - 7, function_code, 0) + payload)
    checksum = 0xFF
    for byte in packet:
        checksum ^= byte
    packet[7] = checksum
    return bytes(packet)


class Glue(unittest.TestCase):
    def fly(self, dialect, name):
        with pose_stream.running(HILCAM, dialect) as to:
            address, port = to.split(":")
            return subprocess.run([GLUE, address, port, name, "40"], capture_output=True, text=True, timeout=60)

    def test_poses_are_accepted_and_shown_in_both_dialects(self):
        for dialect, name in ((h.HILCAM, "hilcam"), (h.CFS, "cfs")):
            result = self.fly(dialect, name)
            self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
            told = json.loads(result.stdout)
            self.assertEqual((told["sent"], told["accepted"], told["refused"]), (42, 41, 1))
            self.assertRegex(told["refusal"], "^exposure_s: found 1000000; accepted: ")
            self.assertEqual((told["pose_shown"], told["foreign"]), (41, 0))
            self.assertGreater(told["frames"], 10)

    def test_the_other_dialect_is_seen_to_be_wrong(self):
        result = self.fly(h.CFS, "hilcam")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(json.loads(result.stdout)["accepted"], 0)


class CoreFlightSystem(unittest.TestCase):
    def test_a_message_of_the_software_bus_is_a_command_and_telemetry_is_messages(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as app, \
                socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ingest:
            ingest.bind(("127.0.0.1", 0))
            for s in (app, ingest):
                s.settimeout(10)
            sets = ("commands.udp.dialect=cfs", "telemetry.port=0", "telemetry.dialect=cfs",
                    f"telemetry.udp_to=[127.0.0.1:{ingest.getsockname()[1]}]")
            with Emulator(HILCAM, ADDRESS, folder, *sets, port=free_port(), dialect=h.CFS) as emulator:
                app.sendto(cfe_command(0x1900, 5, struct.pack(">Q", 77)), ("127.0.0.1", emulator.port))
                answer = app.recv(2048)
                self.assertEqual(self.message_id(answer), 0x0901)
                # Function 5 answered, accepted; the ping's token.
                self.assertEqual((answer[17], answer[18], struct.unpack_from(">Q", answer, 24)), (0x85, 0, (77,)))
                seen = set()
                while seen != {0x0902, 0x0903}:
                    seen.add(self.message_id(ingest.recv(2048)))
                    self.assertLessEqual(seen, {0x0902, 0x0903})

    def message_id(self, packet):
        """Of a message that cFE's software bus takes."""
        stream_id, sequence, length, seconds, _subseconds = struct.unpack_from(TELEMETRY_HEADER, packet)
        self.assertEqual(length + 7, len(packet))  # what CI_LAB compares
        self.assertEqual(sequence >> 14, 3)
        self.assertEqual(seconds // 86400, (1774015237 - CFE_EPOCH_TAI_S) // 86400)  # the scenario's day
        return stream_id


if __name__ == "__main__":
    HILCAM, GLUE = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
