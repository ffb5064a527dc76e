#!/usr/bin/python3
"""PTP between two kernels with clocks of their own: this machine and the guest of tools/vm, with a tap interface as the wire.

Not in the guest, but here: `tools/check-devices ptp`. Needs root (a network namespace, a tap interface), linuxptp, and VM, the folder of
tools/vm/prepare. The guest's processor is emulated, and its threads wait for this machine's: where that is busy, the guest's time
stamps are late by milliseconds. So figures are printed, and judged by a wide bound; ptp_test.py of tests/protocol/gige has the narrow
ones.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
sys.path.insert(0, str(SOURCE / "tests/protocol/gige"))
HILCAM, VM = os.environ["HILCAM"], os.environ["VM"]
CAMERA, HOST, SPACE, TAP = "10.23.0.1", "10.23.0.2", f"hilcam-vm-{os.getpid()}", "hcvm0"
BOUND_NS = 10_000_000

from bench import die_with_parent, percentile  # noqa: E402


def must(*words):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, f"{words}: {result.stdout}{result.stderr}"


class Guest:
    """ptp_guest.py in the guest, with what it has said so far."""

    def __init__(self, folder, *words, seconds):
        self.log = pathlib.Path(folder, f"guest_{words[0]}.log")
        with self.log.open("w") as log:
            self.process = subprocess.Popen(
                ["ip", "netns", "exec", SPACE, str(SOURCE / "tools/vm/boot"), "-k", VM, "-n", TAP, "-w", folder, "-t", str(seconds), "--",
                 "python3", str(HERE / "ptp_guest.py"), *map(str, words)], stdout=log, stderr=log, preexec_fn=die_with_parent)

    def wait_for(self, text, seconds):
        end = time.monotonic() + seconds
        while text not in self.log.read_text():
            assert self.process.poll() is None and time.monotonic() < end, self.log.read_text()
            time.sleep(0.2)

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
        self.process.wait()


class TwoKernels(unittest.TestCase):
    def setUp(self):
        if os.geteuid() != 0:
            self.skipTest("needs root: a network namespace and a tap interface")
        if shutil.which("ptp4l") is None:
            self.skipTest("ptp4l is not installed (Debian package linuxptp)")
        must("ip", "netns", "add", SPACE)
        self.addCleanup(must, "ip", "netns", "del", SPACE)
        must("ip", "-n", SPACE, "tuntap", "add", TAP, "mode", "tap")
        must("ip", "-n", SPACE, "link", "set", TAP, "up")
        must("ip", "-n", SPACE, "link", "set", "lo", "up")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def address(self, address):
        must("ip", "-n", SPACE, "addr", "add", address + "/24", "brd", "+", "dev", TAP)

    def start(self, *words, log):
        file = open(pathlib.Path(self.folder, log), "w")
        self.addCleanup(file.close)
        process = subprocess.Popen(["ip", "netns", "exec", SPACE, *map(str, words)], stdout=file, stderr=file, preexec_fn=die_with_parent)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def guest(self, *words, seconds):
        guest = Guest(self.folder, *words, seconds=seconds)
        self.addCleanup(guest.end)
        return guest

    def judge(self, *words):
        result = subprocess.run(["ip", "netns", "exec", SPACE, sys.executable, str(SOURCE / "tests/protocol/gige/ptp_judge.py"), CAMERA,
                                 HOST, *map(str, words)], capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def logs(self):
        return "\n".join(f"--- {file.name}\n{file.read_text()[-3000:]}" for file in pathlib.Path(self.folder).glob("*log"))

    def say(self, name, samples, shift_ns=0):
        """The figures; the median. A reading is right to its half width."""
        errors = sorted(abs(offset_ns - shift_ns) for _, offset_ns, _ in samples)
        halves = sorted(half_ns for _, _, half_ns in samples)
        print(f"\nptp: {name}: {len(errors)} readings, |offset| p50 {percentile(errors, 0.5) / 1e3:.0f} us, p99 "
              f"{percentile(errors, 0.99) / 1e3:.0f} us, half width p50 {percentile(halves, 0.5) / 1e3:.0f} us", flush=True)
        return percentile(errors, 0.5)

    def test_the_camera_and_the_guests_kernel_follow_one_master(self):
        """The camera by the guest's kernel clock, which ptp4l steers, and by the master's clock, this machine's, across the wire."""
        self.address(HOST)
        config = pathlib.Path(self.folder, "master.cfg")
        config.write_text("[global]\ntime_stamping software\nmasterOnly 1\nlogAnnounceInterval -1\nlogSyncInterval -1\n"
                          f"logMinDelayReqInterval -1\nuds_address {self.folder}/ptp4l\n")
        self.start("ptp4l", "-f", config, "-i", TAP, "-m", log="master.log")
        guest = self.guest("slave", HILCAM, self.folder, 90, 60, seconds=500)
        guest.wait_for("guest: judged", 400)
        judged = self.judge("--until", "Slave", "--seconds", 20)
        samples = json.loads(pathlib.Path(self.folder, "slave.json").read_text())
        self.assertGreater(len(samples), 20, self.logs())
        after = [s for s in samples if s[0] > samples[-1][0] - 40]
        for name in ("slave_ptp4l.log", "slave_hilcam.log", "master.log"):
            shutil.copy(pathlib.Path(self.folder, name), pathlib.Path(VM, "logs", "ptp_" + name))
        kernel_ns = self.say("camera minus the guest's kernel clock, both slaves, last 40 s", after)
        master_ns = self.say("camera minus the master's clock, across the wire", judged["samples"])
        print("\nptp: " + json.dumps(judged["features"]))
        self.assertEqual(judged["features"]["PtpParentClockID"], judged["features"]["PtpGrandmasterClockID"], self.logs())
        self.assertLess(kernel_ns, BOUND_NS, self.logs())
        self.assertLess(master_ns, BOUND_NS, self.logs())

    def test_the_step_of_a_masters_kernel_clock_is_followed(self):
        """The guest's kernel clock is the master's and is set forward by a second; the camera is here, 1 s off and 50 ppm fast."""
        self.address(CAMERA)
        self.address(HOST)
        sets = (f"outputs.gige.interface={CAMERA}", "camera.frame_rate_hz=2",
                "outputs.gige.clock={source: ptp, start: machine, offset_s: 1, ppm: 50, enable_ptp: true}")
        camera = self.start(HILCAM, "run", HERE / "camera.yaml", *(word for s in sets for word in ("--set", s)), log="camera.log")
        guest = self.guest("master", self.folder, 60, 60, seconds=300)
        guest.wait_for("guest: master started", 200)
        before = self.judge("--until", "Slave", "--settle", 15, "--seconds", 10)
        guest.wait_for("stepped by 1 s", 120)
        steps = before["features"]["PtpSteps"]
        after = self.judge("--until-steps", steps + 1, "--until", "Slave", "--settle", 15, "--seconds", 10)
        self.assertIsNone(camera.poll(), self.logs())
        middle = [percentile(sorted(s[1] for s in judged["samples"]), 0.5) for judged in (before, after)]
        print(f"\nptp: the master's clock was set forward by 1 s: the camera's moved by {(middle[1] - middle[0]) / 1e3:.0f} us, steps "
              f"{steps} to {after['features']['PtpSteps']}, Slave {after['took_s']:.1f} s after it was said")
        self.assertAlmostEqual(middle[1] - middle[0], 1e9, delta=BOUND_NS)


if __name__ == "__main__":
    unittest.main(verbosity=2)
