#!/usr/bin/python3
"""Lines on pins and a pulse per second, of the kernel module tests/devices/pins. Runs as root in the guest of tools/vm."""
import os
import pathlib
import signal
import socket
import struct
import subprocess
import tempfile
import time
import unittest

HILCAM = pathlib.Path(os.environ["HILCAM"])
PINS = pathlib.Path(os.environ["PINS"])  # hilcam_pins.ko
DEVICE = pathlib.Path("/sys/devices/platform/hilcam-pins")
CAMERA = pathlib.Path(__file__).resolve().parent / "camera.yaml"
EDGE = struct.Struct(">4s4B2HIq")
MS = 1_000_000


def run(*command):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=300)
    return result.returncode, result.stdout + result.stderr


def wait_until(condition, seconds=30, what="what is waited for"):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"{what} did not come within {seconds} s")
        time.sleep(0.005)


class Chip:
    """Pins that the test pulls and reads from the other side."""

    def __init__(self):
        status, text = run("insmod", PINS)
        assert status == 0, text
        self.device = f"/dev/{next(DEVICE.glob('gpiochip*')).name}"
        wait_until(lambda: os.path.exists(self.device), 10, self.device)

    def set(self, pin, level):
        (DEVICE / "pull").write_text(f"{pin} {level}")

    def get(self, pin):
        return int((DEVICE / "levels").read_text()) >> pin & 1


def setUpModule():
    global CHIP
    CHIP = Chip()


class Bench:
    """hilcam with lines; edges of its outputs come by UDP as well."""

    def __init__(self, lines, exposure_ms=100):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(60)
        self.folder = tempfile.TemporaryDirectory(dir="/dev/shm")
        scenario = pathlib.Path(self.folder.name, "scenario.yaml")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            port = other.getsockname()[1]
        udp = f'  udp: {{port: {port}, send_to: ["127.0.0.1:{self.socket.getsockname()[1]}"]}}\n'
        text = CAMERA.read_text().replace("exposure_ms: 2", f"exposure_ms: {exposure_ms}")
        scenario.write_text(text + "mode: triggered\nlines:\n" + udp + lines +
                            f"outputs: {{files: {{folder: {self.folder.name}/frames}}}}\n")
        self.log = pathlib.Path(self.folder.name, "log")
        self.command = [str(HILCAM), "run", str(scenario)]

    def __enter__(self):
        with self.log.open("w") as log:
            self.process = subprocess.Popen(self.command, stderr=log)
        wait_until(lambda: "running" in self.text() or self.process.poll() is not None, 300, "the emulator")
        assert self.process.poll() is None, self.text()
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=120)
        self.socket.close()

    def text(self):
        return self.log.read_text()

    def edge(self):
        """The outputs' next: (line, level, nominal ns)."""
        _, _, line, level, clock, _, _, _, at_ns = EDGE.unpack(self.socket.recv(64))
        assert clock == 1
        return line, level, at_ns


class Pins(unittest.TestCase):
    def setUp(self):
        for pin in range(8):
            if pin != 5:
                CHIP.set(pin, 0)

    def test_an_edge_of_a_pin_begins_an_exposure_that_another_pin_shows(self):
        lines = (f"  inputs: [{{line: 0, gpio: {CHIP.device}, pin: 3}}]\n"
                 f"  outputs: [{{line: 1, source: exposure_active, gpio: {CHIP.device}, pin: 5}}]\n")
        with Bench(lines, 400) as bench:
            self.assertEqual(CHIP.get(5), 0)
            for _ in range(3):
                before_ns = time.monotonic_ns()
                CHIP.set(3, 1)
                after_ns = time.monotonic_ns()
                line, level, begin_ns = bench.edge()
                self.assertEqual((line, level), (1, 1))
                # The kernel's own time of the edge.
                self.assertTrue(before_ns <= begin_ns <= after_ns, (begin_ns - before_ns, after_ns - before_ns))
                self.assertEqual(CHIP.get(5), 1)
                line, level, end_ns = bench.edge()
                self.assertEqual((line, level, end_ns - begin_ns), (1, 0, 400 * MS))
                self.assertEqual(CHIP.get(5), 0)
                CHIP.set(3, 0)
                time.sleep(0.2)

    def test_the_width_of_a_pulse_is_the_exposure(self):
        lines = (f"  inputs: [{{line: 2, gpio: {CHIP.device}, pin: 4}}]\n"
                 f"  outputs: [{{line: 1, source: exposure_active, inverted: true, gpio: {CHIP.device}, pin: 5}}]\n"
                 "  trigger: {line: 2, exposure: trigger_width}\n")
        with Bench(lines) as bench:
            wait_until(lambda: CHIP.get(5) == 1, 10, "the inverted output's level at rest")
            CHIP.set(4, 1)
            self.assertEqual(bench.edge()[:2], (1, 0))
            self.assertEqual(CHIP.get(5), 0)
            time.sleep(0.25)
            CHIP.set(4, 0)
            line, level, _ = bench.edge()
            self.assertEqual((line, level, CHIP.get(5)), (1, 1, 1))

    def test_a_pin_that_another_has_is_named(self):
        lines = f"  inputs: [{{line: 0, gpio: {CHIP.device}, pin: 3}}]\n"
        with Bench(lines):
            second = Bench(lines)
            status, text = run("env", *second.command)
            self.assertNotEqual(status, 0)
            self.assertIn(f"{CHIP.device} pin 3: Device or resource busy; another program has the pin", text)

    def test_a_pin_that_the_chip_has_not_is_named(self):
        bench = Bench(f"  inputs: [{{line: 0, gpio: {CHIP.device}, pin: 99}}]\n")
        status, text = run(*bench.command)
        self.assertNotEqual(status, 0)
        self.assertIn(f"{CHIP.device} pin 99: Invalid argument; the chip has fewer pins", text)


    def test_doctor_says_which_pins_and_pulses_are_there(self):
        bench = Bench(f"  inputs: [{{line: 0, gpio: {CHIP.device}, pin: 3}}, {{line: 2, gpio: {CHIP.device}, pin: 99}},\n"
                      "           {line: 4, pps: /dev/pps7}]\n")
        status, text = run(HILCAM, "doctor", bench.command[-1])
        self.assertEqual(status, 1, text)
        self.assertRegex(text, f"good +line +{CHIP.device} pin 3\n")
        self.assertRegex(text, f"problem +line +{CHIP.device} pin 99: Invalid argument; the chip has fewer pins")
        self.assertRegex(text, "problem +line +/dev/pps7: No such file or directory; ls /dev/pps.* shows what there is\n.*set lines.inputs.2")


class Pulses(unittest.TestCase):
    def test_a_pulse_per_second_triggers_each_second(self):
        wait_until(lambda: os.path.exists("/dev/pps0"), 10, "/dev/pps0")
        lines = ("  inputs: [{line: 4, pps: /dev/pps0}]\n  outputs: [{line: 1, source: exposure_active}]\n"
                 "  trigger: {line: 4}\n")
        with Bench(lines, 50) as bench:
            begins_ns = []
            while len(begins_ns) < 4:
                line, level, at_ns = bench.edge()
                if level:
                    begins_ns.append(at_ns)
        for before, after in zip(begins_ns, begins_ns[1:]):
            self.assertAlmostEqual((after - before) / 1e9, 1, delta=0.1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
