#!/usr/bin/python3
"""Events and actions: what the camera says by itself, and what is said to all cameras at once.

    signals_test.py HILCAM
"""
import collections
import struct
import sys
import time
import unittest

import gvcp_client as g
from camera_case import CLIENT, OTHER, CameraTest
from genicam_client import Features
from gvsp_client import StreamReceiver

CameraTest.hilcam = sys.argv[1]
CameraTest.address = "127.0.23.15"
ACTION_LATE = 0x8016


class Events(CameraTest):
    def listen(self, client, *names, **options):
        features = Features(client)
        for name in names:
            features.set("EventSelector", name)
            features.set("EventNotification", "On")
        return features, g.MessageChannel(client, CLIENT, **options)

    def off(self, features, *names):
        for name in names:
            features.set("EventSelector", name)
            features.set("EventNotification", "Off")

    def event_ids(self, features):
        """Event's name -> id, from the description's EventID ports."""
        return {name: int(features.text(name, "EventID"), 16) for name, kind in features.kinds.items()
                if kind == "Port" and features.text(name, "EventID")}

    def test_exposures_are_told_in_order(self):
        client = self.controller()
        self.assertEqual(client.read_register(g.MESSAGE_CHANNELS), 1)
        self.assertTrue(client.read_register(g.CAPABILITY) >> 3 & 1, "EVENT is a capability")
        features, messages = self.listen(client, "ExposureStart", "ExposureEnd")
        with messages:
            events = []
            while len(events) < 12:
                received = messages.receive(5)
                self.assertTrue(received, f"{len(events)} events came")
                events += received
            messages.close()
        self.off(features, "ExposureStart", "ExposureEnd")
        kinds = collections.Counter(event.id for event in events)
        self.assertEqual(len(kinds), 2)
        self.assertTrue(all(kind >= 0x9000 for kind in kinds), "device-specific ids")
        self.assertLessEqual(abs(kinds.most_common()[0][1] - 6), 1)
        for kind in kinds:
            times = [event.timestamp for event in events if event.id == kind]
            self.assertEqual(times, sorted(set(times)))
        self.assertLessEqual(abs(events[-1].timestamp - client.timestamp_ns()), 10_000_000_000, "the camera's clock")
        self.assertEqual(len({event.request_id for event in events if event.acknowledge}),
                         len([event for event in events if event.acknowledge]))

    def test_the_end_of_an_exposure_names_its_block(self):
        client = self.controller()
        features, messages = self.listen(client, "ExposureEnd")
        exposure_ns = features.get("ExposureTime") * 1000
        with messages, StreamReceiver(client, CLIENT) as stream:
            stream.open()
            features.execute("AcquisitionStart")
            frames, events = stream.take(6), []
            features.execute("AcquisitionStop")
            while max((event.block for event in events), default=0) < frames[-1].block:
                received = messages.receive(5)
                self.assertTrue(received, f"{len(events)} events came")
                events += received
            messages.close()
        self.off(features, "ExposureEnd")
        ends = {event.block: event for event in events if event.block}
        for frame in frames:
            self.assertIn(frame.block, ends)
            self.assertEqual(ends[frame.block].channel, 0)
            # A frame's time stamp is the middle of its exposure.
            self.assertAlmostEqual(ends[frame.block].timestamp - frame.timestamp, exposure_ns / 2, delta=2)

    def test_an_event_without_an_answer_is_sent_again(self):
        client = self.controller()
        client.write_registers((g.MCTT, 100), (g.MCRC, 2))
        features, messages = self.listen(client, "ExposureStart", deaf=10_000)
        with messages:
            seen = collections.Counter()
            for _ in range(40):
                for event in messages.receive(5):
                    self.assertTrue(event.acknowledge, "with a retry count the camera asks for answers")
                    seen[event.request_id, event.timestamp] += 1
                if max(seen.values(), default=0) == 3:
                    break
            self.assertEqual(max(seen.values()), 3, "once and two retries")
            messages.close()
        self.off(features, "ExposureStart")
        client.write_registers((g.MCTT, 0), (g.MCRC, 0))

    def test_an_event_with_an_answer_is_sent_once(self):
        client = self.controller()
        client.write_registers((g.MCTT, 1000), (g.MCRC, 2))
        features, messages = self.listen(client, "ExposureStart")
        with messages:
            seen = collections.Counter()
            until = time.monotonic() + 20
            while len(seen) < 40:  # more than one a second, which is what comes when each waits for its retries
                self.assertLess(time.monotonic(), until, f"{len(seen)} events")
                seen.update(event.request_id for event in messages.receive(5))
            messages.close()
        self.off(features, "ExposureStart")
        client.write_registers((g.MCTT, 0), (g.MCRC, 0))
        self.assertLess(sum(seen.values()), 60, "hardly any twice")

    def test_no_channel_no_events(self):
        client = self.controller()
        features, messages = self.listen(client, "ExposureStart")
        with messages:
            self.assertTrue(messages.receive(5))
            client.write_register(g.MCP, 0)
            while messages.receive(0.2):
                pass
            self.assertEqual(messages.receive(0.3), [])
        self.off(features, "ExposureStart")

    def test_a_missed_trigger_is_told(self):
        client = self.controller()
        features, messages = self.listen(client, "FrameTriggerMissed")
        with messages, StreamReceiver(client, CLIENT) as stream:
            stream.open()
            features.set("TriggerSelector", "FrameStart")
            features.set("TriggerMode", "On")
            features.set("TriggerSource", "Software")
            features.execute("AcquisitionStart")
            for _ in range(10):
                features.execute("TriggerSoftware")  # faster than the camera can
            self.assertTrue(messages.receive(5), "no event of a missed trigger")
            features.execute("AcquisitionStop")
            features.set("TriggerMode", "Off")
            messages.close()
        self.off(features, "FrameTriggerMissed")


