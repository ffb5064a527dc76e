#!/usr/bin/python3
"""hilcam as a USB camera: its UVC gadget on usbip-vudc, plugged into this same kernel through vhci-hcd, where uvcvideo finds
it. Control requests pass these virtual controllers, isochronous pictures do not. Runs as root in the guest of tools/vm."""
import os
import pathlib
import re
import subprocess
import time
import unittest

import bench
from bench import Emulator, run

CONTROLLER = "usbip-vudc.0"
GADGET = pathlib.Path("/sys/kernel/config/usb_gadget/hilcam")


def setUpModule():
    for module in ("libcomposite", "usb_f_uvc", "uvcvideo", "usbip-vudc", "vhci-hcd"):
        status, text = run("modprobe", module)
        assert status == 0, text
    if not os.path.isdir("/sys/kernel/config/usb_gadget"):
        run("mount", "-t", "configfs", "none", "/sys/kernel/config")
    run("usbipd", "--device", "-D")


def plug():
    """Attaches the gadget to this kernel's own USB; gives the video device that uvcvideo makes of it."""
    bench.wait_until(lambda: (GADGET / "UDC").exists() and (GADGET / "UDC").read_text().strip(), 20, "the gadget")
    time.sleep(0.5)  # usbipd has to see it
    bench.wait_until(lambda: run("usbip", "attach", "-r", "127.0.0.1", "-d", CONTROLLER)[0] == 0, 20, "usbip attach")

    def found():
        for node in sorted(pathlib.Path("/sys/class/video4linux").iterdir()):
            if "vhci" in str(node.resolve()) and (node / "index").read_text().strip() == "0":
                return f"/dev/{node.name}"
        return None

    bench.wait_until(found, 40, "uvcvideo's device")
    return found()


def unplug():
    run("usbip", "detach", "-p", "0")


class UsbCamera(unittest.TestCase):
    def emulator(self, *settings):
        return Emulator(f"outputs.uvc.udc={CONTROLLER}", "outputs.uvc.serial=HC42", "outputs.uvc.product=test camera", *settings,
                        device=None)

    def tearDown(self):
        unplug()

    def mean_dn(self, emulator):
        """Of a frame taken from now on."""
        last = len(list(emulator.frames.iterdir()))
        bench.wait_until(lambda: len(list(emulator.frames.iterdir())) > last + 4, 30, "frames")
        time.sleep(0.3)  # the newest may still be written
        numbers = emulator.numbers()
        return float(numbers[sorted(numbers)[-2]].mean())

    def test_it_enumerates_with_the_right_descriptors(self):
        with self.emulator() as emulator:
            device = plug()
            text = run("lsusb", "-v", "-d", "1209:0001")[1]
            for expected in (r"idVendor +0x1209", r"iProduct +\d+ test camera", r"iSerial +\d+ HC42",
                             r"bDeviceClass +239", r"bFunctionClass +14", r"bInterfaceSubClass +1\b",
                             r"bInterfaceSubClass +2\b", r"wWidth +160", r"wHeight +120",
                             r"dwMaxVideoFrameBufferSize +38400", r"dwDefaultFrameInterval +1250000",
                             r"guidFormat +\{32595559-0000-0010-8000-00aa00389b71\}", r"Auto-Exposure Mode", r"Brightness"):
                self.assertRegex(text, expected)
            formats = run("v4l2-ctl", "-d", device, "--list-formats-ext")[1]
            self.assertIn("'YUYV'", formats)
            self.assertIn("160x120", formats)
            rates = [float(rate) for rate in re.findall(r"\(([\d.]+) fps\)", formats)]
            self.assertIn(8.0, rates)
            print(text, formats, sep="\n")
            emulator.stop()
        self.assertFalse(GADGET.exists())

    def test_controls_reach_the_camera(self):
        with self.emulator() as emulator:
            device = plug()
            listed = run("v4l2-ctl", "-d", device, "-l")[1]
            print(listed)
            self.assertRegex(listed, r"brightness .*min=0 .*step=1 default=400 value=400")
            self.assertAlmostEqual(self.mean_dn(emulator), 400, delta=12)
            for wanted in (900, 250):
                status, text = run("v4l2-ctl", "-d", device, "-c", f"brightness={wanted}")
                self.assertEqual(status, 0, text)
                self.assertIn(f"brightness: {wanted}", run("v4l2-ctl", "-d", device, "-C", "brightness")[1])
                self.assertAlmostEqual(self.mean_dn(emulator), wanted, delta=12)
            if "exposure_time_absolute" in listed:  # kernels from 6.4 on
                self.assertEqual(run("v4l2-ctl", "-d", device, "-c", "exposure_time_absolute=50")[0], 0)
            figures = emulator.stop()["outputs"][0]
            self.assertGreaterEqual(figures["settings_changed"], 2)

    def test_a_host_that_streams_does_not_harm_it(self):
        with self.emulator() as emulator:
            device = plug()
            subprocess.run(["timeout", "5", "v4l2-ctl", "-d", device, "--stream-mmap", "--stream-count=2", "--stream-to=/dev/null"],
                           capture_output=True)
            before = self.mean_dn(emulator)
            self.assertAlmostEqual(before, 400, delta=12)
            unplug()
            time.sleep(1)
            self.assertAlmostEqual(self.mean_dn(emulator), 400, delta=12)
            emulator.stop()

    def test_what_a_killed_run_left_is_taken_over(self):
        with self.emulator() as first:
            bench.wait_until(lambda: (GADGET / "UDC").exists() and (GADGET / "UDC").read_text().strip(), 20, "the gadget")
            first.process.kill()
            first.process.wait()
        self.assertTrue(GADGET.exists())
        with self.emulator() as second:
            plug()
            second.stop()
        self.assertFalse(GADGET.exists())

    def test_a_controller_that_is_not_there_is_named(self):
        status, text = run(*Emulator("outputs.uvc.udc=dwc9", device=None).command, "--frames", "1")
        self.assertEqual(status, 1)
        self.assertRegex(text, "outputs.uvc.udc: found 'dwc9'; this machine has: .*usbip-vudc.0")


if __name__ == "__main__":
    unittest.main(verbosity=2)
