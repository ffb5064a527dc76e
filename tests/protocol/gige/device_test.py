#!/usr/bin/python3
"""What the camera does beyond registers: locks, limits, user sets, test packets, FORCEIP, PENDING_ACK, faults of the
control channel.

    device_test.py HILCAM
"""
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

    def test_settings_and_chunks_stay_for_the_next_client(self):
        first = self.controller()
        features = Features(first)
        names = ("PixelFormat", "Width", "ExposureTime", "ChunkModeActive")
        start = [features.get(name) for name in names]
        wanted = ["Mono8", 128, 321.0, True]
        for name, value in zip(names, wanted):
            features.set(name, value)
        first.release()
        second = Features(self.controller(OTHER))
        self.assertEqual([second.get(name) for name in names], wanted)
        self.assertGreater(second.get("PayloadSize"), 128 * second.get("Height"))
        second.set("UserSetSelector", "Default")
        second.execute("UserSetLoad")
        self.assertEqual([second.get(name) for name in names], start)

    def test_an_exposure_that_the_camera_chooses_is_locked(self):
        features = self.features()
        features.set("ExposureAuto", "Continuous")
        self.refused((*LOCKED, g.INVALID_PARAMETER), features.set, "ExposureTime", 300.0)
        features.set("ExposureAuto", "Off")
        features.set("ExposureTime", 300.0)
        self.assertEqual(features.get("ExposureTime"), 300.0)

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
            stream.test_packets.clear()
            Features(client).execute("GevSCPSFireTestPacket")
            self.eventually("a packet of the size that is set", lambda: stream.test_packets)
            self.assertEqual(stream.test_packets, [size - 28])
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
