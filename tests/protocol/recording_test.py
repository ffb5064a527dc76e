#!/usr/bin/python3
"""The real program records a run that commands and events disturb, and replays it: the same bytes on any number of threads.

    recording_test.py HILCAM SOURCE_DIR
"""
import json
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
PORT = 5863
sys.path.insert(0, str(SOURCE / "tools/client"))
import hilcam_client  # noqa: E402


def hilcam(*arguments):
    return subprocess.run([HILCAM, *map(str, arguments)], capture_output=True, text=True, timeout=120)


def into(folder):
    return ["--set", f"outputs.files={{folder: {folder}, format: raw}}"]


def frames_in(folder):
    return {file.name: file.read_bytes() for file in pathlib.Path(folder).iterdir()}


def lines_of(recording):
    result = hilcam("recording", recording)
    assert result.returncode == 0, result.stderr
    return [json.loads(line) for line in result.stdout.splitlines()]


class Recording(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        self.recording = self.folder / "run.rec"
        script = ["@0 pose --position-m 22 15 7 --look-at-m 0 0 0 --velocity-m-s 1 0 0"]
        for i in range(1, 80):
            script.append(f"+0.02 pose --position-m {22 - 0.1 * i} 15 {7 + 0.05 * i} --look-at-m 0 0 0 --rate-deg-s 0 {i} 0")
            if i % 20 == 0:
                script.append(f"+0.005 settings --exposure-ms {0.1 + 0.002 * i} --gain-db {i / 20}")
        self.script = self.folder / "commands.txt"
        self.script.write_text("\n".join(script) + "\n")

    def run_and_record(self, end):
        """A free-run with commands from outside and an event; `end` ends it."""
        process = subprocess.Popen(
            [HILCAM, "run", str(SCENARIO), "--record", str(self.recording), *into(self.folder / "run"), "--set", "threads=1",
             "--set", f"commands.udp.port={PORT}", "--set",
             "events=[{at_s: 1, do: [fault image_bit_flips --rate 0.001 --frames 20, settings --gain-db 6]}]"],
            stderr=subprocess.PIPE, text=True)
        try:
            for _ in range(200):
                if hilcam("send", "--to", f"127.0.0.1:{PORT}", "--timeout-ms", 300, "ping").returncode == 0:
                    break
                time.sleep(0.05)
            result = hilcam("send", "--to", f"127.0.0.1:{PORT}", "script", self.script)
            self.assertEqual(result.returncode, 0, result.stderr)
        finally:
            process.send_signal(end)
            _, log = process.communicate(timeout=30)
        return process.returncode, log

    def replay(self, name, *arguments):
        result = hilcam("run", SCENARIO, "--replay", self.recording, *into(self.folder / name), *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return frames_in(self.folder / name), result.stderr

    def test_a_replay_has_the_same_bytes_on_any_number_of_threads(self):
        status, log = self.run_and_record(signal.SIGINT)
        self.assertEqual(status, 0, log)
        run = frames_in(self.folder / "run")
        self.assertGreater(len(run), 20)
        one, _ = self.replay("one", "--fast", "--set", "threads=1")
        four, text = self.replay("four", "--fast", "--set", "threads=4")
        self.assertIn(f"replayed all {len(four)} frames", text)
        self.assertEqual(one, four)
        self.assertGreaterEqual(len(one), len(run))
        self.assertEqual({name: one[name] for name in run}, run)
        self.assertGreater(len(set(one.values())), 20)

        lines = lines_of(self.recording)
        self.assertEqual(lines[0]["record"], "header")
        self.assertTrue(lines[-1]["whole"])
        frames = [line for line in lines if line["record"] == "frame"]
        commands = [line for line in lines if line["record"] == "command"]
        self.assertEqual(len(frames), len(one))
        self.assertEqual(sum(c["command"] == "pose" for c in commands), 80)
        self.assertEqual({c["event"] for c in commands if "event" in c}, {0})
        self.assertTrue(any("image_bit_flips" in f.get("faults", []) for f in frames))

    def test_a_run_that_is_killed_leaves_what_can_be_replayed(self):
        self.run_and_record(signal.SIGKILL)
        run = frames_in(self.folder / "run")
        frames, text = self.replay("again", "--fast")
        self.assertIn("cut off", text)
        self.assertGreater(len(frames), 20)
        both = frames.keys() & run.keys()
        self.assertGreater(len(both), 20)
        # Of the frame that was being written when it was killed, a file may be half there.
        self.assertLessEqual(sum(frames[name] != run[name] for name in both), 1)

    def test_a_full_disk_ends_the_recording_and_not_the_run(self):
        report, to = self.folder / "report.json", f"127.0.0.1:{PORT + 2}"
        with hilcam_client.Client(to, timeout_s=0.2) as client:
            # Files that may not grow stand for the disk; the program is to see an error, and not a signal.
            process = subprocess.Popen(
                [HILCAM, "run", str(SCENARIO), "--record", str(self.recording), "--report", str(report), "--set",
                 "mode=lockstep", "--set", f"commands.udp.port={PORT + 2}"], stderr=subprocess.PIPE, text=True,
                preexec_fn=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN), restore_signals=False)
            try:
                client.send(hilcam_client.Ping(), tries=600)
                client.send(hilcam_client.Expose(2), timeout_s=30)
                time.sleep(0.5)  # records are written every 10 ms
                size = self.recording.stat().st_size
                before = resource.prlimit(process.pid, resource.RLIMIT_FSIZE)
                resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (size + 200, before[1]))
                client.send(hilcam_client.Expose(20), timeout_s=60)
                time.sleep(0.5)
                self.assertLessEqual(self.recording.stat().st_size, size + 200)
                resource.prlimit(process.pid, resource.RLIMIT_FSIZE, before)
                client.send(hilcam_client.Expose(3), timeout_s=30)
            finally:
                process.send_signal(signal.SIGINT)
                log = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1, log)
        self.assertIn("run.rec cannot be written: File too large", log)
        told = json.loads(report.read_text())
        self.assertEqual(told["frames"], 25)
        self.assertFalse(told["recording"]["complete"])
        # It goes on nowhere where it would have a gap.
        self.assertLessEqual(self.recording.stat().st_size, size + 200)
        frames = self.replay("cut", "--fast", "--set", "mode=lockstep")[0]
        self.assertLess(len(frames), 25)
        self.assertGreaterEqual(len(frames), 2)

    def test_a_replay_takes_nothing_from_outside(self):
        self.assertEqual(self.run_and_record(signal.SIGINT)[0], 0)
        port = PORT + 1
        process = subprocess.Popen(
            [HILCAM, "run", str(SCENARIO), "--replay", str(self.recording), *into(self.folder / "again"),
             "--set", f"commands.udp.port={port}"], stderr=subprocess.PIPE, text=True)
        answers = 0
        while process.poll() is None:
            for words in (("ping",), ("settings", "--gain-db", 12), ("pose", "--position-m", 1000, 0, 0)):
                result = hilcam("send", "--to", f"127.0.0.1:{port}", "--timeout-ms", 100, *words)
                answers += result.returncode == 0
        log = process.communicate(timeout=30)[1]
        self.assertEqual(process.returncode, 0, log)
        self.assertEqual(answers, 0)
        self.assertEqual(frames_in(self.folder / "again"), self.replay("fast", "--fast")[0])

    def test_what_cannot_be_replayed_is_refused_in_one_line(self):
        self.assertEqual(hilcam("run", SCENARIO, "--frames", 3, "--record", self.recording).returncode, 0)

        def refusal(*arguments):
            result = hilcam("run", SCENARIO, *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            return result.stderr

        self.assertIn("camera.gain_dn_e: '0.29' there, '0.3' here",
                      refusal("--replay", self.recording, "--set", "camera.gain_dn_e=0.3"))
        self.assertIn("is no recording", refusal("--replay", SCENARIO))
        self.assertIn("no such file", refusal("--replay", self.folder / "none.rec"))
        result = hilcam("run", SCENARIO, "--replay", self.recording, "--force", "--set", "camera.gain_dn_e=0.3")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("frames may differ", result.stderr)
        result = hilcam("run", SCENARIO, "--frames", 3, "--record", "/dev/null/run.rec")
        self.assertEqual(result.returncode, 1)
        self.assertIn("/dev/null/run.rec cannot be made", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
