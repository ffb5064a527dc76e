#!/usr/bin/python3
"""The real program from outside: exit codes, messages, determinism, commands, GigE Vision frames with Aravis.

    run_program_test.py HILCAM SOURCE_DIR
"""
import csv
import json
import math
import os
import pathlib
import pty
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"


def hilcam(*arguments, **options):
    return subprocess.run([HILCAM, *map(str, arguments)], capture_output=True, text=True, timeout=120, **options)


class Running:
    """hilcam run with a GigE camera on an address of its own and commands on a port of its own."""

    def __init__(self, address, port, folder, *extra):
        self.address, self.port, self.report = address, port, pathlib.Path(folder) / "report.json"
        self.process = subprocess.Popen(
            [HILCAM, "run", str(SCENARIO), "--set", f"outputs.gige.interface={address}", "--set",
             f"outputs.gige.serial=T{port}", "--set", f"commands.udp.port={port}", "--report", str(self.report), *extra],
            stderr=subprocess.PIPE, text=True)

    def __enter__(self):
        for _ in range(200):
            if self.send("ping").returncode == 0:
                return self
            time.sleep(0.05)
        raise RuntimeError("the emulator does not answer: " + (self.process.stderr.read() if self.process.poll() else ""))

    def send(self, *arguments):
        return hilcam("send", "--to", f"127.0.0.1:{self.port}", "--timeout-ms", 300, *arguments)

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        _, log = self.process.communicate(timeout=30)
        assert self.process.returncode == 0, log
        return json.loads(self.report.read_text())

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate()


class Rate(unittest.TestCase):
    """A run lowers its quality until it holds the camera's rate, and says so. No machine makes 5000 frames a second."""
    FAST = ("--set", "camera.frame_rate_range_hz=[1, 5000]", "--set", "camera.frame_rate_hz=5000", "--set", "camera.exposure_ms=0.05")

    def run_for(self, seconds, *sets):
        with tempfile.TemporaryDirectory() as folder:
            report = pathlib.Path(folder) / "report.json"
            result = hilcam("run", SCENARIO, *self.FAST, "--duration", seconds, "--report", report, *sets)
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(report.read_text()), result.stderr

    def test_quality_goes_down_where_the_rate_is_not_held(self):
        report, log = self.run_for(2, "--set", "loop.levels=[{path_model: direct}, {path_model: direct, max_depth: 1}]")
        quality = report["quality"]
        self.assertEqual(quality["frame_budget_ms"], 0.2)
        self.assertEqual(quality["frames_at_level"][:2], [0, 0])
        self.assertGreaterEqual(quality["frames_at_level"][2], report["frames"])
        self.assertIsNone(quality["core_ms_at_level"][0])
        self.assertGreater(quality["core_ms_at_level"][2], 0)
        full = quality["full_quality"]
        self.assertAlmostEqual(full["cores"], full["core_ms"] * full["frame_rate_hz"] / 1000, delta=0.01 * full["cores"])
        self.assertGreater(full["cores"], full["cores_given"])
        self.assertIn(report["limited_by"], ("rendering", "sensor"))
        self.assertGreater(report["cores_used"], 0)
        self.assertRegex(log, r"[1-9]\d* frames in 2\.\d s, \d+ exposures missed: \d+\.\d frames/s on \d+\.\d of \d+ cores, limited by (rendering|sensor)")
        self.assertRegex(log, r"frames at level 2 \(0: full quality\); full quality takes \d+ core-ms a frame, \d+\.\d cores at 5000 frames/s, and the machine gives \d+")

    def test_a_fixed_quality_and_a_limited_number_of_frames_stay_as_configured(self):
        for sets in (("--set", "loop.levels=fixed"), ("--set", "loop.levels=[{max_depth: 1}]", "--frames", 5)):
            report, log = self.run_for(2, *sets)
            self.assertEqual(len(report["quality"]["frames_at_level"]), 1)
            self.assertEqual(report["quality"]["frame_budget_ms"], 0)
            self.assertNotIn("loop.levels: fixed keeps it", log)

    def test_keys_that_contradict_each_other_are_refused_where_they_stand(self):
        result = hilcam("check", SCENARIO, "--set", "loop.frame_budget_ms=20")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"minimal_scenario.yaml:\d+:\d+: loop.levels: found 'fixed' beside a frame_budget_ms of 20")


