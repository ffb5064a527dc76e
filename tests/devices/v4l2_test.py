#!/usr/bin/python3
"""Frames of `hilcam run` through v4l2loopback, read by programs that know nothing of hilcam. Runs as root in the guest of
tools/vm; tools/check-devices starts it."""
import pathlib
import struct
import subprocess
import time
import unittest

import bench
from bench import DEVICE, Emulator, HEIGHT, Loopback, WIDTH, ids_of, run
from hilcam_client import crc16

FRAMES = 8
FILTERS = "camera.color_filter.pattern={} {}"
BAYER = {"RGGB": ("RGGB", "RG10", "RG12"), "GRBG": ("GRBG", "BA10", "BA12"), "GBRG": ("GBRG", "GB10", "GB12"),
         "BGGR": ("BA81", "BG10", "BG12")}
LINE_BYTES = {"GREY": WIDTH, "BAYER8": WIDTH, "RGB24": 3 * WIDTH}


def mosaic(pattern):
    """The camera with colour filters that pass everything: its mosaic stays plain noise."""
    return (f"camera.color_filter={bench.SOURCE}/tests/devices/{pattern.lower()}_filters.yaml",)


def v4l2_ctl(file, count=FRAMES, buffers=4):
    return run("v4l2-ctl", "-d", DEVICE, f"--stream-mmap={buffers}", f"--stream-count={count}", f"--stream-to={file}",
               "--verbose", seconds=60)


def ffmpeg(file, pixel_format):
    return run("ffmpeg", "-v", "error", "-nostdin", "-f", "v4l2", "-input_format", pixel_format, "-i", DEVICE,
               "-frames:v", FRAMES, "-f", "rawvideo", "-c", "copy", "-y", file, seconds=90)


def gstreamer(file, caps):
    return run("gst-launch-1.0", "-q", "v4l2src", f"device={DEVICE}", f"num-buffers={FRAMES}", "!",
               f"{caps},width={WIDTH},height={HEIGHT}", "!", "filesink", f"location={file}", seconds=90)


def opencv(file):
    return run(bench.TOOLS / "opencv_reader", DEVICE, FRAMES, file, seconds=90)


class Readers(unittest.TestCase):
    """Every program reads whole frames that equal those of the files."""

    def read(self, emulator, format_name, name, read, rows=0):
        file = emulator.folder / name
        for attempt in range(2):
            status, text = read(file)
            # 0.12.7 answers a reader that starts while another one stops with an error now and then.
            if status == 0 and file.exists() and file.stat().st_size > 0:
                break
        self.assertEqual(status, 0, f"{name}: {text}")
        return name, file.read_bytes()

    def check(self, format_name, readers, *settings):
        with Loopback(), Emulator(f"outputs.v4l2.format={format_name}", *settings) as emulator:
            taken = [self.read(emulator, format_name, name, read) for name, read in readers.items()]
            report = emulator.stop()
            numbers = emulator.numbers()
            for output in report["outputs"]:
                self.assertEqual(output["dropped"], 0, output["name"])
            for name, data in taken:
                with self.subTest(format=format_name, reader=name):
                    ids = ids_of(data, format_name, numbers)
                    self.assertGreaterEqual(len(ids), FRAMES - 1)
                    print(f"{format_name} {settings} {name}: {len(ids)} frames equal, ids {ids[0]} to {ids[-1]}", flush=True)

    def test_grey(self):
        self.check("GREY", {
            "v4l2-ctl": v4l2_ctl, "ffmpeg": lambda file: ffmpeg(file, "gray"), "opencv": opencv,
            "gstreamer": lambda file: gstreamer(file, "video/x-raw,format=GRAY8")})

    def test_y16(self):
        self.check("Y16", {
            "v4l2-ctl": v4l2_ctl, "ffmpeg": lambda file: ffmpeg(file, "gray16le"), "opencv": opencv,
            "gstreamer": lambda file: gstreamer(file, "video/x-raw,format=GRAY16_LE")})

    def test_yuyv(self):
        self.check("YUYV", {
            "v4l2-ctl": v4l2_ctl, "ffmpeg": lambda file: ffmpeg(file, "yuyv422"), "opencv": opencv,
            "gstreamer": lambda file: gstreamer(file, "video/x-raw,format=YUY2")})

    def test_rgb24(self):
        self.check("RGB24", {
            "v4l2-ctl": v4l2_ctl, "ffmpeg": lambda file: ffmpeg(file, "rgb24"),
            "gstreamer": lambda file: gstreamer(file, "video/x-raw,format=RGB")})

    def test_bayer_of_every_phase(self):
        for pattern in BAYER:
            self.check("BAYER8", {
                "v4l2-ctl": v4l2_ctl,
                "ffmpeg": lambda file, p=pattern: ffmpeg(file, f"bayer_{p.lower()}8"),
                "gstreamer": lambda file, p=pattern: gstreamer(file, f"video/x-bayer,format={p.lower()}")}, *mosaic(pattern))

    def test_bayer_above_8_bits_where_the_module_has_it(self):
        for name in ("BAYER10", "BAYER12"):
            if bench.version() >= (0, 14, 0):
                self.check(name, {"v4l2-ctl": v4l2_ctl}, *mosaic("GBRG"))
                continue
            with Loopback():
                emulator = Emulator(f"outputs.v4l2.format={name}", *mosaic("GBRG"))
                status, text = run(*emulator.command, "--frames", "1")
                self.assertEqual(status, 1)
                self.assertIn(f"v4l2loopback before 0.13 has no GB{name[-2:]}; it has ", text)
                # Nothing of the refused format stays with the module.
                with Emulator("outputs.v4l2.format=BAYER8", *mosaic("GBRG")) as again:
                    again.stop()

    def test_write_mode(self):
        self.check("Y16", {"v4l2-ctl": v4l2_ctl, "ffmpeg": lambda file: ffmpeg(file, "gray16le"), "opencv": opencv},
                   "outputs.v4l2.io=write")


