#!/usr/bin/python3
"""What the camera does beyond registers: its description, locks, user sets, test packets, events, actions, FORCEIP,
PENDING_ACK, faults of the control channel.

    device_test.py HILCAM
"""
import collections
import socket
import struct
import sys
import time
import unittest

import gvcp_client as g
from camera_case import CLIENT, OTHER, CameraTest
from genicam_client import Features
from gvsp_client import StreamReceiver

CameraTest.hilcam = sys.argv[1]
CameraTest.address = "127.0.23.2"
LOCKED = (g.WRITE_PROTECT, g.ACCESS_DENIED, g.BUSY)
NO_REFERENCE_TIME, ACTION_LATE = 0x8013, 0x8016


class Description(CameraTest):
    # Features that clients rely on: SFNC names, mandatory ones first.
    NEEDED = """Width Height PixelFormat PayloadSize AcquisitionMode AcquisitionStart AcquisitionStop
        DeviceVendorName DeviceModelName DeviceVersion DeviceFirmwareVersion DeviceSerialNumber DeviceUserID DeviceManufacturerInfo
        SensorWidth SensorHeight WidthMax HeightMax OffsetX OffsetY BinningHorizontal BinningVertical ReverseX ReverseY
        TestPattern ExposureMode ExposureTime ExposureAuto Gain BlackLevel AcquisitionFrameRate AcquisitionFrameRateEnable
        AcquisitionFrameCount AcquisitionBurstFrameCount TriggerSelector TriggerMode TriggerSource TriggerSoftware
        TriggerActivation TriggerDelay GevSCPSPacketSize GevSCPSFireTestPacket GevSCPSDoNotFragment GevSCPD
        GevTimestampTickFrequency GevTimestampValue GevTimestampControlLatch GevTimestampControlReset GevHeartbeatTimeout
        GevCCP GevMACAddress GevCurrentIPAddress GevStreamChannelCount TLParamsLocked DeviceReset DeviceTemperature
        ChunkModeActive ChunkSelector ChunkEnable ChunkFrameID ChunkTimestamp ChunkExposureTime ChunkGain ChunkWidth
        ChunkHeight ChunkOffsetX ChunkOffsetY ChunkPixelFormat EventSelector EventNotification UserSetSelector UserSetLoad
        UserSetSave UserSetDefault PtpEnable PtpStatus ActionDeviceKey ActionGroupKey ActionGroupMask""".split()

    def test_the_url_has_the_form_that_clients_read(self):
        client = self.client()
        self.assertRegex(client.read_text(g.URL_0, 512), r"^Local:///[^;\s/]+\.(xml|zip);[0-9A-Fa-f]+;[0-9A-Fa-f]+$")

    def test_both_urls_give_the_same_description(self):
        client = self.client()
        first, second = client.description(g.URL_0), client.description(g.URL_1)
        self.assertEqual(first[0], second[0])
        self.assertIn(".zip", (first[1] + second[1]).lower())

    def test_the_features_that_clients_rely_on_are_there(self):
        features = Features(self.client())
        self.assertEqual([name for name in self.NEEDED if name not in features], [])

    def test_every_feature_that_says_it_can_be_read_can(self):
        features = Features(self.client())
        chunks = set(features.chunk_ids())
        failed = {}
        for name, kind in features.kinds.items():
            if kind not in ("Integer", "Float", "Boolean", "Enumeration", "StringReg", "IntReg", "MaskedIntReg", "FloatReg",
                            "IntSwissKnife", "SwissKnife", "Converter", "IntConverter") or name in chunks:
                continue
            node = name
            while features.text(node, "pValue"):
                node = features.text(node, "pValue")
            if features.text(node, "AccessMode") == "WO" or features.text(node, "pPort", "Device") != "Device":
                continue
            try:
                value = features.get(name)
                low, high = features.limit(name, "Min"), features.limit(name, "Max")
                if kind in ("Integer", "Float") and low is not None and high is not None:
                    self.assertTrue(low <= value <= high, f"{name} is {value}, not {low} to {high}")
                if kind == "Enumeration":
                    self.assertIn(value, features.entries(name), name)
            except g.Refused as error:
                failed[name] = str(error)
        self.assertEqual(failed, {})

    def test_links_between_nodes_lead_somewhere(self):
        features = Features(self.client())
        for name, element in features.nodes.items():
            for child in element:
                tag = child.tag.split("}")[-1]
                if tag.startswith("p") and tag[1:2].isupper():
                    self.assertIn(child.text, features.nodes, f"{tag} of {name}")

    def test_categories_hold_every_feature_once(self):
        features = Features(self.client())
        listed = collections.Counter(text for name, kind in features.kinds.items() if kind == "Category"
                                     for text in features.texts(name, "pFeature"))
        self.assertEqual([name for name, count in listed.items() if count != 1], [])
        reached, ahead = set(), ["Root"]
        while ahead:
            name = ahead.pop()
            reached.add(name)
            if features.kinds[name] == "Category":
                ahead += features.texts(name, "pFeature")
        self.assertEqual([name for name in self.NEEDED if name not in reached], [])


