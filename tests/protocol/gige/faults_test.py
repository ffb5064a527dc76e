#!/usr/bin/python3
"""Loss, resends and every fault of the stream as a client sees it.

    faults_test.py HILCAM
"""
import socket
import sys
import time
import unittest

import gvcp_client as g
from camera_case import OTHER, CameraTest, StreamTest

CameraTest.hilcam = sys.argv[1]
CameraTest.address = "127.0.23.7"
HEIGHT = 192


class Resend(StreamTest):
    def test_two_percent_lost_and_every_frame_as_in_the_files(self):
        self.chunks_on("FrameID")
        for extended in (False, True):
            with self.subTest(extended=extended):
                self.camera.write_register(g.GVSP_CONFIG, 1 << 30 if extended else 0)
                self.fault("packet_drop", rate=0.02)
                stream = self.streaming(packet_bytes=1000, extended=extended)
                frames = stream.take(40)
                self.stop()
                self.emulator.clear_faults()
                # A frame that waits for its packets may be whole after the next.
                self.assertEqual(sorted(frame.block for frame in frames), list(range(1, 41)))
                for frame in frames:
                    self.same_as_file(frame)
                # 40 frames of 103 packets: 82 lost on average; fewer than 40 has a probability below 1e-6.
                self.assertGreater(stream.statistics["resend_packets"], 40)
                self.assertGreater(sum(frame.resent for frame in frames) + stream.statuses[0x0100], 0)
                self.assertEqual(stream.statistics["incomplete_frames"], 0)
                stream.close()

    def test_what_is_gone_is_said_to_be_gone(self):
        stream = self.streaming(resend=False)
        stream.take(3)
        for block, first, last in ((60000, 0, 5), (60001, 3, 3)):
            self.camera.send(g.command_bytes(g.PACKETRESEND, g.resend_payload(block, first, last), 0, self.camera.new_id()))
        self.eventually("an answer", lambda: any(status & 0x8000 for status in stream.statuses))
        self.assertLessEqual({status for status in stream.statuses if status & 0x8000}, {0x800C, 0x8010, 0x8011, 0x8012})
        self.stop()

    def test_senseless_requests_do_no_harm(self):
        stream = self.streaming()
        frame = stream.take(3)[-1]
        packets = stream.statistics["packets"]
        for first, last, channel in ((5, 2, 0), (0, 0xFFFFFF, 0), (0xFFFFFF, 0xFFFFFF, 0), (0, 3, 7), (70, 0xFFFF, 0)):
            for block in (frame.block, 0, 1, 65535):
                self.camera.send(g.command_bytes(g.PACKETRESEND, g.resend_payload(block, first, last, channel), 0,
                                                 self.camera.new_id()))
        for payload in (b"", bytes(4), bytes(11)):
            self.camera.send(g.command_bytes(g.PACKETRESEND, payload, 0, self.camera.new_id()))
        self.assertTrue(all(f.complete for f in stream.take(5)))
        self.stop()
        # A frame has 69 packets: at most one frame's worth for each request that made sense, and eight frames meanwhile.
        self.assertLess(stream.statistics["packets"] - packets, 69 * (6 + 30))

    def test_only_the_receiver_of_the_stream_may_ask(self):
        stream = self.streaming(resend=False)
        frame = stream.take(3)[-1]
        other = self.client(OTHER)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.bind((OTHER, 0))
            before = stream.statistics["late_packets"]
            stranger.sendto(g.command_bytes(g.PACKETRESEND, g.resend_payload(frame.block, 0, 60), 0, 9), (self.address, g.PORT))
            other.read_register(g.VERSION)  # both are through the camera's queue
            stream.take(2)
            self.assertEqual(stream.statistics["late_packets"], before)
        self.stop()

    def test_older_frames_can_be_had_again(self):
        stream = self.streaming(resend=False)
        frames = stream.take(9)
        # The ring holds at least eight frames.
        before = stream.statistics["late_packets"]
        self.camera.send(g.command_bytes(g.PACKETRESEND, g.resend_payload(frames[-7].block, 1, 10), 0, self.camera.new_id()))
        self.eventually("ten packets again", lambda: stream.statistics["late_packets"] - before >= 10)
        self.stop()


