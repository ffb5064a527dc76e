#!/usr/bin/python3
"""Three whole cameras (docs/whole_cameras.md): a real camera's face, its sensor's public figures, a picture by its own names.

    whole_cameras_test.py HILCAM

Needs the real cameras' descriptions in ../shared/data/genicam and the flight pictures beside them, which are not shipped;
skips without.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from bench import SOURCE, Emulator

sys.path.insert(0, str(SOURCE / "tests/protocol"))
import plate  # noqa: E402

DATA = pathlib.Path(os.environ.get("HILCAM_SHARED_DATA", SOURCE.parent / "shared/data"))
BIND = SOURCE / "tools/hilcam-camera-face"
RECORD = SOURCE / "tools/hilcam-record-frames"
CAMERAS = SOURCE / "configs/cameras"
HILCAM = sys.argv[1]
ADDRESS = "127.0.23.40"
# A client that knows its camera's names alone: sets features, takes one picture, prints its format's code and writes its bytes.
CLIENT = """
import sys, gi
gi.require_version("Aravis", "0.8")
from gi.repository import Aravis
address, out, count, *features = sys.argv[1:]
camera = Aravis.Camera.new(address)
genicam = camera.get_device().get_genicam()
for feature in features:
    name, value = feature.split("=")
    node = genicam.get_node(name)
    node.set_string_value(value) if isinstance(node, Aravis.GcEnumeration) else node.set_value(
        float(value) if isinstance(node, Aravis.GcFloat) else int(value))
if int(count):
    camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)
    stream = camera.create_stream(None, None)
    for _ in range(int(count) + 2):
        stream.push_buffer(Aravis.Buffer.new_allocate(camera.get_payload()))
    genicam.get_node("AcquisitionStart").execute()
    taken = 0
    while taken < int(count):
        buffer = stream.timeout_pop_buffer(60000000)
        assert buffer is not None, "no picture in a minute"
        taken += buffer.get_status() == Aravis.BufferStatus.SUCCESS  # a client on a busy machine loses packets
        if taken < int(count):
            stream.push_buffer(buffer)
    genicam.get_node("AcquisitionStop").execute()
    print(buffer.get_image_width(), buffer.get_image_height(), hex(buffer.get_image_pixel_format()))
    open(out, "wb").write(buffer.get_image_data() if hasattr(buffer, "get_image_data") else buffer.get_data())