class Settings(CameraTest):
    def test_geometry_is_locked_while_streaming(self):
        client = self.controller()
        features = Features(client)
        with StreamReceiver(client, CLIENT) as stream:
            stream.open()
            features.execute("AcquisitionStart")
            stream.take(1)
            self.assertEqual(features.get("TLParamsLocked"), 1)
            for name, value in (("Width", 128), ("Height", 64), ("OffsetX", 8), ("OffsetY", 8), ("PixelFormat", "Mono8"),
                                ("ChunkModeActive", True)):
                self.refused(LOCKED, features.set, name, value)
            features.set("ExposureTime", 300.0)  # but exposure is not
            features.execute("AcquisitionStop")
            self.assertEqual(features.get("TLParamsLocked"), 0)
            features.set("Width", 128)
            features.set("Width", features.get("WidthMax"))

    def test_a_window_stays_on_the_sensor(self):
        features = self.features()
        width = features.get("WidthMax")
        features.set("Width", 128)
        features.set("OffsetX", width - 128)
        self.refused(g.INVALID_PARAMETER, features.set, "Width", width)
        self.assertEqual((features.get("Width"), features.get("OffsetX")), (128, width - 128))
        self.assertEqual(features.limit("Width", "Max"), 128)
        features.set("OffsetX", 0)
        features.set("Width", width)
        self.assertEqual(features.limit("OffsetX", "Max"), 0)
        self.assertEqual(features.get("PayloadSize"), width * features.get("Height") * 2)

    def test_values_outside_their_limits_change_nothing(self):
        features = self.features()
        for name in ("ExposureTime", "Gain", "BlackLevel", "AcquisitionFrameRate", "TriggerDelay"):
            before = features.get(name)
            high = features.limit(name, "Max")
            for value in (high * 2 + 1, float("nan"), float("inf")):
                self.refused(g.INVALID_PARAMETER, features.set, name, value)
                self.assertEqual(features.get(name), before, name)
        self.refused(g.INVALID_PARAMETER, features.set, "PixelFormat", 0x01234567)
        self.refused(g.INVALID_PARAMETER, features.set, "AcquisitionMode", 77)

    def test_user_sets_keep_what_was_saved(self):
        features = self.features()
        sets = features.entries("UserSetSelector")
        self.assertIn("Default", sets)
        user = next(name for name in sets if name != "Default")
        start = {name: features.get(name) for name in ("ExposureTime", "Gain", "Width", "PixelFormat")}
        features.set("ExposureTime", 321.0)
        features.set("Gain", 2.0)
        features.set("Width", 128)
        features.set("PixelFormat", "Mono8")
        features.set("UserSetSelector", user)
        features.execute("UserSetSave")
        features.set("UserSetSelector", "Default")
        features.execute("UserSetLoad")
        self.assertEqual({name: features.get(name) for name in start}, start)
        self.refused(LOCKED + (g.INVALID_PARAMETER,), features.execute, "UserSetSave")  # the default is the factory's
        features.set("UserSetSelector", user)
        features.execute("UserSetLoad")
        self.assertEqual([features.get(name) for name in start], [321.0, 2.0, 128, "Mono8"])
        features.set("UserSetSelector", "Default")
        features.execute("UserSetLoad")

    def test_the_timestamp_can_be_latched_by_features(self):
        client = self.controller()
        features = Features(client)
        features.execute("GevTimestampControlLatch")
        first = features.get("GevTimestampValue")
        features.execute("GevTimestampControlLatch")
        self.assertGreater(features.get("GevTimestampValue"), first)

    def test_a_test_packet_has_the_size_that_was_asked_for(self):
        client = self.controller()
        before = client.read_register(g.SCPS) & 0xFFFF
        with StreamReceiver(client, CLIENT) as stream:
            stream.open()
            for size in (576, 1500, 8192, 16384):
                stream.test_packets.clear()
                client.write_register(g.SCPS, 1 << 31 | 1 << 30 | size)
                self.eventually(f"a packet of {size} bytes", lambda: stream.test_packets)
                self.assertEqual(stream.test_packets, [size - 28])
                # The fire bit does not stay.
                self.assertEqual(client.read_register(g.SCPS) & 0x8000FFFF, size)
            self.refused(g.INVALID_PARAMETER, client.write_register, g.SCPS, 20)
            self.refused(g.INVALID_PARAMETER, client.write_register, g.SCPS, 65535)
            client.write_register(g.SCPS, 8192)
            self.fault("test_packet_limit", value=1500)
            stream.test_packets.clear()
            for size in (1500, 1504, 9000):
                client.write_register(g.SCPS, 1 << 31 | size)
            time.sleep(0.3)
            self.assertEqual(stream.test_packets, [1472])
        client.write_register(g.SCPS, before)


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
        late = client.exchange(g.ACTION, payload(at), flags)
        self.assertEqual(late.status, ACTION_LATE)
        self.disarm(features, stream)


