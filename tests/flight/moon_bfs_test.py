#!/usr/bin/python3
"""Two pictures of the Moon through the Earth's air by a Blackfly S BFS-U3-31S4M against hilcam's: limb, brightness, contrast.

    moon_bfs_test.py HILCAM SOURCE_DIR [PICTURE.png]

Needs shared/data beside the source folder, or where HILCAM_SHARED_DATA says; skipped without. docs/flight.md has the residuals.
PICTURE.png: hilcam's picture with 50 mm alone, as the flight pictures may not be copied.
"""
import sys

import numpy
from PIL import Image

from flight_pictures import DATA, PICTURE, SKIPPED, SOURCE, Judgement, blurred, correlation, render, shift_between

# The camera's settings are those of its operators (andrepiz/abram, test/validation/opensky_bfs).
PICTURES = (("imgFLIR_20231222212953_115", "2023-12-22T21:29:53Z", 50, 0.114), ("imgFLIR_20231222192125_025", "2023-12-22T19:21:25Z", 25, 0.080))
GAIN_DB, F_NUMBER, FULL_SCALE_BITS = 15, 4, 8
SCENARIO = """\
name: flight_moon_bfs
time_utc: %(time)s
seed: 1
origin: {kind: earth_fixed, longitude_deg: 8.3810, latitude_deg: 45.8485, height_km: 0.455}
camera: %(camera)s
camera_pose: {position_m: [0, 0, 0], attitude: nadir, nadir_of: moon}
atmosphere: {model: precomputed}
moon: {law: hapke, albedo_map: %(maps)s/moon_color.png, albedo_map_reference: 0.5, height_map: %(maps)s/moon_height.png, height_zero_m: -10000}
spectrum_edges_um: [0.35, 0.45, 0.55, 0.65, 0.75, 0.95]
"""
AZIMUTHS = numpy.radians(numpy.arange(0, 360, 3.0))
BACKGROUND_DN = 12  # of 255; the disk is above


def sampled(picture, x, y):
    """Returns the picture between its pixels, bilinearly."""
    column = numpy.clip(numpy.floor(x).astype(int), 0, picture.shape[1] - 2)
    row = numpy.clip(numpy.floor(y).astype(int), 0, picture.shape[0] - 2)
    u, v = x - column, y - row
    return ((picture[row, column] * (1 - u) + picture[row, column + 1] * u) * (1 - v)
            + (picture[row + 1, column] * (1 - u) + picture[row + 1, column + 1] * u) * v)


def disk(picture):
    """Returns the middle and the radius of the circle through the lit limb, the azimuth of the light and the rms about the circle [px]."""
    rows, columns = numpy.nonzero(picture > BACKGROUND_DN)
    near = (abs(rows - numpy.median(rows)) < 150) & (abs(columns - numpy.median(columns)) < 150)
    centroid = columns[near].mean(), rows[near].mean()
    middle, radius = centroid, 0.6 * numpy.sqrt(near.sum())
    for _ in range(6):
        radii = numpy.arange(0.6, 1.5, 0.002) * radius
        profile = sampled(picture, middle[0] + numpy.cos(AZIMUTHS)[:, None] * radii, middle[1] + numpy.sin(AZIMUTHS)[:, None] * radii)
        step = max(1, round(1 / (radii[1] - radii[0])))
        fall = profile[:, :-step] - profile[:, step:]
        steepest = numpy.argmax(fall, axis=1)
        edge = radii[steepest] + 0.5
        sun = numpy.arctan2(centroid[1] - middle[1], centroid[0] - middle[0]) if middle != centroid else None
        lit = fall.max(axis=1) > 0.5 * numpy.percentile(fall.max(axis=1), 80)
        if sun is not None:
            lit &= numpy.cos(AZIMUTHS - sun) > 0.2
        x, y = middle[0] + edge * numpy.cos(AZIMUTHS), middle[1] + edge * numpy.sin(AZIMUTHS)
        for _ in range(3):
            terms = numpy.stack([x, y, numpy.ones(len(x))], axis=1)
            a, b, c = numpy.linalg.lstsq(terms[lit], (x ** 2 + y ** 2)[lit], rcond=None)[0]
            rest = numpy.hypot(x - a / 2, y - b / 2) - numpy.sqrt(c + (a ** 2 + b ** 2) / 4)
            lit &= abs(rest) < max(1, 3 * numpy.std(rest[lit]))
        middle, radius = (a / 2, b / 2), numpy.sqrt(c + (a ** 2 + b ** 2) / 4)
    return middle, radius, numpy.arctan2(centroid[1] - middle[1], centroid[0] - middle[0]), numpy.std(rest[lit])


