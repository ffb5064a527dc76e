#!/usr/bin/python3
"""A picture of the Earth by ONC-W2 on Hayabusa2 against hilcam's: frame-transfer smear, noise, bias, and where the disk is.

    onc_w2_test.py HILCAM SOURCE_DIR [PICTURE.png]

Needs shared/data beside the source folder, or where HILCAM_SHARED_DATA says; skipped without. docs/flight.md has the residuals.
PICTURE.png: the flight picture, hilcam's and the difference side by side.
"""
import math
import sys

import numpy

from flight_pictures import DATA, PICTURE, SKIPPED, SOURCE, Judgement, fits_arrays, propagated, render, side_by_side

# What the picture must be compared with is published elsewhere. Place and velocity in ICRF at 2015-12-03T08:44:58.179 UTC [km, km/s]:
# instrument position of hyb2_onc_20151203_084458_w2f_l2a in DOI-USGS/ale, tests/pytests/data/isds/hayabusa2_isd.json, after JAXA's kernels.
PLACE_KM = numpy.array([30.15558294075686, -21415.864299596455, 29138.041066520385])
VELOCITY_KM_S = numpy.array([1.5409457644671734, 5.3312261011154565, -3.5389092329306164])
PLACE_S, PICTURE_S = 8 * 3600 + 44 * 60 + 58.179, 6.639  # after 2015-12-03T00:00 UTC; the second is DATE-OBS
EARTH_KM3_S2 = 398600.4418  # WGS 84 (NGA.STND.0036, 2014)
LINEAR_DN = 3100  # DYNRNGLN of the header: above it the camera is not linear
DARK = numpy.r_[0:500, 640:1024]  # columns without the disk, its halo and its smear
ABOVE, BELOW, DISK = slice(0, 700), slice(850, 1010), slice(735, 815)  # rows
SCENARIO = """\
name: flight_onc_w2
time_utc: 2015-12-03T00:00:06.639Z
seed: 1
camera: %(camera)s
camera_pose: {position_m: [%(place)s], attitude_radec_deg: [%(pointing)s]}
earth: %(earth)s
moon: {visible: false}
atmosphere: {model: %(air)s}
spectrum_edges_um: [0.48, 0.66]
"""


def direction(header, index=""):
    """Returns the direction in ICRF that the header has for the boresight, or for the corner of that number."""
    ra, dec = (math.radians(float(header[key + str(index)])) for key in ("S_RA", "S_DEC"))
    return numpy.array([math.cos(ra) * math.cos(dec), math.sin(ra) * math.cos(dec), math.sin(dec)])


def pointing_deg(header):
    """Returns right ascension, declination and roll: up is between the corners 1 and 2."""
    forward, up = direction(header), direction(header, 1) + direction(header, 2)
    east = numpy.cross([0, 0, 1], forward)
    north = numpy.cross(forward, east)
    roll = math.atan2(up @ east / numpy.linalg.norm(east), up @ north / numpy.linalg.norm(north))
    return float(header["S_RA"]), float(header["S_DEC"]), math.degrees(roll)


def smear(picture):
    """Returns, by column, the smear above and below the disk [DN] and the disk's own light in sum [DN], without bias."""
    light = picture - picture[ABOVE, :500].mean()
    above, below = light[ABOVE].mean(axis=0), light[BELOW].mean(axis=0)
    disk = light[DISK].sum(axis=0)
    rows = DISK.stop - DISK.start
    return above, below, disk - rows * (above * 700 + below * 160) / 860


def line_times_us(picture, columns, exposure_us=4100):
    """Returns the time per row that the smear above, and below, has collected the disk's light for, by column."""
    above, below, disk = smear(picture)
    return exposure_us * above[columns] / disk[columns], exposure_us * below[columns] / disk[columns]


def electrons_per_dn(picture, columns):
    """Returns the slope of the smear's photon noise over its mean, turned round: variances along the columns above the disk."""
    light = picture[20:700, columns] - picture[ABOVE, :500].mean()
    slope, _ = numpy.polyfit(light.mean(axis=0), light.var(axis=0, ddof=1), 1)
    return 1 / slope


def lit_edge(picture, middle, radius):
    """Returns the azimuths, clockwise from the right, of the limb that the Sun at the left lights, and where it is steepest [px]."""
    azimuths = numpy.radians(numpy.arange(96, 265, 3.0))
    radii = numpy.arange(radius - 5, radius + 6, 0.1)  # clouds have edges, too
    x, y = middle[0] + numpy.cos(azimuths)[:, None] * radii, middle[1] + numpy.sin(azimuths)[:, None] * radii
    column, row = numpy.floor(x).astype(int), numpy.floor(y).astype(int)
    u, v = x - column, y - row
    profile = ((picture[row, column] * (1 - u) + picture[row, column + 1] * u) * (1 - v)
               + (picture[row + 1, column] * (1 - u) + picture[row + 1, column + 1] * u) * v)
    fall = profile[:, :-20] - profile[:, 20:]  # over 2 px
    # The middle of the fall: its weight about its greatest, as pixels are coarse.
    edge = numpy.full(len(azimuths), numpy.nan)
    for i, values in enumerate(fall):
        top = numpy.argmax(values)
        near = slice(max(0, top - 15), top + 16)
        weight = numpy.clip(values[near], 0, None)
        if values[top] > 50:
            edge[i] = (weight * (radii[:-20][near] + 1)).sum() / weight.sum()
    return azimuths, edge


