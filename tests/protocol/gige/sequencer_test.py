#!/usr/bin/python3
"""The sequencer as Aravis configures and starts it: exposures in turn, judged by the frames' pixels, chunks and truth.

    sequencer_test.py HILCAM [tests ...]
"""
import json
import pathlib
import re
import subprocess
import sys
import time
import unittest

import numpy

import lines_test
from bench import SOURCE
from lines_test import MS, Aravis

WIDTH, HEIGHT, BLACK_LEVEL = 256, 192, 64


class SequencerTest(lines_test.LinesTest):
    sets = ("outputs.truth={{folder: {folder}/truth}}",)

    def setUp(self):
        super().setUp()
        self.camera.set_string("TriggerMode", "Off")

    def tearDown(self):
        self.camera.set_string("SequencerMode", "Off")
        super().tearDown()

    def configure(self, sets, features=("ExposureTime", "Gain")):
        """sets: settings and paths of each, [({feature: value}, [(source, next), ...]), ...]. In the order of FLIR's and SFNC's
        examples: configuration mode, values, paths, save."""
        self.set("SequencerConfigurationMode", "On")
        for name in self.entries("SequencerFeatureSelector"):
            self.set("SequencerFeatureSelector", name), self.set("SequencerFeatureEnable", name in features)
        for i, (values, paths) in enumerate(sets):
            self.set("SequencerSetSelector", i)
            for name, value in values.items():
                self.set(name, value)
            for path, (source, following) in enumerate(paths):
                self.set("SequencerPathSelector", path)
                self.set("SequencerTriggerSource", source), self.set("SequencerSetNext", following)
            self.camera.execute_command("SequencerSetSave")
        self.set("SequencerSetStart", 0)
        self.set("SequencerConfigurationMode", "Off")
        self.set("SequencerMode", "On")

    def entries(self, name):
        return self.camera.dup_available_enumerations_as_strings(name)

    def streaming(self):
        self.camera.set_chunks("FrameID,SequencerSetActive,ExposureTime,Gain,TriggerSequence")
        self.stream = None
        # Aravis's ring of raw packets loses some of the loopback's on a busy machine.
        self.camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)
        self.stream = self.camera.create_stream(None, None)
        for _ in range(20):
            self.stream.push_buffer(Aravis.Buffer.new_allocate(self.camera.get_payload()))
        self.chunks = self.camera.create_chunk_parser()
        self.camera.start_acquisition()

    def whole(self, count):
        """The next frames: chunks by name, and the picture as "dn"."""
        frames = []
        while len(frames) < count:
            buffer = self.stream.timeout_pop_buffer(10_000_000)
            self.assertIsNotNone(buffer, f"{len(frames)} of {count} frames came; {self.emulator.log()}")
            if buffer.get_status() == Aravis.BufferStatus.SUCCESS:
                frame = {name: self.chunks.get_integer_value(buffer, "Chunk" + name)
                         for name in ("FrameID", "SequencerSetActive", "TriggerSequence")}
                frame |= {name: self.chunks.get_float_value(buffer, "Chunk" + name) for name in ("ExposureTime", "Gain")}
                frame["dn"] = numpy.frombuffer(buffer.get_data()[:2 * WIDTH * HEIGHT], "<u2").astype(float)
                frames.append(frame)
            self.stream.push_buffer(buffer)
        return frames

    def truth_of(self, frames):
        """Their sets in the truth, which is written behind the loop."""
        wanted = {frame["FrameID"] for frame in frames}

        def found():
            sets = {}
            for file in pathlib.Path(self.folder.name, "truth").rglob("*.jsonl"):
                for line in file.read_text().splitlines():
                    if line.endswith("}") and "frame" in (record := json.loads(line)):
                        sets[record["frame"]] = record["sequencer_set"]
            return sets if wanted <= sets.keys() else None
        self.eventually("the frames' truth", found)
        return [found()[frame["FrameID"]] for frame in frames]


