#!/usr/bin/python3
"""The cache by the program: damaged files change no picture and refuse no run; folders of others are refused; a bound is kept.

    cache_test.py HILCAM SOURCE_DIR
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
KINDS = {"transfer": "tables of light", "levels": "levels of detail", "hilcam-make-spacecraft": "generated meshes"}


class Cache(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.top = pathlib.Path(cls.temporary.name)
        cls.whole = cls.top / "whole"
        cls.picture = cls.render(cls, cls.whole)[0]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def render(self, cache, expect=0, **environment):
        """A picture's bytes and what the log said."""
        out = self.top / "picture.png"
        out.unlink(missing_ok=True)
        result = self.hilcam("render", SCENARIO, "--set", "quality.path_model=cached", "--set", "quality.probes=2000", "--set",
                             "quality.lod_error_px=0.5", "--out", out, cache=cache, **environment)
        assert result.returncode == expect, result.stderr
        return out.read_bytes() if out.exists() else None, result.stderr

    @staticmethod
    def hilcam(*arguments, cache=None, **environment):
        own = {name: value for name, value in os.environ.items() if not name.startswith("HILCAM_CACHE")} | environment
        if cache:
            own["HILCAM_CACHE"] = str(cache)
        return subprocess.run([HILCAM, *map(str, arguments)], capture_output=True, text=True, timeout=120, env=own)

    def copy(self, name):
        folder = self.top / name
        shutil.copytree(self.whole, folder)
        return folder

    def test_damage_changes_no_picture_and_refuses_no_run(self):
        files = sorted(path.name for path in self.whole.iterdir())
        self.assertEqual(sorted(name.split("_")[0] for name in files), sorted(KINDS))
        draw = random.Random(5)
        for name in files:
            whole = (self.whole / name).read_bytes()
            flip = draw.randrange(len(whole))
            page = draw.randrange(len(whole) // 2)
            for what, damaged in (("cut", whole[:-1]), ("empty", b""), ("garbage", b"garbage" * 100), ("grown", whole + bytes(512)),
                                  ("one bit", whole[:flip] + bytes([whole[flip] ^ 8]) + whole[flip + 1:]),
                                  ("page of ones", whole[:page] + b"\xFF" * 4096 + whole[page + 4096:])):
                with self.subTest(file=name, damage=what):
                    (self.whole / name).write_bytes(damaged)
                    picture, log = self.render(self.whole)
                    self.assertEqual(picture, self.picture)
                    self.assertIn(f"cache: {self.whole / name} is damaged, or of another version: it is made anew", log)
                    self.assertEqual((self.whole / name).read_bytes(), whole)

    def test_what_is_there_is_told_and_cleared(self):
        folder = self.copy("told")
        (folder / "notes.txt").write_text("mine")
        told = self.hilcam("cache", cache=folder, HILCAM_CACHE_MB="50").stdout
        self.assertRegex(told, rf"{folder}: 3 files, \d+ MB of at most 50 MB \(HILCAM_CACHE_MB\)")
        for kind in KINDS.values():
            self.assertRegex(told, rf"{kind} +1 files +[\d.]+ MB")
        doctor = self.hilcam("doctor", cache=folder).stdout
        self.assertRegex(doctor, r"3 files, \d+ MB of at most 4096 MB")
        self.assertIn("3 files removed", self.hilcam("cache", "clear", cache=folder).stdout)
        self.assertEqual([path.name for path in folder.iterdir()], ["notes.txt"])

    def test_the_bound_is_kept(self):
        folder = self.top / "bounded"
        picture, _ = self.render(folder, HILCAM_CACHE_MB="1")
        self.assertEqual(picture, self.picture)
        self.assertLessEqual(sum(path.stat().st_size for path in folder.iterdir()), 1_000_000 + max(path.stat().st_size for path in folder.iterdir()))
        nothing = self.top / "nothing"
        self.assertEqual(self.render(nothing, HILCAM_CACHE_MB="0")[0], self.picture)
        self.assertFalse(nothing.exists())
        self.assertIn("HILCAM_CACHE_MB: found 'many'", self.render(nothing, expect=2, HILCAM_CACHE_MB="many")[1])

    def test_a_folder_that_others_may_write_is_refused(self):
        folder = self.copy("open")
        folder.chmod(0o777)
        picture, log = self.render(folder, expect=2)
        self.assertIsNone(picture)
        self.assertEqual(len(log.strip().splitlines()), 1, log)
        self.assertIn("others may write there; accepted: one that they may not write (chmod go-w), or another folder in HILCAM_CACHE", log)
        self.assertEqual(self.hilcam("cache", "clear", cache=folder).returncode, 2)
        self.assertEqual(len(list(folder.iterdir())), 3)
        self.assertIn("others may write there", self.hilcam("doctor", cache=folder).stdout)

    def test_without_a_home_nothing_is_kept(self):
        temporary = self.top / "tmp"
        temporary.mkdir()
        environment = {"HOME": "", "XDG_CACHE_HOME": "", "TMPDIR": str(temporary)}
        self.assertEqual(self.render(None, **environment)[0], self.picture)
        self.assertEqual(list(temporary.iterdir()), [])
        refusal = self.hilcam("cache", **environment)
        self.assertEqual(refusal.returncode, 2)
        self.assertIn("there is no cache folder", refusal.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
