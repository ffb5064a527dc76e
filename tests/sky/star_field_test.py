#!/usr/bin/python3
"""Star fields at random attitudes, solved blindly by astrometry.net: the attitude that comes back is the commanded one.

    star_field_test.py HILCAM SOURCE_DIR

Needs solve-field and its Tycho-2 index of 60 to 2000 arcmin (astrometry.net, astrometry-data-tycho2-10-19); skipped else.
"""
import glob
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy
from PIL import Image

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
INDEX = "/usr/share/astrometry/index-tycho2-1*.fits"
SIZE_PX, PITCH_UM, FOCAL_MM = 1024, 18, 47.7  # of configs/cameras/has2_star_tracker.yaml
PIXEL_RAD = PITCH_UM * 1e-3 / FOCAL_MM
FIELDS = 5
# The index has places of J2000.0: then no proper motion is between it and the picture. Tycho-2's own are good to 0.1
# arcsec for stars that a tracker sees (Hog et al., A&A 355, L27, 2000: 7 mas below 9 mag), Hipparcos' to less.
TIME_UTC = "2000-01-01T11:58:55.816Z"
CATALOGUE_RAD = math.radians(0.1 / 3600)
LIGHT_AU_DAY = 173.1446327  # speed of light, from the IAU's astronomical unit

SCENARIO = """\
name: star_field
time_utc: %(time)s
seed: %(seed)d
camera: %(source)s/configs/cameras/has2_star_tracker.yaml
camera_pose: {position_m: [0, 0, 2.0e+9], attitude_wxyz: [%(attitude)s]}
earth: {visible: false}
moon: {visible: false}
stars: {catalogue: %(source)s/configs/stars/hipparcos.csv, faintest_magnitude: 8}
"""


def matrix(w, x, y, z):
    """World from body, of a unit quaternion."""
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def attitudes():
    """Uniform over all rotations, but for those that look within 60 degrees of the Sun (at RA 18.7 h, dec -23 then)."""
    generator = random.Random(20260320)
    sun = numpy.array([0.18, -0.90, -0.39])
    while True:
        q = numpy.array([generator.gauss(0, 1) for _ in range(4)])
        q /= numpy.linalg.norm(q)
        if matrix(*q)[:, 2] @ sun < 0.5:
            yield q


def earth_velocity():
    """About the Sun, in units of the speed of light, equatorial axes: from the low-precision Sun of the Astronomical
    Almanac, section C (0.01 degrees), of which 0.1 % of 20 arcsec matters."""
    def sun(day):
        anomaly, longitude = math.radians(357.528 + 0.9856003 * day), 280.460 + 0.9856474 * day
        true = math.radians(longitude + 1.915 * math.sin(anomaly) + 0.020 * math.sin(2 * anomaly))
        distance_au = 1.00014 - 0.01671 * math.cos(anomaly) - 0.00014 * math.cos(2 * anomaly)
        tilt = math.radians(23.439)
        return distance_au * numpy.array([math.cos(true), math.sin(true) * math.cos(tilt), math.sin(true) * math.sin(tilt)])
    return -(sun(0.5) - sun(-0.5)) / LIGHT_AU_DAY


def without_aberration(seen):
    """The catalogue's direction to what is seen there: to first order in v/c, 0.001 arcsec."""
    v = earth_velocity()
    place = seen - (v - (seen @ v) * seen)
    return place / numpy.linalg.norm(place)


def write_fits(file, image):
    """The first row of the picture is FITS's row 1."""
    cards = [("SIMPLE", "T"), ("BITPIX", "32"), ("NAXIS", "2"), ("NAXIS1", image.shape[1]), ("NAXIS2", image.shape[0])]
    header = "".join(f"{key:<8}= {value:>20}".ljust(80) for key, value in cards) + "END".ljust(80)
    data = image.astype(">i4").tobytes()
    with open(file, "wb") as out:
        for block, fill in ((header.encode(), b" "), (data, b"\0")):
            out.write(block + fill * (-len(block) % 2880))


def read_header(file):
    cards = {}
    text = pathlib.Path(file).read_bytes().decode("ascii", "replace")
    for i in range(0, len(text), 80):
        key, equals, value = text[i:i + 80].partition("=")
        if key.strip() == "END":
            break
        if equals:
            cards[key.strip()] = value.split("/")[0].strip().strip("'")
    return cards


