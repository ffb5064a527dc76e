#!/usr/bin/python3
"""Runs that fail when they are late: loop.fail_on, what the report says of latency, and its picture.

    bounds_test.py HILCAM SOURCE_DIR

No test depends on the machine's speed: bounds are such that any run breaks them, or none does.
"""
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
sys.path[:0] = [str(SOURCE / "tools/client"), str(SOURCE / "tests/protocol/gige")]
import gvcp_client as g  # noqa: E402
from hilcam_client import Client, Expose, Ping, Pose  # noqa: E402
from pages import has_matplotlib  # noqa: E402

SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
SMALL = ("camera.width_px=64", "camera.height_px=64", "camera.focal_length_mm=0.7", "objects.0.generate.triangles=5000")
STEPS = ("first_packet", "last_packet", "command_to_exposure_mid", "exposure_mid_to_first_packet", "first_to_last_packet",
         "exposure_mid_to_last_packet")
NEVER = 1e9  # ms or a number that no run reaches
ALWAYS = 0.001  # ms that every frame takes


def sets(*values):
    return [word for value in values for word in ("--set", value)]


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Poses(threading.Thread):
    """A pose each 5 ms until stop()."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port, self.stopping = port, threading.Event()

    def run(self):
        with Client(f"127.0.0.1:{self.port}") as client:
            while not self.stopping.wait(0.005):
                client.post(Pose(position_m=(22, 15, 7), attitude_wxyz=(1, 0, 0, 0)))
                while client.receive() is not None:
                    pass

    def stop(self):
        self.stopping.set()
        self.join()


class Case(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_with(self, *values, frames=60, arguments=(), scenario=SCENARIO, poses=True, beside=None):
        """A run of so many frames with the output shm; gives its status, report and log. beside: called with the
        port for commands while it runs."""
        port, report = free_port(), self.folder / "report.json"
        command = [HILCAM, "run", str(scenario), "--frames", str(frames), "--report", str(report),
                   *sets(*SMALL, f"commands.udp.port={port}", f"outputs.shm.name=hilcam-bounds-{os.getpid()}", *values),
                   *map(str, arguments)]
        sender = Poses(port) if poses else None
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
            try:
                if sender:
                    sender.start()
                if beside:
                    beside(port)
                log = process.communicate(timeout=120)[1]
            finally:
                process.kill()
                if sender:
                    sender.stop()
        return process.returncode, json.loads(report.read_text()) if report.exists() else None, log

    def assert_broken(self, result, key, allowed, unit):
        """The run came to its end, failed, and said in log and report which bound it was."""
        status, report, log = result
        self.assertEqual(status, 1, log)
        self.assertEqual([broken["bound"] for broken in report["failed_on"]], [key], log)
        broken = report["failed_on"][0]
        self.assertEqual(broken["allowed"], allowed)
        self.assertGreater(broken["value"], allowed)
        self.assertIn(broken["text"], log)
        self.assertRegex(log, rf"loop\.fail_on\.{key}: [\w-]+: [\d.]+(e\+\d+)?{unit}, {allowed:g} allowed; first in frame \d+")
        return broken

    def assert_kept(self, result):
        status, report, log = result
        self.assertEqual(status, 0, log)
        self.assertEqual(report["failed_on"], [])
        self.assertNotIn("loop.fail_on", log)


class Latency(Case):
    def test_a_bound_that_every_frame_breaks(self):
        result = self.run_with(f"loop.fail_on.latency_ms={ALWAYS}")
        broken = self.assert_broken(result, "latency_ms", ALWAYS, " ms")
        report = result[1]
        self.assertEqual(report["frames"], 60, "the run comes to its end all the same")
        self.assertGreaterEqual(broken["first_frame"], 11)
        self.assertGreaterEqual(broken["value"] + 1e-4, max(f["latency_ms"] for f in report["latest_frames"]["from_command"]
                                                           if f["frame"] >= 11))
        self.assertEqual(report["fail_on"], {"latency_ms": ALWAYS, "from_frame": 11})

    def test_the_other_bounds_on_time(self):
        for key in ("latency_p999_ms", "exposure_latency_ms"):
            self.assert_broken(self.run_with(f"loop.fail_on.{key}={ALWAYS}"), key, ALWAYS, " ms")

    def test_bounds_that_no_frame_breaks(self):
        bounds = ("latency_ms", "latency_p999_ms", "exposure_latency_ms", "missed_exposures", "dropped_packets", "dropped_frames")
        self.assert_kept(self.run_with(*(f"loop.fail_on.{key}={NEVER}" for key in bounds)))

    def test_frames_before_the_first_that_counts_break_nothing(self):
        status, report, log = self.run_with(f"loop.fail_on={{exposure_latency_ms: {ALWAYS}, from_frame: 1000000}}")
        self.assertEqual(status, 1, log)  # and what nothing was measured for is not kept
        self.assertIn("loop.fail_on.exposure_latency_ms: test-camera: nothing was measured", log)
        self.assertIsNone(report["failed_on"][0]["value"])

    def test_a_run_without_commands_keeps_no_bound_on_their_latency(self):
        status, report, log = self.run_with(f"loop.fail_on.latency_ms={NEVER}", poses=False)
        self.assertEqual(status, 1, log)
        self.assertIn("loop.fail_on.latency_ms: test-camera: nothing was measured", log)
        self.assertEqual(report["latency_ms"]["last_packet"]["count"], 0)
        self.assertEqual(report["latest_frames"]["from_command"], [])

    def test_a_run_that_a_signal_ends_is_judged_as_well(self):
        port, report = free_port(), self.folder / "report.json"
        with subprocess.Popen([HILCAM, "run", str(SCENARIO), "--report", str(report),
                               *sets(*SMALL, f"commands.udp.port={port}", f"outputs.shm.name=hilcam-bounds-{os.getpid()}",
                                     f"loop.fail_on.exposure_latency_ms={ALWAYS}")], stderr=subprocess.PIPE, text=True) as process:
            with Client(f"127.0.0.1:{port}", timeout_s=0.5) as client:
                for _ in range(200):  # until it runs
                    client.post(Pose(position_m=(22, 15, 7), attitude_wxyz=(1, 0, 0, 0)))
                    if client.receive(0.1) is not None:
                        break
            time.sleep(3)
            process.send_signal(signal.SIGINT)
            log = process.communicate(timeout=60)[1]
        self.assert_broken((process.returncode, json.loads(report.read_text()), log), "exposure_latency_ms", ALWAYS, " ms")

    def test_each_camera_is_judged(self):
        second = ("{name: second, width_px: 8, height_px: 8, pitch_um: 5, focal_length_mm: 1, f_number: 4, quantum_efficiency: 0.5,"
                  " full_well_e: 1e4, gain_dn_e: 0.2, bits: 12, frame_rate_hz: 30, exposure_ms: 0.1}")
        status, report, log = self.run_with(
            f"loop.fail_on.exposure_latency_ms={ALWAYS}",
            f"more_cameras=[{{camera: {second}, outputs: {{shm: {{name: hilcam-bounds-{os.getpid()}-2}}}}}}]")
        self.assertEqual(status, 1, log)
        self.assertEqual([broken["camera"] for broken in report["failed_on"]], ["test-camera", "second"])


class Report(Case):
    def test_each_step_has_percentiles_and_a_histogram(self):
        _, report, log = self.run_with()
        for step in STEPS:
            told = report["latency_ms"][step]
            values = [told[which] for which in ("p50", "p99", "p99.9", "max")]
            self.assertEqual(values, sorted(values), step)
            self.assertGreater(told["count"], 0, step + log)
            self.assertEqual(sum(count for _, count in told["histogram"]), told["count"], step)
            edges = [from_ms for from_ms, _ in told["histogram"]]
            for a, b in zip(edges, edges[1:]):
                self.assertAlmostEqual(b / a, 2 ** 0.25, places=9)
            self.assertLessEqual(edges[-1], max(told["max"], 1.001e-3) * 1.0001)
            self.assertGreaterEqual(edges[-1] * 2 ** 0.25 * 1.0001, told["max"])
        self.assertEqual(report["latency_ms"]["exposure_mid_to_last_packet"]["count"], report["frames"])
        self.assertEqual(report["latency_ms"]["last_packet"]["count"], report["latency_ms"]["command_to_exposure_mid"]["count"])
        self.assertEqual(report["fail_on"], {})
        self.assertEqual(report["failed_on"], [])

    def test_the_latest_frames_and_what_made_them_late(self):
        _, report, log = self.run_with()
        for which, step in (("from_command", "last_packet"), ("from_exposure_mid", "exposure_mid_to_last_packet")):
            latest = report["latest_frames"][which]
            self.assertEqual(len(latest), 10, log)
            latencies = [frame["latency_ms"] for frame in latest]
            self.assertEqual(latencies, sorted(latencies, reverse=True))
            self.assertAlmostEqual(latencies[0], report["latency_ms"][step]["max"], delta=2e-4)
            self.assertEqual(len({frame["frame"] for frame in latest}), 10)
        for frame in report["latest_frames"]["from_command"]:
            steps = [frame[f"{name}_ms"] for name in STEPS[2:5]]
            self.assertAlmostEqual(sum(steps), frame["latency_ms"], delta=3e-4)
        by_id = sorted((frame["frame"], frame["exposure_mid_tai_ns"]) for frame in report["latest_frames"]["from_exposure_mid"])
        for (a, at), (b, bt) in zip(by_id, by_id[1:]):  # on the raster of 30 Hz
            self.assertAlmostEqual((bt - at) * 1e-9, (b - a) / 30, delta=1e-6)

    # No machine makes 5000 of these a second.
    FAST = ("camera.frame_rate_range_hz=[1, 5000]", "camera.frame_rate_hz=5000", "camera.exposure_ms=0.05")

    def test_missed_exposures_are_named(self):
        broken = self.assert_broken(result := self.run_with(*self.FAST, "loop.fail_on.missed_exposures=0", frames=100),
                                    "missed_exposures", 0, " exposures")
        report = result[1]
        missed = report["missed_exposures"]
        self.assertEqual(missed["exposures"], report["deadline_misses"])
        self.assertEqual(missed["gaps_left_out"], 0)
        self.assertEqual(sum(gap["exposures"] for gap in missed["gaps"]), missed["exposures"])
        counted = sum(max(0, gap["frame"] + gap["exposures"] - max(11, gap["frame"])) for gap in missed["gaps"])
        self.assertEqual(broken["value"], counted)
        self.assertTrue(any(gap["frame"] <= broken["first_frame"] < gap["frame"] + gap["exposures"] for gap in missed["gaps"]))
        ends = [gap["frame"] + gap["exposures"] for gap in missed["gaps"]]
        self.assertTrue(all(gap["frame"] > end for gap, end in zip(missed["gaps"][1:], ends)), "a frame is between two gaps")
        self.assert_kept(self.run_with(*self.FAST, f"loop.fail_on.missed_exposures={NEVER}", frames=100))

    def test_the_list_of_missed_exposures_is_bounded(self):
        _, report, _ = self.run_with(*self.FAST, frames=400)
        missed = report["missed_exposures"]
        self.assertLessEqual(len(missed["gaps"]), 100)
        if missed["gaps_left_out"]:
            self.assertEqual(len(missed["gaps"]), 100)
        self.assertEqual(missed["exposures"], report["deadline_misses"])


class Losses(Case):
    ADDRESS, CLIENT = "127.0.77.21", "127.0.77.121"

    def stream(self, receiver, port):
        """Has the camera send to an address."""
        with g.GvcpClient(self.ADDRESS, self.CLIENT, tries=1) as client:
            until = time.monotonic() + 60
            while True:
                try:
                    client.control()
                    break
                except g.NoAnswer:
                    if time.monotonic() > until:
                        raise
            client.write_register(g.HEARTBEAT, 60_000)
            from genicam_client import Features
            features = Features(client)
            client.write_registers((g.SCDA, g.ip_number(receiver)), (g.SCP, port))
            features.execute("AcquisitionStart")
            time.sleep(2)

    def run_gige(self, receiver, *values):
        return self.run_with(f"outputs.gige={{interface: {self.ADDRESS}, serial: BOUNDS}}", *values, frames=150, poses=False,
                             beside=lambda _: self.stream(receiver, 50_077))

    def test_packets_that_the_kernel_refuses(self):
        # From an address of the loopback interface there is no way to another network.
        broken = self.assert_broken(result := self.run_gige("198.51.100.1", "loop.fail_on.dropped_packets=0"),
                                    "dropped_packets", 0, " packets")
        gige = next(output for output in result[1]["outputs"] if output["name"].startswith("gige"))
        self.assertEqual(broken["value"], gige["packets_not_taken_by_kernel"])
        self.assertGreater(broken["first_frame"], 0)

    def test_packets_that_a_fault_takes_away_do_not_count(self):
        result = self.run_gige("127.0.77.122", "loop.fail_on={dropped_packets: 0, dropped_frames: 1e9}",
                               "faults=[{kind: packet_drop, rate: 0.5}]")
        self.assert_kept(result)
        gige = next(output for output in result[1]["outputs"] if output["name"].startswith("gige"))
        self.assertGreater(gige["packets_dropped_by_faults"], 0)

    def test_frames_that_a_fault_takes_away_do_not_count(self):
        result = self.run_gige("127.0.77.122", "loop.fail_on.dropped_frames=0", "faults=[{kind: frame_drop, rate: 1}]")
        self.assert_kept(result)
        gige = next(output for output in result[1]["outputs"] if output["name"].startswith("gige"))
        self.assertGreater(gige["dropped"], 0)

    def test_frames_that_an_output_loses(self):
        frames = self.folder / "frames"

        def fill_the_disk(port):
            with Client(f"127.0.0.1:{port}", timeout_s=1) as client:
                client.send(Ping(), tries=60)
                for number in range(3, 7):  # as if the disk were full from the third on
                    (frames / f"frame_{number:08}.png").symlink_to("/dev/full")
                client.send(Expose(frames=6), timeout_s=60)
        # In lockstep no frame comes before it is asked for.
        result = self.run_with("mode=lockstep", "loop.fail_on={dropped_frames: 3, dropped_packets: 0}",
                               f"outputs.files.folder={frames}", frames=6, poses=False, beside=fill_the_disk)
        broken = self.assert_broken(result, "dropped_frames", 3, " frames")
        self.assertEqual((broken["value"], broken["first_frame"]), (4, 3))


class Refusals(Case):
    def refused(self, needle, *values, arguments=()):
        result = subprocess.run([HILCAM, "run", str(SCENARIO), "--frames", "1", *sets(*values), *map(str, arguments)],
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn(needle, result.stderr)

    def test_in_lockstep_and_without_a_timed_output(self):
        self.refused("loop.fail_on.latency_ms: found 50; accepted with 'mode: lockstep': none", "mode=lockstep",
                     "loop.fail_on.latency_ms=50")
        self.refused("loop.fail_on.exposure_latency_ms: found 50; accepted: none without outputs.gige",
                     "loop.fail_on.exposure_latency_ms=50")
        self.refused("loop.fail_on.latency: unknown key", "loop.fail_on.latency=50")
        self.refused("loop.fail_on.latency_ms", "loop.fail_on.latency_ms=-1")

    def test_a_replay_is_not_timed_and_may_have_other_bounds(self):
        recording = self.folder / "run.rec"
        self.assert_kept(self.run_with(f"loop.fail_on.missed_exposures={NEVER}", frames=15, arguments=("--record", recording),
                                       poses=False))
        fast = {"frames": 15, "arguments": ("--replay", recording, "--fast"), "poses": False}
        status, _, log = self.run_with(f"loop.fail_on.missed_exposures={NEVER}", **fast)
        self.assertEqual(status, 2, log)
        self.assertIn("accepted: none with --replay", log)
        self.assert_kept(self.run_with("loop.fail_on.dropped_frames=0", **fast))


class Soaks(Case):
    def soak(self, *values, arguments=()):
        return subprocess.run([HILCAM, "bench", str(SCENARIO), "--soak", "1", "--slice-s", "0.5", "--out",
                               str(self.folder / "soak"), *arguments, *sets(*SMALL, *values)], capture_output=True, text=True, timeout=120)

    def test_a_soak_is_judged(self):
        fast = self.soak(*Report.FAST, "loop.fail_on.missed_exposures=0")
        self.assertEqual(fast.returncode, 1, fast.stderr)
        self.assertIn("loop.fail_on.missed_exposures: test-camera: ", fast.stderr)
        report = json.loads((self.folder / "soak/soak.json").read_text())
        self.assertEqual(report["failed_on"][0]["bound"], "missed_exposures")
        self.assertTrue((self.folder / "soak/index.html").exists())
        kept = self.soak(f"loop.fail_on.missed_exposures={NEVER}")
        self.assertEqual(kept.returncode, 0, kept.stderr)
        refused = self.soak(f"loop.fail_on.latency_ms={NEVER}")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("loop.fail_on.latency_ms: found 1000000000; accepted: none without outputs.gige", refused.stderr)


class Picture(Case):
    TOOL = SOURCE / "tools/hilcam-plot-latency"

    def plot(self, *arguments, **environment):
        return subprocess.run([str(self.TOOL), *map(str, arguments)], capture_output=True, text=True, timeout=120,
                              env={**os.environ, **environment})

    def test_a_report_becomes_a_picture(self):
        if not has_matplotlib():
            self.skipTest("Matplotlib is missing: no picture to look at")
        self.run_with(f"loop.fail_on={{latency_ms: {NEVER}, exposure_latency_ms: {NEVER}}}")
        report = self.folder / "report.json"
        for ending, magic in (("png", b"\x89PNG"), ("svg", b"<?xml")):
            out = self.folder / f"latency.{ending}"
            result = self.plot(report, out)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual(out.read_bytes()[:len(magic)], magic)
        first = (self.folder / "latency.svg").read_text()
        self.plot(report, self.folder / "latency.svg")
        self.assertEqual((self.folder / "latency.svg").read_text(), first, "the same report makes the same file")
        # As a report of no frames, and as one of several cameras.
        told = json.loads(report.read_text())
        told["cameras"] = [{**told, "camera": "left"}, {**told, "camera": "right"}]
        for step in STEPS:
            told["cameras"][1]["latency_ms"] = {step: {"p50": 0, "p99": 0, "p99.9": 0, "max": 0, "count": 0, "histogram": []}
                                                for step in STEPS}
        report.write_text(json.dumps(told))
        result = self.plot(report, self.folder / "two.png")
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_what_is_no_report_is_told(self):
        missing = self.plot(self.folder / "none.json", self.folder / "x.png")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("none.json: No such file or directory; a report that `hilcam run --report` has written is expected",
                      missing.stderr)
        wrong = self.folder / "wrong.json"
        for text, needle in (("{", "is no JSON"), ("[]", "has no latency_ms"), ('{"latency_ms": {"last_packet": {"p50": 1}}}',
                                                                                "has no latency_ms with histograms")):
            wrong.write_text(text)
            result = self.plot(wrong, self.folder / "x.png")
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, re.escape(needle))

    def test_without_matplotlib_there_is_a_message(self):
        (self.folder / "hidden").mkdir()
        (self.folder / "hidden/matplotlib.py").write_text("raise ImportError('hidden')\n")
        empty = {"p50": 0, "p99": 0, "p99.9": 0, "max": 0, "count": 0, "histogram": []}
        (self.folder / "report.json").write_text(json.dumps({"latency_ms": {"last_packet": empty}}))
        result = self.plot(self.folder / "report.json", self.folder / "x.png", PYTHONPATH=str(self.folder / "hidden"))
        self.assertEqual(result.returncode, 1)
        self.assertIn("Matplotlib is missing: no picture is made; install python3-matplotlib", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