class Addresses(CameraTest):
    address = "127.0.23.3"

    def camera(self, to):
        found = [c for c in g.discover(CLIENT, to=to, wait_s=0.3) if c.sender == to]
        return found[0] if found else None

    def test_a_camera_takes_the_address_it_is_given(self):
        mac = self.camera(self.address).mac
        elsewhere = "127.0.23.33"
        # Not ours: another MAC.
        g.to_everyone("127.0.0.1", g.FORCEIP, g.force_ip_payload(b"\x02\0\0\0\0\1", elsewhere), wait_s=0.2)
        self.assertIsNone(self.camera(elsewhere))
        # Not while somebody is in control.
        client = self.controller()
        g.to_everyone("127.0.0.1", g.FORCEIP, g.force_ip_payload(mac, elsewhere), wait_s=0.2)
        self.assertIsNone(self.camera(elsewhere))
        client.release()
        g.to_everyone("127.0.0.1", g.FORCEIP, g.force_ip_payload(mac, elsewhere), wait_s=0.2)
        self.eventually("the camera at its new address", lambda: self.camera(elsewhere))
        self.assertEqual(self.camera(elsewhere).ip, elsewhere)
        self.assertIsNone(self.camera(self.address))
        with g.GvcpClient(elsewhere, CLIENT) as moved:
            moved.control()
            features = Features(moved)
            with StreamReceiver(moved, CLIENT) as stream:
                stream.open()
                features.execute("AcquisitionStart")
                self.assertTrue(all(frame.complete for frame in stream.take(3)))
                features.execute("AcquisitionStop")
            moved.release()
        g.to_everyone("127.0.0.1", g.FORCEIP, g.force_ip_payload(mac, self.address), wait_s=0.2)
        self.eventually("the camera back home", lambda: self.camera(self.address))

    def test_the_fault_ip_change_moves_the_camera(self):
        self.fault("ip_change", value=30)
        elsewhere = "127.0.23.33"
        self.eventually("the camera at its new address", lambda: self.camera(elsewhere))
        self.assertIsNone(self.camera(self.address))
        g.to_everyone("127.0.0.1", g.FORCEIP, g.force_ip_payload(self.camera(elsewhere).mac, self.address), wait_s=0.2)
        self.eventually("the camera back home", lambda: self.camera(self.address))