def sky_direction(wcs, x, y):
    """Of a place in FITS pixels, by the gnomonic projection: Calabretta & Greisen, A&A 395, 1077 (2002)."""
    w = {key: float(wcs[key]) for key in ("CRVAL1", "CRVAL2", "CRPIX1", "CRPIX2", "CD1_1", "CD1_2", "CD2_1", "CD2_2")}
    dx, dy = x - w["CRPIX1"], y - w["CRPIX2"]
    east = math.radians(w["CD1_1"] * dx + w["CD1_2"] * dy)
    north = math.radians(w["CD2_1"] * dx + w["CD2_2"] * dy)
    a, d = math.radians(w["CRVAL1"]), math.radians(w["CRVAL2"])
    middle = numpy.array([math.cos(d) * math.cos(a), math.cos(d) * math.sin(a), math.sin(d)])
    to_east = numpy.array([-math.sin(a), math.cos(a), 0])
    to_north = numpy.array([-math.sin(d) * math.cos(a), -math.sin(d) * math.sin(a), math.cos(d)])
    found = middle + east * to_east + north * to_north
    return found / numpy.linalg.norm(found)


def angle(a, b):
    return math.atan2(numpy.linalg.norm(numpy.cross(a, b)), a @ b)


class StarField(unittest.TestCase):
    def solve(self, folder, attitude, seed):
        """The solution's header."""
        scenario = folder / "scenario.yaml"
        scenario.write_text(SCENARIO % {"time": TIME_UTC, "seed": seed, "source": SOURCE,
                                        "attitude": ", ".join(f"{c:.17g}" for c in attitude)})
        subprocess.run([HILCAM, "render", scenario, "--out", folder / "field.png"], check=True, timeout=120,
                       capture_output=True)
        image = numpy.array(Image.open(folder / "field.png")).astype(int)
        self.assertEqual(image.shape, (SIZE_PX, SIZE_PX))
        write_fits(folder / "field.fits", image)
        result = subprocess.run(
            ["solve-field", "--overwrite", "--no-plots", "--no-tweak", "--new-fits", "none", "--scale-units", "arcsecperpix",
             "--scale-low", "70", "--scale-high", "86", "--crpix-x", str(SIZE_PX / 2 + 0.5), "--crpix-y", str(SIZE_PX / 2 + 0.5),
             "--cpulimit", "60", "--dir", folder, folder / "field.fits"],
            capture_output=True, text=True, timeout=180)
        self.assertTrue((folder / "field.solved").exists(), result.stdout[-2000:] + result.stderr[-2000:])
        return read_header(folder / "field.wcs")

    def test_the_commanded_attitude_comes_back(self):
        for number, attitude in zip(range(FIELDS), attitudes()):
            with self.subTest(field=number), tempfile.TemporaryDirectory() as temporary:
                wcs = self.solve(pathlib.Path(temporary), attitude, number + 1)
                world_from_body = matrix(*attitude)
                # Places from the picture's corner; the middle of FITS's first pixel is (1, 1).
                errors = []
                for x, y in ((SIZE_PX / 2, SIZE_PX / 2), (0, 0), (SIZE_PX, 0), (0, SIZE_PX), (SIZE_PX, SIZE_PX)):
                    in_camera = numpy.array([(x - SIZE_PX / 2) * PIXEL_RAD, (y - SIZE_PX / 2) * PIXEL_RAD, 1])
                    seen = world_from_body @ (in_camera / numpy.linalg.norm(in_camera))
                    errors.append(angle(sky_direction(wcs, x + 0.5, y + 0.5), without_aberration(seen)))
                print(f"field {number}: boresight off by {errors[0] / PIXEL_RAD:.4f} px, corners by at most "
                      f"{max(errors[1:]) / PIXEL_RAD:.4f} px")
                self.assertLess(errors[0], 0.1 * PIXEL_RAD + CATALOGUE_RAD)
                # A plane fitted to evenly spread stars has sqrt(1 + 3 + 3) times the middle's error at a corner.
                self.assertLess(max(errors[1:]), math.sqrt(7) * (0.1 * PIXEL_RAD + CATALOGUE_RAD))


if __name__ == "__main__":
    if not shutil.which("solve-field") or not glob.glob(INDEX):
        print("skipped: no solve-field, or no Tycho-2 index " + INDEX)
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
