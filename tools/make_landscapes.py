#!/usr/bin/python3
"""Makes the ground of configs/scenarios/landing.yaml and the body of configs/scenarios/asteroid.yaml, neither of which is any real place:

    tools/make_landscapes.py configs/maps/crater_field.raw configs/meshes/asteroid.ply

The ground is 400 x 400 heights of int16 in units of 2 cm, 2.5 m apart, rows from the north, 0 in the middle. The body is a mesh of 20480
triangles in metres, 640 m long along x. The same call makes the same files.

Craters have a bowl of 0.2 of their diameter (Pike, Geophysical Research Letters 1, 291, 1974) and a rim of 0.04 of it that falls with the
third power of the distance (McGetchin, Settle & Head, Earth and Planetary Science Letters 20, 226, 1973); there are more small ones than
large ones, by the square of the diameter.
"""
import math
import random
import struct
import sys

COLUMNS, SPACING_M, UNIT_M = 400, 2.5, 0.02
SUBDIVISIONS, RADII_M = 5, (300.0, 220.0, 190.0)


def hashed(x, y, z, seed):
    """A number of -1 to 1 that belongs to a point of the lattice (32-bit mixing after Jenkins and Wang)."""
    h = (x * 374761393 + y * 668265263 + z * 2147483647 + seed * 1274126177) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFF) / 32767.5 - 1


def noise(x, y, z, seed):
    """Value noise: the lattice's numbers, smoothly between them (Perlin, SIGGRAPH 1985)."""
    xi, yi, zi = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = (t * t * (3 - 2 * t) for t in (x - xi, y - yi, z - zi))
    total = 0.0
    for i, wi in ((0, 1 - u), (1, u)):
        for j, wj in ((0, 1 - v), (1, v)):
            for k, wk in ((0, 1 - w), (1, w)):
                total += wi * wj * wk * hashed(xi + i, yi + j, zi + k, seed)
    return total


def rough(x, y, z, octaves, seed):
    """Noise at scales that halve each time; the height goes with the scale to the power 0.9, as of natural ground."""
    return sum(noise(x * 2 ** n, y * 2 ** n, z * 2 ** n, seed + n) / 2 ** (0.9 * n) for n in range(octaves))


def crater_height(distance, radius):
    """Height of a crater's profile over the ground before it, in the unit of its radius."""
    r = distance / radius
    if r < 1:
        return radius * (0.48 * r * r - 0.40)  # the bowl, from -0.40 to the rim's 0.08: of the diameter 0.20 and 0.04
    return radius * 0.08 * r ** -3 if r < 4 else 0.0


def ground():
    middle = 0.5 * (COLUMNS - 1)
    heights = [[8 * rough(c * SPACING_M / 220, r * SPACING_M / 220, 0, 6, 11) for c in range(COLUMNS)] for r in range(COLUMNS)]
    draw = random.Random(4)
    for _ in range(700):
        radius = 2.5 / math.sqrt(draw.uniform(0.0025, 1))  # posts; the largest has a diameter of 250 m
        x, y, fresh = draw.uniform(0, COLUMNS), draw.uniform(0, COLUMNS), 0.1 + 0.7 * draw.uniform(0, 1) ** 2  # most are worn down
        reach = 4 * radius
        if radius > 3 and math.hypot(x - middle, y - middle) < 1.5 * radius:
            continue  # nothing large where the lander comes down
        for r in range(max(0, int(y - reach)), min(COLUMNS, int(y + reach) + 1)):
            for c in range(max(0, int(x - reach)), min(COLUMNS, int(x + reach) + 1)):
                heights[r][c] += fresh * SPACING_M * crater_height(math.hypot(c - x, r - y), radius)
    zero = heights[COLUMNS // 2][COLUMNS // 2]
    return b"".join(struct.pack("<h", round((h - zero) / UNIT_M)) for row in heights for h in row)


def sphere():
    """Points and triangles of an icosahedron whose triangles are divided into four, again and again."""
    g = (1 + math.sqrt(5)) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
              (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    points = [tuple(x / math.hypot(*p) for x in p) for p in points]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
                 (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(SUBDIVISIONS):
        between = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in between:
                p = [x + y for x, y in zip(points[a], points[b])]
                between[key] = len(points)
                points.append(tuple(x / math.hypot(*p) for x in p))
            return between[key]

        finer = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return points, triangles


def asteroid():
    points, triangles = sphere()
    draw = random.Random(9)
    craters = []
    for _ in range(160):
        axis = [draw.gauss(0, 1) for _ in range(3)]
        craters.append(([x / math.hypot(*axis) for x in axis], 0.04 / math.sqrt(draw.uniform(0.012, 1))))  # radius in rad
    out = []
    for p in points:
        size = 1 + 0.16 * rough(*(1.3 * x for x in p), 2, 3) + 0.035 * rough(*(5 * x for x in p), 4, 7)
        for axis, radius in craters:
            size += 0.8 * crater_height(math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(p, axis))))), radius)
        out.append(tuple(r * size * x for r, x in zip(RADII_M, p)))
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(out)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    return header.encode() + b"".join(struct.pack("<3f", *p) for p in out) + b"".join(struct.pack("<B3i", 3, *t) for t in triangles)


if len(sys.argv) != 3:
    sys.exit(__doc__)
for path, content in ((sys.argv[1], ground()), (sys.argv[2], asteroid())):
    with open(path, "wb") as file:
        file.write(content)
