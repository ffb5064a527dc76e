#!/usr/bin/python3
"""Makes render/sky/planet_series_terms.inc from the tables of VSOP87 in libnova's source (Debian's source package libnova).

    apt-get source libnova && tools/make_planet_series.py libnova-0.16/src > render/sky/planet_series_terms.inc

libnova holds version B of VSOP87 (Bretagnon & Francou, A&A 202, 309, 1988; CDS catalogue VI/81) whole: longitude, latitude and radius
as sums of t^k A cos(B + C t). Terms of one planet, k and C become one row, whose sine and cosine serve all three coordinates. Rows stay
whose amplitude, seen from the Sun, is above LEAST_RAD at the end of the span of years that hilcam covers.
"""
import argparse
import math
import pathlib
import re
import sys

PLANETS = ("mercury", "venus", "mars", "jupiter", "saturn", "uranus", "neptune")
COORDINATES = ("longitude_l", "latitude_b", "radius_r")
LEAST_RAD = 5e-8
LATEST_MILLENNIA = 0.2  # 2200
UNIT = 1e-9  # of the amplitudes written


def rows_of(source, planet):
    """Returns {(power, rate): [(cosine, sine) of longitude, latitude, radius]}."""
    text = (source / f"{planet}.c").read_text()
    rows = {}
    tables = re.findall(r"_(longitude_l|latitude_b|radius_r)(\d)\[[^]]*\]\s*=\s*\{(.*?)\};", text, re.DOTALL)
    if len(tables) < 6:
        sys.exit(f"{source}/{planet}.c: {len(tables)} tables of VSOP87, where 6 at least were expected")
    for name, power, body in tables:
        for amplitude, phase, rate in re.findall(r"\{\s*([-\d.]+),\s*([-\d.]+),\s*([-\d.]+)\s*\}", body):
            row = rows.setdefault((int(power), float(rate)), [[0.0, 0.0] for _ in COORDINATES])
            term = row[COORDINATES.index(name)]
            term[0] += float(amplitude) * math.cos(float(phase))
            term[1] -= float(amplitude) * math.sin(float(phase))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=pathlib.Path, help="libnova's folder src")
    source = parser.parse_args().source
    print("// Made by tools/make_planet_series.py from VSOP87 (Bretagnon & Francou, A&A 202, 309, 1988).")
    print("// power of t, rate [rad per Julian millennium], cosine and sine of longitude, latitude [1e-9 rad], radius [1e-9 au]")
    for planet in PLANETS:
        rows = rows_of(source, planet)
        mean_radius_au = rows[(0, 0.0)][2][0]

        def seen_rad(key):
            longitude, latitude, radius = (math.hypot(*term) for term in rows[key])
            return math.hypot(longitude, latitude, radius / mean_radius_au) * LATEST_MILLENNIA ** key[0]

        print(f"constexpr Term k{planet.capitalize()}[] = {{")
        for key in sorted(key for key in rows if seen_rad(key) > LEAST_RAD):
            amplitudes = ", ".join(str(round(value / UNIT)) for term in rows[key] for value in term)
            print(f"    {{{key[0]}, {key[1]:.9f}, {amplitudes}}},")
        print("};")


main()
