#!/usr/bin/python3
"""Clients that nobody here wrote: Aravis's conformance test, its test camera program and tool, GStreamer's source.

    arv_test.py HILCAM [--long] [tests ...]

--long: 100 start/stop cycles and 20 client kills, in place of 20 and 3.
"""
import functools
import operator
import pathlib
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import gvcp_client as g
from arv_lines import conformance
from bench import PATIENT, FrameFiles, camera_test_figures, judge_acquisition, too_busy, tool, wire_bytes
from camera_case import CameraTest

LONG = "--long" in sys.argv
CameraTest.hilcam = sys.argv[1]
CameraTest.address = "127.0.23.5"
GROUPS = ("Genicam", "Properties", "MultipleAcquisitionA", "SingleAcquisition", "SoftwareTrigger", "MultipleAcquisitionB",
          "Multipart", "Chunks", "GigEVision")

import gi  # noqa: E402

gi.require_version("Aravis", "0.8")
from gi.repository import Aravis  # noqa: E402


def run(name, *arguments, timeout=60, **options):
    program = tool(name)
    if program is None:
        raise unittest.SkipTest(f"{name} is not installed (Debian packages aravis-tools, aravis-tools-cli)")
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, **options).stdout


def only_late(failed):
    """What a busy machine does: a rate, a number of frames, a frame that did not come. A refusal is none of it."""
    return all(name.endswith(":FrameRate") or
               (name.endswith(":BufferCheck") and re.fullmatch(r"\d+/\d+|Buffer transfer failure|", line[1]))
               for name, line in failed.items())


class ConformanceTest(CameraTest):
    def run_test(self, *arguments):
        """Acquisitions are judged by the clock: where nothing else failed, a busy machine gets another chance."""
        for _ in range(4):
            results = conformance(run("arv-test", "-n", f"*T{self.emulator.port}*", *arguments))
            failed = {name: line for name, line in results.items() if line[0] == "FAILURE"}
            if not failed or not only_late(failed):
                break
        return results

    @staticmethod
    def ignored(results):
        """Without the schema: arv-test 0.8.26 ignores it where it is not named, 0.8.34 where it is."""
        return {name for name, line in results.items() if line[0] == "IGNORED"} - {"Genicam:Schema"}

    def judge(self, results):
        self.assertTrue(results)
        self.assertEqual({name for name in GROUPS if not any(line.startswith(name + ":") for line in results)}, set())
        failed = {name: line for name, line in results.items() if line[0] == "FAILURE"}
        if failed and too_busy() and only_late(failed):
            self.skipTest(f"{too_busy()}: {failed}")
        self.assertEqual(failed, {})


class Conformance(ConformanceTest):
    def test_arv_test_as_it_comes(self):
        results = self.run_test()
        self.judge(results)
        # Without a configuration of our own it does not know the sensor's size.
        self.assertEqual(self.ignored(results), {"Properties:SensorSizeCheck"})

    def test_arv_test_with_all_it_can_check(self):
        # Integers only: arv-test 0.8 reads chunks as such.
        chunks = ("FrameID Timestamp OffsetX OffsetY Width Height PixelFormat PoseSequence PoseTime ExposureMid "
                  "TriggerSequence Faults")
        with tempfile.NamedTemporaryFile("w", suffix=".cfg") as configuration:
            # Schema: arv-test 0.8 validates descriptions of schema 1.1 against 1.0's (both are loaded from one
            # resource); device_test.py validates against the right one.
            configuration.write("[hilcam:test-camera]\nSchema=Ignore\nSensorSize=256;192\nSoftwareTriggerSupport=true\n"
                                f"ChunksSupport=true\nChunkList={chunks}\n")
            configuration.flush()
            results = self.run_test("-c", configuration.name)
        self.judge(results)
        self.assertEqual(self.ignored(results), set())


class MultipartConformance(ConformanceTest):
    """A camera of its own: arv-test fails one that announces multipart and whose configuration does not."""
    sets = ("outputs.gige.multipart=true",)

    def test_multipart(self):
        with tempfile.NamedTemporaryFile("w", suffix=".cfg") as configuration:
            configuration.write("[hilcam:test-camera]\nMultipart=Intensity Confidence\n")
            configuration.flush()
            results = self.run_test("-c", configuration.name)
        self.judge(results)
        self.assertEqual(results["Multipart:Enable"][0], "SUCCESS")
        self.assertEqual(results["Multipart:BufferCheck"][0], "SUCCESS")