"""
MOON = """
name: whole_bfs
time_utc: 2023-12-22T21:29:53Z
seed: 1
origin: {{kind: earth_fixed, longitude_deg: 8.3810, latitude_deg: 45.8485, height_km: 0.455}}
camera: {camera}
camera_pose: {{position_m: [0, 0, 0], attitude: nadir, nadir_of: moon}}
atmosphere: {{model: precomputed}}
moon: {{law: hapke, albedo_map: {maps}/moon_color.png, albedo_map_reference: 0.5, height_map: {maps}/moon_height.png, height_zero_m: -10000}}
spectrum_edges_um: [0.35, 0.45, 0.55, 0.65, 0.75, 0.95]
loop: {{levels: fixed}}
"""


class WholeCamera(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def camera(self, description, camera_file, scenario, *sets):
        """Runs a scenario with a camera file under the face of a description."""
        xml = DATA / "genicam" / description
        if not xml.is_file():
            self.skipTest(f"{xml} is not there")
        try:
            import gi
            gi.require_version("Aravis", "0.8")
        except (ImportError, ValueError):
            self.skipTest("gir1.2-aravis-0.8 is not installed")
        face, file = self.folder / "face.json", self.folder / "scenario.yaml"
        if not isinstance(scenario, pathlib.Path):
            file.write_text(scenario.format(camera=camera_file, maps=SOURCE / "configs/maps"))
            scenario = file
        camera = [word for s in sets if s.startswith("camera.") for word in ("--set", s.removeprefix("camera."))]
        bound = subprocess.run([str(BIND), "bind", str(xml), str(camera_file), "-o", str(face), *camera], capture_output=True,
                               text=True, timeout=120)
        self.assertEqual(bound.returncode, 0, bound.stderr)
        emulator = Emulator(HILCAM, ADDRESS, self.folder, f"camera={camera_file}", f"outputs.gige.genicam_file={xml}",
                            f"outputs.gige.face_file={face}", *sets, scenario=scenario)
        self.addCleanup(emulator.stop)
        return emulator

    def picture(self, count, kind, *features):
        """The last of some pictures, as an array, after features were set by the vendor's names; 0: none."""
        import numpy
        out = self.folder / "picture.raw"
        done = subprocess.run(["/usr/bin/python3", "-c", CLIENT, ADDRESS, str(out), str(count), *features], capture_output=True,
                              text=True, timeout=240)
        self.assertEqual(done.returncode, 0, done.stderr)
        if not count:
            return None
        width, height, self.code = done.stdout.split()
        return numpy.frombuffer(out.read_bytes(), kind)[:int(width) * int(height)].reshape(int(height), int(width)).astype(float)

    def picture_of_render(self):
        """What `hilcam render` makes of the running scenario with the real picture's settings, in 8 bits."""
        import numpy
        from PIL import Image
        out = self.folder / "rendered.png"
        done = subprocess.run([HILCAM, "render", str(self.folder / "scenario.yaml"), "--set", "camera.offset_dn=0", "--set",
                               "camera.exposure_ms=0.114", "--set", "camera.gain_db=15", "--out", str(out)], capture_output=True, text=True,
                              timeout=240)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.rendered = numpy.floor(numpy.asarray(Image.open(out)) / 16).astype(float)  # 12 bits to 8

    def test_a_blackfly_s_takes_the_moon_as_the_real_one_did(self):
        import numpy
        from PIL import Image
        flight_file = DATA / "flight/moon_bfs/imgFLIR_20231222212953_115.png"
        if not flight_file.is_file():
            self.skipTest(f"{flight_file} is not there")
        self.camera("FLIR_BFS_31S4M.xml", CAMERAS / "bfs_u3_31s4m.yaml", MOON, "camera.offset_dn=0")
        # The settings of the real picture, by FLIR's names (andrepiz/abram, test/validation/opensky_bfs).
        made = self.picture(2, "u1", "PixelFormat=Mono8", "ExposureTime=114", "Gain=15")
        flight = numpy.asarray(Image.open(flight_file).convert("L")).astype(float)
        self.assertEqual(made.shape, flight.shape)
        self.picture_of_render()
        lit = [p > 12 for p in (flight, made, self.rendered)]
        sums = [p[where].sum() for p, where in zip((flight, made, self.rendered), lit)]
        places = [[(axis[where] * p[where]).sum() / p[where].sum() for axis in numpy.mgrid[0:p.shape[0], 0:p.shape[1]]]
                  for p, where in zip((made, self.rendered), lit[1:])]
        print(f"\nMoon, sums of DN: flight over this picture {sums[0] / sums[1]:.3f}, this picture over hilcam render's {sums[1] / sums[2]:.4f}")
        self.assertAlmostEqual(sums[1] / sums[2], 1, delta=0.005)
        self.assertLess(numpy.hypot(*numpy.subtract(*places)), 0.05)
        self.assertAlmostEqual(sums[0] / sums[1], 1.185, delta=0.03)  # as in docs/flight.md, which says why

    def test_a_basler_ace_is_measured_as_its_sheet_says(self):
        scene = plate.write(self.folder, CAMERAS / "basler_aca2040_35gm.yaml", 1.1)
        window = ("camera.width_px=256", "camera.height_px=192")
        frames = self.folder / "frames"
        for kind, exposures, dark in (("dark", ("0.1ms", "20ms"), ("sun.spectrum=0",)),
                                      ("flat", ("0.1ms", "0.2ms", "0.3ms", "0.4ms", "0.5ms", "0.6ms", "4ms"), ())):
            emulator = self.camera("Basler-acA1300-75gm.xml", CAMERAS / "basler_aca2040_35gm.yaml", scene, *window, *dark)
            self.picture(0, "u2", "PixelFormat=Mono12")
            taken = subprocess.run([str(RECORD), kind, ADDRESS, str(frames), "--yes", "--frames", "16", "--exposures", *exposures],
                                   capture_output=True, text=True, timeout=240)
            self.assertEqual(taken.returncode, 0, taken.stderr)
            emulator.stop()
        clone = subprocess.run([HILCAM, "clone", str(frames), "--like", str(CAMERAS / "basler_aca2040_35gm.yaml"), "--set", "width_px=256",
                                "--set", "height_px=192", "--out", str(self.folder / "ace.yaml"), "--json"], capture_output=True, text=True, timeout=240)
        self.assertEqual(clone.returncode, 0, clone.stderr)
        figures = json.loads(clone.stdout)["figures"]
        for key, sheet in (("gain_dn_e", 1 / 2.8), ("read_noise_e", 2.3), ("full_well_e", 10760), ("prnu_fraction", 0.004)):
            figure = figures[key]
            print(f"{key}: {figure['measured']:.5g} +- {figure['uncertainty']:.2g}, sheet {sheet:.5g}")
            self.assertLess(abs(figure["measured"] - sheet), 4 * figure["uncertainty"] + 0.002 * sheet, key)

    def test_an_a35_shows_a_visible_scene(self):
        import numpy
        scenario = SOURCE / "configs/scenarios/geo_inspection.yaml"
        self.camera("FLIR_A35.xml", CAMERAS / "flir_a35_stand_in.yaml", scenario, "camera_pose.position_m=[9, 6, 3]", "loop.levels=fixed")
        deep = self.picture(2, "<u2", "PixelFormat=Mono14")
        self.assertEqual((deep.shape, self.code), ((256, 320), "0x1100025"))
        shallow = self.picture(2, "u1", "PixelFormat=Mono8")
        lit = deep > 500
        self.assertGreater(numpy.count_nonzero(lit), 2000)
        self.assertLess(abs(numpy.median(deep[lit] / 64 - shallow[lit])), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
