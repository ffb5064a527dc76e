#!/usr/bin/python3
"""What Wireshark's dissectors say of sessions with the camera: nothing malformed, every command answered, statuses right.

    wireshark_test.py HILCAM
"""
import collections
import pathlib
import shutil
import struct
import subprocess
import sys
import time
import unittest

import gvcp_client as g
from bench import tool
from camera_case import CLIENT, OTHER, CameraTest
from genicam_client import Features
from gvsp_client import StreamReceiver

CameraTest.hilcam = sys.argv[1]
CameraTest.address = "127.0.23.6"


class Recording:
    """tshark on the loopback interface, for one camera."""

    def __init__(self, camera, file):
        self.file = file
        self.process = subprocess.Popen(["tshark", "-i", "lo", "-B", "64", "-f", f"udp and host {camera}", "-w", str(file)],
                                        stderr=subprocess.PIPE, text=True)
        for line in self.process.stderr:
            if "Capturing" in line:
                break
        else:
            raise unittest.SkipTest("tshark may not record on lo here (root, or dpkg-reconfigure wireshark-common)")
        # The file is opened after the interface and its filter: from then on nothing is missed.
        until = time.monotonic() + 30
        while not file.exists():
            if time.monotonic() > until:
                raise RuntimeError("tshark does not begin to record")
            time.sleep(0.02)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        time.sleep(1.0)  # what has been sent is to be in the file
        self.process.terminate()
        self.process.communicate(timeout=30)

    def rows(self, gvsp_ports, gvcp_ports, shown, fields):
        command = ["tshark", "-r", str(self.file), "-T", "fields", "-E", "separator=|", "-Y", shown]
        for port in gvsp_ports:
            command += ["-d", f"udp.port=={port},gvsp"]
        for port in gvcp_ports:
            command += ["-d", f"udp.port=={port},gvcp"]
        for field in fields:
            command += ["-e", field]
        result = subprocess.run(command, capture_output=True, text=True, timeout=120)
        if result.returncode != 0:
            raise RuntimeError(result.stderr)
        return [dict(zip(fields, line.split("|"))) for line in result.stdout.splitlines()]