class Acquisition(CameraTest):
    sets = ("camera.frame_rate_hz=20",)

    def camera_test(self, *arguments, seconds=4):
        text = run("arv-camera-test", "-n", self.address, "--no-packet-socket", f"--duration={seconds}", *PATIENT, *arguments)
        figures = camera_test_figures(text)
        self.assertIn("n_completed_buffers", figures, text)
        return figures, text

    def whole(self, figures, text, least):
        judge_acquisition(self, figures, text, least)

    def test_frames_come_whole(self):
        self.whole(*self.camera_test(seconds=3), 20)

    def test_registers_as_they_are_cached_and_in_their_ranges(self):
        figures, text = self.camera_test("--register-cache=debug", "--range-check=debug", seconds=2)
        self.whole(figures, text, 10)
        self.assertNotIn("register cache errors", text.lower().replace("0 register cache errors", ""))

    def test_software_triggers_take_a_frame_each(self):
        figures, text = self.camera_test("-o", "5", seconds=3)
        self.whole(figures, text, 5)

    def test_chunks(self):
        figures, text = self.camera_test("-u", "FrameID,Timestamp,ExposureTime,PoseSequence", seconds=2)
        self.whole(figures, text, 10)

    def test_window_exposure_and_rate_are_taken(self):
        figures, text = self.camera_test("-w", "128", "-h", "64", "-e", "300", "-f", "40", "-g", "2", seconds=2)
        self.whole(figures, text, 10)
        self.assertRegex(text, r"image width\s+= 128")
        with g.GvcpClient(self.address) as client:
            from genicam_client import Features
            features = Features(client)
            self.assertEqual((features.get("Width"), features.get("Height")), (128, 64))
            self.assertAlmostEqual(features.get("ExposureTime"), 300)
            self.assertAlmostEqual(features.get("AcquisitionFrameRate"), 40, places=1)

    def test_two_percent_of_packets_lost_and_every_frame_recovered(self):
        self.fault("packet_drop", rate=0.02)
        # Small packets: more of them to lose.
        figures, text = self.camera_test("-i", "1400", "-j", "never", seconds=5)
        self.whole(figures, text, 40)
        self.assertGreater(figures["n_resend_requests"], 10, text)
        self.assertGreaterEqual(figures["n_resend_requests"], figures["n_resent_packets"], text)

    def test_a_busy_receiver_cannot_stop_the_camera(self):
        """A client that is stopped (SIGSTOP) for longer than its buffers last, and goes on."""
        process = subprocess.Popen([tool("arv-camera-test"), "-n", self.address, "--no-packet-socket", "--duration=4"],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        time.sleep(1.5)
        process.send_signal(signal.SIGSTOP)
        time.sleep(1.0)
        process.send_signal(signal.SIGCONT)
        text, _ = process.communicate(timeout=30)
        self.assertGreater(camera_test_figures(text)["n_completed_buffers"], 20, text)
        self.whole(*self.camera_test(seconds=2), 10)


class ComingAndGoing(CameraTest):
    sets = ("camera.frame_rate_hz=20",)

    def take(self, camera, count):
        stream = camera.create_stream(None, None)
        stream.set_property("frame-retention", 3_000_000)  # us; as PATIENT
        stream.set_property("packet-request-ratio", 2.0)
        for _ in range(8):
            stream.push_buffer(Aravis.Buffer.new_allocate(camera.get_payload()))
        camera.start_acquisition()
        for _ in range(count):
            buffer = stream.timeout_pop_buffer(5_000_000)
            self.assertIsNotNone(buffer, "no frame within five seconds")
            self.assertEqual(buffer.get_status(), Aravis.BufferStatus.SUCCESS)
            stream.push_buffer(buffer)
        camera.stop_acquisition()

    def connect(self):
        camera = Aravis.Camera.new(self.address)
        camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)
        return camera

    def test_starting_and_stopping(self):
        camera = self.connect()
        camera.set_acquisition_mode(Aravis.AcquisitionMode.CONTINUOUS)
        for _ in range(100 if LONG else 20):
            self.take(camera, 2)

    def test_connecting_and_leaving(self):
        for _ in range(20 if LONG else 5):
            camera = self.connect()
            self.take(camera, 1)
            del camera

    def test_killed_clients(self):
        memory = None
        for i in range(20 if LONG else 3):
            client = subprocess.Popen([tool("arv-camera-test"), "-n", self.address, "--no-packet-socket", "--duration=60"],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with g.GvcpClient(self.address) as watcher:
                self.eventually("the client streams", lambda: watcher.read_register(g.SCP) & 0xFFFF)
                time.sleep(0.5)
                client.send_signal(signal.SIGKILL)
                client.wait()
                self.eventually("the camera is free again", lambda: watcher.read_register(g.CCP) == 0)
                self.assertEqual(watcher.read_register(g.SCP) & 0xFFFF, 0)
            if i == 1:
                memory = self.emulator.memory_bytes()
        self.take(self.connect(), 3)
        self.assertLess(self.emulator.memory_bytes() - memory, 4 << 20)


class DriversWords(CameraTest):
    """What drivers set by way of Aravis: a line of their own name, every trigger off, exposure found once."""
    sets = ("outputs.gige.lines=[Line1, Line2]",)

    def acquiring(self, camera):
        stream = camera.create_stream(None, None)
        for _ in range(4):
            stream.push_buffer(Aravis.Buffer.new_allocate(camera.get_payload()))
        camera.start_acquisition()
        return stream

    def test_a_line_of_another_name_is_the_trigger_input(self):
        camera = Aravis.Camera.new(self.address)
        camera.set_trigger("Line1")
        self.assertEqual(camera.get_string("TriggerSource"), "Line1")
        self.assertEqual(camera.get_string("TriggerMode"), "On")
        camera.clear_triggers()
        for selector in ("FrameStart", "FrameBurstStart", "AcquisitionStart"):
            camera.set_string("TriggerSelector", selector)
            camera.set_string("TriggerMode", "Off")
        self.assertEqual(list(camera.dup_available_enumerations_as_strings("LineSelector")), ["Line0", "Line1", "Line2"])
        for line in ("Line0", "Line2"):
            camera.set_string("LineSelector", line)
            camera.set_string("LineMode", "Input")
            self.assertEqual(camera.get_string("LineMode"), "Input")
            self.assertFalse(camera.get_boolean("LineStatus"))

    def test_the_resulting_frame_rate_follows_the_exposure(self):
        camera = Aravis.Camera.new(self.address)
        camera.set_exposure_time_auto(Aravis.Auto.OFF)
        camera.set_frame_rate(5)
        for feature in ("AcquisitionResultingFrameRate", "ResultingFrameRate"):
            camera.set_exposure_time(1000)
            self.assertAlmostEqual(camera.get_float(feature), 5, places=6)
            camera.set_exposure_time(900_000)
            self.assertAlmostEqual(camera.get_float(feature), 1 / 0.9, places=6)
        self.assertEqual(camera.get_frame_rate(), 5)

    def test_exposure_is_found_once(self):
        camera = Aravis.Camera.new(self.address)
        stream = self.acquiring(camera)
        camera.set_exposure_time_auto(Aravis.Auto.ONCE)
        for _ in range(200):
            buffer = stream.timeout_pop_buffer(5_000_000)
            if buffer:
                stream.push_buffer(buffer)
            if camera.get_exposure_time_auto() == Aravis.Auto.OFF:
                break
        self.assertEqual(camera.get_exposure_time_auto(), Aravis.Auto.OFF)
        found_us = camera.get_exposure_time()
        camera.stop_acquisition()
        camera.set_exposure_time(found_us)  # it is the client's again


class Tool(CameraTest):
    def test_the_camera_is_listed_and_its_features_read_and_written(self):
        name = f"hilcam-test-camera-T{self.emulator.port}"
        self.assertIn(f"{name} ({self.address})", run("arv-tool"))
        self.assertIn("<RegisterDescription", run("arv-tool", "-n", name, "genicam"))
        listed = run("arv-tool", "-n", name, "features")
        for feature in ("Width", "ExposureTime", "TriggerSoftware", "ChunkModeActive"):
            self.assertIn(f"'{feature}'", listed)
        self.assertNotIn("Error", run("arv-tool", "-n", name, "values"))
        run("arv-tool", "-n", name, "control", "ExposureTime=222")
        self.assertIn("222", run("arv-tool", "-n", name, "control", "ExposureTime"))


class GStreamer(CameraTest):
    sets = ("outputs.files.folder={folder}/frames", "camera.frame_rate_hz=15")

    def setUp(self):
        if subprocess.run(["gst-inspect-1.0", "aravissrc"], capture_output=True).returncode != 0:
            self.skipTest("GStreamer or its aravissrc is missing (gstreamer1.0-tools, libaravis-0.8-0)")
        super().setUp()

    def test_a_mode_that_another_client_left_is_set_back(self):
        """The lines of docs/interoperability.md."""
        def three_frames(*properties):
            return subprocess.run(["gst-launch-1.0", "-q", "aravissrc", f"camera-name={self.address}", *properties, "num-buffers=3",
                                   "!", "fakesink"], capture_output=True, text=True, timeout=60)
        def control(mode, *words):
            """Once more where a busy machine lets arv-tool give up: it waits for an answer by the clock."""
            def is_done():
                run("arv-tool", "-a", self.address, "control", *words)
                return mode in run("arv-tool", "-a", self.address, "control", "AcquisitionMode")
            self.eventually(f"{' '.join(words)} is taken", is_done)
        for set_back, properties in ((("UserSetSelector=Default", "UserSetLoad"), ()), (("AcquisitionMode=Continuous",), ()),
                                     ((), ("features=AcquisitionMode=Continuous",))):
            control("SingleFrame", "AcquisitionMode=SingleFrame")
            self.assertNotEqual(three_frames().returncode, 0)
            if set_back:
                control("Continuous", *set_back)
            for _ in range(4):  # see pictures()
                result = three_frames(*properties)
                if result.returncode == 0:
                    break
            words = f"{set_back or properties}: {result.stderr}{self.emulator.log()}"
            if result.returncode != 0 and too_busy():
                self.skipTest(f"{too_busy()}: {words}")
            self.assertEqual(result.returncode, 0, words)

    def pictures(self, caps, picture_bytes, number=8, properties=()):
        """So many of aravissrc's pictures, and the words of gst-launch.

        aravissrc gives up when two seconds bring no whole frame, and it hands its memory back to its stream before a
        sink has written it: a busy machine gets another chance, as with Aravis's own acquisitions.
        """
        for _ in range(4):
            with tempfile.TemporaryDirectory() as folder:
                result = subprocess.run(
                    ["gst-launch-1.0", "-e", "-v", "aravissrc", f"camera-name={self.address}", *properties, f"num-buffers={number}",
                     "!", caps, "!", "identity", "silent=false", "!", "filesink", "buffer-mode=unbuffered", f"location={folder}/frames.raw"],
                    capture_output=True, text=True, timeout=60)
                stream = b"".join(file.read_bytes() for file in pathlib.Path(folder).glob("*.raw"))
            if result.returncode == 0 and len(stream) == number * picture_bytes:
                return [stream[i:i + picture_bytes] for i in range(0, len(stream), picture_bytes)]
        words = f"{len(stream)} of {number * picture_bytes} bytes; {result.stdout}{result.stderr}{self.emulator.log()}"
        if too_busy():
            self.skipTest(f"{too_busy()}: {words}")
        self.fail(words)

    def test_frames_are_byte_for_byte_the_files(self):
        """aravissrc's 16-bit and 8-bit pictures against the files output of the same run."""
        files = FrameFiles(self.folder.name + "/frames")
        for caps, name in (("video/x-raw,format=GRAY8", "Mono8"), ("video/x-raw,format=GRAY16_LE", "Mono16")):
            taken = self.pictures(caps, 256 * 192 * (1 if name == "Mono8" else 2))
            time.sleep(0.5)  # the files' thread writes behind the loop
            index = {}
            for frame in files.ids()[:-1]:
                dn = files.dn(frame)
                for form in ("Mono8", "Mono10", "Mono12", "Mono14", "Mono16"):
                    if form == name or (name == "Mono16" and form != "Mono8"):
                        index.setdefault(wire_bytes(dn, 12, form), frame)
            found = [index.get(data) for data in taken]
            self.assertNotIn(None, found, f"{caps}: frames that no file has")
            self.assertEqual(found, sorted(set(found)))

    def test_16_bits_hold_the_numbers_as_the_document_says(self):
        """The table of docs/gstreamer.md: Mono12 as it is, what is asked for without a format in the upper bits."""
        for properties, where in ((("features=PixelFormat=Mono12",), 0x0FFF), ((), 0xFFF0)):
            joined = b"".join(self.pictures("video/x-raw,format=GRAY16_LE", 256 * 192 * 2, 2, properties))
            values = struct.unpack(f"<{len(joined) // 2}H", joined)
            self.assertEqual(functools.reduce(operator.or_, values), where, properties)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *[a for a in sys.argv[2:] if a != "--long"]], verbosity=2)