class Bracketing(SequencerTest):
    def test_three_exposures_in_turn(self):
        """Set by chunk and truth, the exposure by chunk, and by light: twice the time, twice the signal."""
        exposures_us = (2000.0, 4000.0, 8000.0)
        self.configure([({"ExposureTime": us}, [("FrameStart", (i + 1) % 3)]) for i, us in enumerate(exposures_us)])
        self.streaming()
        frames = self.whole(9)
        self.assertEqual(self.camera.get_string("SequencerMode"), "On")
        self.camera.stop_acquisition()
        self.assertEqual(frames[0]["SequencerSetActive"], 0, "a stream begins at the start set")
        ids = [frame["FrameID"] - frames[0]["FrameID"] for frame in frames]
        sets = [frame["SequencerSetActive"] for frame in frames]
        if ids == list(range(9)):  # frames that a busy machine skipped have no set
            self.assertEqual(sets, [0, 1, 2] * 3)
        self.assertEqual(sets, self.truth_of(frames))
        light = {}
        for frame in frames:
            self.assertAlmostEqual(frame["ExposureTime"], exposures_us[frame["SequencerSetActive"]], places=6)
            light.setdefault(frame["SequencerSetActive"], []).append(frame["dn"])
        mean = [numpy.mean(light[i], axis=0) - BLACK_LEVEL for i in range(3)]
        lit = (mean[2] > 200) & (mean[2] < 3000)  # neither noise nor full scale
        self.assertGreater(lit.sum(), 100)
        signal = [picture[lit].mean() for picture in mean]
        # With one ray a pixel, means of one exposure scatter by 2.5 % from frame to frame; of three frames each, a ratio by 2 %.
        self.assertAlmostEqual(signal[1] / signal[0], 2, delta=4.5 * 0.02 * 2)
        self.assertAlmostEqual(signal[2] / signal[0], 4, delta=4.5 * 0.02 * 4)

    def test_each_acquisition_begins_at_the_start_set(self):
        self.configure([({"Gain": 0.0}, [("FrameStart", 1)]), ({"Gain": 6.0}, [("FrameStart", 0)])])
        for _ in range(6):
            self.streaming()
            first = self.whole(1)[0]
            self.assertEqual((first["SequencerSetActive"], first["Gain"]), (0, 0.0))
            self.camera.stop_acquisition()

    def test_a_counter_gives_each_set_three_frames(self):
        self.set("CounterSelector", "Counter0"), self.set("CounterEventSource", "FrameStart")
        self.set("CounterResetSource", "Counter0End"), self.set("CounterDuration", 3)
        self.configure([({"Gain": 0.0}, [("Counter0End", 1)]), ({"Gain": 6.0}, [("Counter0End", 0)])])
        self.streaming()
        frames = self.whole(9)
        self.camera.stop_acquisition()
        if [frame["FrameID"] - frames[0]["FrameID"] for frame in frames] == list(range(9)):
            self.assertEqual([frame["SequencerSetActive"] for frame in frames], [0, 0, 0, 1, 1, 1, 0, 0, 0])
        for frame in frames:
            self.assertEqual(frame["Gain"], 6.0 * frame["SequencerSetActive"])


class Lines(SequencerTest):
    def triggered(self):
        self.set("TriggerMode", "On"), self.set("TriggerSource", "Line0")
        self.streaming()
        time.sleep(0.2)  # an exposure of the free run before is over
        self.wires.drain()

    def pulse(self, line=0):
        edge = self.wires.pulse(line)[0]
        time.sleep(0.05)
        return edge

    def test_a_line_chooses_the_set_of_triggered_frames(self):
        """Line2's rising edge goes to the other set; Line0 takes frames."""
        self.configure([({"ExposureTime": 1000.0}, [("Off", 0), ("Line2", 1)]), ({"ExposureTime": 9000.0}, [("Line2", 0)])])
        self.triggered()
        edges = []
        for line in (0, 0, 2, 0, 2, 2, 0, 2, 0):
            if line == 0:
                edges.append(self.pulse())
            else:
                self.pulse(2)
        frames = self.whole(len(edges) - 1)  # a busy machine may drop one
        self.camera.stop_acquisition()
        wanted = dict(zip(edges, ((0, 1000.0), (0, 1000.0), (1, 9000.0), (1, 9000.0), (0, 1000.0))))
        for frame in frames:
            self.assertEqual((frame["SequencerSetActive"], frame["ExposureTime"]), wanted[frame["TriggerSequence"]])

    def test_an_output_is_as_long_as_the_sets_exposure(self):
        self.set("LineSelector", "Line1"), self.set("LineSource", "ExposureActive")
        self.configure([({"ExposureTime": 3000.0}, [("ExposureEnd", 1)]), ({"ExposureTime": 7000.0}, [("ExposureEnd", 0)])])
        self.triggered()
        for exposure_ms in (3, 7, 3):
            self.wires.pulse(0)
            (_, _, begin_ns, _), (_, _, end_ns, _) = self.wires.receive(2)
            self.assertEqual(end_ns - begin_ns, exposure_ms * MS)
            time.sleep(0.05)
        self.camera.stop_acquisition()


class Modes(SequencerTest):
    def test_the_documents_program_brackets(self):
        self.camera = None  # gives control to it
        text = (SOURCE / "docs/lines.md").read_text()
        program = re.search(r"```python\n(.*?)```", text, re.S)[1].replace("127.0.0.1", self.address)
        result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.camera = Aravis.Camera.new(self.address)
        self.streaming()
        self.assertEqual({(frame["SequencerSetActive"], frame["ExposureTime"]) for frame in self.whole(6)},
                         {(0, 2000.0), (1, 4000.0), (2, 8000.0)})
        self.camera.stop_acquisition()

    def test_aravis_sees_what_is_locked(self):
        def locked(name):
            return self.camera.get_device().get_feature(name).is_locked()
        self.assertTrue(locked("SequencerSetNext"))
        self.assertFalse(locked("SequencerMode"))
        self.set("SequencerConfigurationMode", "On")
        self.assertFalse(locked("SequencerSetNext"))
        self.assertTrue(locked("SequencerMode"))
        self.set("SequencerConfigurationMode", "Off")
        self.set("SequencerMode", "On")
        self.assertTrue(locked("SequencerConfigurationMode"))

    def test_its_names_are_those_of_real_cameras(self):
        self.assertEqual(self.entries("SequencerFeatureSelector"),
                         ["ExposureTime", "Gain", "BlackLevel", "TestPattern", "ReverseX", "ReverseY"])
        self.assertEqual(self.entries("SequencerTriggerSource"),
                         ["Off", "FrameStart", "ExposureStart", "ExposureEnd", "Counter0End", "Counter1End", "Timer0End",
                          "Timer1End", "Line0", "Line2"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
