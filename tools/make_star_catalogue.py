#!/usr/bin/python3
"""Makes configs/stars/hipparcos.csv from the star files of Debian's package kstars-data.

    tools/make_star_catalogue.py [--folder /usr/share/kstars] [--faintest 8.0] > configs/stars/hipparcos.csv

The files describe their own records: a preamble of 124 bytes, a byte order mark, a version, the number of fields and per field its
name, size, type and the divisor of its integers; then an index of sky cells and the records. The stars in them are
those of the Hipparcos and Tycho-2 catalogues (ESA SP-1200, 1997; Hog et al., A&A 355, L27, 2000).
"""
import argparse
import pathlib
import struct
import sys

PREAMBLE_BYTES = 124
BYTE_ORDER_MARK = 0x4B53
INTEGER_OF_SIZE = {1: "b", 2: "h", 4: "i"}


def stars_of(path):
    """Yields a dict of field values per star."""
    data = path.read_bytes()
    mark, _, field_count = struct.unpack_from("<HBH", data, PREAMBLE_BYTES)
    if mark != BYTE_ORDER_MARK:
        sys.exit(f"{path}: not a little-endian KStars star file")
    at = PREAMBLE_BYTES + 5
    names, divisors, layout = [], [], "<"
    for _ in range(field_count):
        name, size, kind, divisor = struct.unpack_from("<10sbBi", data, at)
        at += 16
        name = name.split(b"\0")[0].decode()
        text = name == "spec_type"
        layout += f"{size}s" if text else INTEGER_OF_SIZE[size]
        names.append(name)
        divisors.append(None if text else max(1, divisor))
    (cells,) = struct.unpack_from("<I", data, at)
    record = struct.Struct(layout)
    for cell in range(cells):
        _, offset, count = struct.unpack_from("<III", data, at + 4 + 12 * cell)
        for i in range(count):
            values = record.unpack_from(data, offset + i * record.size)
            yield {n: v if d is None else v / d for n, v, d in zip(names, values, divisors)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", default="/usr/share/kstars", type=pathlib.Path)
    parser.add_argument("--faintest", default=8.0, type=float, help="V magnitude of the faintest star kept")
    options = parser.parse_args()
    files = [options.folder / name for name in ("namedstars.dat", "unnamedstars.dat")]
    for file in files:
        if not file.exists():
            sys.exit(f"{file}: missing; install kstars-data or name its folder")
    stars = []
    for file in files:
        for star in stars_of(file):
            if star["mag"] <= options.faintest:
                # Right ascension is in hours there; HD is stored undivided.
                stars.append((star["mag"], round(star["HD"] * 10), star["RA"] * 15, star["Dec"], star["dRA"],
                              star["dDec"], star["bv_index"]))
    stars.sort()
    print("# Stars to V", options.faintest, "from the Hipparcos and Tycho-2 catalogues (ESA SP-1200, 1997; Hog et al. 2000).")
    print("# Places: ICRS at epoch J1991.25. A B-V that the source lacks is 0. Made by tools/make_star_catalogue.py from Debian's kstars-data 3.6.2.")
    print("hd,ra_deg,dec_deg,pm_ra_mas_yr,pm_dec_mas_yr,v_mag,b_v")
    for v, hd, ra, dec, pm_ra, pm_dec, b_v in stars:
        print(f"{hd},{ra:.5f},{dec:.5f},{pm_ra:.1f},{pm_dec:.1f},{v:.2f},{b_v:.2f}")


if __name__ == "__main__":
    main()
