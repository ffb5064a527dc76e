#!/usr/bin/python3
"""Makes configs/stars/hipparcos.csv, the stars to V 8, or a deeper catalogue of the same columns.

    tools/make_star_catalogue.py                                  the shipped catalogue, anew
    tools/make_star_catalogue.py --faintest 10.5 --out deep.csv   580,000 stars

Needs Debian 12 (apt-get download of stellarium-data 0.22, kstars-data and, below V 8, astrometry-data-tycho2-07), npm, python3-numpy and python3-scipy. The
packages, 330 or 420 MB, are downloaded to a temporary folder, or kept in --packages and used from there. docs/stars.md says what the catalogue is and how good.
"""
import argparse
import pathlib
import sys
import tempfile

import numpy

from star_catalogue import merge, packages

SHIPPED = pathlib.Path(__file__).resolve().parents[1] / "configs/stars/hipparcos.csv"
FAINTEST_SHIPPED = 8.0
FAINTEST_POSSIBLE = 10.5
COLUMNS = "hip,hd,ra_deg,dec_deg,epoch_year,pm_ra_mas_yr,pm_dec_mas_yr,parallax_mas,v_mag,b_v,v_i"


def number(value, digits):
    """Returns the text of a rounded number, zero without a sign."""
    return f"{round(float(value), digits) + 0.0:.{digits}f}"


def line(light):
    x, y, z = light.direction
    ra_deg, dec_deg = numpy.degrees(numpy.arctan2(y, x)) % 360, numpy.degrees(numpy.arcsin(z))
    pm_ra, pm_dec = light.motion_mas_yr
    return ",".join([str(light.hip), str(light.hd), number(ra_deg, 6), number(dec_deg, 6), number(merge.EPOCH_YEAR, 1), number(pm_ra, 1),
                     number(pm_dec, 1), number(light.parallax_mas, 1), number(light.v_mag, 2), number(light.b_v, 2),
                     "" if light.v_i is None else number(light.v_i, 2)])


def write(lights, counts, versions, faintest, file):
    print(f"# {len(lights)} stars to V {faintest:g} of the Hipparcos and Tycho-2 catalogues (ESA SP-1200, 1997; Hog et al., A&A 355, L27, 2000).", file=file)
    print(f"# Places: ICRS at epoch_year; pm_ra has the factor cos(dec); V and B-V: Johnson; v_i: V-Ic of M stars by their class. hip, hd and parallax are 0 where there is none.", file=file)
    print(f"# Made by tools/make_star_catalogue.py from {', '.join(versions)}; terms: NOTICE.", file=file)
    for what, count in counts.items():
        print(f"# {what}: {count}", file=file)
    print(COLUMNS, file=file)
    for light in lights:
        print(line(light), file=file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faintest", default=FAINTEST_SHIPPED, type=float, help=f"V magnitude of the faintest star kept, at most {FAINTEST_POSSIBLE}")
    parser.add_argument("--out", default=SHIPPED, type=pathlib.Path, help="file to write; default: the shipped catalogue")
    parser.add_argument("--packages", type=pathlib.Path, help="folder where packages are kept; default: a temporary one")
    options = parser.parse_args()
    if options.faintest > FAINTEST_POSSIBLE:
        sys.exit(f"--faintest {options.faintest:g}: the sources end at V {FAINTEST_POSSIBLE}")
    if options.faintest > FAINTEST_SHIPPED and options.out == SHIPPED:
        sys.exit(f"--faintest {options.faintest:g}: name a file with --out; the shipped catalogue ends at V {FAINTEST_SHIPPED:g}")
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.packages.resolve() if options.packages else pathlib.Path(temporary)
        *sources, versions = packages.obtain(folder)
        index = None
        if options.faintest > FAINTEST_SHIPPED:
            index, version = packages.obtain_tycho_index(folder)
            versions.append(version)
        lights, counts = merge.catalogue(*sources, index, options.faintest)
    with open(options.out, "w", encoding="ascii") as file:
        write(lights, counts, versions, options.faintest, file)


if __name__ == "__main__":
    main()