class AcquisitionTriggers(CameraTest):
    def test_a_stream_waits_for_one_trigger_and_then_runs_by_itself(self):
        client = self.controller()
        features = Features(client)
        features.set("TriggerSelector", "AcquisitionStart")
        features.set("TriggerSource", "Software")
        features.set("TriggerMode", "On")
        with StreamReceiver(client, CLIENT) as stream:
            stream.open()
            for _ in range(2):  # and the next acquisition waits again
                features.execute("AcquisitionStart")
                self.assertIsNone(stream.next_frame(0.5), "a frame before the trigger")
                features.execute("TriggerSoftware")
                for _ in range(5):
                    self.assertIsNotNone(stream.next_frame(5))
                features.execute("AcquisitionStop")
                while stream.next_frame(0.3):
                    pass
        features.set("TriggerMode", "Off")
        features.set("TriggerSelector", "FrameStart")


class Actions(CameraTest):
    DEVICE, GROUP, MASK = 0x1234ABCD, 0x00000011, 0x0000000F

    def armed(self):
        client = self.controller()
        self.assertTrue(client.read_register(g.CAPABILITY) >> 6 & 1, "ACTION is a capability")
        self.assertGreaterEqual(client.read_register(g.ACTION_SIGNALS), 1)
        client.write_registers((g.ACTION_DEVICE_KEY, self.DEVICE), (g.ACTION_GROUP_KEY, self.GROUP),
                               (g.ACTION_GROUP_MASK, self.MASK))
        features = Features(client)
        features.set("TriggerSelector", "FrameStart")
        features.set("TriggerSource", "Action1")
        features.set("TriggerMode", "On")
        stream = StreamReceiver(client, CLIENT).open()
        features.execute("AcquisitionStart")
        while stream.next_frame(0.3):
            pass
        return client, features, stream

    def disarm(self, features, stream):
        features.execute("AcquisitionStop")
        features.set("TriggerMode", "Off")
        features.set("TriggerSource", "Software")
        stream.close()

    def test_an_action_takes_a_frame_and_only_with_the_right_keys(self):
        client, features, stream = self.armed()
        other = self.client(OTHER)
        for keys in ((self.DEVICE + 1, self.GROUP, self.MASK), (self.DEVICE, self.GROUP + 1, self.MASK),
                     (self.DEVICE, self.GROUP, 0xF0), (self.DEVICE, self.GROUP, 0)):
            other.send(g.command_bytes(g.ACTION, g.action_payload(*keys), request_id=other.new_id()))
            received = other.receive(0.2)
            if received is not None:
                self.assertNotEqual(g.Answer.of(received).status, g.SUCCESS)
        self.assertIsNone(stream.next_frame(0.5), "a frame for an action that was not ours")
        answer = other.exchange(g.ACTION, g.action_payload(self.DEVICE, self.GROUP, 0x1))
        self.assertEqual(answer.status, g.SUCCESS)
        self.assertTrue(stream.next_frame(5).complete)
        self.assertIsNone(stream.next_frame(0.5), "one action, one frame")
        # Sent to everyone, without an answer.
        g.to_everyone("127.0.0.1", g.ACTION, g.action_payload(self.DEVICE, self.GROUP, self.MASK), flags=0, request_id=7,
                      wait_s=0.05)
        self.assertTrue(stream.next_frame(5).complete)
        self.disarm(features, stream)

    def test_a_repeated_action_is_one_action(self):
        client, features, stream = self.armed()
        other = self.client(OTHER)
        for _ in range(3):
            self.assertEqual(other.exchange(g.ACTION, g.action_payload(self.DEVICE, self.GROUP, self.MASK),
                                            request_id=99).status, g.SUCCESS)
            time.sleep(0.2)
        self.assertTrue(stream.next_frame(5).complete)
        self.assertIsNone(stream.next_frame(0.5))
        self.disarm(features, stream)

    def test_a_repeated_software_trigger_is_one_trigger(self):
        client, features, stream = self.armed()
        features.set("TriggerSource", "Software")
        address, _ = features.register_of("TriggerSoftware")
        for _ in range(3):
            answer = client.exchange(g.WRITEMEM, struct.pack(">II", address, 1), request_id=4242)
            self.assertEqual(answer.status, g.SUCCESS)
            time.sleep(0.2)
        self.assertTrue(stream.next_frame(5).complete)
        self.assertIsNone(stream.next_frame(0.5))
        self.disarm(features, stream)

    def test_a_scheduled_action_waits_for_its_time(self):
        client, features, stream = self.armed()
        self.assertTrue(client.read_register(g.CAPABILITY) >> 17 & 1, "scheduled ACTION is a capability")
        payload = lambda at: g.action_payload(self.DEVICE, self.GROUP, self.MASK, at)
        flags = g.ACKNOWLEDGE | g.SCHEDULED
        at = client.timestamp_ns() + 1_000_000_000
        self.assertEqual(client.exchange(g.ACTION, payload(at), flags).status, g.SUCCESS)
        frame = stream.next_frame(10)
        self.assertGreaterEqual(frame.timestamp, at)
        client.write_register(g.GVCP_CONFIG, 1 << 18 | 1 << 2)  # status codes of GigE Vision 1.1 and 2.0
        late = client.exchange(g.ACTION, payload(at), flags)
        client.write_register(g.GVCP_CONFIG, 0)
        self.assertEqual(late.status, ACTION_LATE)
        self.disarm(features, stream)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
