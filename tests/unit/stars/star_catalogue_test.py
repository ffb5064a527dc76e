#!/usr/bin/python3
"""configs/stars/hipparcos.csv: one line a star, one epoch, published values; and against the Yale Bright Star Catalogue.

    star_catalogue_test.py SOURCE_DIR

The comparison needs ../shared/data/stars/bsc5-short.json beside the source folder (Hoffleit and Warren, 5th ed., VizieR V/50, as JSON with the keys HR,
RA, Dec, V); it is skipped without. bsc_exceptions.csv names the stars whose magnitudes differ, with the reasons.
"""
import collections
import csv
import json
import pathlib
import re
import sys
import unittest

import numpy

SOURCE = pathlib.Path(sys.argv[1])
HERE = pathlib.Path(__file__).parent
CATALOGUE = SOURCE / "configs/stars/hipparcos.csv"
BRIGHT_STARS = SOURCE.parent / "shared/data/stars/bsc5-short.json"
COLUMNS = "hip,hd,ra_deg,dec_deg,epoch_year,pm_ra_mas_yr,pm_dec_mas_yr,parallax_mas,v_mag,b_v,v_i".split(",")
FAINTEST = 8.0
ARCSEC = numpy.pi / 180 / 3600
CELL_RAD = 20 * ARCSEC

# ICRS at J2000 and motion: SIMBAD, from Hipparcos' new reduction (van Leeuwen, A&A 474, 653, 2007), alpha Cen B from Hipparcos itself; V and B-V:
# Hipparcos (ESA SP-1200, 1997).
PUBLISHED = {
    "Sirius": (32349, 48915, 101.287155, -16.716116, -546.01, -1223.07, -1.44, 0.01),
    "alpha Cen A": (71683, 128620, 219.902058, -60.833993, -3679.25, 473.67, -0.01, 0.71),
    "alpha Cen B": (71681, 128621, 219.896171, -60.837157, -3600.35, 952.11, 1.35, 0.90),
    "Arcturus": (69673, 124897, 213.915300, 19.182409, -1093.39, -2000.06, -0.05, 1.24),
    "Vega": (91262, 172167, 279.234735, 38.783689, 200.94, 286.23, 0.03, 0.00),
    "Betelgeuse": (27989, 39801, 88.792939, 7.407064, 27.54, 11.30, 0.45, 1.50),
    "Spica": (65474, 116658, 201.298247, -11.161319, -42.35, -30.67, 0.98, -0.23),
    "Menkent": (68933, 123139, 211.670615, -36.369955, -520.53, -518.06, 2.06, 1.01),
    "tau Cet": (8102, 10700, 26.017014, -15.937480, -1721.05, 854.16, 3.49, 0.73),
    "40 Eri A": (19849, 26965, 63.817998, -7.652872, -2240.12, -3420.27, 4.43, 0.82),
    "epsilon Ind": (108870, 209100, 330.840223, -56.785979, 3960.93, -2539.23, 4.69, 1.06),
    "Groombridge 1830": (57939, 103095, 178.244869, 37.718678, 4003.98, -5813.62, 6.42, 0.75),
}


def directions(ra_deg, dec_deg):
    ra, dec = numpy.radians(ra_deg), numpy.radians(dec_deg)
    return numpy.stack([numpy.cos(dec) * numpy.cos(ra), numpy.cos(dec) * numpy.sin(ra), numpy.sin(dec)], axis=-1)


class Neighbours:
    """Finds the places within 20" of another, by cells of a grid in space."""

    def __init__(self, places):
        self.places = places
        self.rows_of = collections.defaultdict(list)
        for row, cell in enumerate(map(tuple, self.cell(places))):
            self.rows_of[cell].append(row)

    @staticmethod
    def cell(places):
        return numpy.floor(places / CELL_RAD).astype(int)

    def within(self, place, arcsec):
        x, y, z = self.cell(place)
        rows = [row for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) for row in self.rows_of.get((x + i, y + j, z + k), ())]
        return [row for row in rows if numpy.linalg.norm(self.places[row] - place) <= arcsec * ARCSEC]


def magnitude_of_sum(magnitudes):
    return -2.5 * numpy.log10(numpy.sum(10 ** (-0.4 * numpy.asarray(magnitudes))))


def bright_stars():
    """Returns HR numbers, places and V of the Bright Star Catalogue's stars."""
    def numbers(text):
        return [float(number) for number in re.findall(r"[\d.]+", text)]

    hr, ra, dec, v = [], [], [], []
    for star in json.loads(BRIGHT_STARS.read_text(encoding="utf-8")):
        h, d = numbers(star["RA"]), numbers(star["Dec"])
        hr.append(int(star["HR"]))
        ra.append(15 * (h[0] + h[1] / 60 + h[2] / 3600))
        dec.append((1 if star["Dec"].strip()[0] == "+" else -1) * (d[0] + d[1] / 60 + d[2] / 3600))
        v.append(float(star["V"]))
    return hr, directions(numpy.array(ra), numpy.array(dec)), numpy.array(v)


