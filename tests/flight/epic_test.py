#!/usr/bin/python3
"""Ten pictures of the Earth by EPIC on DSCOVR against hilcam's: radius of the limb, and the time that the continents tell.

    epic_test.py HILCAM SOURCE_DIR

Needs shared/data beside the source folder, or where HILCAM_SHARED_DATA says; skipped without. Fitted of each picture: where its disk
lies (two numbers, the attitude). Not fitted: scale, roll, time, position. docs/flight.md has the residuals.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
from PIL import Image

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
DATA = pathlib.Path(os.environ.get("HILCAM_SHARED_DATA", SOURCE.parent / "shared/data"))
SIZE_PX = 1080
FEWEST_AZIMUTHS = 60
# EPIC: 2048 px of 15 um behind 2836.42 mm at f/9.3, of which the public pictures are reduced to 1080 px (the data's README).
SCENARIO = """\
name: flight_epic
time_utc: %(time)s
camera: {width_px: 1080, height_px: 1080, pitch_um: 28.44444, focal_length_mm: 2836.42, f_number: 9.3, exposure_ms: 2,
         quantum_efficiency: 0.6, full_well_e: 200000, read_noise_e: 10, gain_e_dn: 50, bits: 12}
camera_pose: {position_m: [%(position)s], attitude: look_at, look_at_m: [0, 0, 0], up: [0, 0, 1]}
earth: {%(map)s}
moon: {visible: false}
spectrum_edges_um: [0.60, 0.70]
"""


def render(folder, position_km, time, earth):
    """Returns hilcam's picture, in digital numbers, of an Earth with the keys 'earth'."""
    scenario, picture = folder / "epic.yaml", folder / "epic.png"
    scenario.write_text(SCENARIO % {"time": time, "position": ", ".join(str(1000 * p) for p in position_km),
                                    "map": earth})
    done = subprocess.run([HILCAM, "render", scenario, "--out", picture], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return numpy.asarray(Image.open(picture)).astype(float)


def sampled(image, x, y):
    """Returns the image between its pixels, bilinearly."""
    column, row = numpy.floor(x).astype(int), numpy.floor(y).astype(int)
    u, v = x - column, y - row
    return ((image[row, column] * (1 - u) + image[row, column + 1] * u) * (1 - v)
            + (image[row + 1, column] * (1 - u) + image[row + 1, column + 1] * u) * v)


AZIMUTHS = numpy.radians(numpy.arange(0, 360, 2.0))


def edges(image):
    """Returns the radius about the picture's middle where each azimuth crosses half of what lies 12 px inside; nan where that is dark."""
    radii = numpy.arange(390, 490, 0.1)
    profile = sampled(image, 539.5 + numpy.cos(AZIMUTHS)[:, None] * radii, 539.5 + numpy.sin(AZIMUTHS)[:, None] * radii)
    steepest = radii[numpy.argmin(profile[:, 20:] - profile[:, :-20], axis=1) + 10]
    found = numpy.full(len(AZIMUTHS), numpy.nan)
    for i, radius in enumerate(steepest):
        if radius < 405:
            continue
        inside = numpy.median(profile[i, (radii > radius - 14) & (radii < radius - 8)])
        beyond = numpy.nonzero((profile[i] < inside / 2) & (radii > radius - 8))[0]
        if inside > 0.15 * numpy.percentile(image, 90) and len(beyond):
            found[i] = radii[beyond[0]]
    return found


def limb(flight, rendered):
    """Returns by how much the flight picture's limb lies right, lower and outside of the rendered one, and the rms of what remains [px]."""
    difference = edges(flight) - edges(rendered)
    seen = numpy.isfinite(difference)
    for _ in range(4):
        terms = numpy.stack([numpy.cos(AZIMUTHS), numpy.sin(AZIMUTHS), numpy.ones(len(AZIMUTHS))], axis=1)
        fit = numpy.linalg.lstsq(terms[seen], difference[seen], rcond=None)[0]
        rest = difference - terms @ fit
        seen = numpy.isfinite(difference) & (numpy.abs(rest) < 3 * max(0.2, numpy.nanstd(rest[seen])))
    assert seen.sum() > FEWEST_AZIMUTHS
    return fit, numpy.std(rest[seen]), seen.sum()


def coast_shift(flight, rendered, centre):
    """Returns the shift at which the continents correlate best [px], and that correlation, where clouds are few."""
    y, x = numpy.mgrid[0:SIZE_PX, 0:SIZE_PX] - 539.5
    middle = numpy.hypot(x, y) < 320
    colour = flight[..., 0] - flight[..., 2]  # land is redder than clouds, sea and air
    spectrum = [numpy.fft.fft2(numpy.where(middle, p - numpy.mean(p[middle]), 0))
                for p in (numpy.roll(colour, (-round(centre[1]), -round(centre[0])), (0, 1)), rendered)]
    power = numpy.fft.ifft2(spectrum[0] * numpy.conj(spectrum[1])).real
    near = numpy.roll(power, (30, 30), (0, 1))[:61, :61]
    row, column = numpy.unravel_index(numpy.argmax(near), near.shape)
    scale = numpy.sqrt(numpy.prod([numpy.sum(numpy.abs(s) ** 2) / SIZE_PX ** 2 for s in spectrum]))
    return column - 30, row - 30, near[row, column] / scale


def main():
    pictures = sorted((DATA / "flight/epic").glob("*.json"))
    if not pictures or not (DATA / "earth/blue_marble_albedo.jpg").exists():
        print(f"skipped: no {DATA}/flight/epic/*.json or no {DATA}/earth/blue_marble_albedo.jpg")
        return 77
    print("picture           dx px  dy px  dr px  rms px  azimuths  coast by 'date': x y corr  by 'identifier': x y corr")
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        for path in pictures:
            about = json.loads(path.read_text())
            stamp = about["identifier"]
            named = f"{stamp[:4]}-{stamp[4:6]}-{stamp[6:8]}T{stamp[8:10]}:{stamp[10:12]}:{stamp[12:]}Z"
            flight = numpy.asarray(Image.open(path.with_suffix(".jpg")).convert("RGB")).astype(float)
            position = [about["dscovr_j2000_position"][axis] for axis in "xyz"]
            even = render(pathlib.Path(folder), position, named, "albedo: 0.3")
            land = f"albedo_map: {DATA}/earth/blue_marble_albedo.jpg"
            both = [render(pathlib.Path(folder), position, time, land) for time in (about["date"].replace(" ", "T") + "Z", named)]
            (dx, dy, dr), rms, count = limb(flight.mean(axis=2), even)
            shifts = [coast_shift(flight, p, (dx, dy)) for p in both]
            print(f"{stamp}  {dx:6.2f} {dy:6.2f} {dr:6.2f} {rms:6.2f} {count:6d}     "
                  + "   ".join(f"{x:4d} {y:4d} {c:6.3f}" for x, y, c in shifts), flush=True)
            # The Earth turns by 9 px in the five minutes between the two times.
            if shifts[1][2] <= shifts[0][2] or max(abs(shifts[1][0]), abs(shifts[1][1])) > 2 or abs(dr) > 2:
                wrong.append(stamp)
    if wrong:
        print("the continents are not where the identifier's time has them, or the limb is off by 2 px:", *wrong)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