class ExitCodes(unittest.TestCase):
    def refused(self, needle, *arguments):
        result = hilcam(*arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn(needle, result.stderr)
        messages = [line for line in result.stderr.splitlines() if not line.startswith("hilcam: loading ")]
        self.assertEqual(len(messages), 1, result.stderr)

    def test_bad_input_is_one_line_and_status_2(self):
        self.refused("none.yaml: no such file", "check", "none.yaml")
        self.refused("unknown key", "check", SCENARIO, "--set", "camera.exposure_us=3")
        self.refused("nearest known key: f_number", "check", SCENARIO, "--set", "camera.f_numbr=3")
        self.refused("accepted: a number", "check", SCENARIO, "--set", "camera.f_number=wide")
        self.refused("no such mesh file", "check", SOURCE / "configs/scenarios/iss.yaml")
        self.refused("is not a date and time", "check", SCENARIO, "--set", "time_utc=noon")
        self.refused("interface 'nowhere0' does not exist; accepted: lo", "run", SCENARIO, "--set",
                     "outputs.gige.interface=nowhere0")
        self.refused("accepted: .exr", "render", SCENARIO, "--out", "x.png", "--stage", "radiance")
        self.refused("--out is missing; accepted: --out FILE, --pixel X Y, or both", "render", SCENARIO)
        self.refused("--parts: they are parts of the light at the lens", "render", SCENARIO, "--out", "x.png", "--parts")
        self.refused("--pixel 256 0: the frame has no such pixel; accepted: 0 to 255 and 0 to 191", "render", SCENARIO, "--pixel", 256, 0)
        self.refused("--pixel 0 -1: the frame has no such pixel", "render", SCENARIO, "--pixel", 0, -1)
        self.assertEqual(hilcam("fly").returncode, 2)

    def test_numbers_are_what_they_look_like_or_refused(self):
        whole, number = "a whole number, 0 or more", "a number"
        for value, accepted, *arguments in (
                ("-1", whole, "run", SCENARIO, "--frames"), ("99999999999999999999", whole, "run", SCENARIO, "--frames"),
                ("nan", number, "run", SCENARIO, "--duration"), ("-65535", whole, "run", SCENARIO, "--preview"),
                ("-18446744073709551615", whole, "check", SCENARIO, "--camera"), ("0x1", whole, "render", SCENARIO, "--camera"),
                ("inf", number, "render", SCENARIO, "--time-offset-s"), ("-1", whole, "campaign", "c.yaml", "--case"),
                ("1e999", number, "send", "watch", "--duration-s"), ("-1", whole, "send", "watch", "--frames"),
                ("-4294967295", whole, "send", "expose", "--frames"), ("nan", number, "send", "fault", "image_black", "--rate")):
            with self.subTest(arguments=arguments, value=value):
                result = hilcam(*arguments, value)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertEqual(result.stderr.splitlines()[0], f"{arguments[-1]}: found '{value}'; accepted: {accepted}")

    def test_no_message_commands_the_terminal(self):
        for arguments in (("--set", "camera.\x1b[31mname=3"), ("--set", "time_utc=\x1b]0;title\x07"), ("--\x1b[31m",)):
            result = hilcam("check", SCENARIO, *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertNotRegex(result.stderr, "[\x00-\x09\x0b-\x1f\x7f-\x9f]")
        result = hilcam("check", "configs/\x1b[31m.yaml")
        self.assertIn("configs/ [31m.yaml: no such file", result.stderr)

    def test_check_loads_what_a_run_loads(self):
        second = "{width_px: 8, height_px: 8, pitch_um: 5, focal_length_mm: 25, f_number: 4, quantum_efficiency: 0.5," \
                 " full_well_e: 1e4, gain_dn_e: 0.2, bits: 12, fixed_pattern: {dark_map: /none/map.tiff}}"
        for key in ("prnu_map", "offset_map", "dark_map"):
            self.refused("/none/map.tiff: no such file", "check", SCENARIO, "--set", f"camera.fixed_pattern.{key}=/none/map.tiff")
        self.refused("/none/map.tiff: no such file", "check", SCENARIO, "--set", f"more_cameras=[{{camera: {second}}}]")
        self.refused("/none/map.tiff: no such file", "check", SOURCE / "configs/cameras/inspector_1k.yaml", "--set",
                     "fixed_pattern.prnu_map=/none/map.tiff")
        self.refused("found a Bayer format, but the camera has no colour filters", "check", SCENARIO, "--set",
                     "outputs.v4l2.format=BAYER8")

    def test_a_sensor_without_enough_memory_is_named(self):
        """4 GB of radiance, where a limit allows 3; and 138 GB, which no such machine has."""
        def refused(pixels, status, words):
            large = ("--set", f"camera.width_px={pixels}", "--set", f"camera.height_px={pixels}", "--set", "quality.oversampling=8")
            for command in ("check", "run"):
                result = subprocess.run(["prlimit", "--as=3000000000", HILCAM, command, str(SCENARIO), *large],
                                        capture_output=True, text=True, timeout=120)
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertIn(words, result.stderr)
        refused(2750, 1, "not enough memory for the scenario: its camera of 2750 x 2750 px")
        refused(16384, 2, "a frame of 131328 x 131328 pixels (guard_px and oversampling included)")

    def test_a_command_that_is_missing_is_answered_by_the_help(self):
        for words, own in (((), "geo_inspection"), (("send",), "hilcam send settings --exposure-ms 5")):
            result = hilcam(*words)
            self.assertEqual((result.returncode, result.stdout), (2, ""))
            self.assertIn(own, result.stderr)
            self.assertEqual(result.stderr, hilcam(*words, "--help").stdout)
        for line in hilcam("--help").stdout, hilcam("redner", "small").stderr, hilcam("make-page").stderr:
            self.assertNotIn("make-pages", line)
        self.refused("nearest: render", "redner", "small")

    def test_shipped_parts_go_by_their_names(self):
        refused = hilcam("check", SCENARIO, "--set", "quality=realtme")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("nearest: realtime", refused.stderr)
        result = hilcam("check", SCENARIO, "--set", "quality=fast", "--set", "camera=mv_imx249", "--set", "camera.color_filter=GRBG",
                        "--set", "objects=[{name: rock, mesh: asteroid, scale: 0.001}]", "--set", "quality.path_model=direct")
        self.assertEqual(result.returncode, 0, result.stderr)
        for words, command in (("which is neither a file nor a shipped one ('hilcam list meshes'); nearest: asteroid", ("mesh", "asteriod")),
                               ("a shipped scenario or camera ('hilcam list')", ("check", "nosuchthing"))):
            result = hilcam(*command)
            self.assertEqual(result.returncode, 2)
            self.assertIn(words, result.stderr)

    def test_the_list_has_every_part_with_what_it_is(self):
        parts = json.loads(hilcam("list", "--json").stdout)
        kinds = {part["kind"] for part in parts}
        self.assertEqual(kinds, {"scenarios", "cameras", "qualities", "materials", "filters", "meshes", "maps", "stars"})
        for folder, kind in (("scenarios", "scenarios"), ("cameras", "cameras"), ("quality", "qualities"), ("materials", "materials")):
            names = sorted(path.stem for path in (SOURCE / "configs" / folder).glob("*.yaml"))
            self.assertEqual(sorted(p["name"] for p in parts if p["kind"] == kind), names)
            lines = hilcam("list", kind).stdout.splitlines()
            self.assertTrue(lines[0].startswith(kind + ": "), lines[0])
            self.assertEqual(sorted(line.split()[0] for line in lines[1:]), names)
            self.assertTrue(all(len(line.split()) > 3 for line in lines[1:]), lines)
        for part in parts:
            self.assertTrue(pathlib.Path(part["file"]).is_file(), part)
        self.assertEqual(hilcam("list", "lenses").returncode, 2)

    def test_device_faults_are_status_1_and_say_what_to_do(self):
        result = hilcam("run", SCENARIO, "--set", "outputs.v4l2.device=/dev/video-none")
        self.assertEqual(result.returncode, 1)
        self.assertIn("/dev/video-none: cannot be opened", result.stderr)
        self.assertIn("modprobe v4l2loopback", result.stderr)
        self.assertEqual(hilcam("send", "--to", "127.0.0.1:15999", "--timeout-ms", 100, "ping").returncode, 1)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as deaf:
            deaf.bind(("127.0.0.1", 0))
            for dialect, other in (("hilcam", "cfs"), ("cfs", "hilcam")):
                silent = hilcam("send", "--to", f"127.0.0.1:{deaf.getsockname()[1]}", "--timeout-ms", 100, "--dialect", dialect, "ping")
                self.assertEqual(silent.returncode, 1)
                self.assertIn(f"the other dialect (--dialect {other})?", silent.stderr)

    def test_the_manual_is_the_documented_one(self):
        documented = (SOURCE / "docs/configuration.md").read_text().splitlines()
        self.assertEqual([line for line in hilcam("manual").stdout.splitlines() if line not in documented], [])

    def test_check_and_version(self):
        self.assertIn("object 1 'target'", hilcam("check", SCENARIO).stdout)
        self.assertRegex(hilcam("--version").stdout, r"^hilcam 0\.3\.0 \(\S.*\)\n$")


class Check(unittest.TestCase):
    def test_the_verdict_comes_first_and_says_what_is_not_meant(self):
        good = hilcam("check", SCENARIO)
        self.assertEqual(good.returncode, 0, good.stderr)
        self.assertTrue(good.stdout.startswith("warnings: none\nscenario protocol_test at "), good.stdout[:200])
        for words in ("m, ", "phase angle", "expected  about", "in camera axes", "plan\n", "memory: "):
            self.assertIn(words, good.stdout)
        bad = hilcam("check", SCENARIO, "--set", "mode=lockstep", "--set", "commands={}", "--set", "camera_pose.look_at_m=[44, 30, 14]",
                     "--set", "faults=[{kind: v4l2_stall}]", "--set", "outputs.gige.interface=nowhere0")
        self.assertEqual(bad.returncode, 0, bad.stderr)
        warnings = bad.stdout[:bad.stdout.index("scenario protocol_test")]
        self.assertTrue(warnings.startswith("warnings:\n"))
        for words in ("nothing can request a frame", "object 'target' is behind the camera", "the fault 'v4l2_stall'",
                      "interface 'nowhere0' does not exist"):
            self.assertIn(words, warnings)
        told = json.loads(hilcam("check", SCENARIO, "--json").stdout)
        self.assertEqual(told["warnings"], [])
        self.assertEqual(told["cameras"][0]["objects"][0]["place"], "visible")
        sheet = json.loads(hilcam("check", SOURCE / "configs/cameras/inspector_1k.yaml", "--json").stdout)
        self.assertEqual(sheet["width_px"], 1024)

    def test_strict_makes_warnings_failures(self):
        self.assertEqual(hilcam("check", SCENARIO, "--strict").returncode, 0)
        warned = hilcam("check", SCENARIO, "--strict", "--set", "outputs.gige.interface=eth7")
        self.assertEqual(warned.returncode, 1)
        self.assertRegex(warned.stdout, r"--set outputs.gige.interface: outputs.gige: interface 'eth7' does not exist")
        self.assertEqual(hilcam("check", SOURCE / "configs/cameras/inspector_1k.yaml", "--strict", "--set", "offset_dn=4000").returncode, 1)

    def test_render_and_run_print_what_concerns_them(self):
        away = ("--set", "camera_pose.look_at_m=[44, 30, 14]")
        behind, nobody = "object 'target' is behind the camera", "so the frames of a run go nowhere"
        with tempfile.TemporaryDirectory() as folder:
            picture = hilcam("render", SCENARIO, "--out", f"{folder}/black.png", *away)
            self.assertEqual(picture.returncode, 0, picture.stderr)
            run = hilcam("run", SCENARIO, "--frames", 1, "--set", "outputs={}", "--set", "commands={}", *away)
            self.assertEqual(run.returncode, 0, run.stderr)
        for result in (picture, run):
            self.assertIn(behind, result.stderr)
            self.assertIn("it will be black", result.stderr)
        self.assertIn(nobody, run.stderr)
        self.assertNotIn(nobody, picture.stderr)

    def test_each_camera_of_a_bench(self):
        pair = SOURCE / "tests/protocol/pair_scenario.yaml"
        text = hilcam("check", pair).stdout
        self.assertIn("camera 1 of 2\n", text)
        self.assertIn("camera 2 of 2\n", text)
        self.assertRegex(text, r"baseline    1 m from camera 1")
        self.assertNotIn("camera 1 of 2\n", hilcam("check", pair, "--camera", 2).stdout)
        result = hilcam("check", pair, "--camera", 3)
        self.assertEqual((result.returncode, result.stderr), (2, "hilcam: --camera: found 3; accepted: 1 to 2\n"))
        with tempfile.TemporaryDirectory() as folder:
            pictures = []
            for camera in (1, 2):
                file = pathlib.Path(folder) / f"{camera}.png"
                result = hilcam("render", pair, "--out", file, "--camera", camera)
                self.assertEqual(result.returncode, 0, result.stderr)
                pictures.append(file.read_bytes())
            self.assertNotEqual(pictures[0], pictures[1])

    def test_a_mesh(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "plate.obj"
            file.write_text("o wing\nv 0 0 0\nv 2000 0 0\nv 0 1000 0\nf 1 2 3\n")
            text = hilcam("mesh", file).stdout
            self.assertIn("size       2000 x 1000 x 0 m", text)
            self.assertIn("'wing'", text)
            self.assertIn("probably in millimetres", text)
            self.assertEqual(json.loads(hilcam("mesh", file, "--json").stdout)["open_edges"], 3)
            self.assertEqual(hilcam("mesh", file.with_name("none.obj")).returncode, 2)


class Words(unittest.TestCase):
    def test_a_subcommand_that_there_is_not(self):
        for arguments, words in ((("redner",), "unknown subcommand 'redner'; nearest: render; accepted: run"),
                                 (("send", "pnig"), "unknown subcommand 'pnig'; nearest: ping"),
                                 (("send", "--to", "127.0.0.1:9", "xyzzy"), "unknown subcommand 'xyzzy'; accepted: ping")):
            result = hilcam(*arguments)
            self.assertEqual(result.returncode, 2)
            self.assertIn(words, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)

    def test_help_lists_words_and_is_text(self):
        for arguments, words in ((("render", "--help"), "--stage radiance|electrons|frame"), (("send", "--help"), "--dialect hilcam|cfs")):
            text = hilcam(*arguments).stdout
            self.assertIn(words, text)
            self.assertNotRegex(text, "[\x00-\x09\x0b-\x1f]")
        result = hilcam("render", SCENARIO, "--out", "x.exr", "--stage", "radiant")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--stage: found 'radiant'; accepted: radiance|electrons|frame", result.stderr)

    def test_refusals_say_what_helps(self):
        with tempfile.TemporaryDirectory() as folder, Running("127.0.0.13", 15030, folder) as emulator:
            self.assertIn("not now: no trigger is taken in free_run ('hilcam send mode triggered')", emulator.send("expose").stdout)
            for mode in ("triggered", "free_run", "free-run"):
                self.assertEqual(emulator.send("mode", mode).returncode, 0)
            emulator.stop()


class Signals(unittest.TestCase):
    PING = ("send", "--to", "127.0.0.1:15028", "--timeout-ms", 300, "ping")

    def wait_for_answer(self):
        for _ in range(200):
            if hilcam(*self.PING).returncode == 0:
                return
            time.sleep(0.05)
        self.fail("the program does not answer")

    def run_and_hang_up(self, *, ignored):
        with tempfile.TemporaryDirectory() as folder:
            report, recording, path = (pathlib.Path(folder) / name for name in ("report.json", "run.hcr", "commands"))
            process = subprocess.Popen(
                [HILCAM, "run", str(SCENARIO), "--set", "commands.udp.port=15028", "--set", f"commands.unix.path={path}",
                 "--set", "outputs.gige.interface=127.0.22.9", "--report", str(report), "--record", str(recording)],
                stderr=subprocess.PIPE, text=True,
                preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN if ignored else signal.SIG_DFL))
            try:
                self.wait_for_answer()
                self.assertTrue(path.exists())
                process.send_signal(signal.SIGHUP)
                if ignored:
                    time.sleep(0.3)
                    self.assertEqual(hilcam(*self.PING).returncode, 0)
                    process.send_signal(signal.SIGTERM)
                log = process.communicate(timeout=30)[1]
            finally:
                process.kill()
                process.communicate()
            self.assertEqual(process.returncode, 0, log)
            self.assertGreater(json.loads(report.read_text())["frames"], 0)
            self.assertTrue(json.loads(hilcam("recording", recording).stdout.splitlines()[-1])["whole"])
            self.assertFalse(path.exists())

    def test_signals_that_come_at_once_are_one(self):
        with tempfile.TemporaryDirectory() as folder:
            report = pathlib.Path(folder) / "report.json"
            process = subprocess.Popen([HILCAM, "run", str(SCENARIO), "--set", "commands.udp.port=15028", "--report", str(report)],
                                       stderr=subprocess.PIPE, text=True)
            try:
                self.wait_for_answer()
                # Less than a second, and up to the program's last moment.
                for _ in range(180):
                    process.send_signal(signal.SIGINT)
                    time.sleep(0.005)
                log = process.communicate(timeout=30)[1]
            finally:
                process.kill()
                process.communicate()
            self.assertEqual(process.returncode, 0, log)
            self.assertGreater(json.loads(report.read_text())["frames"], 0)

    def test_every_signal_that_asks_for_the_end_gets_a_report(self):
        for number in (signal.SIGTERM, signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM):
            with self.subTest(signal=number.name), tempfile.TemporaryDirectory() as folder:
                report = pathlib.Path(folder) / "report.json"
                process = subprocess.Popen([HILCAM, "run", str(SCENARIO), "--set", "commands.udp.port=15028", "--report", str(report)],
                                           stderr=subprocess.PIPE, text=True)
                try:
                    self.wait_for_answer()
                    process.send_signal(number)
                    log = process.communicate(timeout=30)[1]
                finally:
                    process.kill()
                    process.communicate()
                self.assertEqual(process.returncode, 0, log)
                self.assertIn("frames", json.loads(report.read_text()))

    def test_a_terminal_that_closes_ends_a_run_in_order(self):
        self.run_and_hang_up(ignored=False)

    def test_nohup_is_heeded(self):
        self.run_and_hang_up(ignored=True)


class Pictures(unittest.TestCase):
    def test_frames_do_not_depend_on_threads(self):
        with tempfile.TemporaryDirectory() as folder:
            frames = []
            for threads in (1, 2):
                file = pathlib.Path(folder) / f"{threads}.png"
                self.assertEqual(hilcam("render", SCENARIO, "--out", file, "--set", f"threads={threads}").returncode, 0)
                frames.append(file.read_bytes())
            self.assertEqual(frames[0], frames[1])

    def test_a_picture_without_a_seed_has_noise_of_its_own_and_says_how_to_get_it_again(self):
        with tempfile.TemporaryDirectory() as folder:
            scenario = pathlib.Path(folder) / "no_seed.yaml"
            scenario.write_text(SCENARIO.read_text().replace("\nseed: 3\n", "\n").replace("../../configs", f"{SOURCE}/configs"))
            self.assertIn("each run draws its own noise", hilcam("check", scenario).stdout)

            def picture(*more):
                file = pathlib.Path(folder) / "frame.raw"
                result = hilcam("render", scenario, "--out", file, *more)
                self.assertEqual(result.returncode, 0, result.stderr)
                return file.read_bytes(), result.stderr

            one, log = picture()
            self.assertNotEqual(picture()[0], one)
            seed = re.search(r"drawn for this run; with --set (seed=\d+) its noise", log).group(1)
            again, log = picture("--set", seed)
            self.assertEqual(again, one)
            self.assertEqual(log, "")

    def test_a_pixel_is_told_with_a_picture_or_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder) / "frame.png"
            alone, beside = (hilcam("render", SCENARIO, "--pixel", 128, 96, *more) for more in ((), ("--out", picture)))
            for result in (alone, beside):
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertRegex(result.stdout, r"^pixel 128 96 of protocol_test: .*\n(  [a-z._]+ +[0-9.]+ e- +[0-9.]+ %\n)+  sum +[0-9.]+ e-\n")
                self.assertIn("object 'target', surface '", result.stdout)
            self.assertEqual(alone.stdout, beside.stdout)
            self.assertTrue(picture.exists())

    def test_every_stage_writes_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            for stage in ("radiance", "electrons"):
                file = pathlib.Path(folder) / f"{stage}.exr"
                result = hilcam("render", SCENARIO, "--stage", stage, "--out", file)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(file.read_bytes()[:4], b"\x76\x2f\x31\x01")  # OpenEXR's magic number


class SlowDisk(unittest.TestCase):
    """Frames come faster than a disk takes them: a thousand a second, of which no machine writes each."""
    FAST = ("--frames", 60, "--set", "commands={}", "--set", "camera.exposure_ms=0.1", "--set", "camera.exposure_range_ms=[0.01, 1]",
            "--set", "camera.frame_rate_hz=1000", "--set", "camera.frame_rate_range_hz=[1, 2000]")

    def run_into(self, folder, *arguments):
        result = hilcam("run", SCENARIO, *self.FAST, "--report", f"{folder}/report.json", "--set",
                        f"outputs={{files: {{folder: {folder}/frames, view: true}}, truth: {{folder: {folder}/frames}}}}", *arguments)
        report = json.loads(pathlib.Path(folder, "report.json").read_text())
        outputs = {output["name"].split()[0]: output for output in report["outputs"]}
        with open(f"{folder}/frames/truth.jsonl") as file:
            lines = [json.loads(line) for line in file][1:]
        return result, outputs, lines, set(pathlib.Path(folder, "frames").glob("frame_????????.png"))

    def test_a_free_run_loses_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            result, outputs, lines, pictures = self.run_into(folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(len(pictures), 60)
            self.assertEqual(len(lines), 60)
            for name in ("files", "truth"):
                self.assertEqual((outputs[name]["frames"], outputs[name]["dropped"]), (60, 0), result.stderr)
            self.assertFalse([line for line in lines if "file" in line])
            self.assertRegex(result.stderr, r"outputs: files \S+ 60 frames; truth 60 frames")

    def test_what_may_be_dropped_is_told_and_no_fault(self):
        with tempfile.TemporaryDirectory() as folder:
            result, outputs, lines, pictures = self.run_into(folder, "--set", "outputs.files.when_slow=drop")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(outputs["files"]["frames"], len(pictures))
            self.assertEqual(outputs["files"]["frames"] + outputs["files"]["dropped"], 60)
            there = {int(picture.stem.split("_")[1]) for picture in pictures}
            self.assertEqual({line["frame"] for line in lines if line.get("file", True)}, there)


class FullDisk(unittest.TestCase):
    def test_it_is_said_at_once_and_once_and_leaves_nothing_broken(self):
        with tempfile.TemporaryDirectory() as folder:
            frames = pathlib.Path(folder) / "frames"
            # In lockstep no frame comes before it is asked for; what is there before the run would be refused.
            with Running("127.0.0.12", 15029, folder, "--set", f"outputs.files={{folder: {frames}}}", "--set", "mode=lockstep") as emulator:
                for number in range(3, 400):  # as if the disk were full from the third on
                    (frames / f"frame_{number:08}.png").symlink_to("/dev/full")
                self.assertEqual(hilcam("send", "--to", "127.0.0.1:15029", "--timeout-ms", 60000, "expose", "--frames", 30).returncode, 0)
                time.sleep(0.5)  # faults are looked for four times a second
                emulator.process.send_signal(signal.SIGINT)
                log = emulator.process.communicate(timeout=60)[1]
                result = subprocess.CompletedProcess([], emulator.process.returncode, "", log)
            self.assertEqual(result.returncode, 1, result.stderr)
            names = {f.name: f.is_symlink() for f in frames.iterdir()}
            self.assertLessEqual({name for name, full in names.items() if not full},
                                 {"frame_00000001.png", "frame_00000002.png"})
            # What was tried there is gone; a busy machine leaves out some exposures.
            first = next(name for name in (f"frame_{number:08}.png" for number in range(3, 400)) if name not in names)
            lines = result.stderr.splitlines()
            told = [i for i, line in enumerate(lines) if f"{first}: cannot be written: No space left" in line]
            self.assertEqual(len(told), 2, result.stderr)
            end = next(i for i, line in enumerate(lines) if "exposures missed" in line)
            self.assertLess(told[0], end)
            self.assertRegex(lines[told[1]], r"the first of \d\d+ frames lost")
            self.assertNotIn("libpng", result.stderr)


class Characterise(unittest.TestCase):
    CAMERA = SOURCE / "configs/cameras/inspector_1k.yaml"
    FAST = ("--set", "window_px=[400, 400, 160, 160]")

    def test_json_has_the_figures_that_scripts_read(self):
        result = hilcam("characterise", self.CAMERA, "--json", *self.FAST)
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        for key in ("gain_dn_e", "qe_peak", "read_noise_e", "dark_current_e_s", "full_well_e", "prnu_fraction",
                    "dsnu_e", "linearity_error", "mtf_nyquist", "snr_max_db", "dynamic_range_db",
                    "saturation_capacity_e", "absolute_threshold_e"):
            self.assertEqual(set(report[key]), {"configured", "measured", "uncertainty"}, key)
            for value in report[key].values():
                self.assertIsInstance(value, (int, float), key)
        self.assertEqual(report["gain_dn_e"]["configured"], 0.29)
        self.assertAlmostEqual(report["gain_dn_e"]["measured"], 0.29, delta=0.0029)
        self.assertGreater(len(report["photon_transfer"]), 16)
        self.assertEqual(len(report["mtf"]["vertical"]["points"]), 65)

    def test_a_folder_with_curves_and_a_page(self):
        with tempfile.TemporaryDirectory() as folder:
            result = hilcam("characterise", self.CAMERA, "--out", folder, *self.FAST)
            self.assertIn("System gain K", result.stdout)
            files = {path.name for path in pathlib.Path(folder).iterdir()}
            self.assertLessEqual({"characterise.json", "photon_transfer.csv", "linearity.csv", "dark.csv",
                                  "mtf_horizontal.csv", "mtf_vertical.csv"}, files)
            if subprocess.run(["/usr/bin/python3", "-c", "import matplotlib"], capture_output=True).returncode != 0:
                self.assertEqual(result.returncode, 1)
                self.assertIn("Matplotlib is missing", result.stderr)
                self.skipTest("Matplotlib is missing: the page is not looked at")
            self.assertEqual(result.returncode, 0, result.stderr)
            page = (pathlib.Path(folder) / "index.html").read_text()
            self.assertEqual(page.count("<svg"), 9)
            self.assertNotIn("http-equiv", page)  # one file, nothing to load
            self.assertNotIn("<script", page)
            # Levels beyond saturation are marked, and a straight response has no error of rounding.
            file = pathlib.Path(folder) / "characterise.json"
            report = json.loads(file.read_text())
            beyond = [point["saturated"] for point in report["photon_transfer"]]
            self.assertEqual(beyond, sorted(beyond))
            self.assertTrue(beyond[-1] and not beyond[0])
            self.assertEqual(report["linearity_error"]["configured"], 0)
            self.assertIn("beyond saturation", page)
            # A camera without a nonuniformity has words in place of empty axes.
            report["prnu_fraction"]["configured"], report["dsnu_histogram"] = 0, None
            file.write_text(json.dumps(report))
            subprocess.run([SOURCE / "tools/hilcam-plot-characterise", file, pathlib.Path(folder) / "none.html"], check=True, timeout=60)
            page = (pathlib.Path(folder) / "none.html").read_text()
            self.assertEqual(page.count("<svg"), 7)
            self.assertIn("PRNU: none configured (", page)
            self.assertIn("DSNU: none configured (", page)

    def test_progress_is_told_on_one_line_to_terminals_and_by_lines_to_logs(self):
        # Its standard error is a terminal, its standard output is none.
        parent, terminal = pty.openpty()
        with subprocess.Popen([HILCAM, "characterise", self.CAMERA, "--json"], stdout=subprocess.PIPE, stderr=terminal) as process:
            os.close(terminal)
            told = b""
            while b"left" not in told:
                try:
                    told += os.read(parent, 4096)
                except OSError:  # the other end is closed
                    break
            process.kill()
        os.close(parent)
        self.assertRegex(told.decode(), r"\r\x1b\[Khilcam: measuring [a-zA-Z ]+ \d+ %, \d+ s, about [^:]* left\r")
        def log(seconds):
            return hilcam("characterise", self.CAMERA, "--json", *self.FAST, env=os.environ | {"HILCAM_PROGRESS_S": seconds}).stderr
        self.assertEqual(log("0"), "")
        lines = log("0.1").splitlines()
        self.assertGreater(len(lines), 1)
        for line in lines:
            self.assertRegex(line, r"^hilcam: measuring( [a-zA-Z ]+( \d+ %)?)?, \d+ s(, about [^:]* left)?$")

    def test_a_camera_that_cannot_be_is_refused(self):
        result = hilcam("characterise", self.CAMERA, "--set", "f_number=0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("f_number", result.stderr)


class Ground(unittest.TestCase):
    SCENARIO = SOURCE / "configs/scenarios/lunar_landing.yaml"

    def test_it_lists_what_is_about_the_site(self):
        result = hilcam("ground", self.SCENARIO, "--list", "boulders", "--within-m", 100, "--smallest-m", 0.5)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        rows = list(csv.DictReader(result.stdout.splitlines()))
        self.assertGreater(len(rows), 3)
        for row in rows:
            self.assertGreaterEqual(float(row["diameter_m"]), 0.5)
            self.assertLessEqual(math.hypot(float(row["east_m"]), float(row["north_m"])), 100.1)

    def test_hazards_are_heights_with_a_judgement(self):
        result = hilcam("ground", self.SCENARIO, "--list", "hazards", "--within-m", 10, "--spacing-m", 0.5, "--slope-deg", 4, "--step-m", 0.1)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        rows = list(csv.DictReader(result.stdout.splitlines()))
        self.assertEqual(len(rows), 41 * 41)
        for row in rows:
            # A text's last digit may be on the other side of a limit.
            slope, step = float(row["slope_deg"]), float(row["step_m"])
            if abs(slope - 4) > 1e-3 and abs(step - 0.1) > 1e-4:
                self.assertEqual(row["hazard"], "1" if slope > 4 or step > 0.1 else "0")
        self.assertEqual({row["hazard"] for row in rows}, {"0", "1"})

    def test_the_axes_of_a_site_are_those_of_its_poses(self):
        """A camera that stands in local axes, as truth has it in the world's."""
        scenario = SOURCE / "tools/landing_example/landing.yaml"
        x, y, z, *axes = map(float, hilcam("ground", scenario, "--list", "axes").stdout.splitlines()[1].split(","))
        self.assertLess(math.hypot(x, y, z), 1e-3)  # the origin is the site
        with tempfile.TemporaryDirectory() as folder:
            result = hilcam("render", scenario, "--out", f"{folder}/a.png", "--truth", folder, "--set", "camera.width_px=16", "--set",
                            "camera.height_px=16")
            self.assertEqual(result.returncode, 0, result.stderr)
            pose = json.loads(pathlib.Path(folder, "a.truth.jsonl").read_text().splitlines()[1])["pose"]
        # 300 m up, looking down: a half turn about east after the site's axes.
        w, a, b, c = axes
        up = (2 * (a * c + w * b), 2 * (b * c - w * a), 1 - 2 * (a * a + b * b))
        for found, expected in zip(pose["position_m"], up):
            self.assertAlmostEqual(found, 300 * expected, delta=1e-3)
        turned = (-a, w, c, -b)  # (w, a, b, c) * (0, 1, 0, 0)
        self.assertAlmostEqual(abs(sum(p * q for p, q in zip(pose["attitude_wxyz"], turned))), 1, delta=1e-9)

    def test_a_picture_lists_what_it_shows(self):
        scenario = SOURCE / "tools/landing_example/landing.yaml"
        result = hilcam("ground", scenario, "--list", "craters", "--footprint", "--smallest-px", 20)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        rows = list(csv.DictReader(result.stdout.splitlines()))
        self.assertGreater(len(rows), 5)
        for row in rows:
            self.assertTrue(0 <= float(row["x_px"]) < 512 and 0 <= float(row["y_px"]) < 512 and float(row["diameter_px"]) >= 20)
        with tempfile.TemporaryDirectory() as folder:
            result = hilcam("ground", scenario, "--list", "hazards", "--footprint", "--spacing-m", 2, "--out", f"{folder}/h.exr")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertGreater(pathlib.Path(folder, "h.exr").stat().st_size, 10_000)
        for wrong in (("--list", "hazards", "--footprint"), ("--list", "heights", "--footprint"), ("--list", "craters", "--out", "a.exr")):
            result = hilcam("ground", scenario, *wrong)
            self.assertEqual(result.returncode, 2, wrong)
            self.assertIn("--out" if "heights" not in wrong else "--footprint", result.stderr)

    def test_what_has_no_ground_is_refused(self):
        result = hilcam("ground", SOURCE / "configs/scenarios/small.yaml", "--list", "craters")
        self.assertEqual(result.returncode, 2)
        self.assertIn("has no terrain.globe", result.stderr)
        result = hilcam("ground", self.SCENARIO, "--list", "trees")
        self.assertEqual(result.returncode, 2)
        self.assertIn("craters", result.stderr)


class Calibration(unittest.TestCase):
    SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"

    def test_it_is_printed_for_scenarios_and_camera_files(self):
        result = hilcam("check", self.SCENARIO, "--calibration", "kalibr")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("resolution: [256, 192]\n", result.stdout)
        self.assertIn("127.5, 95.5]", result.stdout)  # the middle, counted from the first pixel's middle
        result = hilcam("check", SOURCE / "configs/cameras/inspector_1k.yaml", "--calibration", "ros")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("camera_name: inspector_1k\n", result.stdout)

    def test_what_cannot_be_is_refused(self):
        result = hilcam("check", self.SCENARIO, "--calibration", "colmap")
        self.assertEqual(result.returncode, 2)
        self.assertIn("found 'colmap'; accepted: opencv|ros|kalibr", result.stderr)
        result = hilcam("check", self.SCENARIO, "--calibration", "kalibr", "--set", "camera.distortion=[0,0,0,0,0.1]")
        self.assertEqual(result.returncode, 2)
        self.assertIn("camera 1 has distortion.k3 0.1, and Kalibr's radtan model has k1, k2, p1, p2 alone", result.stderr)
        self.assertEqual(result.stdout, "")


class Camera(unittest.TestCase):
    def test_aravis_takes_every_frame_and_settings_reach_the_camera(self):
        with tempfile.TemporaryDirectory() as folder, Running("127.0.0.9", 15021, folder) as emulator:
            import gi
            gi.require_version("Aravis", "0.8")
            from gi.repository import Aravis

            def take(camera, count):
                camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)
                stream = camera.create_stream(None, None)
                for _ in range(8):
                    stream.push_buffer(Aravis.Buffer.new_allocate(camera.get_payload()))
                camera.start_acquisition()
                sizes, ids = [], []
                while len(ids) < count:
                    buffer = stream.timeout_pop_buffer(5_000_000)
                    self.assertIsNotNone(buffer, "no frame within five seconds")
                    self.assertEqual(buffer.get_status(), Aravis.BufferStatus.SUCCESS)
                    sizes.append(len(buffer.get_data()))
                    ids.append(buffer.get_frame_id())
                    stream.push_buffer(buffer)
                camera.stop_acquisition()
                return sizes, ids

            camera = Aravis.Camera.new("127.0.0.9")
            self.assertEqual(camera.get_pixel_format_as_string(), "Mono12")
            sizes, ids = take(camera, 60)
            self.assertEqual(set(sizes), {256 * 192 * 2})
            self.assertEqual(ids, list(range(ids[0], ids[0] + 60)))

            for name, size in (("Mono8", 256 * 192), ("Mono16", 256 * 192 * 2)):
                camera.set_pixel_format_from_string(name)
                self.assertEqual(set(take(camera, 3)[0]), {size})
            camera.set_region(32, 16, 128, 64)
            self.assertEqual(set(take(camera, 3)[0]), {128 * 64 * 2})

            camera.set_exposure_time(500)
            camera.set_gain(6)
            camera.set_frame_rate(50)
            self.assertAlmostEqual(camera.get_exposure_time(), 500)
            self.assertAlmostEqual(camera.get_frame_rate(), 50)
            # What a command changes is what the client reads, and the other way round.
            self.assertEqual(emulator.send("settings", "--gain-db", 3).returncode, 0)
            self.assertAlmostEqual(camera.get_gain(), 3)
            self.assertEqual(emulator.send("settings", "--gain-db", 99).returncode, 1)

            self.assertIsNotNone(camera.acquisition(3_000_000))  # one single frame
            self.assertIsNotNone(camera.acquisition(3_000_000))
            del camera
            report = emulator.stop()
            self.assertGreater(report["frames"], 60)
            self.assertEqual(report["commands"]["refused"], 1)
            for key in ("frame_rate_hz", "deadline_misses", "latency_ms", "outputs", "faults", "quality"):
                self.assertIn(key, report)

    def test_a_killed_client_frees_the_camera_and_the_loop_goes_on(self):
        with tempfile.TemporaryDirectory() as folder, Running("127.0.0.10", 15022, folder) as emulator:
            client = subprocess.Popen(["arv-camera-test-0.8", "-n", "127.0.0.10", "--no-packet-socket", "--duration=60"],
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            time.sleep(2)
            client.kill()
            client.communicate()
            time.sleep(4)  # the heartbeat's time-out is 3 s
            result = subprocess.run(["arv-camera-test-0.8", "-n", "127.0.0.10", "--no-packet-socket", "--duration=3"],
                                    capture_output=True, text=True, timeout=60)
            figures = dict(line.split("=") for line in result.stdout.replace(" ", "").splitlines()
                           if line.startswith("n_") and "=" in line)
            self.assertGreater(int(figures["n_completed_buffers"]), 30, result.stdout)
            self.assertEqual(figures["n_failures"], "0", result.stdout)
            self.assertEqual(figures["n_missing_frames"], "0", result.stdout)
            emulator.stop()

    def test_poses_are_shown_and_start_stop_work(self):
        with tempfile.TemporaryDirectory() as folder, Running(
                "127.0.0.11", 15023, folder, "--set", f"outputs.files.folder={folder}/frames") as emulator:
            frames = pathlib.Path(folder) / "frames"
            self.assertEqual(emulator.send("fly", "--from-m", 22, 15, 7, "--duration-s", 1, "--rate-hz", 50).returncode, 0)
            self.assertEqual(emulator.send("stop").returncode, 0)
            refused = emulator.send("settings", "--exposure-ms", 5e9)
            self.assertEqual(refused.returncode, 1)
            self.assertRegex(refused.stdout, r"^bad argument: exposure_s: found 5000000; accepted: \S+ to \d+ ")
            time.sleep(0.5)
            before = len(list(frames.iterdir()))
            time.sleep(0.5)
            self.assertEqual(len(list(frames.iterdir())), before)
            self.assertEqual(emulator.send("start").returncode, 0)
            time.sleep(0.5)
            self.assertGreater(len(list(frames.iterdir())), before)
            # A camera turned away from the target sees an (almost) empty picture: the file compresses to less.
            report = emulator.stop()
            self.assertGreaterEqual(report["commands"]["received"], 53)
            self.assertEqual(report["commands"]["refused"], 1)


class Pair(unittest.TestCase):
    """Two cameras in one process, an address each."""

    def test_both_are_found_and_take_the_same_instants_from_their_own_places(self):
        import numpy
        from PIL import Image
        scenario = SOURCE / "tests/protocol/pair_scenario.yaml"
        with tempfile.TemporaryDirectory() as folder:
            report_file = pathlib.Path(folder) / "report.json"
            emulator = subprocess.Popen(
                [HILCAM, "run", str(scenario), "--set", "mode=lockstep", "--set",
                 f"outputs.files.folder={folder}/left", "--set",
                 f"more_cameras.0.outputs.files.folder={folder}/right", "--report", str(report_file)],
                stderr=subprocess.PIPE, text=True)
            try:
                send = lambda *words: hilcam("send", "--to", "127.0.0.1:15024", "--timeout-ms", 20000, *words)
                for _ in range(100):
                    if send("ping").returncode == 0:
                        break
                    time.sleep(0.1)
                found = subprocess.run(["arv-tool-0.8"], capture_output=True, text=True, timeout=30).stdout
                self.assertIn("PAIR1", found)
                self.assertIn("PAIR2", found)
                watches = [subprocess.Popen([HILCAM, "send", "--to", "127.0.0.1:15024", "watch", *words],
                                            stdout=subprocess.PIPE, text=True, bufsize=1)
                           for words in (("--json",), ("--frames", "6"))]
                self.addCleanup(lambda: [(watch.kill(), watch.wait(), watch.stdout.close()) for watch in watches])
                # Once it hears housekeeping it is subscribed.
                for watch in watches:
                    self.assertIn("housekeeping" if "--json" in watch.args else "camera lockstep", watch.stdout.readline())
                for _ in range(3):
                    self.assertEqual(send("expose").returncode, 0)
                told, frames = [], 0
                for _ in range(60):  # housekeeping comes every second
                    if len(told) == 6 and frames == 6:  # of both cameras
                        break
                    packet = json.loads(watches[0].stdout.readline())
                    if packet["kind"] == "frame":
                        told.append(packet)
                    else:
                        frames = packet["frames"]
                lines = [line for line in watches[1].communicate(timeout=30)[0].splitlines() if " mid-exposure " in line]
                self.assertEqual(frames, 6, "housekeeping counts the frames of both")
                emulator.send_signal(signal.SIGINT)
                log = emulator.communicate(timeout=30)[1]
                self.assertEqual(emulator.returncode, 0, log)
            finally:
                emulator.kill()
                emulator.communicate()
            report = json.loads(report_file.read_text())
            self.assertEqual([camera["frames"] for camera in report["cameras"]], [3, 3])
            for camera in (1, 2):
                self.assertEqual([packet["frame"] for packet in told if packet["camera"] == camera], [1, 2, 3])
            instants = [packet["exposure_mid_tai_ns"] for packet in told]
            self.assertEqual(len(set(instants)), 3, "both take the same instants")
            self.assertEqual(sum(line.startswith("camera 2 frame") for line in lines), 3, lines)
            outputs = [[output for output in camera["outputs"] if output["name"] == "telemetry"]
                       for camera in report["cameras"]]
            self.assertEqual([(output["frames"], output["dropped"]) for (output,) in outputs], [(3, 0), (3, 0)])
            # The target is 27.5 m away and the focal length is 227 px: a metre to the right moves it by
            # 227 / 27.5 = 8.3 px to the left. Light's middle, as the shape seen differs little.
            def middle(name):
                image = numpy.asarray(Image.open(pathlib.Path(folder) / name / "frame_00000002.png")).astype(float)
                light = numpy.clip(image - image.min() - 0.1 * (image.max() - image.min()), 0, None)
                return (light.sum(0) * numpy.arange(image.shape[1])).sum() / light.sum()
            self.assertAlmostEqual(middle("left") - middle("right"), 8.3, delta=1.5)


if __name__ == "__main__":
    os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")
    unittest.main(argv=[sys.argv[0]], verbosity=2)
