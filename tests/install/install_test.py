#!/usr/bin/python3
"""An installed tree, moved to another place: it has its files where GNU programs have them, and runs without the source tree.

    install_test.py BUILD SOURCE CMAKE
"""
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

import manual_names

BUILD, SOURCE, CMAKE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="hilcam_install_"))
        subprocess.run([CMAKE, "--install", BUILD, "--prefix", cls.folder / "first", "--strip"], check=True, stdout=subprocess.DEVNULL)
        cls.prefix = cls.folder / "moved"
        (cls.folder / "first").rename(cls.prefix)
        cls.work = cls.folder / "work"
        cls.work.mkdir()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def hilcam(self, *arguments, status=0, **more):
        result = subprocess.run([self.prefix / "bin/hilcam", *arguments], cwd=self.work, capture_output=True, text=True, timeout=120, **more)
        self.assertEqual(result.returncode, status, result.stderr)
        return result.stdout + result.stderr

    def test_files_lie_where_gnu_programs_have_them(self):
        for name in ("bin/hilcam", "libexec/hilcam/hilcam-make-spacecraft", "libexec/hilcam/hilcam-plot-tradeoff", "libexec/hilcam/hilcam-read-map",
                     "libexec/hilcam/hilcam-plot-campaign", "libexec/hilcam/hilcam-plot-latency", "libexec/hilcam/hilcam-camera-face",
                     "share/hilcam/camera_face/binding.py", "share/hilcam/schema/campaign.schema.json",
                     "share/doc/hilcam/tools/python/hilcam/client.py",
                     "share/hilcam/scenarios/small.yaml", "share/hilcam/stars/hipparcos.csv", "share/hilcam/maps/earth_albedo.png",
                     "share/hilcam/schema/scenario.schema.json", "share/hilcam/client/hilcam_client.py", "share/hilcam/client/hilcam_read_packets.py",
                     "share/doc/hilcam/tools/client/hilcam_client.py", "share/doc/hilcam/tools/client/hilcam_client.h",
                     "share/doc/hilcam/tools/flight_software_example/main.cpp",
                     "share/doc/hilcam/tools/landing_example/main.cpp", "share/doc/hilcam/tools/flight_software_glue/camera_link.c",
                     "share/doc/hilcam/configs/scenarios/small.yaml",
                     "share/doc/hilcam-examples/examples/README.md",
                     "include/hilcam/hilcam_client.h", "include/hilcam/render/frame/plugin.h", "share/man/man1/hilcam.1",
                     "share/man/man1/hilcam-send.1", "share/bash-completion/completions/hilcam",
                     "lib/systemd/system/hilcam@.service", "share/doc/hilcam/NOTICE", "share/doc/hilcam/docs/protocol.md"):
            self.assertTrue((self.prefix / name).is_file(), name)

    def test_the_manual_names_no_file_that_is_elsewhere(self):
        self.assertGreater(len(manual_names.pages(self.prefix)), 60)
        self.assertEqual(manual_names.missing_in(self.prefix), [])

    def test_a_page_that_names_a_lost_file_is_seen(self):
        def lost(text):
            page = self.prefix / "share/doc/hilcam/docs/invented.md"
            return [line.split(": ")[1] for line in manual_names.missing_names(page, text, self.prefix)]

        self.assertEqual(lost("`tools/check` and [a page](nowhere.md), `share/hilcam/nothing`\n\n    build/release/bin/hilcam\n"),
                         ["nowhere.md", "tools/check", "share/hilcam/nothing", "build/release/bin/hilcam"])
        # What is there, and what the source tree is said to have; a paragraph's mark is not for the next one.
        self.assertEqual(lost("`configs/scenarios/small.yaml`, [pages](protocol.md), `render/frame/plugin.h`"), [])
        self.assertEqual(lost("In the source tree:\n\n    tools/check\n\n`tools/package`"), ["tools/package"])
        self.assertEqual(lost("[In the source tree](nowhere.md) `tools/check`"), ["nowhere.md"])

    def test_the_programs_know_no_data_of_the_source_tree(self):
        for name in ("bin/hilcam", "libexec/hilcam/hilcam-make-spacecraft"):
            self.assertNotIn(os.fsencode(SOURCE / "configs"), (self.prefix / name).read_bytes(), name)

    def test_the_version_has_a_commit(self):
        self.assertRegex(self.hilcam("--version"), r"^hilcam \d+\.\d+\.\d+ \(\S.*\)\n$")

    def test_a_shipped_scenario_renders_by_its_name(self):
        for name in ("small", "configs/scenarios/small.yaml", "scenarios/small.yaml"):
            self.hilcam("render", name, "--out", "frame.png", "--set", "camera.width_px=64", "--set", "camera.height_px=48")
            self.assertEqual((self.work / "frame.png").read_bytes()[16:24], b"\0\0\0\x40\0\0\0\x30")
            (self.work / "frame.png").unlink()
        self.assertIn("nearest: small", self.hilcam("check", "smal", status=2))

    def test_a_scenario_of_ones_own_names_shipped_files(self):
        text = (SOURCE / "configs/scenarios/small.yaml").read_text().replace("../", "")
        (self.work / "own.yaml").write_text(text)
        self.hilcam("render", "own.yaml", "--out", "own.png", "--set", "camera.width_px=64", "--set", "camera.height_px=48")
        # A file of that name in the scenario's own folder comes first.
        (self.work / "cameras").mkdir()
        (self.work / "cameras/inspector_1k.yaml").write_text("name: mine\n")
        self.assertIn("cameras/inspector_1k.yaml:1:1: camera.", self.hilcam("check", "own.yaml", status=2))
        shutil.rmtree(self.work / "cameras")

    def test_a_shipped_scenario_writes_to_the_working_directory(self):
        self.hilcam("run", "small", "--frames", "1", "--set", "camera.width_px=64", "--set", "camera.height_px=48", "--set",
                    "commands={}", "--set", "mode=free_run")
        self.assertTrue(any((self.work / "out/small").glob("*.png")))
        shutil.rmtree(self.work / "out")

    def test_the_data_sheet_of_a_shipped_camera(self):
        self.assertEqual(json.loads(self.hilcam("check", "lorri", "--json"))["name"], "lorri")

    def test_a_service_manager_hears_when_it_is_ready_and_when_it_stops(self):
        for address in (str(self.work / "notify"), "\0hilcam_install_%d" % os.getpid()):
            with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
                manager.bind(address)
                manager.settimeout(5)
                self.hilcam("run", "small", "--frames", "1", "--set", "camera.width_px=64", "--set", "camera.height_px=48", "--set",
                            "commands={}", "--set", "outputs={}", env=os.environ | {"NOTIFY_SOCKET": address.replace("\0", "@")})
                self.assertEqual([manager.recv(100), manager.recv(100)], [b"READY=1", b"STOPPING=1"])
        # A socket that nobody hears is no failure of the camera.
        self.hilcam("run", "small", "--frames", "1", "--set", "camera.width_px=64", "--set", "camera.height_px=48", "--set", "commands={}",
                    "--set", "outputs={}", env=os.environ | {"NOTIFY_SOCKET": str(self.work / "nobody")})

    def test_the_unit_is_one_that_systemd_takes(self):
        verify = shutil.which("systemd-analyze")
        if not verify:
            self.skipTest("systemd-analyze is not installed")
        unit = (self.prefix / "lib/systemd/system/hilcam@.service").read_text()
        (self.work / "hilcam@.service").write_text(unit.replace("ExecStart=hilcam", f"ExecStart={self.prefix}/bin/hilcam"))
        result = subprocess.run([verify, "verify", "--man=no", "hilcam@bench.service"], cwd=self.work, capture_output=True, text=True,
                                env=os.environ | {"SYSTEMD_UNIT_PATH": f"{self.work}:"})
        said = [line for line in result.stderr.splitlines() if "hilcam" in line]
        self.assertEqual((result.returncode, said), (0, []), result.stderr)


if __name__ == "__main__":
    os.environ.setdefault("HILCAM_CACHE", tempfile.gettempdir() + f"/hilcam_test_cache_{os.getuid()}")
    unittest.main(argv=sys.argv[:1], verbosity=2)
