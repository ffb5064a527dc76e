"""Makes one list of stars, one line a light, of what Stellarium, KStars and d3-celestial have.

Stellarium gives the stars, their places, motions and parallaxes, d3-celestial V and B-V of the Hipparcos stars to 0.01 mag by number; KStars gives
V_T, B_T-V_T and HD numbers of Tycho-2 stars without a Hipparcos number, and tells which places and stars of Stellarium are not to be believed.
"""
import collections
import dataclasses

import numpy
from scipy.spatial import cKDTree

from . import celestial, kstars, m_stars, stellarium, tycho_index

ARCSEC = numpy.pi / 180 / 3600
EPOCH_YEAR = 2000.0

# By falling brightness; the last, from V 9 on, has no Hipparcos stars.
STELLARIUM_FILES = ("stars_0_0v0_8.cat", "stars_1_0v0_8.cat", "stars_2_0v0_8.cat", "stars_3_1v0_4.cat")

# Components of one Hipparcos number nearer than this are one line.
ONE_LIGHT_ARCSEC = 2.0
# Hipparcos' photometry takes in what is nearer than this: a star of Tycho-2 there is light of the Hipparcos star's magnitude already.
HIPPARCOS_APERTURE_ARCSEC = 10.0
# Hipparcos' magnitude of a number is that of the number's only light, of its brightest component, or of all components, if it differs by less than this
# from Stellarium's, which is in steps of 0.05 mag. Else it has a neighbour's light in it.
SAME_STAR_MAG = 0.5
SAME_COMPONENT_MAG = 0.1
SAME_LIGHT_MAG = 0.3
# Tycho's observed places are of this time before J2000 [yr], with this spread: the median of the stars of more than 1"/yr.
OBSERVED_BEFORE_YEARS, OBSERVED_SPREAD_YEARS = 8.34, 0.08
# A place that is off is told from one that is right by other places if the shift is this many times their rounding's standard deviation.
LEAST_SHIFT_SIGMA = 3.0
# KStars has the stars of Tycho-2 to this V_T.
KSTARS_FAINTEST_V_T = 8.0
# A star of the Tycho-2 index is a star here that is nearer than this and of a V_T as near as this.
INDEX_REACH_ARCSEC, INDEX_REACH_MAG = 2.0, 0.3
# Johnson's from Tycho's magnitudes: ESA SP-1200, vol. 1, eq. 1.3.20.
V_PER_TYCHO_COLOUR, COLOUR_PER_TYCHO_COLOUR = -0.090, 0.850


@dataclasses.dataclass
class Light:
    """Holds a line of the catalogue; colour_assumed says where B-V comes from if the source has none."""

    hip: int
    hd: int
    direction: numpy.ndarray
    motion_mas_yr: tuple
    parallax_mas: float
    v_mag: float
    b_v: float | None
    spectrum: str = ""
    v_i: float | None = None
    colour_assumed: str = ""


def east_north(direction):
    east = stellarium.unit(numpy.cross([0.0, 0.0, 1.0], direction))
    return east, numpy.cross(direction, east)


def moved(direction, motion_mas_yr, years):
    """Returns places after some years of straight motion on the sphere."""
    east, north = east_north(direction)
    years = numpy.asarray(years)
    offset = (motion_mas_yr * years) * (ARCSEC / 1000)
    return stellarium.unit(direction + offset[:, :1] * east + offset[:, 1:] * north)


def nearest(tree, direction):
    """Returns the distance ["] to the nearest of a tree's places, and its row."""
    chord, row = tree.query(direction)
    return 2 * numpy.arcsin(chord / 2) / ARCSEC, row


def rows_by_number(stars):
    """Returns rows by Hipparcos number, the brightest component's first."""
    rows_of = collections.defaultdict(list)
    for row in numpy.argsort(stars.v_mag, kind="stable"):
        if stars.hip[row]:
            rows_of[int(stars.hip[row])].append(int(row))
    return rows_of


def centre_of_light(stars, rows):
    return stellarium.unit(numpy.sum(stars.direction[rows] * 10 ** (-0.4 * stars.v_mag[rows])[:, None], axis=0))


