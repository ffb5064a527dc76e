#!/usr/bin/python3
"""The camera's control port, with a client of its own (gvcp_client.py): what Aravis sends and what it does not.

    control_test.py HILCAM
"""
import collections
import random
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
CameraTest.address = "127.0.23.1"


class Discovery(CameraTest):
    def mine(self, found):
        return [camera for camera in found if camera.sender == self.address]

    def test_a_camera_is_found_by_its_address_and_by_broadcast(self):
        direct = self.mine(g.discover(CLIENT, to=self.address))
        everyone = self.mine(g.discover("127.0.0.1"))
        self.assertEqual([len(direct), len(everyone)], [1, 1])
        self.assertEqual(direct[0].registers, everyone[0].registers)
        camera = direct[0]
        self.assertEqual(camera.ip, self.address)
        self.assertEqual(camera.text(g.SERIAL, 16), f"T{self.emulator.port}")
        self.assertNotEqual(camera.mac, bytes(6))
        self.assertTrue(camera.text(g.VENDOR, 32) and camera.text(g.MODEL, 32))
        major, minor = struct.unpack(">HH", camera.registers[:4])
        self.assertIn(major, (1, 2))
        mode = struct.unpack(">I", camera.registers[g.DEVICE_MODE:g.DEVICE_MODE + 4])[0]
        self.assertEqual(mode >> 31, 1, "big-endian")
        self.assertEqual(mode & 0xFF, 1, "UTF-8")
        # The same bytes as registers.
        client = self.client()
        self.assertEqual(client.read_memory(0, 0xF8), camera.registers)

    def test_the_request_id_comes_back(self):
        answers = [answer for answer, (sender, _) in g.to_everyone(CLIENT, g.DISCOVERY, to=self.address, request_id=0x1234)
                   if sender == self.address]
        self.assertEqual([answer.request_id for answer in answers], [0x1234])

    def test_a_broadcast_from_another_network_is_not_answered(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.connect(("192.0.2.1", 9))
                outside = probe.getsockname()[0]
            except OSError:
                self.skipTest("this machine has no network but loopback")
        if outside.startswith("127."):
            self.skipTest("this machine has no network but loopback")
        self.assertEqual(self.mine(g.discover(outside)), [])


class Registers(CameraTest):
    def test_several_registers_in_one_message(self):
        client = self.client()
        values = client.read_registers(g.VERSION, g.DEVICE_MODE, g.STREAM_CHANNELS, g.CAPABILITY)
        self.assertEqual(values, [client.read_register(a) for a in
                                  (g.VERSION, g.DEVICE_MODE, g.STREAM_CHANNELS, g.CAPABILITY)])
        self.assertEqual(values[2], 1)
        self.assertEqual(len(client.read_registers(*[g.VERSION] * 135)), 135)
        self.refused(g.INVALID_PARAMETER, client.read_registers, *[g.VERSION] * 136)

    def test_reading_what_cannot_be_read(self):
        client = self.client()
        self.refused(g.BAD_ALIGNMENT, client.read_register, 0x0A02)
        self.refused(g.INVALID_ADDRESS, client.read_register, 0xFFFFFFF0)
        self.refused(g.INVALID_ADDRESS, client.read_memory, 0x7FFF0000, 64)
        read = lambda address, count: client.command(g.READMEM, struct.pack(">IHH", address, 0, count))
        self.refused((g.BAD_ALIGNMENT, g.INVALID_PARAMETER), read, 0x0201, 64)
        self.refused((g.BAD_ALIGNMENT, g.INVALID_PARAMETER), read, 0x0200, 6)
        self.refused(g.INVALID_PARAMETER, read, 0x0200, 0)
        self.refused(g.INVALID_PARAMETER, read, 0x0200, 0xFFFC)
        self.assertEqual(len(client.read_memory(0x0200, 512)), 512)

    def test_writing_what_cannot_be_written(self):
        client = self.controller()
        self.refused(g.BAD_ALIGNMENT, client.write_register, 0x0A02, 1)
        self.refused(g.INVALID_ADDRESS, client.write_register, 0xFFFFFFF0, 1)
        for address in (g.VERSION, g.CAPABILITY, g.STREAM_CHANNELS, g.PRIMARY_PORT, g.URL_0):
            self.refused(g.WRITE_PROTECT, client.write_register, address, 1)
        for address, data in ((0x0A02, bytes(4)), (g.USER_NAME, bytes(3))):
            self.refused((g.BAD_ALIGNMENT, g.INVALID_PARAMETER), client.write_memory, address, data)
        self.refused((g.WRITE_PROTECT, g.INVALID_PARAMETER), client.write_memory, g.VENDOR, bytes(32))
        self.refused((g.INVALID_PARAMETER, g.INVALID_ADDRESS, g.WRITE_PROTECT), client.write_memory, g.USER_NAME, bytes(480))

    def test_writes_stop_at_the_first_error_and_say_which(self):
        client = self.controller()
        client.write_registers((g.HEARTBEAT, 4000), (g.SCPD, 0))
        answer = self.refused(g.WRITE_PROTECT, client.write_registers, (g.HEARTBEAT, 5000), (g.SCPD, 7), (g.VERSION, 0),
                              (g.HEARTBEAT, 6000))
        self.assertEqual(struct.unpack(">HH", answer.payload), (0, 2))
        self.assertEqual(client.read_registers(g.HEARTBEAT, g.SCPD), [5000, 7])
        client.write_registers((g.HEARTBEAT, 3000), (g.SCPD, 0))

    def test_text_is_written_and_kept(self):
        client = self.controller()
        client.write_memory(g.USER_NAME, b"left eye".ljust(16, b"\0"))
        self.assertEqual(client.read_text(g.USER_NAME, 16), "left eye")
        self.assertEqual(self.client(OTHER).read_text(g.USER_NAME, 16), "left eye")
        client.write_memory(g.USER_NAME, bytes(16))
        self.assertEqual(client.read_text(g.USER_NAME, 16), "")

    def test_commands_that_ask_for_no_answer_are_run(self):
        client = self.controller()
        client.send(g.command_bytes(g.WRITEREG, struct.pack(">II", g.HEARTBEAT, 3500), 0, client.new_id()))
        self.assertIsNone(client.receive(0.2))
        self.assertEqual(client.read_register(g.HEARTBEAT), 3500)
        client.write_register(g.HEARTBEAT, 3000)

    def test_a_retry_is_answered_and_not_run_again(self):
        client = self.controller()
        latch = struct.pack(">II", g.TIMESTAMP_CONTROL, 2)
        first = client.exchange(g.WRITEREG, latch, request_id=500)
        time.sleep(0.2)
        again = client.exchange(g.WRITEREG, latch, request_id=500)
        self.assertEqual(first, again)
        high, low = client.read_registers(g.TIMESTAMP_HIGH, g.TIMESTAMP_LOW)
        now = client.timestamp_ns()
        # Had the second message latched, less than the pause could lie between it and now.
        self.assertGreaterEqual(now - (high << 32 | low), 200_000_000)

    def test_the_clock_runs_on_and_has_a_frequency(self):
        client = self.controller()
        high, low = client.read_registers(g.TICKS_HIGH, g.TICKS_LOW)
        self.assertGreater(high << 32 | low, 0)
        times = [client.timestamp_ns() for _ in range(5)]
        self.assertEqual(times, sorted(set(times)))


class Malformed(CameraTest):
    def test_what_is_no_command_gets_no_success(self):
        client = self.client()
        good = struct.pack(">I", g.CCP)
        for name, datagram in {
                "wrong key": g.command_bytes(g.READREG, good, key=0x43),
                "empty": b"", "short": b"\x42\x01\x00", "only a key": b"\x42",
                "length too long": g.command_bytes(g.READREG, good, length=8),
                "length too short": g.command_bytes(g.READREG, good, length=0),
                "request id 0": g.command_bytes(g.READREG, good, request_id=0)}.items():
            client.send(datagram)
            received = client.receive(0.1)
            if received is not None:
                self.assertNotEqual(g.Answer.of(received).status, g.SUCCESS, name)
        self.assertEqual(client.read_register(g.STREAM_CHANNELS), 1)

    def test_unknown_commands_are_answered_not_implemented(self):
        client = self.controller()
        for code in (0x0000, 0x0006, 0x008A, 0x00F0, 0x7FFE):
            answer = client.exchange(code)
            self.assertEqual((answer.status, answer.code), (g.NOT_IMPLEMENTED, code + 1))

    def test_payloads_of_wrong_length(self):
        client = self.controller()
        bad = (g.INVALID_PARAMETER, g.INVALID_HEADER)
        for code, payload in ((g.READREG, b""), (g.READREG, bytes(3)), (g.READREG, bytes(6)),
                              (g.WRITEREG, b""), (g.WRITEREG, bytes(4)), (g.WRITEREG, bytes(12)),
                              (g.READMEM, b""), (g.READMEM, bytes(4)), (g.READMEM, bytes(12)),
                              (g.WRITEMEM, b""), (g.WRITEMEM, bytes(4)),
                              (g.FORCEIP, bytes(10)), (g.ACTION, bytes(8))):
            client.send(g.command_bytes(code, payload, request_id=client.new_id()))
            received = client.receive(1.0)
            if code in (g.FORCEIP, g.ACTION) and received is None:
                continue
            self.assertIsNotNone(received, f"0x{code:04X} with {len(payload)} bytes")
            self.assertIn(g.Answer.of(received).status, bad, f"0x{code:04X} with {len(payload)} bytes")

    def test_random_datagrams_do_no_harm(self):
        client = self.controller()
        features = Features(client)
        rng = random.Random(23)
        with StreamReceiver(client, CLIENT) as stream, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as noise:
            stream.open()
            features.execute("AcquisitionStart")
            stream.take(3)
            noise.bind((OTHER, 0))
            noise.connect((self.address, g.PORT))
            codes = (g.DISCOVERY, g.FORCEIP, g.PACKETRESEND, g.READREG, g.WRITEREG, g.READMEM, g.WRITEMEM, g.EVENT, g.ACTION)
            counts = collections.Counter()
            memory = None
            for i in range(300_000):
                if i == 50_000:
                    memory = self.emulator.memory_bytes()
                body = rng.randbytes(rng.choice((0, 4, 8, 12, 20, 56, 200, 560)))
                # Nonsense; commands with nonsense in them; commands with a wrong length.
                if (kind := rng.randrange(3)) == 0:
                    datagram = rng.randbytes(8) + body
                else:
                    datagram = g.command_bytes(rng.choice(codes), body, rng.randrange(256), rng.randrange(1, 65536),
                                               length=rng.randrange(600) if kind == 2 else None)
                try:
                    noise.send(datagram)
                    counts["sent"] += 1
                except ConnectionRefusedError:
                    pass
                if i % 5000 == 0:
                    client.read_register(g.CCP)  # the heartbeat
            stream.forget()
            stream.take(5)
            features.execute("AcquisitionStop")
        self.assertGreater(counts["sent"], 250_000)
        self.assertTrue(self.emulator.alive())
        # Flat: what is left of 250,000 datagrams is less than ten bytes each.
        self.assertLess(self.emulator.memory_bytes() - memory, 2 << 20)


class Privilege(CameraTest):
    def test_one_controller_and_others_may_read(self):
        first, second = self.controller(), self.client(OTHER)
        self.assertEqual(second.read_register(g.CCP), g.CCP_CONTROL)
        self.assertEqual(second.read_registers(g.PRIMARY_PORT, g.PRIMARY_IP), [first.port, g.ip_number(CLIENT)])
        for address, value in ((g.CCP, g.CCP_CONTROL), (g.CCP, g.CCP_EXCLUSIVE), (g.CCP, 0), (g.HEARTBEAT, 5000),
                               (g.SCP, 5555)):
            self.refused(g.ACCESS_DENIED, second.write_register, address, value)
        self.refused(g.ACCESS_DENIED, second.write_memory, g.USER_NAME, bytes(16))
        self.assertEqual(first.read_register(g.HEARTBEAT), 3000)
        first.release()
        self.assertEqual(second.read_registers(g.CCP, g.PRIMARY_PORT, g.PRIMARY_IP), [0, 0, 0])
        second.control()
        self.refused(g.ACCESS_DENIED, first.write_register, g.HEARTBEAT, 5000)

    def test_without_control_nothing_is_written(self):
        client = self.client()
        self.refused(g.ACCESS_DENIED, client.write_register, g.HEARTBEAT, 5000)
        self.refused(g.ACCESS_DENIED, client.write_register, g.SCP, 5555)

    def test_another_port_of_the_same_machine_is_another_application(self):
        self.controller()
        self.refused(g.ACCESS_DENIED, self.client(CLIENT).write_register, g.HEARTBEAT, 5000)

    def test_exclusive_control_hides_the_camera_but_for_discovery(self):
        first, second = self.client(), self.client(OTHER)
        first.control(g.CCP_EXCLUSIVE)
        self.refused(g.ACCESS_DENIED, second.read_register, g.HEARTBEAT)
        self.refused(g.ACCESS_DENIED, second.read_memory, g.URL_0, 512)
        self.refused(g.ACCESS_DENIED, second.write_register, g.CCP, g.CCP_CONTROL)
        self.assertEqual(len([c for c in g.discover(OTHER, to=self.address) if c.sender == self.address]), 1)
        self.assertEqual(first.read_register(g.CCP), g.CCP_EXCLUSIVE)
        first.control(g.CCP_CONTROL)  # steps down
        self.assertEqual(second.read_register(g.HEARTBEAT), 3000)
        first.control(g.CCP_EXCLUSIVE)  # and up
        self.refused(g.ACCESS_DENIED, second.read_register, g.HEARTBEAT)

    def test_control_is_handed_over_to_who_knows_the_key(self):
        first, second = self.client(), self.client(OTHER)
        self.assertTrue(first.read_register(g.CAPABILITY) >> 21 & 1, "switch-over is a capability")
        first.control()
        first.write_register(g.SWITCHOVER_KEY, 0xBEEF)
        # Not before the controller allows it, and not without the key.
        self.refused(g.ACCESS_DENIED, second.control, g.CCP_CONTROL, 0xBEEF)
        first.control(g.CCP_CONTROL | g.CCP_SWITCHOVER)
        self.refused(g.ACCESS_DENIED, second.control, g.CCP_CONTROL, 0xDEAD)
        self.refused(g.ACCESS_DENIED, second.control, g.CCP_CONTROL)
        second.control(g.CCP_CONTROL, 0xBEEF)
        self.assertEqual(second.read_registers(g.PRIMARY_PORT, g.PRIMARY_IP), [second.port, g.ip_number(OTHER)])
        self.refused(g.ACCESS_DENIED, first.write_register, g.HEARTBEAT, 5000)
        second.write_register(g.HEARTBEAT, 3000)

    def test_the_controller_is_told_when_it_is_replaced(self):
        first, second = self.controller(), self.client(OTHER)
        first.write_register(g.SWITCHOVER_KEY, 0x1234)
        first.control(g.CCP_CONTROL | g.CCP_SWITCHOVER)
        with g.MessageChannel(first, CLIENT) as messages:
            second.control(g.CCP_CONTROL, 0x1234)
            self.assertEqual([event.id for event in messages.receive(3.0)], [0x0007])

    def test_a_silent_controller_loses_the_camera_and_its_stream(self):
        first, second = self.controller(), self.client(OTHER)
        first.write_register(g.HEARTBEAT, 500)
        features = Features(first)
        with StreamReceiver(first, CLIENT) as stream:
            stream.open()
            features.execute("AcquisitionStart")
            stream.take(2)
            self.eventually("control ends", lambda: second.read_register(g.CCP) == 0)
            self.assertEqual(second.read_register(g.SCP) & 0xFFFF, 0)
            stream.forget()
            while stream.next_frame(0.5):
                pass
            self.assertIsNone(stream.next_frame(0.3), "the stream has ended")
        second.control()
        second.write_register(g.HEARTBEAT, 3000)
        self.refused(g.ACCESS_DENIED, first.write_register, g.SCPD, 0)

    def test_any_command_of_the_controller_is_a_heartbeat(self):
        client, other = self.controller(), self.client(OTHER)
        client.write_register(g.HEARTBEAT, 2000)
        until = time.monotonic() + 3
        while time.monotonic() < until:
            client.read_register(g.VERSION)
            time.sleep(0.1)
        self.assertEqual(other.read_register(g.CCP), g.CCP_CONTROL)
        client.write_register(g.HEARTBEAT, 3000)

    def test_the_heartbeat_can_be_switched_off(self):
        client, other = self.controller(), self.client(OTHER)
        self.assertTrue(client.read_register(g.CAPABILITY) >> 29 & 1)
        client.write_registers((g.HEARTBEAT, 500), (g.GVCP_CONFIG, 1))
        time.sleep(1.5)
        self.assertEqual(other.read_register(g.CCP), g.CCP_CONTROL)
        client.write_registers((g.GVCP_CONFIG, 0), (g.HEARTBEAT, 3000))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
