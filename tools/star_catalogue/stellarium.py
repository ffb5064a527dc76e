"""Reads the star files of Stellarium (Debian's package stellarium-data 0.22, folder stars/default).

A file stars_N holds the stars of a range of magnitudes in the triangles of a geodesic grid of level N: the icosahedron, each of its triangles
cut into four, N times. A star's place in its triangle is the gnomonic projection on the plane that touches the sphere at the triangle's middle:
x0 to the east, x1 to the north, in integers whose greatest is the greatest coordinate of any triangle's corner. Places are ICRS at J2000.
Type 0 (28 bytes a star) has Hipparcos number, component, B-V, magnitude, spectral type and parallax; type 1 (10 bytes) has none of the numbers.
Magnitudes are Johnson V cut (not rounded) to steps of 0.05 mag; the step's middle is returned. B-V has steps of 4/127 mag from -0.5 on.
"""
import dataclasses

import numpy

MAGIC = 0x835F040A
B_V_OF_ZERO = 16  # The index of a colour of 0.00, which also stands for a colour that is not known.
HEADER = numpy.dtype([(name, "<i4") for name in ("magic", "type", "major", "minor", "level", "mag_min", "mag_range", "mag_steps")])
NUMBERED = numpy.dtype([("hip", "<u4"), ("x0", "<i4"), ("x1", "<i4"), ("b_v", "u1"), ("mag", "u1"), ("spectrum", "<u2"),
                        ("dx0", "<i4"), ("dx1", "<i4"), ("parallax", "<i4")])
GREATEST_NUMBERED = 2**31 - 1
UNNUMBERED_BYTES = 10
GREATEST_UNNUMBERED = 2**19 - 1

# Corners of the icosahedron, by the golden ratio, and its triangles in the order of the files' zones.
GOLDEN = (1 + 5**0.5) / 2
B = (1 + GOLDEN**2) ** -0.5
A = B * GOLDEN
CORNERS = numpy.array([(A, -B, 0), (A, B, 0), (-A, B, 0), (-A, -B, 0), (0, A, -B), (0, A, B), (0, -A, B), (0, -A, -B), (-B, 0, A), (B, 0, A),
                       (B, 0, -A), (-B, 0, -A)])
TRIANGLES = [(1, 0, 10), (0, 1, 9), (0, 9, 6), (9, 8, 6), (0, 7, 10), (6, 7, 0), (7, 6, 3), (6, 8, 3), (11, 10, 7), (7, 3, 11), (3, 2, 11),
             (2, 3, 8), (10, 11, 4), (2, 4, 11), (5, 4, 2), (2, 8, 5), (4, 1, 10), (4, 5, 1), (5, 9, 1), (8, 9, 5)]


@dataclasses.dataclass
class Stars:
    """Holds the stars of one or more files, an array per quantity."""

    hip: numpy.ndarray  # 0 where there is none
    direction: numpy.ndarray  # unit vectors, ICRS at J2000
    motion_mas_yr: numpy.ndarray  # right ascension times cos(declination), declination
    parallax_mas: numpy.ndarray
    v_mag: numpy.ndarray
    b_v: numpy.ndarray  # not a number where it is not known
    b_v_is_zero: numpy.ndarray  # True where the file says 0.00, which may mean that it is not known
    spectrum: numpy.ndarray  # a row of stars_hip_sp

    def of(self, rows):
        return Stars(**{field.name: getattr(self, field.name)[rows] for field in dataclasses.fields(self)})


def joined(parts):
    return Stars(**{field.name: numpy.concatenate([getattr(part, field.name) for part in parts]) for field in dataclasses.fields(Stars)})


def unit(vectors):
    return vectors / numpy.linalg.norm(vectors, axis=-1, keepdims=True)


def dot(a, b):
    return numpy.sum(a * b, axis=-1)


def zones(level):
    """Returns middles, east and north axes of a level's triangles, and the greatest coordinate of their corners."""
    corners = CORNERS[numpy.array(TRIANGLES)]
    for _ in range(level):
        c0, c1, c2 = corners[:, 0], corners[:, 1], corners[:, 2]
        e0, e1, e2 = unit(c1 + c2), unit(c2 + c0), unit(c0 + c1)
        children = [(c0, e2, e1), (e2, c1, e0), (e1, e0, c2), (e0, e1, e2)]
        corners = numpy.stack([numpy.stack(child, axis=1) for child in children], axis=1).reshape(-1, 3, 3)
    middle = unit(corners.sum(axis=1))
    east = unit(numpy.cross([0.0, 0.0, 1.0], middle))
    north = numpy.cross(middle, east)
    greatest = 0.0
    for corner in range(3):
        offset = corners[:, corner] - middle
        x0, x1 = dot(offset, east), dot(offset, north)
        greatest = max(greatest, (numpy.maximum(abs(x0), abs(x1)) / numpy.sqrt(1 - x0**2 - x1**2)).max())
    return middle, east, north, greatest


