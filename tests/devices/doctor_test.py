#!/usr/bin/python3
"""hilcam doctor on a machine whose devices come and go: what it says is so."""
import json
import os
import unittest

from bench import HILCAM, Loopback, SCENARIO, Emulator, run


def doctor(*settings):
    command = [HILCAM, "doctor", "--json"]
    if settings:
        command.append(SCENARIO)
        for setting in settings:
            command += ["--set", setting]
    status, text = run(*command)
    report = json.loads(text[text.index("{"):])
    return status, {finding["topic"]: finding for finding in report["findings"]}


class Doctor(unittest.TestCase):
    V4L2 = "outputs.v4l2.device=/dev/video0"

    def test_without_a_scenario_all_is_well(self):
        status, found = doctor()
        self.assertEqual(status, 0)
        self.assertIn("v4l2loopback", found)

    def test_the_module(self):
        status, found = doctor(self.V4L2)
        self.assertEqual(status, 1)
        self.assertEqual(found["v4l2loopback"]["level"], "problem")
        self.assertIn("installed, not loaded", found["v4l2loopback"]["found"])
        with Loopback():
            status, found = doctor(self.V4L2)
            self.assertEqual(status, 0, found)
            self.assertEqual(found["v4l2 device"]["level"], "good")
            status, found = doctor("outputs.v4l2.device=/dev/video5")
            self.assertEqual(status, 1)
            self.assertIn("video_nr=5 ", found["v4l2 device"]["advice"])
            with Emulator() as emulator:
                status, found = doctor(self.V4L2)
                self.assertEqual(status, 1)
                self.assertIn("another program feeds it", found["v4l2 device"]["found"])
                emulator.stop()
        with Loopback(max_buffers=2, exclusive_caps=0):
            status, found = doctor(self.V4L2)
            self.assertEqual(status, 0)

    def test_the_usb_controller(self):
        status, found = doctor("outputs.uvc.serial=1")
        self.assertEqual((status, found["usb device side"]["level"]), (1, "problem"))
        for module in ("libcomposite", "usbip-vudc"):
            run("modprobe", module)
        if not os.path.isdir("/sys/kernel/config/usb_gadget"):
            run("mount", "-t", "configfs", "none", "/sys/kernel/config")
        status, found = doctor("outputs.uvc.serial=1")
        self.assertEqual(status, 0, found)
        self.assertIn("usbip-vudc.0", found["usb device side"]["found"])

    def test_ports(self):
        import socket
        status, _ = doctor("commands.udp.port=15240", "outputs.gige.interface=127.0.24.1")
        self.assertEqual(status, 0)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as two:
            one.bind(("127.0.0.1", 15240))
            two.bind(("127.0.24.1", 3956))
            status, found = doctor("commands.udp.port=15240", "outputs.gige.interface=127.0.24.1")
            self.assertEqual(status, 1)
            self.assertIn("is taken", found["port"]["found"])
            self.assertIn("is taken", found["gige port"]["found"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
