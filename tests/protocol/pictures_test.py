#!/usr/bin/python3
"""Pictures in the hands of other programs' readers: Pillow, astropy, OpenImageIO.

    pictures_test.py HILCAM SOURCE_DIR

Each format is read as docs/pictures.md says. What a reader is missing for is skipped.
"""
import importlib
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy
from PIL import Image

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
STARS = """\
name: stars
time_utc: 2026-03-20T12:00:00Z
seed: 5
camera: %(source)s/configs/cameras/has2_star_tracker.yaml
camera_pose: {position_m: [0, 0, 2.0e+9], attitude_wxyz: [0.5, -0.5, 0.3, 0.64031242]}
earth: {visible: false}
moon: {visible: false}
stars: {catalogue: %(source)s/configs/stars/hipparcos.csv, faintest_magnitude: 6}
"""


def reader(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        raise unittest.SkipTest(f"{name} is not installed")


class Pictures(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def render(self, name, *arguments, scenario=SCENARIO):
        result = subprocess.run([HILCAM, "render", scenario, "--set", "seed=7", "--out", self.folder / name, *arguments],
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.folder / name, result.stderr

    def frame(self):
        """The frame's numbers, as the camera's memory has them."""
        raw, _ = self.render("frame.raw")
        return numpy.frombuffer(raw.read_bytes(), "<u2")

    def test_pillow_finds_numbers_and_notes(self):
        dn = self.frame()
        png, words = self.render("frame.png")
        self.assertRegex(words, r"^hilcam: .*frame.png: 12-bit DN right-aligned in 16 bits, dark in a viewer; --view FILE.png")
        self.assertEqual(len(words.splitlines()), 1)
        picture = Image.open(png)
        self.assertTrue((numpy.array(picture).ravel() == dn).all())
        self.assertEqual(picture.text["seed"], "7")
        self.assertRegex(picture.text["Software"], r"^hilcam \d")
        tiff, _ = self.render("frame.tiff")
        picture = Image.open(tiff)
        self.assertTrue((numpy.array(picture).ravel() == dn).all())
        notes = json.loads(picture.tag_v2[270])
        self.assertEqual(notes["seed"], 7)
        manual = (SOURCE / "docs/pictures.md").read_text()
        for key in notes:
            self.assertIn(f"`{key}`", manual)
        self.assertEqual(notes["unit"], "DN")
        self.assertAlmostEqual(math.hypot(*notes["attitude_wxyz"]), 1)
        self.assertEqual(picture.tag_v2[306], notes["time_utc"][:19].replace("-", ":").replace("T", " "))
        self.assertEqual(picture.tag_v2[305], notes["software"])
        self.assertEqual(tiff.read_bytes(), self.render("again.tiff")[0].read_bytes())

    def test_a_view_is_eight_bits_and_bright(self):
        _, words = self.render("frame.png", "--view", self.folder / "view.png")
        self.assertEqual(words, "")
        view = Image.open(self.folder / "view.png")
        self.assertEqual(view.mode, "L")
        dn = self.frame()
        black, white = (float(view.text[f"view_{end}_dn"]) for end in ("black", "white"))
        expected = numpy.rint(255 * numpy.clip((dn - black) / (white - black), 0, 1) ** (1 / 2.2))
        self.assertTrue((numpy.array(view).ravel() == expected).all())
        self.assertGreater(numpy.array(view).max(), 250)

    def test_astropy_reads_fits_and_finds_the_stars(self):
        fits, wcs = reader("astropy.io.fits"), reader("astropy.wcs")
        scenario = self.folder / "stars.yaml"
        scenario.write_text(STARS % {"source": SOURCE})
        file, words = self.render("stars.fits", "--truth", self.folder / "truth", scenario=scenario)
        self.assertEqual(words, "")
        with fits.open(file) as hdus, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that DATE-OBS was made a Julian date
            hdus.verify("exception")
            header, dn = hdus[0].header, hdus[0].data
            sky = wcs.WCS(header)
        self.assertEqual(header["SEED"], 7)
        self.assertEqual(dn.dtype, numpy.uint16)
        png, _ = self.render("stars.png", scenario=scenario)
        self.assertTrue((numpy.array(Image.open(png)) == dn).all())
        truth = json.loads((self.folder / "truth/stars.truth.jsonl").read_text().splitlines()[1])
        lines = (SOURCE / "configs/stars/hipparcos.csv").read_text().splitlines()
        rows = [line for line in lines if line and not line.startswith("#")]
        names = rows[0].split(",")
        places = {}
        for row in rows[1:]:
            values = dict(zip(names, row.split(",")))
            places[int(values["hip"] or 0)] = float(values["ra_deg"]), float(values["dec_deg"])
        self.assertGreater(len(truth["stars"]), 10)
        pixel_arcsec = 3600 * math.degrees(1 / truth["image"]["focal_length_px"][0])
        for star in truth["stars"]:
            x, y = sky.world_to_pixel_values(*places[star["hip"]])
            off_px = math.dist((x + 0.5, y + 0.5), star["position_px"])
            # Aberration is 20.5 arcsec at most, proper motion since J1991.25 below 5 of them for all but a handful of stars.
            self.assertLess(off_px * pixel_arcsec, 30, star)

    def test_openimageio_finds_planes_and_attributes(self):
        oiio = reader("OpenImageIO")
        for stage, channels in (("electrons", ["Y"]), ("radiance", None)):
            file, words = self.render(f"{stage}.exr", "--stage", stage)
            self.assertEqual(words, "")
            image = oiio.ImageInput.open(str(file))
            spec = image.spec()
            if channels:
                self.assertEqual(list(spec.channelnames), channels)
            else:
                self.assertEqual(set(spec.channelnames[:3]), set("RGB"))
                self.assertRegex(" ".join(spec.channelnames), r"L_0\.\d{3}_0\.\d{3}um")
            self.assertEqual(spec.getattribute("seed"), "7")
            self.assertEqual(spec.getattribute("frame"), "1")
            self.assertGreater(spec.getattribute("exposure_s"), 0)
            self.assertGreater(image.read_image().max(), 0)

    def test_truth_has_the_pixels_of_its_picture(self):
        """Charge and light are shown before a camera bins them."""
        sizes = {}
        for stage, ending, binned in (("electrons", "exr", False), ("frame", "png", True)):
            file, _ = self.render(f"binned_{stage}.{ending}", "--stage", stage, "--truth", self.folder / "binned",
                                  "--set", "camera.binning_x=2", "--set", "camera.binning_y=2")
            truth = json.loads((self.folder / f"binned/binned_{stage}.truth.jsonl").read_text().splitlines()[1])
            mask = Image.open(self.folder / f"binned/binned_{stage}.truth.object.png")
            sizes[stage] = mask.size
            self.assertEqual(truth["image"]["binning"], [2, 2] if binned else [1, 1])
        self.assertEqual(sizes["frame"], Image.open(file).size)
        self.assertEqual(sizes["electrons"], tuple(2 * side for side in sizes["frame"]))

    def test_truth_masks_are_sixteen_bits(self):
        oiio = reader("OpenImageIO")
        self.render("frame.raw", "--truth", self.folder / "truth")
        mask = numpy.array(Image.open(self.folder / "truth/frame.truth.object.png"))
        layers = oiio.ImageInput.open(str(self.folder / "truth/frame.truth.exr"))
        # OpenImageIO gives whole numbers beside floats as shares of their greatest.
        shares = layers.read_image()[..., list(layers.spec().channelnames).index("object.ID")]
        ids = numpy.rint(shares.astype(float) * (2**32 - 1)).astype(int)
        bodies = ids >= 1000000
        self.assertTrue((mask == numpy.where(bodies, ids - 1000000 + 60000, ids)).all())
        self.assertIn(1, mask)

    def layers(self, *arguments):
        """The channels of a picture with the parts of its light, by name."""
        oiio = reader("OpenImageIO")
        file, _ = self.render("parts.exr", "--stage", "radiance", "--parts", *arguments)
        image = oiio.ImageInput.open(str(file))
        pixels, names = image.read_image(), list(image.spec().channelnames)
        image.close()
        return {name: pixels[..., i] for i, name in enumerate(names)}

    def test_parts_are_layers_that_add_up_to_the_picture(self):
        # The manual's rows are the layers, in their order.
        manual = (SOURCE / "docs/pictures.md").read_text().split("| Layer |")[1].split("\n\n")[0]
        parts = [line.split("`")[1] for line in manual.splitlines()[2:]]
        for edges, bins in (([0.4, 0.7], {"Y": "Y"}), ([0.4, 0.55, 0.6255, 0.7], {
                "L_0.400_0.550um": "L_400_550nm", "L_0.550_0.625um": "L_550_625p5nm", "L_0.625_0.700um": "L_625p5_700nm"})):
            channels = self.layers("--set", f"spectrum_edges_um={edges}")
            names = ("Y",) if len(edges) == 2 else (*bins.values(), "R", "G", "B")
            self.assertEqual({name for name in channels if "." in name and not name.startswith("L_")},
                             {f"{part}.{name}" for part in parts for name in names})
            for picture_bin, layer_bin in bins.items():
                total = numpy.zeros_like(channels[picture_bin])
                for part in parts[:-1]:
                    total += channels[f"{part}.{layer_bin}"]
                self.assertTrue((total == channels[picture_bin]).all())
                self.assertGreater(channels[f"direct.sun.{layer_bin}"].max(), 0)
                self.assertGreater(channels[f"rays.path.{layer_bin}"].max(), 0)

    def test_names_of_a_runs_files(self):
        result = subprocess.run([HILCAM, "run", SCENARIO, "--frames", "2", "--set", "mode=free_run", "--set",
                                 "outputs={files: {folder: '%s', name: 'cam{camera}_%%03d.png', view: true}}" % (self.folder / "run")],
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        names = sorted(f.name for f in (self.folder / "run").iterdir())
        self.assertIn("cam1_001.png", names)
        self.assertIn("cam1_001.view.png", names)
        frame = Image.open(self.folder / "run/cam1_001.png")
        self.assertEqual(frame.text["frame"], "1")
        self.assertEqual(len(json.loads(frame.text["position_m"])), 3)
        result = subprocess.run([HILCAM, "check", SCENARIO, "--set", "outputs.files={name: picture.png}"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("each frame would be written over the one before", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