def signed(value, bits):
    return (value ^ (1 << (bits - 1))) - (1 << (bits - 1))


def unnumbered_records(data, offset):
    """Returns the fields of type 1: 20 bits x0, 20 x1, 14 and 14 of motion, 7 of colour, 5 of magnitude, lowest bits first."""
    d = numpy.frombuffer(data, numpy.uint8, offset=offset).reshape(-1, UNNUMBERED_BYTES).astype(numpy.int64)
    none = numpy.zeros(len(d), numpy.int64)
    return {
        "hip": none,
        "x0": signed(d[:, 0] | d[:, 1] << 8 | (d[:, 2] & 0xF) << 16, 20),
        "x1": signed(d[:, 2] >> 4 | d[:, 3] << 4 | d[:, 4] << 12, 20),
        "dx0": signed(d[:, 5] | (d[:, 6] & 0x3F) << 8, 14),
        "dx1": signed(d[:, 6] >> 6 | d[:, 7] << 2 | (d[:, 8] & 0xF) << 10, 14),
        "b_v": d[:, 8] >> 4 | (d[:, 9] & 7) << 4,
        "mag": d[:, 9] >> 3,
        "parallax": none,
        "spectrum": none,
    }


def motion_on_sphere(place, moved):
    """Returns right ascension's (times cos(declination)) and declination's motion of a place on the plane that moves there, in the unit of its motion.

    The files take the two motions m along the axes of the triangle's middle, the third part of the vector making it square to the line of sight, and project
    that: moved = sqrt(1 + p^2) (m + p (p m)) for a place p. This is turned round here. (Numbered stars come out as in hip_pm.dat to 0.04 mas/yr.)
    """
    square = 1 + dot(place, place)
    return (moved - place * (dot(place, moved) / square)[:, None]) / numpy.sqrt(square)[:, None]


def read(path):
    """Returns the Stars of a file."""
    data = path.read_bytes()
    header = numpy.frombuffer(data, HEADER, count=1)[0]
    if int(header["magic"]) & 0xFFFFFFFF != MAGIC or header["type"] not in (0, 1):
        raise ValueError(f"{path}: not a star file of Stellarium 0.22, type 0 or 1")
    middle, east, north, greatest = zones(int(header["level"]))
    counts = numpy.frombuffer(data, "<u4", count=len(middle), offset=HEADER.itemsize)
    offset = HEADER.itemsize + counts.nbytes
    if header["type"] == 0:
        record, scale = numpy.frombuffer(data, NUMBERED, offset=offset), greatest / GREATEST_NUMBERED
    else:
        record, scale = unnumbered_records(data, offset), greatest / GREATEST_UNNUMBERED
    zone = numpy.repeat(numpy.arange(len(middle)), counts)
    middle, east, north = middle[zone], east[zone], north[zone]
    place = scale * numpy.stack([record["x0"], record["x1"]], axis=1)
    direction = unit(middle + place[:, :1] * east + place[:, 1:] * north)
    step = header["mag_range"] / header["mag_steps"]
    zero = record["b_v"] == B_V_OF_ZERO
    return Stars(
        hip=(record["hip"] & 0xFFFFFF).astype(int),
        direction=direction,
        motion_mas_yr=motion_on_sphere(place, 0.1 * numpy.stack([record["dx0"], record["dx1"]], axis=1)),
        parallax_mas=record["parallax"] * 0.01,
        v_mag=(header["mag_min"] + (record["mag"] + 0.5) * step) / 1000,
        b_v=record["b_v"] * (4 / 127) - 0.5,
        b_v_is_zero=zero,
        spectrum=record["spectrum"].astype(int),
    )


def table(path):
    """Yields the fields of a text table whose comments begin with #."""
    for line in path.read_text().splitlines():
        if line and line[0] != "#":
            yield line.split("\t")


def proper_motions(folder):
    """Returns (right ascension times cos(declination), declination) [mas/yr] by Hipparcos number."""
    return {int(row[0]): (float(row[1]), float(row[2])) for row in table(folder / "hip_pm.dat")}


def henry_draper(folder):
    """Returns HD numbers by Hipparcos number, the first component's where components have several."""
    found = {}
    for hip, _, _, hd, *_ in table(folder / "cross-id.dat"):
        if hd:
            found.setdefault(int(hip), int(hd))
    return found


def spectral_types(folder):
    return (folder / "stars_hip_sp_0v0_4.cat").read_text().splitlines()