class Faults(StreamTest):
    """Each fault is ordered while the stream runs; the frames after it are looked at."""

    def setUp(self):
        super().setUp()
        self.chunks_on("FrameID", "Timestamp", "ExposureMid", "Faults")

    def faulty_frames(self, count, kind, resend=False, **options):
        self.fault(kind, **options)
        stream = self.streaming(resend=resend)
        frames = stream.take(count)
        self.stop()
        stream.close()
        return frames, stream

    def test_dropped_packets_are_missing(self):
        frames, _ = self.faulty_frames(8, "packet_drop", rate=0.05)
        self.assertTrue(any(frame.missing for frame in frames))
        self.assertLess(sum(len(frame.missing) for frame in frames), 8 * 70 * 0.15)

    def test_duplicates(self):
        frames, stream = self.faulty_frames(3, "packet_duplicate")
        for frame in frames:
            self.same_as_file(frame)
        self.assertGreater(stream.statistics["duplicate_packets"] + stream.statistics["late_packets"], 3 * 60)

    def test_reordered_packets(self):
        frames, stream = self.faulty_frames(4, "packet_reorder", rate=0.3)
        for frame in frames:
            self.same_as_file(frame)
        self.assertGreater(stream.statistics["out_of_order_packets"], 20)

    def test_late_packets(self):
        frames, stream = self.faulty_frames(4, "packet_delay", rate=0.05, value=15, resend=True)
        for frame in frames:
            self.same_as_file(frame)
        self.assertGreater(stream.statistics["out_of_order_packets"] + stream.statistics["late_packets"] +
                           stream.statistics["duplicate_packets"], 0)

    def test_corrupt_packets_have_one_byte_inverted(self):
        frames, _ = self.faulty_frames(3, "packet_corrupt", rate=0.1)
        wrong = 0
        for frame in frames:
            frame_id = frame.chunks and self.frame_id(frame)
            if not frame_id or not self.files.file(frame_id).exists():
                continue  # the chunks themselves were struck
            expected = self.expected(frame_id, "Mono12")
            different = [i for i, (a, b) in enumerate(zip(frame.image, expected)) if a != b]
            self.assertLess(len(different), 25)
            for i in different:
                self.assertEqual(frame.image[i], expected[i] ^ 0xFF)
            wrong += len(different)
        self.assertGreater(wrong, 0)

    def test_wrong_packet_ids(self):
        frames, stream = self.faulty_frames(4, "packet_wrong_id", rate=0.05, value=1000)
        self.assertTrue(any(not frame.complete for frame in frames))

    def test_truncated_packets(self):
        frames, stream = self.faulty_frames(4, "packet_truncate", rate=0.1, value=100)
        self.assertTrue(any(not frame.complete for frame in frames))
        self.assertGreater(stream.statistics["malformed_frames"], 0)

    def test_lost_leaders_and_trailers(self):
        frames, _ = self.faulty_frames(3, "leader_lost")
        self.assertEqual([frame.missing for frame in frames], [[0]] * 3)
        self.emulator.clear_faults()
        frames, _ = self.faulty_frames(3, "trailer_lost")
        self.assertTrue(all(not frame.complete and frame.size_y == 0 and frame.packets >= 67 for frame in frames))
        self.emulator.clear_faults()
        # With resends both come back.
        for kind in ("leader_lost", "trailer_lost"):
            frames, _ = self.faulty_frames(3, kind, resend=True)
            for frame in frames:
                self.same_as_file(frame)
            self.emulator.clear_faults()

    def test_refused_resends(self):
        self.fault("packet_drop", rate=0.05)
        frames, stream = self.faulty_frames(5, "resend_refused", resend=True)
        self.assertTrue(any(frame.unavailable for frame in frames))
        self.assertGreater(stream.statuses[g.PACKET_UNAVAILABLE], 0)

    def test_delayed_resends(self):
        self.fault("packet_drop", rate=0.02)
        frames, stream = self.faulty_frames(5, "resend_delayed", resend=True, value=30)
        for frame in frames:
            self.same_as_file(frame)
        self.assertGreater(stream.statistics["resend_requests"], 0)

    def test_resends_with_a_wrong_id_do_not_fill_the_gap(self):
        self.fault("packet_drop", rate=0.05)
        frames, stream = self.faulty_frames(3, "resend_wrong_id", resend=True, value=2000)
        self.assertTrue(any(not frame.complete for frame in frames))

    def test_a_bandwidth_cap_stretches_frames(self):
        frames, _ = self.faulty_frames(3, "bandwidth_cap", value=1)
        for frame in frames:
            # 98 KiB at 1 MB/s take 98 ms; a sender may be late, never early, but for the first of its packets.
            self.assertGreater(frame.last_ns - frame.first_ns, 60_000_000)

    def test_dropped_frames_leave_a_gap_in_the_ids(self):
        stream = self.streaming()
        first = stream.take(2)[-1]
        self.fault("frame_drop", rate=0.5)
        frames = stream.take(8)
        self.stop()
        blocks = [first.block] + [frame.block for frame in frames]
        self.assertGreater(blocks[-1] - blocks[0], len(blocks) - 1)
        for frame in frames:
            self.same_as_file(frame)
            # An exposure that the loop misses takes a frame id and no block id.
            self.assertLessEqual(frame.block - first.block, self.frame_id(frame) - self.frame_id(first))

    def test_repeated_frames_show_the_picture_before(self):
        stream = self.streaming()
        last = stream.take(3)[-1]
        self.fault("frame_repeat", rate=1, frames=0)
        frames = stream.take(4)
        self.stop()
        self.assertEqual(len({frame.image for frame in frames[2:]}), 1)
        self.assertGreater(frames[-1].block, last.block)

    def test_a_wrong_height_in_the_trailer(self):
        frames, _ = self.faulty_frames(3, "wrong_size_y", value=5)
        self.assertEqual({(frame.height, frame.size_y) for frame in frames}, {(HEIGHT, HEIGHT + 5)})

    def test_time_stamps_jump_drift_and_freeze(self):
        stream = self.streaming()
        before = stream.take(2)[-1]
        self.fault("timestamp_step", value=-5000)
        stream.take(2)
        frame = stream.take(1)[0]
        self.assertLess(frame.timestamp, before.timestamp)
        self.emulator.clear_faults()
        self.fault("timestamp_freeze")
        stream.take(2)
        self.assertEqual(len({frame.timestamp for frame in stream.take(3)}), 1)
        self.emulator.clear_faults()
        self.fault("timestamp_drift", value=500_000)
        stream.take(2)
        frames = stream.take(10)
        self.stop()
        mids = [self.feature.chunk_values(frame)["ChunkExposureMid"] for frame in (frames[0], frames[-1])]
        ratio = (frames[-1].timestamp - frames[0].timestamp) / (mids[1] - mids[0])
        self.assertAlmostEqual(ratio, 1.5, delta=0.01)

    def test_faults_of_the_picture_are_told_in_its_chunk(self):
        stream = self.streaming()
        self.assertEqual(self.feature.chunk_values(stream.take(2)[-1])["ChunkFaults"], 0)
        bits = set()
        for kind, check in (("image_black", lambda image: not any(image)),
                            ("image_saturated", lambda image: set(image[0::2]) == {0xFF} and set(image[1::2]) == {0x0F})):
            self.fault(kind)
            self.eventually(kind, lambda: check((frame := stream.take(1)[0]).image) and
                            bits.add(self.feature.chunk_values(frame)["ChunkFaults"]) is None)
            self.emulator.clear_faults()
        self.stop()
        self.assertEqual(len(bits), 2)
        self.assertTrue(all(value and value & (value - 1) == 0 for value in bits), bits)

    def test_the_stream_goes_on_after_every_fault(self):
        stream = self.streaming()
        for kind in ("packet_drop", "packet_duplicate", "packet_reorder", "packet_delay", "packet_corrupt", "packet_wrong_id",
                     "packet_truncate", "leader_lost", "trailer_lost", "resend_delayed", "resend_wrong_id", "wrong_size_y",
                     "timestamp_step", "block_id_wrap", "link_down"):
            values = {"packet_delay": 3, "packet_wrong_id": 7, "packet_truncate": 9, "resend_delayed": 3, "resend_wrong_id": 2,
                      "wrong_size_y": 1, "timestamp_step": 10}
            self.fault(kind, rate=0.2, duration_s=0.1, **({"value": values[kind]} if kind in values else {}))
        self.emulator.clear_faults()
        time.sleep(0.5)
        stream.forget()
        stream.take(2)
        for frame in stream.take(3):
            self.same_as_file(frame)
        self.stop()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
