#!/usr/bin/python3
"""The camera in a network namespace of its own, Aravis in another, a veth pair between them that loses packets.

    netns_test.py HILCAM

Needs root (network namespaces, nftables); skips with a message otherwise.
"""
import re
import subprocess
import sys
import tempfile
import time
import unittest

from bench import PATIENT, Emulator, camera_test_figures, judge_acquisition, tool
from wire import CAMERA, NotHere, Wire

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


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
