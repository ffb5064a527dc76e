"""Reads the star files of KStars (Debian's package kstars-data).

stars.dat is text: Hipparcos and Tycho-1 stars with Johnson V and B-V; places ICRS at J2000 in steps of 0.15" and 0.1".
unnamedstars.dat describes its own records: a preamble of 124 bytes, a byte order mark, a version, the number of fields and per field its
name, size, type and the divisor of its integers; then an index of sky cells and the records: Tycho-2 stars with HD numbers and, for all but
the brightest, Tycho's own magnitudes V_T and B_T-V_T. A fast star stands there once per sky cell that it crosses.
"""
import struct

import numpy

PLACE_STEPS_ARCSEC = (0.15, 0.1)  # right ascension on the equator, declination
HIPPARCOS_FAINTEST_V = 8.9  # stars.dat is complete to this.
PREAMBLE_BYTES = 124
BYTE_ORDER_MARK = 0x4B53
INTEGER_OF_SIZE = {1: "i1", 2: "<i2", 4: "<i4"}


def directions(ra_deg, dec_deg):
    ra, dec = numpy.radians(ra_deg), numpy.radians(dec_deg)
    return numpy.stack([numpy.cos(dec) * numpy.cos(ra), numpy.cos(dec) * numpy.sin(ra), numpy.sin(dec)], axis=1)


def hipparcos(folder):
    """Returns the unit vectors of stars.dat."""
    ra, dec = [], []
    for line in (folder / "stars.dat").read_text().splitlines():
        if line.startswith("#"):
            continue
        ra.append(15 * (int(line[0:2]) + int(line[2:4]) / 60 + float(line[4:9]) / 3600))
        dec.append((-1 if line[10] == "-" else 1) * (int(line[11:13]) + int(line[13:15]) / 60 + float(line[15:19]) / 3600))
    return directions(numpy.array(ra), numpy.array(dec))


def tycho(folder):
    """Returns unit vectors, and by name the columns HD, V_T ("mag"), B_T-V_T ("bv_index"), "dRA" and "dDec" [mas/yr] of unnamedstars.dat."""
    path = folder / "unnamedstars.dat"
    data = path.read_bytes()
    mark, _, field_count = struct.unpack_from("<HBH", data, PREAMBLE_BYTES)
    if mark != BYTE_ORDER_MARK:
        raise ValueError(f"{path}: not a little-endian KStars star file")
    at = PREAMBLE_BYTES + 5
    layout, divisors = [], {}
    for _ in range(field_count):
        name, size, _, divisor = struct.unpack_from("<10sbBi", data, at)
        at += 16
        name = name.split(b"\0")[0].decode()
        layout.append((name, f"S{size}" if name == "spec_type" else INTEGER_OF_SIZE[size]))
        divisors[name] = max(1, divisor)
    (cells,) = struct.unpack_from("<I", data, at)
    index = numpy.frombuffer(data, [("id", "<u4"), ("offset", "<u4"), ("stars", "<u4")], count=cells, offset=at + 4)
    stars = numpy.frombuffer(data, numpy.dtype(layout), count=index["stars"].sum(), offset=index["offset"][index["stars"] > 0].min())
    value = {name: stars[name] / divisors[name] for name in ("RA", "Dec", "dRA", "dDec", "mag", "bv_index")}
    value["HD"] = stars["HD"].astype(int)
    return directions(15 * value["RA"], value["Dec"]), value
