#!/usr/bin/python3
"""tools/star_catalogue: star files are read as they are, stale places are found, close components become one light.

    star_catalogue_tools_test.py SOURCE_DIR

Ends with 77 (skipped) where python3-scipy is not installed.
"""
import pathlib
import re
import sys
import tempfile
import unittest

import numpy

SOURCE = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(SOURCE / "tools"))
try:
    from star_catalogue import kstars, m_stars, merge, stellarium
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

ARCSEC = numpy.pi / 180 / 3600


def star_file(folder, header, zone, record):
    """Writes a star file with one star, as Stellarium 0.22 has it in that zone."""
    level = int.from_bytes(header[16:20], "little")
    counts = numpy.zeros(20 * 4**level, "<u4")
    counts[zone] = 1
    path = pathlib.Path(folder) / "stars.cat"
    path.write_bytes(header + counts.tobytes() + record)
    return path


def ra_dec(direction):
    return numpy.degrees(numpy.arctan2(direction[1], direction[0])) % 360, numpy.degrees(numpy.arcsin(direction[2]))


def stars_of(hip, ra_deg, dec_deg, motion_mas_yr, v_mag):
    n = len(hip)
    return stellarium.Stars(hip=numpy.array(hip), direction=kstars.directions(numpy.array(ra_deg), numpy.array(dec_deg)),
                            motion_mas_yr=numpy.array(motion_mas_yr, float), parallax_mas=numpy.zeros(n), v_mag=numpy.array(v_mag, float),
                            b_v=numpy.full(n, 0.5), b_v_is_zero=numpy.zeros(n, bool), spectrum=numpy.zeros(n, int))


class StarFiles(unittest.TestCase):
    def test_sirius_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            header = bytes.fromhex("0a045f830000000000000000080000000000000030f8ffff0032000000010000")
            record = bytes.fromhex("5d7e0000772e9be34e6af6cc100b420127e6ffff8bc7ffff21940000")
            star = stellarium.read(star_file(folder, header, 14, record))
        # Hipparcos: HIP 32349, J2000 101.287155 -16.716116, -546.01 -1223.08 mas/yr, 379.21 mas, V -1.44 (in a step of 0.05), B-V 0.009.
        self.assertEqual(star.hip[0], 32349)
        ra, dec = ra_dec(star.direction[0])
        self.assertAlmostEqual(ra, 101.287155, delta=1e-6)
        self.assertAlmostEqual(dec, -16.716116, delta=1e-6)
        self.assertAlmostEqual(star.motion_mas_yr[0, 0], -546.01, delta=0.05)
        self.assertAlmostEqual(star.motion_mas_yr[0, 1], -1223.08, delta=0.05)
        self.assertAlmostEqual(star.parallax_mas[0], 379.21, delta=0.001)
        self.assertAlmostEqual(star.v_mag[0], -1.44, delta=0.026)
        self.assertAlmostEqual(star.b_v[0], 0.009, delta=0.016)

    def test_a_star_without_numbers_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            header = bytes.fromhex("0a045f830100000000000000040000000300000028230000dc0500001e000000")
            star = stellarium.read(star_file(folder, header, 8, bytes.fromhex("b4d30c1620fcc5ffcfca")))
        # Tycho-2: 20.682747 -16.291960, V_T 10.364, which is V 10.28 of this colour.
        ra, dec = ra_dec(star.direction[0])
        self.assertAlmostEqual(ra, 20.682747, delta=0.02 / 3600)
        self.assertAlmostEqual(dec, -16.291960, delta=0.02 / 3600)
        self.assertAlmostEqual(star.v_mag[0], 10.364 - 0.09 * star.b_v[0] / 0.85, delta=0.03)

    def test_another_file_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "stars.cat"
            path.write_bytes(bytes(64))
            with self.assertRaisesRegex(ValueError, "stars.cat: not a star file of Stellarium"):
                stellarium.read(path)


class Merging(unittest.TestCase):
    def test_a_place_without_its_motion_is_moved_and_a_right_one_is_not(self):
        # Both move by 1" a year to the north; the first stands where it was 8.34 years before J2000.
        stars = stars_of([1, 2], [10.0, 20.0], [5.0, 5.0], [(0, 1000), (0, 1000)], [5.0, 5.0])
        known = kstars.directions(numpy.array([10.0, 20.0]), numpy.array([5.0 + 8.34 / 3600, 5.0]))
        self.assertEqual(merge.put_stale_places_right(stars, [[0], [1]], known, (0.15, 0.1)), 1)
        self.assertLess(numpy.linalg.norm(stars.direction - known, axis=1).max(), 0.01 * ARCSEC)

    def test_components_are_one_light_or_two(self):
        close = stars_of([7, 7], [10.0, 10.0], [0.0, 1.0 / 3600], [(0, 0)] * 2, [6.0, 6.0])
        lights = merge.lights_of_number(7, 70, close, 5.26, 0.6, ["G"])
        self.assertEqual([(light.hip, light.hd) for light in lights], [(7, 70)])
        self.assertAlmostEqual(lights[0].v_mag, 5.26)
        self.assertAlmostEqual(ra_dec(lights[0].direction)[1], 0.5 / 3600, delta=1e-7)
        wide = stars_of([7, 7], [10.0, 10.0], [0.0, 5.0 / 3600], [(0, 0)] * 2, [6.0, 7.0])
        # 5.636 is the light of both, 6.02 the first's.
        for v_mag, expected in ((5.686, (6.05, 7.05)), (6.02, (6.02, 7.0))):
            lights = merge.lights_of_number(7, 70, wide, v_mag, 0.6, ["G"])
            self.assertEqual([light.hip for light in lights], [7, 0])
            self.assertAlmostEqual(lights[0].v_mag, expected[0], delta=0.001)
            self.assertAlmostEqual(lights[1].v_mag, expected[1], delta=0.001)


class ColoursOfMStars(unittest.TestCase):
    def test_they_go_by_class_and_luminosity(self):
        for spectral_type, v_i in {"M0III": 1.64, "M2III": 1.86, "gM4": 2.40, "M5IIIe": 2.80, "M0/1III": 1.695, "M1-M2Ia-Iab": 2.16, "M1.5Iab-b": 2.16,
                                   "M4II": 2.40, "M2V": 2.01, "dM3": 2.43, "M6.5e": 3.57, "M9III": 3.88}.items():
            self.assertAlmostEqual(m_stars.v_i(spectral_type), v_i, delta=0.001, msg=spectral_type)
        for spectral_type in ("K5III", "K5/M0III", "G2V", "M", "", "C6", "S5"):
            self.assertIsNone(m_stars.v_i(spectral_type), spectral_type)

    def test_the_program_reads_catalogues_with_the_same_colours(self):
        source = (SOURCE / "io/files/m_stars.cpp").read_text()
        for name, colours in (("kGiants", m_stars.GIANTS), ("kSupergiants", m_stars.SUPERGIANTS), ("kDwarfs", m_stars.DWARFS)):
            numbers = re.search(name + r" = \{([^}]*)\}", source)[1]
            in_program = [float(number) for number in numbers.split(",")]
            # A table that ends early goes on with its last colour.
            self.assertEqual(in_program, [*colours, *[colours[-1]] * (len(in_program) - len(colours))], name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