class Times(unittest.TestCase):
    def stamps(self, text):
        """(sequence, time stamp [s]) of each buffer."""
        return [(int(sequence), float(stamp)) for _, stamp, sequence in map(str.split, text.splitlines())]

    def read(self, io):
        with Loopback(), Emulator(f"outputs.v4l2.io={io}", "outputs.v4l2.metadata_row=bottom") as emulator:
            file = emulator.folder / "frames.raw"
            status, text = run(bench.TOOLS / "frame_reader", DEVICE, 12, file)
            self.assertEqual(status, 0, text)
            emulator.stop()
            line = 2 * WIDTH
            size = (HEIGHT + 1) * line
            data = file.read_bytes()
            rows = [decode_row(data[at + HEIGHT * line:at + size]) for at in range(0, len(data), size)]
            self.written = sorted(emulator.numbers())
            stamps = self.stamps(text)
            self.assertEqual(len(stamps), len(rows), text)
            # Before 0.14 a reader's REQBUFS stamps all buffers anew: what was there before it, two of them at most, has the
            # time of that and the number 0.
            first = 0 if bench.version() >= (0, 14, 0) else 2
            return stamps[first:], rows[first:]

    def steps(self, rows):
        """By how many frames each is after the one before, of those that the emulator made."""
        places = [self.written.index(row["id"]) for row in rows]
        return [b - a for a, b in zip(places, places[1:])]

    def test_mapped_frames_carry_the_time_of_their_exposure(self):
        stamps, rows = self.read("mmap")
        for (sequence, stamp), row in zip(stamps, rows):
            self.assertAlmostEqual(stamp, row["exposure_mid_monotonic_ns"] * 1e-9, delta=2e-6)  # microseconds in V4L2
            if bench.version() < (0, 13, 0):
                self.assertEqual(sequence, 0)
        if bench.version() >= (0, 13, 0):
            steps = [b[0] - a[0] for a, b in zip(stamps, stamps[1:])]
            self.assertEqual(steps, self.steps(rows))

    def test_written_frames_are_counted(self):
        stamps, rows = self.read("write")
        steps = [b[0] - a[0] for a, b in zip(stamps, stamps[1:])]
        self.assertEqual(steps, self.steps(rows))
        self.assertGreater(stamps[0][1], rows[0]["exposure_mid_monotonic_ns"] * 1e-9)


def decode_row(row):
    """The reader that docs/devices.md shows."""
    names = ("mark", "version", "length", "id", "exposure_mid_tai_ns", "exposure_mid_monotonic_ns", "exposure_s", "gain_db",
             "pose_sequence", "trigger_sequence", "pose_time_tai_ns", "faults", "quality_level", "bits", "crc")
    values = dict(zip(names, struct.unpack(">4sHHQqqddIIqQIHH", row[:80])))
    assert values["mark"] == b"HCMR" and values["version"] == 1 and values["length"] == 80
    assert crc16(row[:80]) == 0
    return values


