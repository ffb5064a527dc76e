#!/usr/bin/python3
"""tools/check-devices says what is missing beside the given program before it installs, builds or boots anything."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/check-devices"


class Given(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        # Nothing by which a package could be installed or a program be built.
        (self.folder / "path").mkdir()
        for name in ("bash", "dirname", "basename", "cat", "env"):
            (self.folder / "path" / name).symlink_to(shutil.which(name))

    def program(self, name):
        file = self.folder / name
        file.write_text("#!/bin/sh\n")
        file.chmod(0o755)
        return file

    def refusal(self, *arguments):
        result = subprocess.run([str(SCRIPT), *map(str, arguments)], capture_output=True, text=True, timeout=60,
                                env={**os.environ, "PATH": str(self.folder / "path")})
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stdout, "")
        return result.stderr

    def test_each_test_names_what_it_needs(self):
        hilcam = self.program("hilcam")
        self.assertEqual(self.refusal("--hilcam", hilcam, "v4l2", "faults"),
                         f"check-devices: v4l2_faults: missing beside {hilcam}; cmake --build FOLDER --target v4l2_faults, "
                         "or name other tests\n")
        self.program("v4l2_faults")
        self.assertIn("check-devices: usb_pose_gadget usb_receiver: missing beside", self.refusal("--hilcam", hilcam))
        self.program("usb_receiver")
        self.assertIn("check-devices: usb_pose_gadget: missing beside", self.refusal("--hilcam", hilcam, "usb"))

    def test_what_is_no_program_is_named(self):
        for nothing in (self.folder, self.folder / "none"):
            self.assertEqual(self.refusal("--hilcam", nothing),
                             f"check-devices: --hilcam: found '{nothing}'; accepted: a program\n")


if __name__ == "__main__":
    unittest.main(verbosity=2)
