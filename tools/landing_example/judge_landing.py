#!/usr/bin/python3
"""Judges a landing by the ground's truth, which the flight software never saw.

    judge_landing.py LANDING.yaml LANDING.csv [--hilcam HILCAM]

prints one line of JSON: how far the touchdown is from the place that was chosen last, what the ground has there, and how near the
nearest stones are. `hilcam ground` lists the ground.
"""
import argparse
import csv
import io
import json
import math
import subprocess

LANDER_RADIUS_M = 1.5
LEAST_STONE_M = 0.3  # height that a lander's legs may not meet
FOCAL_PX = 3.4e-3 / 5.5e-6
MIDDLE_PX = 255.5


def ground(arguments, listing, *more):
    out = subprocess.run([arguments.hilcam, "ground", arguments.scenario, "--list", listing, *map(str, more)], check=True, capture_output=True,
                         text=True).stdout
    return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(io.StringIO(out))]


class Heights:
    """The ground's heights up from the site, on a square about it."""

    def __init__(self, arguments, within_m, spacing_m, at):
        rows = ground(arguments, "hazards", "--within-m", within_m, "--spacing-m", spacing_m, "--at", *at)
        self.rows = rows

    def nearest(self, east_m, north_m):
        return min(self.rows, key=lambda row: (row["east_m"] - east_m) ** 2 + (row["north_m"] - north_m) ** 2)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scenario")
    parser.add_argument("log")
    parser.add_argument("--hilcam", default="hilcam")
    parser.add_argument("--site-deg", nargs=2, type=float, default=(23.47, 0.67), help="longitude and latitude of the site")
    parser.add_argument("--site-height-m", type=float, default=-1959.3)
    arguments = parser.parse_args()
    with open(arguments.log, newline="") as lines:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]
    last = rows[-1]
    chosen = [row for row in rows if row["chosen"] == 1][-1]
    heights = Heights(arguments, 60, 0.5, arguments.site_deg)
    # Where the ray of the last choice meets the ground: its height there, by steps.
    up_m = 0.0
    for _ in range(20):
        way_m = (chosen["up_m"] - up_m) / FOCAL_PX
        east_m = chosen["east_m"] + way_m * (chosen["target_x_px"] - MIDDLE_PX)
        north_m = chosen["north_m"] - way_m * (chosen["target_y_px"] - MIDDLE_PX)
        up_m = heights.nearest(east_m, north_m)["height_m"] - arguments.site_height_m
    under = [row for row in heights.rows if math.hypot(row["east_m"] - last["east_m"], row["north_m"] - last["north_m"]) <= LANDER_RADIUS_M]
    stones = ground(arguments, "boulders", "--within-m", 60, "--smallest-m", 0.2)
    margin_m = min(math.hypot(s["east_m"] - last["east_m"], s["north_m"] - last["north_m"]) - s["diameter_m"] / 2
                   for s in stones if s["height_m"] > LEAST_STONE_M)
    # The slope over the lander's own width, by least squares.
    mean = [sum(row[key] for row in under) / len(under) for key in ("east_m", "north_m", "height_m")]
    ee, en, nn, eh, nh = (sum((row[a] - mean[i]) * (row[b] - mean[j]) for row in under) for a, i, b, j in (
        ("east_m", 0, "east_m", 0), ("east_m", 0, "north_m", 1), ("north_m", 1, "north_m", 1), ("east_m", 0, "height_m", 2),
        ("north_m", 1, "height_m", 2)))
    by_east, by_north = (nn * eh - en * nh) / (ee * nn - en * en), (ee * nh - en * eh) / (ee * nn - en * en)
    rough_m = max(abs(row["height_m"] - mean[2] - by_east * (row["east_m"] - mean[0]) - by_north * (row["north_m"] - mean[1])) for row in under)
    print(json.dumps({
        "landing_error_m": math.hypot(last["east_m"] - east_m, last["north_m"] - north_m),
        "slope_deg": math.degrees(math.atan(math.hypot(by_east, by_north))),
        "roughness_m": rough_m,
        "nearest_stone_m": margin_m,
        "ground_up_m": mean[2] - arguments.site_height_m,
        "frames": len(rows),
    }))


if __name__ == "__main__":
    main()
