"""What a register's number means, as a formula that hilcam knows: found by looking at samples of the vendor's own."""
import math

from .evaluator import NoValue
from .formula import FormulaError

EXACT = 1e-9


def samples_of(low, high, is_float):
    if is_float:
        return [0.001, 0.01, 0.1, 0.5, 1.0, 2.0, 3.0, 10.0, 100.0, 1000.0, 12345.5, 1e6]
    values = {low, high, 0, 1}
    at = 1
    while at < high:
        values |= {at, at + 1, 3 * at // 2, -at}
        at *= 2
    return sorted(v for v in values if low <= v <= high)


def curve(put, get, raws):
    """Returns (raw, value) for each raw number that has a value."""
    found = []
    for raw in raws:
        try:
            put(raw)
            value = get()
        except (NoValue, FormulaError, OverflowError, ValueError):
            continue
        if isinstance(value, (int, float)) and math.isfinite(value):
            found.append((raw, value))
    return found


def _solve(rows, x_of):
    """Returns value = a x + b through the rows, if they all lie on it; the ends decide."""
    rows = [(x_of(raw), value) for raw, value in rows]
    (x0, y0), (x1, y1) = rows[0], rows[-1]
    if x0 == x1:
        return None
    a = (y1 - y0) / (x1 - x0)
    b = y0 - a * x0
    span = max(abs(y) for _, y in rows)
    if abs(b) < EXACT * min(span, 1):
        b = 0.0
    if abs(a) < 1e-15:
        return None
    if all(abs(a * x + b - y) <= EXACT * max(abs(y), 1e-3 * span, 1e-12) for x, y in rows):
        return a, b
    return None


def fit(rows, put, get, with_points=True):
    """Returns a formula for the table: linear, reciprocal, logarithm, or points; None where the value does not change."""
    if len(rows) < 2 or all(value == rows[0][1] for _, value in rows):
        return None
    found = _solve(rows, float)
    if found:
        return {"kind": "linear", "scale": tidy(found[0]), "offset": tidy(found[1])}
    positive = [row for row in rows if row[0] > 0]
    if len(positive) > 3:
        for kind, x_of in (("reciprocal", lambda raw: 1 / raw), ("logarithm", math.log)):
            found = _solve(positive, x_of)
            if found:
                return {"kind": kind, "scale": tidy(found[0]), "offset": tidy(found[1])}
    if not with_points:
        return None
    more = rows
    if isinstance(rows[0][0], int) and rows[-1][0] - rows[0][0] <= 1024:
        more = curve(put, get, range(rows[0][0], rows[-1][0] + 1))
    rising = monotone(more)
    return {"kind": "points", "points": [[tidy(raw), tidy(value)] for raw, value in rising]} if len(rising) > 1 else None


def monotone(rows):
    """Leaves out what goes back, so that each value has one number."""
    up = rows[-1][1] > rows[0][1]
    kept = [rows[0]]
    for raw, value in rows[1:]:
        if (value > kept[-1][1]) == up and value != kept[-1][1]:
            kept.append((raw, value))
    return kept


def tidy(value):
    rounded = float(f"{value:.12g}")
    if abs(rounded) < 1e-15:
        rounded = 0.0
    return int(rounded) if rounded == int(rounded) and abs(rounded) < 2 ** 53 else rounded


def inverse(formula, value):
    """Returns the number whose value that is, or None."""
    if formula["kind"] == "points":
        points = formula["points"]
        for (x0, y0), (x1, y1) in zip(points, points[1:]):
            if min(y0, y1) <= value <= max(y0, y1):
                return x0 + (value - y0) / (y1 - y0) * (x1 - x0)
        return points[0][0] if abs(value - points[0][1]) < abs(value - points[-1][1]) else points[-1][0]
    y = (value - formula["offset"]) / formula["scale"]
    if formula["kind"] == "linear":
        return y
    if formula["kind"] == "reciprocal":
        return None if y == 0 else 1 / y
    return math.exp(y) if y < 700 else None