def limb(flight, rendered, middle, radius):
    """Returns by how much the flight picture's lit limb lies right, lower and outside of the rendered one, and the rms of the rest [px]."""
    azimuths, first = lit_edge(flight, middle, radius)
    difference = first - lit_edge(rendered, middle, radius)[1]
    terms = numpy.stack([numpy.cos(azimuths), numpy.sin(azimuths), numpy.ones(len(azimuths))], axis=1)
    seen = numpy.isfinite(difference)
    for _ in range(4):
        fit = numpy.linalg.lstsq(terms[seen], difference[seen], rcond=None)[0]
        rest = difference - terms @ fit
        seen = numpy.isfinite(difference) & (numpy.abs(rest) < 3 * max(0.1, numpy.nanstd(rest[seen])))
    return fit, numpy.std(rest[seen]), int(seen.sum())


def main():
    path = DATA / "flight/onc_w2/hyb2_onc_20151203_000006_w2f_l2a.fit"
    land_map = DATA / "earth/blue_marble_albedo.jpg"
    if not path.exists() or not land_map.exists():
        print(f"skipped: no {path} or no {land_map}")
        return SKIPPED
    header, flight = fits_arrays(path)[1]
    place = propagated(PLACE_KM, VELOCITY_KM_S, PICTURE_S - PLACE_S, EARTH_KM3_S2)
    distance = numpy.linalg.norm(place)
    keys = {"camera": SOURCE / "configs/cameras/hyb2_onc_w2.yaml", "place": ", ".join(str(1000 * p) for p in place),
            "pointing": ", ".join(map(str, pointing_deg(header)))}
    rendered = render(SCENARIO % {**keys, "earth": f"{{albedo_map: {land_map}}}", "air": "precomputed"}).astype(float)
    # The year's mean of land, sea, air and clouds together (CERES), as a Lambert surface.
    mean_map = f"{{albedo: 1, albedo_map: {SOURCE}/configs/maps/earth_albedo.png}}"
    cloudy = render(SCENARIO % {**keys, "earth": mean_map, "air": "none"}).astype(float)
    judged = Judgement()
    print(f"distance: {distance:.0f} km, the header's S_DISTHE {header['S_DISTHE']} km")

    # Columns that hold much and are linear throughout: chosen by what the disk has, not by what the smear has.
    constants = []
    for name, picture in (("flight", flight), ("hilcam", cloudy)):  # without clouds no column holds much
        above, below, disk = smear(picture)
        columns = numpy.nonzero((disk > 30000) & (picture[DISK].max(axis=0) < LINEAR_DN))[0]
        up, down = line_times_us(picture, columns)
        constants.append((up.mean(), down.mean()))
        print(f"{name}: {len(columns)} columns; above {up.mean():.3f} us/row ({up.min():.3f} to {up.max():.3f}), below {down.mean():.3f} "
              f"({down.min():.3f} to {down.max():.3f}); brightest {picture.max():.0f} DN, median of the disk's {numpy.median(disk[columns]):.0f}")
        for column in columns[numpy.linspace(0, len(columns) - 1, 5).astype(int)]:
            print(f"    column {column}: {above[column]:7.2f} DN above, {below[column]:7.2f} below; "
                  f"{4100 * above[column] / disk[column]:.3f} and {4100 * below[column] / disk[column]:.3f} us/row")
    for side, first, second in zip(("above", "below"), *constants):
        judged.most(f"smear {side}, flight against hilcam", 100 * abs(first / second - 1), 2, "%")

    dark = [(numpy.median(p[ABOVE][:, DARK]), numpy.std(p[ABOVE, :500])) for p in (flight, rendered)]
    print(f"bias {dark[0][0]:.0f} DN, hilcam {dark[1][0]:.0f}; dark noise {dark[0][1]:.2f} DN, hilcam {dark[1][1]:.2f}")
    bright = numpy.arange(541, 584)
    print(f"photon noise of the smear: {electrons_per_dn(flight, bright):.1f} e-/DN, hilcam "
          f"{electrons_per_dn(rendered, numpy.nonzero(smear(rendered)[2] > 2000)[0]):.1f}")

    rows, columns = numpy.nonzero(rendered[DISK] - dark[1][0] > 200)
    radius = (rows.max() - rows.min() + 1) / 2
    middle = columns.min() + radius, DISK.start + rows.min() + radius
    fit, rms, count = limb(flight, rendered, middle, radius)
    print(f"lit limb: flight lies {fit[0]:.2f} px right, {fit[1]:.2f} lower, {fit[2]:.2f} outside of {radius:.0f}; rms {rms:.2f} px of {count} azimuths")
    lit = rendered[DISK] - dark[1][0] > 400
    shares = numpy.percentile((flight[DISK] - dark[0][0])[lit], (10, 50, 90)) / numpy.median((rendered[DISK] - dark[1][0])[lit])
    print("disk: flight's 10 %%, 50 %% and 90 %% over hilcam's median without clouds: %.2f %.2f %.2f" % tuple(shares))
    sums = [smear(p)[2].sum() for p in (flight, cloudy)]
    print(f"disk's light in sum over that of an Earth with the year's mean albedo: {sums[0] / sums[1]:.3f}; brightest {cloudy.max():.0f} DN")
    if PICTURE:
        box = slice(735, 815), slice(520, 610)
        level = [(p - b) / 2500 for p, b in ((flight, dark[0][0]), (rendered, dark[1][0]))]
        side_by_side(level[0][box], level[1][box], PICTURE, zoom=4, gamma=0.45)
    return judged.status()


if __name__ == "__main__":
    sys.exit(main())
