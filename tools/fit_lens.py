#!/usr/bin/python3
"""Fits camera.distortion_x_mm and distortion_y_mm to a table of places, as an instrument kernel's own law or a lens design program has them:

    tools/fit_lens.py TABLE [--order 5] [--pitch-um 10]

TABLE has a line for each place, numbers apart by blanks or commas: x and y where the place is by a pinhole, and x and y where the lens has it, in mm from the principal
point, right and down. Lines that begin with # are left out. Places should reach beyond the picture's corners and be some hundreds, on a grid, say. What is printed goes
into a camera's file; what the fit leaves is said on standard error.

Needs python3-numpy.
"""
import argparse
import sys

import numpy

MAX_ORDER = 5


def table(lines):
    """Rows of four numbers; a ValueError names a line that is none."""
    rows = []
    for number, line in enumerate(lines, 1):
        text = line.replace(",", " ").split()
        if not text or text[0].startswith("#"):
            continue
        try:
            rows.append([float(word) for word in text])
        except ValueError:
            raise ValueError(f"line {number}: found {line.strip()!r}; accepted: four numbers") from None
        if len(rows[-1]) != 4 or not numpy.isfinite(rows[-1]).all():
            raise ValueError(f"line {number}: found {line.strip()!r}; accepted: four numbers")
    return numpy.array(rows).reshape(-1, 4)


def monomials(places, order):
    """1, x, y, x^2, x y, y^2, x^3 ... of each place."""
    x, y = places.T
    return numpy.stack([x ** (n - j) * y**j for n in range(order + 1) for j in range(n + 1)], axis=1)


def fit(rows, order):
    """Terms of x and of y in mm, and what they leave of each place [mm]."""
    ideal, shift = rows[:, :2], rows[:, 2:] - rows[:, :2]
    reach = numpy.abs(ideal).max()  # places of up to 1 keep the equations' numbers alike
    scaled = monomials(ideal / reach, order)
    if len(rows) < scaled.shape[1]:
        raise ValueError(f"found {len(rows)} places; accepted: at least {scaled.shape[1]} for order {order}")
    terms, _, rank, _ = numpy.linalg.lstsq(scaled, shift, rcond=None)
    if rank < scaled.shape[1]:
        raise ValueError(f"these places do not tell the terms of order {order} apart; accepted: places all over the picture, or a lower --order")
    powers = numpy.array([n for n in range(order + 1) for _ in range(n + 1)])
    return terms / reach ** powers[:, None], shift - scaled @ terms


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", metavar="TABLE")
    parser.add_argument("--order", type=int, choices=range(MAX_ORDER + 1), default=MAX_ORDER)
    parser.add_argument("--pitch-um", type=float, help="says what is left in pixels, too")
    options = parser.parse_args()
    try:
        with open(options.table, encoding="utf-8") as file:
            terms, left = fit(table(file), options.order)
    except (OSError, ValueError) as error:
        sys.exit(f"{options.table}: {error}")
    for name, axis in (("x", 0), ("y", 1)):
        print(f"distortion_{name}_mm: [{', '.join(f'{term:.12g}' for term in terms[:, axis])}]")
    off_um = 1e3 * numpy.hypot(left[:, 0], left[:, 1])
    pixels = f" ({off_um.max() / options.pitch_um:.3g} px)" if options.pitch_um else ""
    print(f"{len(left)} places: the fit leaves {numpy.sqrt((off_um**2).mean()):.3g} um rms, {off_um.max():.3g} um{pixels} at most", file=sys.stderr)


if __name__ == "__main__":
    main()