def straightened(picture, found, size=121):
    """Returns the disk with its middle in the middle, the light from the right and a radius of half of 0.8 of the size."""
    (x0, y0), radius, sun, _ = found
    v, u = (numpy.mgrid[0:size, 0:size] - size // 2) / (0.4 * size) * radius
    return sampled(picture, x0 + u * numpy.cos(sun) - v * numpy.sin(sun), y0 + u * numpy.sin(sun) + v * numpy.cos(sun))


def main():
    folder = DATA / "flight/moon_bfs"
    if not all((folder / f"{name}.png").exists() for name, *_ in PICTURES):
        print(f"skipped: no {folder}/*.png")
        return SKIPPED
    judged = Judgement()
    for name, time, focal_mm, exposure_ms in PICTURES:
        flight = numpy.asarray(Image.open(folder / f"{name}.png").convert("L")).astype(float)
        settings = {"focal_length_mm": focal_mm, "f_number": F_NUMBER, "exposure_ms": exposure_ms, "gain_db": GAIN_DB,
                    "width_px": 400, "height_px": 400, "offset_dn": 0}
        made = render(SCENARIO % {"time": time, "camera": SOURCE / "configs/cameras/bfs_u3_31s4m.yaml", "maps": SOURCE / "configs/maps"}, "frame",
                      *(f"camera.{key}={value}" for key, value in settings.items())) / 2 ** (12 - FULL_SCALE_BITS)
        disks = disk(flight), disk(made)
        print(f"{focal_mm} mm: radius {disks[0][1]:.2f} px, hilcam {disks[1][1]:.2f}; form {disks[0][3]:.2f} px rms, hilcam {disks[1][3]:.2f}; "
              f"light from {numpy.degrees(disks[0][2]):.1f} deg, hilcam {numpy.degrees(disks[1][2]):.1f} (attitude fitted)")
        both = [straightened(p, d) for p, d in zip((flight, made), disks)]
        y, x = (numpy.mgrid[0:121, 0:121] - 60) / 48.4
        lit = (numpy.hypot(x, y) < 0.95) & (both[1] > 20) & (both[0] < 250)
        inner = (numpy.hypot(x - 0.3, y) < 0.5) & lit
        ratio = both[0][lit].sum() / both[1][lit].sum()
        print(f"    DN of 255: sums, flight over hilcam {ratio:.3f}; medians {numpy.median(both[0][lit]):.1f}, hilcam "
              f"{numpy.median(both[1][lit]):.1f}; greatest {both[0].max():.0f}, hilcam {both[1].max():.0f}")
        print(f"    contrast (rms over mean, within): {both[0][inner].std() / both[0][inner].mean():.3f}, hilcam "
              f"{both[1][inner].std() / both[1][inner].mean():.3f}; correlation {correlation(both[0][lit], both[1][lit]):.3f}")
        # What is between two and eight pixels wide, well within the disk: maria, where hilcam's Moon has them.
        weight = numpy.clip((0.75 - numpy.hypot(x, y)) / 0.1, 0, 1) * numpy.clip((x + 0.3) / 0.1, 0, 1)
        maria = [(blurred(p, 1) - blurred(p, 6)) / p[inner].mean() * weight for p in both]
        right, lower = shift_between(*maria, reach=8)
        print(f"    maria: rms {maria[0][weight > 0].std():.4f}, hilcam {maria[1][weight > 0].std():.4f}; correlation "
              f"{correlation(maria[0], maria[1]):.3f}; flight lies {right * disks[0][1] / 48.4:.2f} px along the light, {lower * disks[0][1] / 48.4:.2f} across")
        judged.most(f"{focal_mm} mm: radius, flight against hilcam", abs(disks[0][1] - disks[1][1]), 1, "px")
        judged.most(f"{focal_mm} mm: place of the maria", numpy.hypot(right, lower) * disks[0][1] / 48.4, 0.5, "px")
        # The two pictures' settings contradict each other by more than either ratio (docs/flight.md).
        judged.known(f"{focal_mm} mm: DN, flight over hilcam, less one", ratio - 1, 0.15, {50: 0.185, 25: 1.060}[focal_mm], 0.02)
        if PICTURE and focal_mm == 50:
            Image.fromarray(numpy.clip(made, 0, 255).astype("uint8")).save(PICTURE)
    return judged.status()


if __name__ == "__main__":
    sys.exit(main())