def put_stale_places_right(stars, numbers, known, steps_arcsec):
    """Brings places to J2000 that Stellarium left at the time of Tycho's observation; returns their number.

    About 2 % of the Hipparcos numbers have Tycho-2's observed places (of 1991.5 to 1991.8) where J2000 is stated: without motion. A number is one of them if
    another catalogue's star (known, rounded to steps of right ascension and declination) is not where Stellarium says, but where 8.34 years of motion lead.
    Its new place is the mean of that place and the known one, by their weights. Of a number with components, the known place is one component's or that of
    the centre of light; the components keep their places to each other.
    """
    tree = cKDTree(known)
    sigma_arcsec = numpy.array(steps_arcsec) / 12**0.5
    numbers = [rows for rows in numbers
               if numpy.linalg.norm(stars.motion_mas_yr[rows[0]]) / 1000 * OBSERVED_BEFORE_YEARS > LEAST_SHIFT_SIGMA * sigma_arcsec[0]]
    points = [(rows, point) for rows in numbers
              for point in [*stars.direction[rows], centre_of_light(stars, rows)][:1 if len(rows) == 1 else None]]
    direction = numpy.array([point for _, point in points])
    motion = numpy.array([stars.motion_mas_yr[rows[0]] for rows, _ in points])
    speed = numpy.linalg.norm(motion, axis=1) / 1000
    later = moved(direction, motion, OBSERVED_BEFORE_YEARS)
    before_arcsec, _ = nearest(tree, direction)
    after_arcsec, there = nearest(tree, later)
    reach_arcsec = numpy.linalg.norm(steps_arcsec) + 2 * OBSERVED_SPREAD_YEARS * speed
    # A few of KStars' places are off by up to 1": they still tell which hypothesis holds, but not where the star is.
    exact = after_arcsec < reach_arcsec
    near = (exact | (after_arcsec < 0.4 * before_arcsec)) & (before_arcsec < 1.5 * OBSERVED_BEFORE_YEARS * speed + 2 * numpy.linalg.norm(steps_arcsec))
    east, north = east_north(later)
    offset = known[there] - later
    offset_arcsec = numpy.stack([stellarium.dot(offset, east), stellarium.dot(offset, north)], axis=1) / ARCSEC
    rounding = sigma_arcsec * numpy.stack([numpy.hypot(later[:, 0], later[:, 1]), numpy.ones(len(later))], axis=1)
    spread = OBSERVED_SPREAD_YEARS * speed[:, None]
    step = exact[:, None] * offset_arcsec * ARCSEC * spread**2 / (spread**2 + rounding**2)
    target = later + step[:, :1] * east + step[:, 1:] * north
    best = {}
    for k, (rows, _) in enumerate(points):
        best.setdefault(rows[0], []).append(k)
    stale = 0
    for ks in best.values():
        k = min(ks, key=lambda k: after_arcsec[k])
        if near[k] and after_arcsec[k] < min(before_arcsec[ks]):
            rows = points[k][0]
            stars.direction[rows] = stellarium.unit(stars.direction[rows] + target[k] - direction[k])
            stale += 1
    return stale


def combined_magnitude(v_mag):
    return -2.5 * numpy.log10(numpy.sum(10 ** (-0.4 * numpy.asarray(v_mag))))


def clusters(direction, reach_arcsec):
    """Returns lists of rows: places that a chain of steps below the reach joins."""
    left, found = list(range(len(direction))), []
    while left:
        cluster, grown = [left.pop(0)], 0
        while grown < len(cluster):
            near = [row for row in left if numpy.linalg.norm(direction[row] - direction[cluster[grown]]) < reach_arcsec * ARCSEC]
            cluster += near
            left = [row for row in left if row not in near]
            grown += 1
        found.append(cluster)
    return found


