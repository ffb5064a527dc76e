#!/usr/bin/python3
"""The camera in a network namespace of its own, Aravis in another, a veth pair between them that loses packets.

    netns_test.py HILCAM

Needs root (network namespaces, nftables); skips with a message otherwise.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

from bench import PATIENT, Emulator, camera_test_figures, judge_acquisition, tool
from wire import CAMERA, CLIENT, NotHere, Wire

HILCAM = sys.argv[1]


class TwoMachines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if tool("arv-camera-test") is None:
            raise unittest.SkipTest("arv-camera-test is not installed (aravis-tools)")
        try:
            cls.wire = Wire().open()
        except NotHere as error:
            raise unittest.SkipTest(str(error))
        cls.addClassCleanup(cls.wire.close)
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.emulator = Emulator(HILCAM, CAMERA, cls.folder.name, "camera.frame_rate_hz=20", namespace=cls.wire.here)
        cls.addClassCleanup(cls.emulator.kill)

    def setUp(self):
        self.addCleanup(self.wire.lose_nothing)

    def lose(self, one_in):
        try:
            self.wire.lose(one_in)
        except NotHere as error:
            self.skipTest(str(error))

    def camera_test(self, *arguments, seconds=3):
        text = self.wire.at_client(tool("arv-camera-test"), "-n", CAMERA, f"--duration={seconds}", *PATIENT, *arguments).stdout
        figures = camera_test_figures(text)
        self.assertIn("n_completed_buffers", figures, text)
        return figures, text

    def whole(self, figures, text, least):
        judge_acquisition(self, figures, text, least)

    def test_found_by_broadcast_over_the_wire(self):
        listed = self.wire.at_client(tool("arv-tool")).stdout
        self.assertEqual(listed.count(f"T{self.emulator.port} ({CAMERA})"), 1, listed)

    def test_plain_sockets(self):
        self.whole(*self.camera_test("--no-packet-socket"), 20)

    def test_packet_socket(self):
        """Aravis's other receiver: a ring under the interface (AF_PACKET), its default where it has the right."""
        self.whole(*self.camera_test(), 20)

    def test_the_packet_size_is_negotiated_down_to_the_wire_s(self):
        figures, text = self.camera_test("-i", "8000", "-j", "always", "--no-packet-socket", seconds=2)
        self.whole(figures, text, 10)
        size = int(re.search(r"gv packet size\s+= (\d+)", text)[1])
        self.assertTrue(1400 < size <= 1500, text)

    def test_two_percent_lost_plain_sockets(self):
        self.lose(50)
        self.recovered(*self.camera_test("--no-packet-socket", "-i", "1400", "-j", "never", seconds=5))

    def test_two_percent_lost_packet_socket(self):
        self.lose(50)
        self.recovered(*self.camera_test("-i", "1400", "-j", "never", seconds=5))

    def recovered(self, figures, text):
        self.assertGreater(self.wire.lost(), 20)
        self.whole(figures, text, 40)
        self.assertGreater(figures["n_resent_packets"], 20, text)

    def test_a_cable_that_is_pulled_and_put_back(self):
        process = subprocess.Popen(["ip", "netns", "exec", self.wire.there, tool("arv-camera-test"), "-n", CAMERA,
                                    "--no-packet-socket", "--duration=5"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   text=True)
        time.sleep(1.5)
        self.wire.cable(False)
        time.sleep(1)
        self.wire.cable(True)
        text, _ = process.communicate(timeout=60)
        self.assertGreater(camera_test_figures(text)["n_completed_buffers"], 0, text)
        self.assertTrue(self.emulator.alive(), self.emulator.log())
        self.whole(*self.camera_test("--no-packet-socket", seconds=2), 10)


# A plain client that looks at its socket every 20 ms; its buffer is the system's default (208 KiB), which takes a frame and
# a half. Prints how many blocks came whole, and how many did not.
SLOW_CLIENT = """
import collections, socket, struct, time
import gvcp_client as g
from genicam_client import Features
from gvsp_client import Packet, TRAILER
with g.GvcpClient("{camera}", "{client}") as camera, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stream:
    camera.control()
    features = Features(camera, camera.description()[0])
    features.set("PixelFormat", "Mono12")
    stream.bind(("{client}", 0))
    stream.setblocking(False)
    camera.write_register(g.SCPS, 1500)
    camera.write_registers((g.SCDA, g.ip_number("{client}")), (g.SCP, stream.getsockname()[1]))
    features.execute("AcquisitionStart")
    blocks, last = collections.defaultdict(set), {{}}
    until = time.monotonic() + {seconds}
    while time.monotonic() < until:
        time.sleep(0.02)
        camera.keep_control()
        try:
            while True:
                packet = Packet.of(stream.recv(65535))
                blocks[packet.block].add(packet.id)
                if packet.format == TRAILER:
                    last[packet.block] = packet.id
        except BlockingIOError:
            pass
    features.execute("AcquisitionStop")
    ended = [block for block in blocks if block < max(blocks)]
    whole = sum(block in last and len(blocks[block]) == last[block] + 1 for block in ended)
    print(whole, len(ended) - whole)
"""


class LateFrames(unittest.TestCase):
    """Where the receiver's buffer is not seen, frames that wait behind a slow one do not leave in a burst after it."""

    @classmethod
    def setUpClass(cls):
        try:
            cls.wire = Wire().open()
        except NotHere as error:
            raise unittest.SkipTest(str(error))
        cls.addClassCleanup(cls.wire.close)
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)

    def test_a_client_with_a_default_buffer_gets_them_whole(self):
        # A frame of 98 kB takes 140 ms at this rate: two wait meanwhile.
        emulator = Emulator(HILCAM, CAMERA, self.folder.name, "camera.frame_rate_hz=20",
                            "faults=[{kind: bandwidth_cap, value: 0.7, rate: 0.1}]", namespace=self.wire.here)
        self.addCleanup(emulator.kill)
        result = self.wire.at_client(sys.executable, "-c", SLOW_CLIENT.format(camera=CAMERA, client=CLIENT, seconds=10),
                                     cwd=pathlib.Path(__file__).parent)
        self.assertEqual(result.returncode, 0, result.stderr)
        whole, broken = map(int, result.stdout.split())
        report = emulator.stop()
        slow = report["fault_strikes"]["counts"]["bandwidth_cap"]
        output = next(output for output in report["outputs"] if output["name"].startswith("gige"))
        self.assertGreater(slow, 5)
        self.assertGreater(output["frames_spaced"], slow / 3)
        # Without the spacing nearly every slow frame breaks one or two behind it.
        self.assertLess(broken, slow / 2, f"{whole} whole, {broken} broken, {slow} slow")
        self.assertGreater(whole, 60)
        self.assertRegex(emulator.log(), r"exposures missed, mid-exposure to last packet p99 \d+\.\d ms")


