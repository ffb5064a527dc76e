#!/usr/bin/python3
"""What hilcam sends as image packets, read by the header that flight software copies (tools/image_packets): the pixels of its files.

    image_reader_test.py HILCAM IMAGE_PACKETS_READER
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy
from PIL import Image

HILCAM, READER = (os.path.abspath(path) for path in sys.argv[1:3])
SCENARIO = pathlib.Path(__file__).resolve().parents[1] / "minimal_scenario.yaml"
os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")


class Packets(unittest.TestCase):
    def test_pixels_are_those_of_the_files(self):
        for payload in ("raw_le", "raw_be", "packed"):
            with self.subTest(payload), tempfile.TemporaryDirectory() as folder:
                packets = f"{{transport: file, folder: {folder}/packets, payload: {payload}, strip_rows: 25, apid: 291}}"
                run = subprocess.run([HILCAM, "run", str(SCENARIO), "--frames", "4", "--set", f"outputs.packets={packets}", "--set",
                                      f"outputs.files.folder={folder}/files"], capture_output=True, text=True, timeout=120)
                self.assertEqual(run.returncode, 0, run.stderr)
                with open(f"{folder}/packets/packets.bin", "rb") as stream:
                    read = subprocess.run([READER, "291", folder], stdin=stream, capture_output=True, text=True, timeout=60)
                self.assertEqual(read.returncode, 0, read.stdout)
                lines = [line.split() for line in read.stdout.splitlines()]
                self.assertEqual(len(lines), 4)
                for frame, missing_pixels, missing_packets in lines:
                    self.assertEqual((missing_pixels, missing_packets), ("0", "0"))
                    picture = numpy.array(Image.open(f"{folder}/files/frame_{int(frame):08}.png"))
                    pixels = numpy.fromfile(f"{folder}/{frame}.raw", dtype=numpy.uint16).reshape(picture.shape)
                    numpy.testing.assert_array_equal(pixels, picture)


if __name__ == "__main__":
    if "outputs.packets" not in subprocess.run([HILCAM, "manual"], capture_output=True, text=True, check=True).stdout:
        print("skipped: this hilcam has no outputs.packets")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