def lights_of_number(hip, hd, stars, v_mag, b_v, types):
    """Returns the Lights of one Hipparcos number: its components, those nearer than 2" as one.

    v_mag is Hipparcos' magnitude of the number, to 0.01 mag: for most of all its light, for some of the brightest component's, for a few of a
    neighbour's light, too. It refines the components' magnitudes, which have steps of 0.05 mag, where it is plainly the same light's.
    """
    lights = []
    for rows in clusters(stars.direction, ONE_LIGHT_ARCSEC):
        flux = 10 ** (-0.4 * stars.v_mag[rows])
        brightest = rows[int(numpy.argmax(flux))]
        known = not stars.b_v_is_zero[brightest]
        lights.append(Light(0, 0, stellarium.unit(numpy.sum(stars.direction[rows] * flux[:, None], axis=0)), tuple(stars.motion_mas_yr[brightest]),
                            max(0.0, stars.parallax_mas[brightest]), combined_magnitude(stars.v_mag[rows]), stars.b_v[brightest] if known else None,
                            types[stars.spectrum[brightest]]))
    lights.sort(key=lambda light: light.v_mag)
    first = lights[0]
    first.hip, first.hd = hip, hd
    whole = combined_magnitude([light.v_mag for light in lights])
    of_whole, of_first = abs(v_mag - whole), abs(v_mag - first.v_mag)
    if len(lights) == 1 and of_whole < SAME_STAR_MAG:
        first.v_mag = v_mag
    elif of_first < min(of_whole, SAME_COMPONENT_MAG):
        first.v_mag = v_mag
    elif of_whole < SAME_LIGHT_MAG:
        for light in lights:
            light.v_mag += v_mag - whole
    if b_v is not None:
        first.b_v = b_v
    for light in lights[1:]:
        if light.b_v is None and b_v is not None:
            light.b_v, light.colour_assumed = b_v, "that of the brighter component"
    return lights


def numbered_lights(stars, rows_of, magnitudes, hd, types):
    lights = []
    for hip, rows in rows_of.items():
        v_mag, b_v, *_ = magnitudes.get(hip) or (combined_magnitude(stars.v_mag[rows]), None)
        lights += lights_of_number(hip, hd.get(hip, 0), stars.of(rows), v_mag, b_v, types)
    return lights


def unnumbered_lights(stars, tycho, index, numbered):
    """Returns the Lights of the stars without a Hipparcos number, and how many were left out because nobody else has them.

    Stellarium's stars without a number are of Tycho-2 and NOMAD. NOMAD's bright ones are no stars: knots of galaxies and globular clusters, images of bright
    stars. Down to its faintest magnitude KStars has all of Tycho-2, so that a star that it lacks there is not one.
    """
    apart, _ = nearest(cKDTree(numbered), stars.direction)
    stars = stars.of(apart > HIPPARCOS_APERTURE_ARCSEC)
    places, value = tycho
    arcsec, row = nearest(cKDTree(places), stars.direction)
    # A place of the star that has moved for up to 10 years is the same star's.
    reach_arcsec = 1.5 + numpy.linalg.norm(stars.motion_mas_yr, axis=1) / 100
    found = (arcsec < reach_arcsec) & (abs(value["mag"][row] - stars.v_mag) < 0.5)
    tycho_v = stars.v_mag - V_PER_TYCHO_COLOUR / COLOUR_PER_TYCHO_COLOUR * stars.b_v
    found &= first_of_each(row, arcsec)
    beside_confirmed = numpy.zeros(len(row), bool)
    beside_confirmed[~found] = nearest(cKDTree(stars.direction[found]), stars.direction[~found])[0] < HIPPARCOS_APERTURE_ARCSEC
    if index:
        index_arcsec, there = nearest(cKDTree(index[0]), stars.direction)
        doubtful = ~found & ~((index_arcsec < INDEX_REACH_ARCSEC) & (abs(index[1][there] - tycho_v) < INDEX_REACH_MAG))
    else:
        doubtful = ~found & ((~beside_confirmed & (tycho_v < KSTARS_FAINTEST_V_T - 0.05)) | stars.b_v_is_zero)
    lights = []
    for k in numpy.flatnonzero(~doubtful):
        light = Light(0, 0, stars.direction[k], tuple(stars.motion_mas_yr[k]), 0.0, stars.v_mag[k], stars.b_v[k] if index or not stars.b_v_is_zero[k] else None)
        if found[k]:
            t = row[k]
            light.hd, light.motion_mas_yr = int(value["HD"][t]), (value["dRA"][t], value["dDec"][t])
            if value["bv_index"][t]:
                light.v_mag = value["mag"][t] + V_PER_TYCHO_COLOUR * value["bv_index"][t]
                light.b_v = COLOUR_PER_TYCHO_COLOUR * value["bv_index"][t]
        lights.append(light)
    return one_line_each(lights), int(doubtful.sum())


