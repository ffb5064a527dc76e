"""Reads the stars of astrometry.net's index of Tycho-2 (Debian's package astrometry-data-tycho2-07-littleendian): 1.9 million places and V_T.

The file is FITS, binary tables one after the other. A place is a unit vector (ICRS at J2000) of three unsigned integers: lower corner + integer / scale,
which stand with the upper corner in a table of their own. For each small square of the sky the index has a number of its brightest stars, so that it is
complete to V_T 11 but for the densest fields.
"""
import numpy

BLOCK_BYTES = 2880
CARD_BYTES = 80


def tables(data):
    """Yields name of the first column, bytes a row and contents of each table."""
    at = 0
    while at < len(data):
        cards = {}
        while True:
            card = data[at:at + CARD_BYTES].decode("ascii")
            at += CARD_BYTES
            if card.startswith("END "):
                break
            cards[card[:8].strip()] = card[10:].split("/")[0].strip(" '")
        at = -(-at // BLOCK_BYTES) * BLOCK_BYTES
        if "XTENSION" not in cards:
            continue
        row_bytes = int(cards["NAXIS1"])
        size = row_bytes * int(cards["NAXIS2"])
        yield cards.get("TTYPE1", ""), row_bytes, data[at:at + size]
        at += -(-size // BLOCK_BYTES) * BLOCK_BYTES


def read(path):
    """Returns unit vectors and V_T."""
    table = {name: (row_bytes, content) for name, row_bytes, content in tables(path.read_bytes())}
    limits = numpy.frombuffer(table["kdtree_range_stars"][1], "<f8")
    row_bytes, content = table["kdtree_data_stars"]
    if row_bytes != 12:
        raise ValueError(f"{path}: accepted: places of three integers of four bytes")
    places = limits[:3] + numpy.frombuffer(content, "<u4").reshape(-1, 3) / limits[6]
    v_t = numpy.frombuffer(table["MAG_VT"][1], ">f4").astype(float)
    return places / numpy.linalg.norm(places, axis=1, keepdims=True), v_t