@unittest.skipIf(shutil.which("tshark") is None, "tshark is not installed")
class Dissected(CameraTest):
    def recorded(self):
        return Recording(self.address, pathlib.Path(self.folder.name) / f"{self.id().split('.')[-1]}.pcapng")

    def nothing_malformed(self, recording, gvsp_ports, gvcp_ports):
        bad = recording.rows(gvsp_ports, gvcp_ports, "_ws.malformed or _ws.short", ["frame.number", "_ws.col.Info"])
        self.assertEqual(bad, [])

    def commands(self, recording, gvsp_ports=(), gvcp_ports=()):
        """Commands that ask for an answer, with the statuses of the answers."""
        rows = recording.rows(gvsp_ports, gvcp_ports, "gvcp",
                              ["gvcp.cmd.command", "gvcp.cmd.flags", "gvcp.cmd.req_id", "gvcp.ack", "gvcp.cmd.status", "ip.src",
                               "udp.srcport", "ip.dst", "udp.dstport"])
        asked, answered = [], collections.defaultdict(list)
        for row in rows:
            if row["gvcp.cmd.command"]:
                # Both directions: clients' commands and the camera's events.
                if int(row["gvcp.cmd.flags"], 16) & 1:
                    asked.append((row["ip.src"], row["udp.srcport"], row["gvcp.cmd.req_id"], row["gvcp.cmd.command"]))
            else:
                answered[row["ip.dst"], row["udp.dstport"], row["gvcp.cmd.req_id"]].append(
                    (row["gvcp.ack"], int(row["gvcp.cmd.status"], 16)))
        self.assertGreater(len(asked), 0)
        return asked, answered

    def answered(self, asked, answers):
        for source, port, request, command in asked:
            codes = [code for code, _ in answers[source, port, request]]
            self.assertIn(int(command, 16) + 1, [int(code, 16) for code in codes], f"{command} {request} of {source}:{port}")

    def test_a_good_session_with_everything_in_it(self):
        with self.recorded() as recording:
            g.discover(CLIENT, to=self.address)
            client = self.controller()
            features = Features(client)
            features.set("ChunkModeActive", True)
            for name in features.entries("ChunkSelector"):
                features.set("ChunkSelector", name)
                features.set("ChunkEnable", True)
            features.set("EventSelector", "ExposureStart")
            client.write_register(g.MCRC, 2)
            client.write_register(g.MCTT, 300)
            ports, message_ports = [], []
            for extended in (False, True):
                features.set("EventNotification", "On")
                client.write_register(g.GVSP_CONFIG, 1 << 30 if extended else 0)
                with g.MessageChannel(client, CLIENT) as messages, \
                        StreamReceiver(client, CLIENT, extended=extended) as stream:
                    ports.append(stream.port)
                    message_ports.append(messages.port)
                    stream.open(1500)
                    client.write_register(g.SCPS, 1 << 31 | 1500)
                    features.execute("AcquisitionStart")
                    self.fault("packet_drop", rate=0.02)
                    for _ in range(8):
                        self.assertTrue(messages.receive(5))
                        self.assertTrue(stream.take(1)[0].complete)
                    self.emulator.clear_faults()
                    features.execute("AcquisitionStop")
                    # Whoever leaves has answered what was on its way.
                    features.set("EventNotification", "Off")
                    while messages.receive(0.4):
                        pass
                    messages.close()
            client.write_registers((g.ACTION_DEVICE_KEY, 5), (g.ACTION_GROUP_KEY, 6), (g.ACTION_GROUP_MASK, 7))
            client.command(g.ACTION, g.action_payload(5, 6, 7))
            client.write_register(g.GVCP_CONFIG, 2)
            self.fault("control_slow", value=300)
            client.timeout_s = 3
            client.read_register(g.VERSION)
            self.emulator.clear_faults()
            client.release()
        self.nothing_malformed(recording, ports, message_ports)
        asked, answers = self.commands(recording, ports, message_ports)
        self.answered(asked, answers)
        statuses = {status for found in answers.values() for _, status in found}
        self.assertEqual(statuses, {0})
        kinds = {int(command, 16) for *_, command in asked}
        self.assertLessEqual({g.DISCOVERY, g.READREG, g.WRITEREG, g.READMEM, g.WRITEMEM, g.ACTION}, kinds)
        self.assertTrue(kinds & {g.EVENT, g.EVENTDATA}, "the camera's events")
        self.assertIn(g.PENDING_ACK, {int(code, 16) for found in answers.values() for code, _ in found})
        # The stream as Wireshark reads it: leaders, trailers, resends of both kinds of ids.
        packets = recording.rows(ports, message_ports, "gvsp and !icmp",
                                 ["gvsp.format", "gvsp.status", "gvsp.blockid16", "gvsp.blockid64", "gvsp.payloadtype",
                                  "gvsp.sizex", "gvsp.flag.packetresend"])
        formats = collections.Counter(int(p["gvsp.format"], 16) & 0x7F for p in packets if p["gvsp.format"])
        self.assertGreaterEqual(min(formats[1], formats[2]), 16)
        self.assertGreater(formats[3], 16 * 50)
        self.assertEqual({int(p["gvsp.payloadtype"], 16) for p in packets if p["gvsp.payloadtype"]}, {0x4001})
        self.assertTrue(any(p["gvsp.blockid64"] for p in packets) and any(p["gvsp.blockid16"] for p in packets))

    def test_a_session_of_errors_is_well_formed_and_answered(self):
        with self.recorded() as recording:
            client, other = self.controller(), self.client(OTHER)
            expected = collections.Counter()
            for who, code, payload, status in (
                    (client, g.READREG, struct.pack(">I", 0xFFFFFFF0), g.INVALID_ADDRESS),
                    (client, g.READREG, struct.pack(">I", 2), g.BAD_ALIGNMENT),
                    (client, g.WRITEREG, struct.pack(">II", g.VERSION, 1), g.WRITE_PROTECT),
                    (client, g.WRITEREG, struct.pack(">IIII", g.SCPD, 0, g.VERSION, 1), g.WRITE_PROTECT),
                    (other, g.WRITEREG, struct.pack(">II", g.CCP, 2), g.ACCESS_DENIED),
                    (other, g.WRITEMEM, struct.pack(">I", g.USER_NAME) + bytes(16), g.ACCESS_DENIED)):
                self.assertEqual(who.exchange(code, payload).status, status)
                expected[status] += 1
        self.nothing_malformed(recording, (), ())
        asked, answers = self.commands(recording)
        self.answered(asked, answers)
        seen = collections.Counter(status for found in answers.values() for _, status in found if status)
        self.assertEqual(seen, expected)

    def test_what_aravis_does(self):
        program = tool("arv-camera-test")
        if program is None:
            self.skipTest("arv-camera-test is not installed (aravis-tools)")
        with self.recorded() as recording:
            subprocess.run([program, "-n", self.address, "--no-packet-socket", "--duration=2"], capture_output=True, timeout=60)
        asked, answers = self.commands(recording)
        self.answered(asked, answers)
        self.assertEqual({status for found in answers.values() for _, status in found}, {0})
        # Its stream port is what most datagrams go to.
        sent = recording.rows((), (), f"ip.src=={self.address}", ["udp.dstport"])
        port = collections.Counter(row["udp.dstport"] for row in sent).most_common()[0][0]
        self.nothing_malformed(recording, (port,), ())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
