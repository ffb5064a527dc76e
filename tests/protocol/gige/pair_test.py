#!/usr/bin/python3
"""Two cameras, one instant: what exposes at one scheduled ACTION command does so together, and when it was told to.

    pair_test.py HILCAM

action_pair.py measures the same over thousands of actions.
"""
import statistics
import sys
import tempfile
import time
import unittest

import action_pair as pair
import gvcp_client as g

HILCAM = sys.argv[1]
ACTION_LATE = 0x8016
# The exposures are on the clock's raster however busy the machine is; what is left is how well two clocks are compared.
WITHIN_NS = 100_000


class OneInstant(unittest.TestCase):
    ACTIONS, RATE_HZ = 200, 25

    def judge(self, in_one, tai):
        (left, right), answered, _ = pair.measure(HILCAM, self.ACTIONS, self.RATE_HZ, in_one, tai)
        # A machine without time for a frame misses a trigger, and says so; it does not expose at another time.
        both = set(left) & set(right)
        self.assertGreater(len(both), self.ACTIONS // 2, "of the actions both cameras took most")
        self.assertEqual({action for action in both if not 0 <= action < self.ACTIONS}, set())
        for camera in (left, right):
            for action in both:
                exposure = camera[action]
                self.assertLess(abs(exposure.truth), WITHIN_NS, f"action {action}: from its instant, by the truth")
                self.assertLess(abs(exposure.begin), WITHIN_NS, f"action {action}: from its instant, by the time stamp")
                self.assertLess(abs(exposure.stamp), WITHIN_NS, f"action {action}: the time stamp against the truth")
                # The picture shows the world of the instant that it names: position and time tag are doubles and ns.
                self.assertLess(abs(exposure.shown), 1_000, f"action {action}: where the camera was")
        for action in both:
            self.assertLess(abs(left[action].truth - right[action].truth), WITHIN_NS)
        stamps = [camera[action].stamp for camera in (left, right) for action in both]
        self.assertLess(abs(statistics.fmean(stamps)), 20_000, "no bias of the time stamps")
        expected = tuple((address, g.SUCCESS) for address in pair.ADDRESSES)
        self.assertGreaterEqual(answered[expected], 0.95 * self.ACTIONS, f"each action has two answers: {answered}")
        if not tai:  # one clock; with TAI, each camera compares two by readings of its own
            self.assertEqual({exposure for action in both for exposure in (left[action].truth, right[action].truth)}, {0})

    def test_two_processes_by_tai(self):
        self.judge(in_one=False, tai=True)

    def test_two_processes_by_the_monotonic_clock(self):
        self.judge(in_one=False, tai=False)

    def test_one_process_by_tai(self):
        self.judge(in_one=True, tai=True)


class Answers(unittest.TestCase):
    """Each camera that an action is for answers it, and no other."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.context = pair.two_cameras(HILCAM, cls.folder.name, in_one=False)
        cls.emulators = cls.context.__enter__()
        cls.cameras = [pair.ActionCamera(address, bind, tai=True, group=group)
                       for address, bind, group in zip(pair.ADDRESSES, pair.CLIENTS, (pair.GROUP, pair.GROUP + 1))]
        cls.sender = pair.ActionSender(time.CLOCK_TAI)
        cls.request = 0

    @classmethod
    def tearDownClass(cls):
        for closed in (cls.sender, *cls.cameras):
            closed.close()
        for emulator in cls.emulators:
            emulator.stop()
        cls.context.__exit__(None, None, None)
        cls.folder.cleanup()

    def answers(self, at_ns, **options):
        type(self).request += 1
        self.sender.send(self.request, at_ns, **options)
        until = time.monotonic() + 10
        while not self.sender.answers[self.request] and time.monotonic() < until and options.get("group") != 0x99:
            time.sleep(0.01)
        time.sleep(0.3)  # for an answer of the one that must not
        return dict(self.sender.answers[self.request])

    def soon(self):
        return time.clock_gettime_ns(time.CLOCK_TAI) + 200_000_000

    def frames(self):
        time.sleep(1)
        return [len(camera.frames) for camera in self.cameras]

    def test_only_its_group_answers_and_exposes(self):
        for group, answering in ((pair.GROUP, 0), (pair.GROUP + 1, 1)):
            before = self.frames()
            self.assertEqual(self.answers(self.soon(), group=group), {pair.ADDRESSES[answering]: g.SUCCESS})
            after = self.frames()
            self.assertEqual([b - a for a, b in zip(before, after)], [int(answering == i) for i in (0, 1)])

    def test_nobody_answers_for_another_group(self):
        before = self.frames()
        self.assertEqual(self.answers(self.soon(), group=0x99), {})
        self.assertEqual(self.frames(), before)

    def test_an_action_to_one_address_is_that_cameras(self):
        self.assertEqual(self.answers(self.soon(), to=pair.ADDRESSES[0]), {pair.ADDRESSES[0]: g.SUCCESS})
        self.assertEqual(self.answers(self.soon(), to=pair.ADDRESSES[1]), {}, "it has another group")

    def test_an_action_in_the_past_is_refused_by_its_group_alone(self):
        before = self.frames()
        past = time.clock_gettime_ns(time.CLOCK_TAI) - 1_000_000_000
        answers = self.answers(past)
        self.assertEqual(set(answers), {pair.ADDRESSES[0]})
        self.assertNotEqual(answers[pair.ADDRESSES[0]], g.SUCCESS)
        self.assertEqual(self.frames(), before)

    def test_without_an_acknowledge_flag_there_is_no_answer(self):
        before = self.frames()
        type(self).request += 1
        payload = g.action_payload(pair.DEVICE, pair.GROUP, pair.MASK, self.soon())
        self.sender.socket.sendto(g.command_bytes(g.ACTION, payload, g.SCHEDULED, self.request), (pair.EVERYBODY, g.PORT))
        after = self.frames()
        self.assertEqual([b - a for a, b in zip(before, after)], [1, 0])
        self.assertEqual(self.sender.answers[self.request], {})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
