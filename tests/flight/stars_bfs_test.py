#!/usr/bin/python3
"""Eight pictures of the night sky by a Blackfly S BFS-U3-31S4M against hilcam's stars: where they are, and how bright by each other.

    stars_bfs_test.py HILCAM SOURCE_DIR

Needs flight/stars_bfs/*.tiff in shared/data beside the source folder, or where HILCAM_SHARED_DATA says (test_data of the public
repository esa/tetra3), and astrometry.net's solve-field; skipped without. docs/flight.md has the residuals.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy
from PIL import Image

from flight_pictures import DATA, HILCAM, SKIPPED, SOURCE, Judgement

# Sony IMX265, binned 2 x 2, behind a Fujifilm HF35XA-5M of 35 mm at f/1.9 (README of esa/tetra3). The time is that of the file names.
WIDTH, HEIGHT, PITCH_UM = 1024, 768, 6.9
SATURATED = 60000
SCENARIO = """\
name: flight_stars_bfs
time_utc: 2019-07-29T20:47:26Z
seed: 1
origin: {kind: free}
sun: {direction: [0, 0, 1]}
camera: %(camera)s
camera_pose: {position_m: [0, 0, 0], attitude_radec_deg: [%(pointing)s]}
stars: {catalogue: %(stars)s, faintest_magnitude: 7.5}
spectrum_edges_um: [0.35, 0.45, 0.55, 0.65, 0.75, 0.95]
"""


def mean_around(picture, reach):
    """Returns the mean of the square of so many pixels to each side."""
    sums = numpy.cumsum(numpy.cumsum(numpy.pad(picture, ((reach + 1, reach), (reach + 1, reach)), mode="edge"), 0), 1)
    size = 2 * reach + 1
    return (sums[size:, size:] - sums[:-size, size:] - sums[size:, :-size] + sums[:-size, :-size]) / size ** 2


def found_stars(picture):
    """Returns place [px, the first pixel's middle at 0.5], light [DN] and brightest pixel of the 60 brightest stars, in the order of light."""
    light = picture - mean_around(picture, 12)
    noise = 1.4826 * numpy.median(abs(light - numpy.median(light)))
    smooth, edge = mean_around(light, 1), 8
    core = smooth[edge:-edge, edge:-edge]
    peak = core > 4 * noise
    for dy in range(-3, 4):
        for dx in range(-3, 4):
            peak &= core >= smooth[edge + dy:smooth.shape[0] - edge + dy, edge + dx:smooth.shape[1] - edge + dx]
    y, x = numpy.mgrid[-3:4, -3:4]
    stars = []
    for row, column in zip(*(n + edge for n in numpy.nonzero(peak))):
        around = light[row - 3:row + 4, column - 3:column + 4]
        weight = numpy.clip(around, 0, None) / numpy.clip(around, 0, None).sum()
        stars.append((column + 0.5 + (weight * x).sum(), row + 0.5 + (weight * y).sum(), around.sum(),
                      picture[row - 1:row + 2, column - 1:column + 2].max()))
    return numpy.array(sorted(stars, key=lambda star: -star[2])[:60])


def solved_pointing(stars, folder):
    """Returns right ascension, declination and roll as astrometry.net has them, or None where it does not solve the field."""
    from astropy.io import fits
    columns = [fits.Column(name, "E", array=values) for name, values in zip(("X", "Y", "FLUX"), (*(stars[:, :2].T + 0.5), stars[:, 2]))]
    fits.BinTableHDU.from_columns(columns).writeto(folder / "x.xyls", overwrite=True)
    subprocess.run(["solve-field", "--overwrite", "--no-plots", "--no-tweak", "--width", str(WIDTH), "--height", str(HEIGHT), "--sort-column", "FLUX",
                    "--scale-units", "arcsecperpix", "--scale-low", "38", "--scale-high", "43", "--crpix-center", "x.xyls"], cwd=folder,
                   capture_output=True, check=False)
    if not (folder / "x.wcs").exists():
        return None
    wcs = fits.getheader(folder / "x.wcs")
    # FITS' y goes down here, as the picture's rows do: up is -y.
    return [wcs["CRVAL1"], wcs["CRVAL2"], numpy.degrees(numpy.arctan2(-wcs["CD1_2"], -wcs["CD2_2"]))]


def drawn_stars(pointing, focal_mm, folder):
    """Returns place and electrons of the stars that hilcam draws, by its truth."""
    config = folder / "stars.yaml"
    config.write_text(SCENARIO % {"camera": SOURCE / "configs/cameras/bfs_u3_31s4m.yaml", "stars": SOURCE / "configs/stars/hipparcos.csv",
                                  "pointing": ", ".join(map(str, pointing))})
    settings = {"width_px": WIDTH, "height_px": HEIGHT, "pitch_um": PITCH_UM, "focal_length_mm": focal_mm, "f_number": 1.9, "exposure_ms": 100}
    shutil.rmtree(folder / "truth", ignore_errors=True)
    done = subprocess.run([HILCAM, "render", config, "--out", folder / "x.png", "--truth", folder / "truth",
                           *(word for key, value in settings.items() for word in ("--set", f"camera.{key}={value}"))],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    frame = json.loads((folder / "truth/x.truth.jsonl").read_text().splitlines()[-1])
    return numpy.array([(*star["position_px"], star["electrons"], star["magnitude_v"]) for star in frame["stars"]])


def pairs(found, drawn, reach_px):
    """Returns index pairs of stars that are nearest to each other within a reach, where no other of like brightness is near."""
    distance = numpy.hypot(found[:, None, 0] - drawn[None, :, 0], found[:, None, 1] - drawn[None, :, 1])
    near = distance < reach_px
    out = []
    for i in range(len(found)):
        candidates = numpy.nonzero(near[i])[0]
        if len(candidates):
            j = candidates[numpy.argmax(drawn[candidates, 2])]
            blends = (numpy.hypot(*(drawn[:, :2] - drawn[j, :2]).T) < 6) & (drawn[:, 2] > 0.05 * drawn[j, 2])
            if blends.sum() == 1:
                out.append((i, j))
    return numpy.array(out, dtype=int).reshape(-1, 2)


def main():
    pictures = sorted((DATA / "flight/stars_bfs").glob("*.tiff"))
    if not pictures or not shutil.which("solve-field"):
        print(f"skipped: no {DATA}/flight/stars_bfs/*.tiff or no solve-field")
        return SKIPPED
    judged, places, lights = Judgement(), [], []
    with tempfile.TemporaryDirectory() as name:
        for path in pictures:
            folder = pathlib.Path(name, path.stem)
            folder.mkdir()
            found = found_stars(numpy.asarray(Image.open(path)).astype(float))
            pointing = solved_pointing(found, folder)
            if pointing is None:
                print(f"{path.stem}: not solved")
                continue
            focal_mm = 35.0
            for reach_px in (12, 4, 2.5):
                drawn = drawn_stars(pointing, focal_mm, folder)
                matched = pairs(found, drawn, reach_px)
                seen, made = (found[matched[:, 0], :2] - (WIDTH / 2, HEIGHT / 2)), (drawn[matched[:, 1], :2] - (WIDTH / 2, HEIGHT / 2))
                # Attitude and scale as the complex numbers a, b of seen = a made + b.
                z, w = (p[:, 0] + 1j * p[:, 1] for p in (seen, made))
                a, b = numpy.linalg.lstsq(numpy.stack([w, numpy.ones(len(w))], axis=1), z, rcond=None)[0]
                rest = z - a * w - b
                if reach_px > 2.5:
                    focal_mm, pointing = moved(pointing, focal_mm, a, b)
            places += [(path, *star) for star in zip(seen, numpy.stack([rest.real, rest.imag], axis=1))]
            whole = found[matched[:, 0], 3] < SATURATED
            ratio = -2.5 * numpy.log10(found[matched[:, 0], 2] / drawn[matched[:, 1], 2])[whole]
            bright = drawn[matched[:, 1], 2][whole] > numpy.percentile(drawn[matched[:, 1], 2], 50)
            lights += list(zip(drawn[matched[:, 1], 3][whole], ratio - numpy.median(ratio[bright])))
            print(f"{path.stem}: {len(matched)} of {len(found)} stars, {focal_mm:.3f} mm; rms {numpy.sqrt(numpy.mean(abs(rest) ** 2) / 2):.3f} px an axis; "
                  f"light {numpy.std(ratio[bright]):.3f} mag rms of {bright.sum()}", flush=True)
    rest = numpy.array([r for _, _, r in places])
    seen = numpy.array([p for _, p, _ in places])
    radius = numpy.hypot(*seen.T)
    outward = (rest * seen).sum(axis=1) / radius
    print(f"all: {len(places)} stars, {numpy.sqrt(numpy.mean(rest ** 2)):.3f} px rms an axis")
    for low, high in ((0, 150), (150, 300), (300, 400), (400, 500), (500, 640)):
        ring = (radius >= low) & (radius < high)
        print(f"    {low} to {high} px from the middle: outward {numpy.median(outward[ring]):.3f} px, about that {numpy.std(outward[ring]):.3f}, "
              f"rms an axis {numpy.sqrt(numpy.mean(rest[ring] ** 2)):.3f}; {ring.sum()} stars")
    # The lens's distortion, c (r^3 - m r) with m for the scale that was fitted, of every other picture tells it of the others.
    half = numpy.array([pictures.index(path) % 2 == 0 for path, _, _ in places])
    cubic, linear = seen * (radius ** 2)[:, None] / 1e6, seen / 1e3
    terms = numpy.stack([cubic[half].ravel(), linear[half].ravel()], axis=1)
    fit = numpy.linalg.lstsq(terms, rest[half].ravel(), rcond=None)[0]
    left = rest[~half] - fit[0] * cubic[~half] - fit[1] * linear[~half]
    print(f"with the distortion of half of the pictures, the others: {numpy.sqrt(numpy.mean(rest[~half] ** 2)):.3f} px rms before, "
          f"{numpy.sqrt(numpy.mean(left ** 2)):.3f} after, median {numpy.median(numpy.hypot(*left.T)):.3f} px")
    lights = numpy.array(lights)
    for low, high in ((0, 3), (3, 4), (4, 5), (5, 6), (6, 7.5)):
        row = (lights[:, 0] >= low) & (lights[:, 0] < high)
        if row.sum() > 3:
            print(f"    V {low} to {high}: flight fainter by {numpy.median(lights[row, 1]):.3f} mag, robust deviation "
                  f"{1.4826 * numpy.median(abs(lights[row, 1] - numpy.median(lights[row, 1]))):.3f}; {row.sum()} stars")
    judged.most("stars' places, rms an axis", numpy.sqrt(numpy.mean(rest ** 2)), 0.5, "px")
    return judged.status()


def moved(pointing, focal_mm, a, b):
    """Returns focal length and pointing with which what lay at w is drawn at a w + b, w and b from the picture's middle [px]."""
    focal_px = focal_mm * 1000 / PITCH_UM
    roll = numpy.radians(pointing[2])
    # The sky's point that has to be in the middle lies at -b / a now; right is east of up, turned by the roll.
    middle = -b / a
    right, down = middle.real / focal_px, middle.imag / focal_px
    ra, dec = numpy.radians(pointing[:2])
    forward = numpy.array([numpy.cos(dec) * numpy.cos(ra), numpy.cos(dec) * numpy.sin(ra), numpy.sin(dec)])
    east = numpy.array([-numpy.sin(ra), numpy.cos(ra), 0])
    north = numpy.cross(forward, east)
    up = numpy.cos(roll) * north + numpy.sin(roll) * east
    side = numpy.cross(forward, up)  # right: x with y down and z forward
    turn = numpy.angle(a)
    new = forward + right * side - down * up
    new /= numpy.linalg.norm(new)
    # A picture turned clockwise by an angle has its up at that angle anticlockwise in the sky's picture.
    up = numpy.cos(turn) * up - numpy.sin(turn) * side
    east = numpy.cross([0, 0, 1], new)
    east /= numpy.linalg.norm(east)
    north = numpy.cross(new, east)
    return focal_mm * abs(a), [float(numpy.degrees(numpy.arctan2(new[1], new[0])) % 360), float(numpy.degrees(numpy.arcsin(new[2]))),
                               float(numpy.degrees(numpy.arctan2(up @ east, up @ north)))]


if __name__ == "__main__":
    sys.exit(main())