class ControlFaults(CameraTest):
    def test_slow_answers_are_announced_to_those_who_ask_for_it(self):
        client = self.controller(timeout_s=3)
        self.assertTrue(client.read_register(g.CAPABILITY) >> 5 & 1, "PENDING_ACK is a capability")
        client.write_register(g.GVCP_CONFIG, 2)
        self.fault("control_slow", value=700)
        self.assertEqual(client.read_register(g.STREAM_CHANNELS), 1)
        self.assertTrue(client.pending_acks)
        self.assertGreaterEqual(max(client.pending_acks), 700)
        self.emulator.clear_faults()
        client.write_register(g.GVCP_CONFIG, 0)
        client.pending_acks.clear()
        self.fault("control_slow", value=300)
        self.assertEqual(client.read_register(g.STREAM_CHANNELS), 1)
        self.assertEqual(client.pending_acks, [])

    def test_a_client_that_gives_up_too_early_is_not_served_twice(self):
        client = self.controller(timeout_s=0.2, tries=30)
        before = client.read_register(g.HEARTBEAT)
        self.fault("control_slow", value=500)
        latch = struct.pack(">II", g.TIMESTAMP_CONTROL, 2)
        self.assertEqual(client.exchange(g.WRITEREG, latch).status, g.SUCCESS)
        self.assertGreater(client.retries, 0)
        self.emulator.clear_faults()
        client.drain()
        self.assertEqual(client.read_register(g.HEARTBEAT), before)

    def test_silence(self):
        client = self.controller(timeout_s=0.3, tries=1)
        self.fault("control_silence")
        with self.assertRaises(g.NoAnswer):
            client.read_register(g.VERSION)
        self.assertEqual([c for c in g.discover(CLIENT, to=self.address, wait_s=0.3) if c.sender == self.address], [])
        self.emulator.clear_faults()
        client.tries = 3
        client.read_register(g.VERSION)

    def test_busy_and_denied(self):
        client = self.controller()
        for kind, status in (("control_busy", g.BUSY), ("control_denied", g.ACCESS_DENIED)):
            self.fault(kind)
            self.refused(status, client.read_register, g.VERSION)
            self.refused(status, client.write_register, g.HEARTBEAT, 9000)
            self.emulator.clear_faults()
            self.assertEqual(client.read_register(g.HEARTBEAT), 3000)

    def test_control_is_lost_although_the_controller_speaks(self):
        client, other = self.controller(), self.client(OTHER)
        client.write_register(g.HEARTBEAT, 500)
        self.fault("heartbeat_ignored")

        def lost():
            client.read_register(g.VERSION)
            return other.read_register(g.CCP) == 0
        self.eventually("control ends", lost)
        self.emulator.clear_faults()
        client.control()
        client.write_register(g.HEARTBEAT, 3000)

    def test_a_reset_camera_is_as_after_power_up(self):
        client = self.controller()
        features = Features(client)
        start = features.get("ExposureTime")
        features.set("ExposureTime", start * 2)
        features.set("PixelFormat", "Mono8")
        client.write_memory(g.USER_NAME, b"x".ljust(16, b"\0"))
        self.fault("device_reset")
        self.eventually("nobody in control", lambda: client.read_registers(g.CCP, g.SCP) == [0, 0])
        self.assertEqual(features.get("ExposureTime"), start)
        self.assertEqual(features.get("PixelFormat"), "Mono12")
        client.control()
        features.set("ExposureTime", start * 2)
        features.execute("DeviceReset")
        self.eventually("nobody in control", lambda: client.read_register(g.CCP) == 0)
        self.assertEqual(features.get("ExposureTime"), start)

    def test_a_link_that_is_down_carries_nothing(self):
        client = self.controller(timeout_s=0.3)
        features = Features(client)
        client.write_register(g.GVCP_CONFIG, 1)  # control is to outlive it
        with StreamReceiver(client, CLIENT, resend=False) as stream:
            stream.open()
            features.execute("AcquisitionStart")
            stream.take(2)
            self.fault("link_down", duration_s=1)
            client.tries = 1
            with self.assertRaises(g.NoAnswer):
                client.read_register(g.VERSION)
            client.tries = 20
            client.read_register(g.VERSION)
            stream.forget()
            stream.take(3)
            features.execute("AcquisitionStop")
        client.write_register(g.GVCP_CONFIG, 0)

    def test_faults_can_be_read_and_ordered_as_features(self):
        client = self.controller()
        features = Features(client)
        self.assertIn("FaultSelector", features)
        self.assertIn("PacketDrop", features.entries("FaultSelector"))
        self.fault("packet_drop", rate=0.25)
        features.set("FaultSelector", "PacketDrop")
        self.assertAlmostEqual(features.get("FaultRate"), 0.25)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
