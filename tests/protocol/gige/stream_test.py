#!/usr/bin/python3
"""The camera's stream, with a receiver of its own (gvsp_client.py), byte for byte against the files output of the same run.

    stream_test.py HILCAM
"""
import pathlib
import subprocess
import sys
import unittest

import gvcp_client as g
from camera_case import CLIENT, OTHER, CameraTest, StreamTest
from genicam_client import Features
from gvsp_client import StreamReceiver
from hilcam_client import FrameReport, Pose, Subscribe

CameraTest.hilcam = sys.argv[1]
CameraTest.address = "127.0.23.4"


class Formats(StreamTest):
    def each_format(self, formats):
        for name in formats:
            with self.subTest(format=name):
                self.feature.set("PixelFormat", name)
                self.chunks_on("FrameID")
                stream = self.streaming()
                for frame in stream.take(2):
                    self.assertEqual(frame.pixel_format, self.feature.entries("PixelFormat")[name])
                    self.same_as_file(frame, name)
                    self.assertEqual(len(frame.data), self.feature.get("PayloadSize"))
                self.stop()
                stream.close()

    def test_they_are_those_of_the_document(self):
        self.assertEqual(set(self.feature.entries("PixelFormat")), {
            "Mono8", "Mono10", "Mono12", "Mono14", "Mono16", "Mono10Packed", "Mono12Packed", "Mono10p",
            "Mono12p", "RGB8"})

    def test_every_monochrome_format_is_byte_for_byte_the_file(self):
        formats = [name for name in self.feature.entries("PixelFormat") if name.startswith("Mono")]
        for name in ("Mono8", "Mono10", "Mono12", "Mono14", "Mono16", "Mono10Packed", "Mono12Packed"):
            self.assertIn(name, formats)
        self.each_format(formats)

    def test_rgb_of_a_camera_without_colours_is_grey(self):
        self.feature.set("PixelFormat", "RGB8")
        self.chunks_on("FrameID")
        stream = self.streaming()
        frame = stream.take(2)[1]
        grey = self.expected(self.frame_id(frame), "Mono8")
        self.assertEqual([frame.image[i::3] for i in range(3)], [grey] * 3)
        self.stop()

    def test_windows_of_odd_sizes(self):
        self.chunks_on("FrameID")
        for name, (x, y, w, h) in (("Mono12", (3, 5, 101, 67)), ("Mono8", (155, 91, 101, 101)), ("Mono8", (0, 0, 1, 1))):
            with self.subTest(window=(x, y, w, h)):
                self.feature.set("PixelFormat", name)
                for feature, value in (("OffsetX", 0), ("OffsetY", 0), ("Width", w), ("Height", h), ("OffsetX", x),
                                       ("OffsetY", y)):
                    self.feature.set(feature, value)
                stream = self.streaming()
                frame = stream.take(2)[1]
                self.assertEqual((frame.offset_x, frame.offset_y, frame.width, frame.height, frame.size_y), (x, y, w, h, h))
                self.same_as_file(frame, name, (x, y, w, h))
                self.stop()
                stream.close()


class Colour(StreamTest):
    """The same through a colour filter array."""
    sets = ("camera.color_filter={{pattern: RG GB, filters: [{{name: R, transmission: [[0.4, 0.1], [0.9, 0.9]]}}, "
            "{{name: G, transmission: [[0.4, 0.5], [0.9, 0.5]]}}, {{name: B, transmission: [[0.4, 0.9], [0.9, 0.1]]}}]}}",)

    def test_formats_and_features_are_those_of_the_document(self):
        self.assertEqual(set(self.feature.entries("PixelFormat")), {
            "BayerRG8", "BayerRG10", "BayerRG12", "BayerRG12Packed", "BayerRG16", "RGB8", "YUV422_8"})
        for name in ("ReverseX", "ReverseY"):
            self.assertNotIn(name, self.feature)

    def test_every_mosaic_format_is_byte_for_byte_the_file(self):
        formats = [name for name in self.feature.entries("PixelFormat") if name.startswith("Bayer")]
        for name in ("BayerRG8", "BayerRG10", "BayerRG12", "BayerRG12Packed", "BayerRG16"):
            self.assertIn(name, formats)
        Formats.each_format(self, formats)

    def test_rgb_keeps_the_samples_that_are_there(self):
        import numpy
        self.feature.set("PixelFormat", "RGB8")
        self.chunks_on("FrameID")
        stream = self.streaming()
        frame = stream.take(2)[1]
        self.stop()
        raw = numpy.frombuffer(self.expected(self.frame_id(frame), "BayerRG8"), numpy.uint8).reshape(192, 256)
        rgb = numpy.frombuffer(frame.image, numpy.uint8).reshape(192, 256, 3)
        for (y, x), colour in {(0, 0): 0, (0, 1): 1, (1, 0): 1, (1, 1): 2}.items():
            # 12 bits are interpolated and then cut to 8: a sample that is there stays.
            self.assertTrue((rgb[y::2, x::2, colour] == raw[y::2, x::2]).all())