OTHER = "10.25.0.1"
# Run at one end of the wire: FORCEIP to everybody, from this end's address.
FORCE_IP = """
import gvcp_client as g
g.to_everyone("{source}", g.FORCEIP, g.force_ip_payload(bytes.fromhex("{mac}"), "{ip}"), wait_s=0.3)
"""
# Who answers a discovery, and whether a camera answers when it is asked by name.
FOUND = """
import gvcp_client as g
print(sorted(found.ip for found in g.discover("{source}")))
"""
ANSWERS = """
import gvcp_client as g
try:
    print(g.GvcpClient("{camera}", timeout_s=0.3, tries=2).read_register(g.VERSION) != 0)
except g.NoAnswer:
    print(False)
"""


class OtherNetworks(unittest.TestCase):
    """A camera on the loopback interface and one on a network that the wire does not lead to, though it could carry to both."""

    @classmethod
    def setUpClass(cls):
        try:
            cls.wire = Wire().open()
            cls.addClassCleanup(cls.wire.close)
            cls.wire.must("ip", "-n", cls.wire.here, "link", "add", "hother0", "type", "veth", "peer", "name", "hother1")
            cls.wire.must("ip", "-n", cls.wire.here, "addr", "add", OTHER + "/24", "brd", "+", "dev", "hother0")
            for end in ("hother0", "hother1"):
                cls.wire.must("ip", "-n", cls.wire.here, "link", "set", end, "up")
            cls.wire.must("ip", "-n", cls.wire.there, "route", "add", OTHER, "via", CAMERA)
        except NotHere as error:
            raise unittest.SkipTest(str(error))
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        for interface in ("127.0.0.1", "hother0"):
            emulator = Emulator(HILCAM, interface, cls.folder.name, namespace=cls.wire.here)
            cls.addClassCleanup(emulator.kill)

    @staticmethod
    def run_at(end, code, **values):
        result = end(sys.executable, "-c", code.format(**values), cwd=pathlib.Path(__file__).parent)
        if result.returncode != 0:
            raise RuntimeError(result.stderr)
        return result.stdout.strip()

    def test_a_broadcast_from_the_wire_orders_no_loopback_camera_about(self):
        # The MAC address of a loopback camera is known beforehand: it is made from the IP address.
        for end, source, address in ((self.wire.at_client, CLIENT, "127.0.0.1"), (self.wire.at_camera, "127.0.0.1", "127.0.0.9")):
            self.run_at(end, FORCE_IP, source=source, mac="02007f000001", ip="127.0.0.9")
            self.assertIn(address, self.run_at(self.wire.at_camera, FOUND, source="127.0.0.1"))
        # Back, with the MAC address that it has kept.
        self.run_at(self.wire.at_camera, FORCE_IP, source="127.0.0.1", mac="02007f000001", ip="127.0.0.1")
        self.assertEqual(self.run_at(self.wire.at_camera, FOUND, source="127.0.0.1"), "['127.0.0.1']")

    def test_a_camera_is_found_on_its_own_network_alone(self):
        self.assertEqual(self.run_at(self.wire.at_camera, FOUND, source=OTHER), str([OTHER]))
        self.assertEqual(self.run_at(self.wire.at_client, FOUND, source=CLIENT), "[]")

    def test_a_datagram_that_is_routed_in_from_another_network_is_not_answered(self):
        self.assertEqual(self.run_at(self.wire.at_client, ANSWERS, camera=OTHER), "False")
        self.assertEqual(self.run_at(self.wire.at_camera, ANSWERS, camera=OTHER), "True")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