def first_of_each(row, arcsec):
    """Returns which stars are the nearest of those that have the same row for their nearest."""
    order = numpy.lexsort((arcsec, row))
    first = numpy.ones(len(row), bool)
    first[order[1:]] = row[order[1:]] != row[order[:-1]]
    return first


def one_line_each(lights):
    """Returns the lights with those nearer than 2" as one: components that Tycho-2 has apart."""
    pairs = cKDTree(numpy.array([light.direction for light in lights])).query_pairs(ONE_LIGHT_ARCSEC * ARCSEC)
    merged = set()
    for a, b in sorted(pairs):
        if a in merged or b in merged:
            continue
        bright, faint = sorted((lights[a], lights[b]), key=lambda light: light.v_mag)
        flux = 10 ** (-0.4 * numpy.array([bright.v_mag, faint.v_mag]))
        bright.direction = stellarium.unit(flux[0] * bright.direction + flux[1] * faint.direction)
        bright.v_mag = combined_magnitude([bright.v_mag, faint.v_mag])
        merged.add(a if faint is lights[a] else b)
    return [light for row, light in enumerate(lights) if row not in merged]


def assume_colours(lights):
    """Gives each light without a colour the median of the lights of its spectral class (two letters), or of all."""
    known = collections.defaultdict(list)
    for light in lights:
        if light.b_v is not None and not light.colour_assumed:
            known[light.spectrum[:2]].append(light.b_v)
            known["all"].append(light.b_v)
    for light in lights:
        if light.b_v is None:
            of_class = light.spectrum[:2] if len(known[light.spectrum[:2]]) >= 10 and light.spectrum else "all"
            light.b_v = float(numpy.median(known[of_class]))
            light.colour_assumed = "the median of all" if of_class == "all" else "the median of its spectral class"


def catalogue(stellarium_folder, kstars_folder, celestial_file, tycho_index_file, faintest):
    """Returns the Lights to a faintest V, brightest first, and a dict of counts of what was done. The index of Tycho-2 may be None."""
    hipparcos = celestial.stars(celestial_file)
    stars = stellarium.joined([stellarium.read(stellarium_folder / name) for name in STELLARIUM_FILES if tycho_index_file or name != STELLARIUM_FILES[-1]])
    rows_of = rows_by_number(stars)
    for hip, motion in stellarium.proper_motions(stellarium_folder).items():
        stars.motion_mas_yr[rows_of.get(hip, [])] = motion
    known = kstars.hipparcos(kstars_folder)
    bright = [rows for rows in rows_of.values() if stars.v_mag[rows[0]] < kstars.HIPPARCOS_FAINTEST_V]
    faint = [rows for rows in rows_of.values() if stars.v_mag[rows[0]] >= kstars.HIPPARCOS_FAINTEST_V]
    counts = {"places brought to J2000": put_stale_places_right(stars, bright, known, kstars.PLACE_STEPS_ARCSEC)}
    if tycho_index_file:
        places = kstars.directions(*numpy.array([star[2:] for star in hipparcos.values()]).T)
        counts["places brought to J2000"] += put_stale_places_right(stars, faint, places, [celestial.PLACE_STEP_ARCSEC] * 2)
    numbered = numbered_lights(stars, rows_of, hipparcos, stellarium.henry_draper(stellarium_folder), stellarium.spectral_types(stellarium_folder))
    # A little more than asked for: with KStars' magnitude a star may be brighter.
    rest = stars.of((stars.hip == 0) & (stars.v_mag < faintest + 0.2))
    index = tycho_index.read(tycho_index_file) if tycho_index_file else None
    others, counts["left out: in Stellarium alone"] = unnumbered_lights(rest, kstars.tycho(kstars_folder), index, stars.direction[stars.hip > 0])
    lights = numbered + others
    for light in lights:
        light.v_mag = round(float(light.v_mag), 2)
    lights = [light for light in lights if light.v_mag <= faintest]
    assume_colours(lights)
    for light in lights:
        light.v_i = m_stars.v_i(light.spectrum)
    counts["V-Ic by class"] = sum(light.v_i is not None for light in lights)
    for reason, number in collections.Counter(light.colour_assumed for light in lights if light.colour_assumed).items():
        counts[f"B-V assumed: {reason}"] = number
    return sorted(lights, key=lambda light: (light.v_mag, light.hip)), counts