class MetadataRow(unittest.TestCase):
    def test_it_is_that_of_its_frame(self):
        for where, name in (("bottom", "GREY"), ("top", "Y16"), ("bottom", "RGB24")):
            with self.subTest(where=where, format=name):
                with Loopback(), Emulator(
                        f"outputs.v4l2.format={name}", f"outputs.v4l2.metadata_row={where}") as emulator:
                    file = emulator.folder / "frames.raw"
                    status, text = v4l2_ctl(file)
                    self.assertEqual(status, 0, text)
                    emulator.stop()
                    data = file.read_bytes()
                    ids = ids_of(data, name, emulator.numbers(), rows=1, row_at_top=where == "top")
                    line = LINE_BYTES.get(name, 2 * WIDTH)
                    size = (HEIGHT + 1) * line
                    rows = [decode_row(data[at:at + size][:80] if where == "top" else data[at + HEIGHT * line:at + size])
                            for at in range(0, len(data), size)]
                    self.assertEqual([row["id"] for row in rows], ids)
                    self.assertEqual({row["bits"] for row in rows}, {12})
                    self.assertEqual({row["exposure_s"] for row in rows}, {0.002})


class Restarts(unittest.TestCase):
    def test_readers_come_and_go(self):
        with Loopback(), Emulator() as emulator:
            data = []
            for turn in range(4):
                file = emulator.folder / f"{turn}.raw"
                # Readers that ask for few buffers take them from all on old modules; frames stay whole.
                status, text = v4l2_ctl(file, 6, buffers=(4, 3, 2, 2)[turn])
                self.assertEqual(status, 0, text)
                data.append(file.read_bytes())
            killed = subprocess.Popen(["v4l2-ctl", "-d", DEVICE, "--stream-mmap", "--stream-to=/dev/null"],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(1)
            killed.kill()
            killed.wait()
            file = emulator.folder / "last.raw"
            self.assertEqual(v4l2_ctl(file, 6)[0], 0)
            data.append(file.read_bytes())
            report = emulator.stop()
            self.assertEqual(report["outputs"][0]["dropped"], 0)
            numbers = emulator.numbers()
            for part in data:
                self.assertGreaterEqual(len(ids_of(part, "Y16", numbers)), 6)

    def test_the_emulator_comes_back_under_a_reader(self):
        """The reader has the device open throughout; the second emulator's frames reach it."""
        with Loopback():
            with Emulator() as first:
                file = first.folder.parent / "through.raw"
                reader = subprocess.Popen(["v4l2-ctl", "-d", DEVICE, "--stream-mmap", "--stream-count=40",
                                           f"--stream-to={file}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                bench.wait_until(lambda: file.exists() and file.stat().st_size > 10 * WIDTH * HEIGHT * 2, 30, "frames")
                first.stop()
                numbers = first.numbers()
            with Emulator("seed=77") as second:
                self.assertEqual(reader.wait(timeout=60), 0)
                second.stop()
                size = 2 * WIDTH * HEIGHT
                data = file.read_bytes()
                others = {bench.wire("Y16", dn) for dn in second.numbers().values()}
                mine = {bench.wire("Y16", dn) for dn in numbers.values()}
                whose = ["first" if data[at:at + size] in mine else "second" if data[at:at + size] in others else "nobody"
                         for at in range(0, len(data), size)]
                self.assertNotIn("nobody", whose)
                self.assertEqual(whose, sorted(whose))
                self.assertIn("second", whose)
                file.unlink()

    def test_a_reader_that_holds_another_format_is_named(self):
        with Loopback():
            with Emulator("outputs.v4l2.format=GREY"):
                reader = subprocess.Popen(["v4l2-ctl", "-d", DEVICE, "--stream-mmap", "--stream-to=/dev/null"],
                                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(1.5)
            try:
                status, text = run(*Emulator("outputs.v4l2.format=Y16").command, "--frames", "1")
                self.assertEqual(status, 1, text)
                self.assertRegex(text, "/dev/video0: (asked for Y16 .*close that reader|refuses Y16 .*has it open)")
            finally:
                reader.kill()
                reader.wait()
            with Emulator("outputs.v4l2.format=Y16") as again:
                again.stop()

    def test_two_emulators_do_not_share_a_device(self):
        with Loopback(), Emulator() as first:
            status, text = run(*Emulator().command, "--frames", "1")
            self.assertEqual(status, 1, text)
            self.assertRegex(text, "another program feeds it")
            first.stop()

    def test_a_camera_without_filters_has_no_mosaic(self):
        with Loopback():
            status, text = run(*Emulator("outputs.v4l2.format=BAYER8").command, "--frames", "1")
            self.assertEqual(status, 2)
            self.assertIn("the camera has no colour filters; accepted: GREY, Y16, YUYV, RGB24", text)

    def test_too_large_a_picture_is_named(self):
        with Loopback(max_width=100, max_height=100):
            status, text = run(*Emulator().command, "--frames", "1")
            self.assertEqual(status, 1)
            self.assertIn("max_width and max_height", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
