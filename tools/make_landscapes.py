#!/usr/bin/python3
"""Makes the ground of configs/scenarios/landing.yaml and the body of configs/scenarios/asteroid.yaml, neither of which is any real place, and a ball:

    tools/make_landscapes.py configs/maps/crater_field.raw configs/meshes/asteroid.ply configs/meshes/ball.ply

The ground is 800 x 800 heights of int16 in units of 1 cm, 1.25 m apart, rows from the north, 0 in the middle. The body is a mesh of 81920
triangles in metres with normals, some 600 m long along x. The ball has 20480 and a radius of 10 m. The same call makes the same files.

Craters have a bowl of 0.2 of their diameter (Pike, Geophysical Research Letters 1, 291, 1974) and a rim of 0.04 of it that falls with the
third power of the distance (McGetchin, Settle & Head, Earth and Planetary Science Letters 20, 226, 1973); there are more small ones than
large ones, by the square of the diameter.
"""
import sys

import numpy as np

COLUMNS, SPACING_M, UNIT_M = 800, 1.25, 0.01
SUBDIVISIONS, RADII_M = 6, (300.0, 220.0, 190.0)
BALL_SUBDIVISIONS, BALL_RADIUS_M = 5, 10.0


def hashed(x, y, z, seed):
    """32 bits that belong to a point of the lattice (32-bit mixing after Jenkins and Wang)."""
    h = (x * 374761393 + y * 668265263 + z * 2147483647 + seed * 1274126177).astype(np.uint32)
    h = (h ^ (h >> np.uint32(13))) * np.uint32(1274126177)
    h = (h ^ (h >> np.uint32(16))) * np.uint32(2246822519)
    return h ^ (h >> np.uint32(15))


def noise(p, seed):
    """Gradient noise (Perlin, SIGGRAPH 1985) at points [..., 3]: slopes of the lattice's points, smoothly between them."""
    low = np.floor(p).astype(np.int64)
    at = p - low
    share = at ** 3 * (at * (at * 6 - 15) + 10)  # Perlin, SIGGRAPH 2002: no crease at the lattice
    total = np.zeros(p.shape[:-1])
    for corner in np.ndindex(2, 2, 2):
        h = hashed(*np.moveaxis(low + corner, -1, 0), seed)
        z = (h & np.uint32(0xFFFF)) / 32767.5 - 1
        turn = (h >> np.uint32(16)) / 65536 * 2 * np.pi
        flat = np.sqrt(np.maximum(0, 1 - z * z))
        away = at - corner
        slope = away[..., 0] * flat * np.cos(turn) + away[..., 1] * flat * np.sin(turn) + away[..., 2] * z
        total += np.prod(np.where(corner, share, 1 - share), axis=-1) * slope
    return total


def rough(p, octaves, seed):
    """Noise at scales that halve each time; the height goes with the scale to the power 0.9, as of natural ground."""
    return sum(noise(p * 2 ** n, seed + n) / 2 ** (0.9 * n) for n in range(octaves))


def crater_height(distance, radius):
    """Height of a crater's profile over the ground before it, in the unit of its radius: a bowl from -0.40 to the rim's 0.08, which is 0.20 and
    0.04 of the diameter. The rim is round over a tenth of the radius, as impacts of dust leave it."""
    r = distance / radius
    bowl, blanket = 0.48 * r * r - 0.40, 0.08 * np.maximum(r, 0.5) ** -3
    return radius * np.where(r < 4, -0.03 * np.logaddexp(-bowl / 0.03, -blanket / 0.03), 0)


def ground():
    across_m = (np.arange(COLUMNS) - 0.5 * (COLUMNS - 1)) * SPACING_M
    x, y = np.meshgrid(across_m, across_m)
    heights_m = 14 * rough(np.stack([x / 260, y / 260, np.zeros_like(x)], axis=-1), 9, 11)
    draw = np.random.Generator(np.random.PCG64(4))
    for _ in range(5000):
        radius_m = 1.6 / np.sqrt(draw.uniform(0.0003, 1))  # from 3 m to 180 m across
        at, fresh = draw.uniform(-500, 500, 2), 0.1 + 0.7 * draw.uniform() ** 2  # most are worn down
        if radius_m > 8 and np.hypot(*at) < 1.5 * radius_m:
            continue  # nothing large where the lander comes down
        columns, rows = (slice(*np.searchsorted(across_m, (c - 4 * radius_m, c + 4 * radius_m))) for c in at)
        heights_m[rows, columns] += fresh * crater_height(np.hypot(x[rows, columns] - at[0], y[rows, columns] - at[1]), radius_m)
    middle_m = heights_m[COLUMNS // 2, COLUMNS // 2]
    return np.round((heights_m - middle_m) / UNIT_M).astype("<i2").tobytes()


def sphere(subdivisions):
    """Points and triangles of an icosahedron whose triangles are divided into four, again and again."""
    g = (1 + 5 ** 0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
              (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    points = [np.array(p) / np.linalg.norm(p) for p in points]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
                 (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(subdivisions):
        between = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in between:
                between[key] = len(points)
                points.append((points[a] + points[b]) / np.linalg.norm(points[a] + points[b]))
            return between[key]

        finer = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return np.array(points), np.array(triangles)


def normals(points, triangles):
    """Unit vectors at the points: of the triangles about each, by area."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    of_triangles = np.cross(b - a, c - a)
    out = np.zeros_like(points)
    for i in range(3):
        np.add.at(out, triangles[:, i], of_triangles)
    return out / np.linalg.norm(out, axis=1, keepdims=True)


def asteroid():
    points, triangles = sphere(SUBDIVISIONS)
    draw = np.random.Generator(np.random.PCG64(9))
    size = 1 + 0.35 * rough(1.1 * points, 2, 3) + 0.06 * rough(5 * points, 6, 7)
    for _ in range(260):
        axis = draw.normal(size=3)
        radius = 0.045 / np.sqrt(draw.uniform(0.015, 1))  # in radians: from 20 m to 170 m across
        fresh = 0.4 + 0.6 * draw.uniform()
        size += fresh * crater_height(np.arccos(np.clip(points @ (axis / np.linalg.norm(axis)), -1, 1)), radius)
    points = points * RADII_M * size[:, None]
    return ply(points, normals(points, triangles), triangles)


def ball():
    points, triangles = sphere(BALL_SUBDIVISIONS)
    return ply(BALL_RADIUS_M * points, points, triangles)


def ply(points, upright, triangles):
    vertices = np.hstack([points, upright]).astype("<f4")
    faces = np.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<u2", 3)])
    faces["count"], faces["corners"] = 3, triangles
    header = "ply\nformat binary_little_endian 1.0\n" + f"element vertex {len(vertices)}\n"
    header += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    header += f"element face {len(faces)}\nproperty list uchar ushort vertex_indices\nend_header\n"
    return header.encode() + vertices.tobytes() + faces.tobytes()


if len(sys.argv) != 4:
    sys.exit(__doc__)
for path, content in ((sys.argv[1], ground()), (sys.argv[2], asteroid()), (sys.argv[3], ball())):
    with open(path, "wb") as file:
        file.write(content)