class StarCatalogue(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        lines = [line for line in CATALOGUE.read_text().splitlines() if not line.startswith("#")]
        cls.header = lines[0]
        values = numpy.array([[value or "nan" for value in line.split(",")] for line in lines[1:]], float)
        cls.star = dict(zip(COLUMNS, values.T))
        cls.places = directions(cls.star["ra_deg"], cls.star["dec_deg"])
        cls.neighbours = Neighbours(cls.places)

    def test_has_its_columns_one_epoch_and_falls_in_brightness(self):
        self.assertEqual(self.header.split(","), COLUMNS)
        self.assertEqual(set(self.star["epoch_year"]), {2000.0})
        self.assertTrue((numpy.diff(self.star["v_mag"]) >= 0).all())
        self.assertLessEqual(self.star["v_mag"][-1], FAINTEST)
        self.assertTrue((abs(self.star["b_v"]) < 6).all())
        self.assertTrue((self.star["parallax_mas"] >= 0).all())

    def test_has_each_hipparcos_number_once(self):
        numbers = self.star["hip"][self.star["hip"] > 0]
        self.assertEqual(len(numbers), len(set(numbers)))

    def test_has_no_star_twice(self):
        for row, place in enumerate(self.places):
            for other in self.neighbours.within(place, 2.0):
                if other > row:
                    self.assertGreater(abs(self.star["v_mag"][row] - self.star["v_mag"][other]), 0.5,
                                       f"HIP {self.star['hip'][row]:.0f} and {self.star['hip'][other]:.0f}, lines {row} and {other} of the stars")

    def test_is_complete(self):
        # Hipparcos has 41,411 numbers to V 8 and 5,044 to V 6 (XHIP's V; VizieR V/137D); a double that is two lines here may leave both below.
        numbered = self.star["hip"] > 0
        self.assertGreater(numpy.count_nonzero(numbered), 0.99 * 41411)
        self.assertGreater(numpy.count_nonzero(numbered & (self.star["v_mag"] <= 6)), 0.99 * 5044)

    def test_m_stars_have_the_v_i_of_their_class(self):
        """By their types in SIMBAD: Betelgeuse M1-M2 Ia-ab, Antares M1.5 Iab-b, Mirach M0 III, gamma Crucis M3.5 III; Arcturus and Vega are of no class M."""
        row_of = {int(hip): row for row, hip in enumerate(self.star["hip"]) if hip}
        for hip, v_i in {27989: 2.2, 80763: 2.1, 5447: 1.7, 61084: 2.3}.items():
            self.assertAlmostEqual(self.star["v_i"][row_of[hip]], v_i, delta=0.15)
        for hip in (69673, 91262):
            self.assertTrue(numpy.isnan(self.star["v_i"][row_of[hip]]))
        given = self.star["v_i"][~numpy.isnan(self.star["v_i"])]
        self.assertGreater(len(given), 1500)
        self.assertTrue(((given > 1.6) & (given < 4.2)).all())

    def test_colours_are_known(self):
        # Real colours of exactly 0.00 are 1 % of the stars; Capella (0.80) and Procyon (0.43) once had none.
        self.assertLess(numpy.count_nonzero(self.star["b_v"] == 0), 0.02 * len(self.places))
        row_of = {int(hip): row for row, hip in enumerate(self.star["hip"])}
        self.assertAlmostEqual(self.star["b_v"][row_of[24608]], 0.80, delta=0.011)
        self.assertAlmostEqual(self.star["b_v"][row_of[37279]], 0.43, delta=0.011)

    def test_has_published_values(self):
        row_of = {int(hip): row for row, hip in enumerate(self.star["hip"])}
        for name, (hip, hd, ra, dec, pm_ra, pm_dec, v, b_v) in PUBLISHED.items():
            with self.subTest(name):
                row = row_of[hip]
                off_arcsec = numpy.linalg.norm(self.places[row] - directions(ra, dec)) / ARCSEC
                self.assertLess(off_arcsec, 0.1)
                self.assertEqual(self.star["hd"][row], hd)
                # Hipparcos' two reductions differ by 8 mas/yr for alpha Cen A.
                self.assertAlmostEqual(self.star["pm_ra_mas_yr"][row], pm_ra, delta=9)
                self.assertAlmostEqual(self.star["pm_dec_mas_yr"][row], pm_dec, delta=9)
                self.assertAlmostEqual(self.star["v_mag"][row], v, delta=0.011)
                self.assertAlmostEqual(self.star["b_v"][row], b_v, delta=0.011)

    @unittest.skipUnless(BRIGHT_STARS.exists(), f"{BRIGHT_STARS} is absent")
    def test_agrees_with_the_bright_star_catalogue(self):
        # A star is there if one line within 15" has its V, or all lines there together: BSC has some doubles as one star, some as two.
        with open(HERE / "bsc_exceptions.csv", newline="") as file:
            excused = {int(row["hr"]): row["reason"] for row in csv.DictReader(line for line in file if not line.startswith("#"))}
        hr, places, v = bright_stars()
        theirs = Neighbours(places)
        compared, missed = 0, set()
        for row in numpy.flatnonzero(v < 6.5):
            compared += 1
            near = self.star["v_mag"][self.neighbours.within(places[row], 15.0)]
            if numpy.count_nonzero(abs(near - v[row]) <= 0.15) == 1:
                continue
            together = magnitude_of_sum(near) if len(near) else numpy.inf
            if min(abs(together - v[row]), abs(together - magnitude_of_sum(v[theirs.within(places[row], 15.0)]))) > 0.15:
                missed.add(hr[row])
        print(f"{compared} stars of the Bright Star Catalogue with V < 6.5, {len(missed)} with another V, {len(excused)} of them excused by name")
        self.assertGreater(compared, 8300)
        self.assertEqual(sorted(missed - excused.keys()), [])
        self.assertEqual(sorted(excused.keys() - missed), [], "no exception is needed for these")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