class Ids(StreamTest):
    def test_block_ids_follow_one_another(self):
        self.chunks_on("FrameID")
        for extended in (False, True):
            self.camera.write_register(g.GVSP_CONFIG, 1 << 30 if extended else 0)
            stream = self.streaming(extended=extended)
            frames = stream.take(8)
            self.assertEqual({frame.extended for frame in frames}, {extended})
            self.assertEqual([frame.block for frame in frames], list(range(frames[0].block, frames[0].block + 8)))
            for frame in frames:
                self.same_as_file(frame)
            times = [frame.timestamp for frame in frames]
            self.assertEqual(times, sorted(set(times)))
            self.stop()
            stream.close()

    def test_block_ids_wrap_and_are_never_0(self):
        self.fault("block_id_wrap")
        stream = self.streaming()
        blocks = [frame.block for frame in stream.take(10)]
        self.assertIn(65535, blocks)
        place = blocks.index(65535)
        self.assertEqual(blocks[place:place + 3], [65535, 1, 2])
        self.stop()
        stream.close()
        self.emulator.clear_faults()
        self.camera.write_register(g.GVSP_CONFIG, 1 << 30)
        self.fault("block_id_wrap")
        stream = self.streaming(extended=True)
        blocks = [frame.block for frame in stream.take(10)]
        self.assertIn(65536, blocks)
        self.stop()

    def test_single_and_counted_acquisitions_end_by_themselves(self):
        for mode, count in (("SingleFrame", 1), ("MultiFrame", 5)):
            self.feature.set("AcquisitionMode", mode)
            self.feature.set("AcquisitionFrameCount", 5)
            for _ in range(2):
                stream = self.streaming()
                stream.take(count)
                self.assertIsNone(stream.next_frame(0.4))
                self.assertEqual(self.feature.get("TLParamsLocked"), 0)
                stream.close()
        self.feature.set("AcquisitionMode", "Continuous")

    def test_a_group_of_listeners(self):
        group = "239.255.23.4"
        self.chunks_on("FrameID")
        first = StreamReceiver(self.camera, CLIENT, group=group, port=15249)
        second = StreamReceiver(self.camera, OTHER, group=group, port=15249, resend=False)
        self.addCleanup(first.close)
        self.addCleanup(second.close)
        first.open(1500)
        self.feature.execute("AcquisitionStart")
        for stream in (first, second):
            for frame in stream.take(3):
                self.same_as_file(frame)
        self.stop()

    def test_a_delay_between_packets_is_kept(self):
        ticks = 1_000_000  # of 1 ns
        self.camera.write_register(g.SCPD, ticks)
        stream = self.streaming()
        frame = stream.take(2)[1]
        # Sleeps are never shorter; a receiver's clock readings may lie closer by a scheduling delay at the start.
        self.assertGreater(frame.last_ns - frame.first_ns, frame.packets * ticks // 2)
        self.stop()
        self.camera.write_register(g.SCPD, 0)


class Multipart(StreamTest):
    sets = ("outputs.gige.multipart=true",)

    def test_an_image_its_confidence_and_its_chunks(self):
        self.chunks_on("FrameID")
        self.feature.set("PixelFormat", "Mono12")
        for confidence in (False, True):
            with self.subTest(confidence=confidence):
                self.feature.set("ComponentSelector", "Confidence")
                self.feature.set("ComponentEnable", confidence)
                self.camera.write_registers((g.SCCFG, 1 << 6))
                stream = self.streaming()
                frame = stream.take(2)[1]
                self.stop()
                self.assertTrue(frame.complete, stream.statistics)
                self.assertTrue(frame.extended)
                self.assertEqual(frame.payload_type, 0x400A)
                self.assertEqual([part.type for part in frame.parts], [1, 9, 0x0A] if confidence else [1, 0x0A])
                self.assertEqual(len(frame.data), self.feature.get("PayloadSize"))
                self.same_as_file(frame)
                if confidence:
                    self.assertEqual((frame.parts[1].pixel_format, frame.parts[1].purpose),
                                     (0x010800C6, self.feature.get("ComponentIDValue")))
                    dn = self.files.dn(self.frame_id(frame))
                    self.assertEqual(frame.parts[1].data, bytes(255 * (0 < v < 4095) for v in dn.flatten()))
                stream.close()


class Chunks(StreamTest):
    def test_every_chunk_says_what_is_true(self):
        self.feature.set("Width", 128)
        self.feature.set("OffsetX", 16)
        self.feature.set("ExposureTime", 432.0)
        self.feature.set("Gain", 3.0)
        self.chunks_on()
        stream = self.streaming()
        self.camera.drain()
        frames = stream.take(6)
        self.stop()
        last_id = None
        for frame in frames[1:]:
            self.assertTrue(frame.complete)
            self.assertEqual(frame.payload_type, 0x4001)
            self.assertEqual(frame.chunk_bytes, len(frame.data))
            self.assertEqual(len(frame.data), self.feature.get("PayloadSize"))
            values = self.feature.chunk_values(frame)
            self.assertEqual((values["ChunkWidth"], values["ChunkHeight"], values["ChunkOffsetX"], values["ChunkOffsetY"]),
                             (128, 192, 16, 0))
            self.assertEqual(values["ChunkPixelFormat"], frame.pixel_format)
            self.assertEqual(values["ChunkTimestamp"], frame.timestamp)
            self.assertAlmostEqual(values["ChunkExposureTime"], 432.0)
            self.assertAlmostEqual(values["ChunkGain"], 3.0)
            self.assertAlmostEqual(values["ChunkBlackLevel"], self.feature.get("BlackLevel"))
            self.same_as_file(frame, window=(16, 0, 128, 192))
            if last_id is not None:
                self.assertGreater(values["ChunkFrameID"], last_id)
            last_id = values["ChunkFrameID"]

    def test_each_chunk_alone_and_none(self):
        entries = [name for name in self.feature.entries("ChunkSelector") if name != "Image"]
        self.assertGreaterEqual(len(entries), 15)
        for name in entries:
            self.chunks_on(name)
            stream = self.streaming()
            frame = stream.take(1)[0]
            self.assertTrue(frame.complete, name)
            self.assertEqual(len(frame.chunks), 2, f"the image and {name}")
            self.assertEqual(len(frame.data), self.feature.get("PayloadSize"))
            self.stop()
            stream.close()
        self.feature.set("ChunkModeActive", False)
        stream = self.streaming()
        frame = stream.take(1)[0]
        self.assertEqual((frame.payload_type, len(frame.data)), (1, 256 * 192 * 2))
        self.stop()

    def test_a_frames_number_is_the_runs_and_its_block_the_streams(self):
        self.chunks_on("FrameID")
        numbers = []
        for _ in range(2):
            stream = self.streaming()
            frames = stream.take(3)
            self.stop()
            stream.close()
            self.assertEqual([frame.block for frame in frames], [1, 2, 3])
            numbers += [self.frame_id(frame) for frame in frames]
        self.assertEqual(numbers, sorted(set(numbers)))
        self.same_as_file(frames[-1])  # which goes by the same number

    def test_chunks_say_what_the_frames_report_says(self):
        self.chunks_on()
        with self.emulator.client() as sender:
            sender.send(Subscribe(frame_reports=True), tries=5)
            tag_ns = sender.clock(1).reading.departure_tai_ns
            sender.send(Pose(time_tai_ns=tag_ns, position_m=(22.0, 15, 7)), tries=5)
            stream = self.streaming()
            frames = [self.feature.chunk_values(frame) for frame in stream.take(5)]
            self.stop()
            reports = {}
            while frames[-1]["ChunkFrameID"] not in reports:
                report = sender.receive(10)
                self.assertIsNotNone(report)
                if isinstance(report, FrameReport):
                    reports[report.frame] = report
        for values in frames:
            report = reports[values["ChunkFrameID"]]
            self.assertEqual((values["ChunkExposureMid"], values["ChunkTimestamp"]),
                             (report.exposure_mid_tai_ns, report.exposure_mid_monotonic_ns))
            self.assertEqual((values["ChunkPoseSequence"], values["ChunkPoseTime"]),
                             (report.pose_sequence, report.pose_time_tai_ns))
            self.assertEqual(values["ChunkTriggerSequence"], report.trigger_sequence)
            self.assertAlmostEqual(values["ChunkExposureTime"], report.exposure_s * 1e6)
            self.assertEqual(values["ChunkFaults"], report.faults)
        self.assertEqual(frames[-1]["ChunkPoseTime"], tag_ns)

    def test_a_frame_says_which_pose_it_shows(self):
        self.chunks_on()
        stream = self.streaming()
        stream.take(2)
        with self.emulator.client() as sender:
            sender.sequence = 77_001
            shown = []
            for turn in range(10):
                # Looking along +x of the world, away from the target: a quarter turn about +y.
                sequence = sender.post(Pose(position_m=(22.0 + turn, 15, 7), attitude_wxyz=(0.5**0.5, 0, 0.5**0.5, 0)))
                values = self.feature.chunk_values(stream.take(1)[0])
                shown.append((values["ChunkPoseSequence"], values["ChunkPoseTime"], values["ChunkExposureMid"]))
            self.eventually("the last pose is shown", lambda: self.feature.chunk_values(
                stream.take(1)[0])["ChunkPoseSequence"] == sequence)
        self.stop()
        numbers = [number for number, _, _ in shown if number > 77_000]
        self.assertEqual(numbers, sorted(numbers))
        self.assertGreater(len(set(numbers)), 3)
        times = [mid for _, _, mid in shown]
        self.assertEqual(times, sorted(set(times)))
        for number, tag, mid in shown:
            if number > 77_000:
                self.assertLess(abs(mid - tag), 3_600_000_000_000)


# Asks for whole blocks of the stream again and again, from a socket that has neither control nor the stream.
STORM = """
import socket, sys, time
import gvcp_client as g
camera, here = sys.argv[1:]
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
    stranger.bind((here, 0))
    while True:
        for block in range(1, 100):
            stranger.sendto(g.command_bytes(g.PACKETRESEND, g.resend_payload(block, 0, 0xFFFFFF), 0, 1 + block), (camera, g.PORT))
        time.sleep(0.01)
"""


class Storm(CameraTest):
    """Another program of the client's machine asks for packets again."""
    sets = ("camera.frame_rate_hz=15",)

    def test_the_client_gets_what_it_asks_for_and_nothing_else(self):
        camera = self.controller()
        features = Features(camera)
        storm = subprocess.Popen([sys.executable, "-c", STORM, self.address, CLIENT], cwd=pathlib.Path(__file__).parent)
        try:
            with StreamReceiver(camera, CLIENT) as stream:
                stream.open(1500)
                features.execute("AcquisitionStart")
                frames = stream.take(60)
                features.execute("AcquisitionStop")
                asked = stream.statistics["resend_packets"]
        finally:
            storm.kill()
            storm.wait()
        self.assertTrue(all(frame.complete for frame in frames))
        self.assertEqual([frame.block for frame in frames], list(range(1, 61)))
        self.assertLessEqual(features.get("StatisticsPacketsResent"), asked)


class Lockstep(CameraTest):
    """Frames as fast as they are made, over a link that is slower."""
    sets = ("mode=lockstep", "outputs.gige.rate_limit_mb_s=1")

    def test_no_frame_is_lost_to_a_slow_link(self):
        camera = self.controller()
        features = Features(camera)
        with StreamReceiver(camera, CLIENT) as stream:
            stream.open(1500)
            features.execute("AcquisitionStart")
            self.emulator.expose(12)
            frames = stream.take(12)
            features.execute("AcquisitionStop")
        self.assertEqual([frame.block for frame in frames], list(range(1, 13)))
        self.assertTrue(all(frame.complete for frame in frames))

    def test_frames_that_nobody_takes_are_not_waited_for(self):
        before = self.emulator.frames()
        self.emulator.expose(30)
        self.eventually("frames without a client", lambda: self.emulator.frames() >= before + 30)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
