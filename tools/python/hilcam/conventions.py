"""Attitudes and times in the forms that others use (docs/conventions.md has one attitude in all of them).

hilcam's own attitude is a unit quaternion, scalar first, that turns body axes into the frame's: v_frame = R(q) v_body.
"""
import datetime
from typing import Sequence, Tuple

import numpy

# TAI - UTC in whole seconds from these days on (IERS Bulletin C; none was announced after 2017 by 2026).
LEAP_SECONDS: Tuple[Tuple[str, int], ...] = (
    ("1972-01-01", 10), ("1972-07-01", 11), ("1973-01-01", 12), ("1974-01-01", 13), ("1975-01-01", 14), ("1976-01-01", 15),
    ("1977-01-01", 16), ("1978-01-01", 17), ("1979-01-01", 18), ("1980-01-01", 19), ("1981-07-01", 20), ("1982-07-01", 21),
    ("1983-07-01", 22), ("1985-07-01", 23), ("1988-01-01", 24), ("1990-01-01", 25), ("1991-01-01", 26), ("1992-07-01", 27),
    ("1993-07-01", 28), ("1994-07-01", 29), ("1996-01-01", 30), ("1997-07-01", 31), ("1999-01-01", 32), ("2006-01-01", 33),
    ("2009-01-01", 34), ("2012-07-01", 35), ("2015-07-01", 36), ("2017-01-01", 37))
_UTC = datetime.timezone.utc
_EPOCH = datetime.datetime(1970, 1, 1, tzinfo=_UTC)
_STEPS = [(datetime.datetime.fromisoformat(day).replace(tzinfo=_UTC), step) for day, step in LEAP_SECONDS]


def _nanoseconds(span: datetime.timedelta) -> int:
    return (span.days * 86400 + span.seconds) * 10**9 + span.microseconds * 1000


def tai_ns_of_utc(utc: str) -> int:
    """Nanoseconds since 1970-01-01T00:00:00 TAI of a time as scenarios have it, 2026-03-20T12:00:00Z, from 1972 on."""
    when = datetime.datetime.fromisoformat(utc.replace("Z", "+00:00"))
    if when.tzinfo is None:
        when = when.replace(tzinfo=_UTC)
    steps = [step for day, step in _STEPS if day <= when]
    if not steps:
        raise ValueError(f"{utc}: accepted: 1972-01-01 or later")
    return _nanoseconds(when - _EPOCH) + steps[-1] * 10**9


def utc_of_tai_ns(tai_ns: int) -> datetime.datetime:
    """The same back, to the microsecond. A leap second itself is the first second after it."""
    for day, step in reversed(_STEPS):
        if tai_ns >= _nanoseconds(day - _EPOCH) + step * 10**9:
            return _EPOCH + datetime.timedelta(microseconds=(tai_ns - step * 10**9) // 1000)
    raise ValueError(f"{tai_ns}: accepted: 1972-01-01 or later")


def dcm_of(attitude_wxyz: Sequence[float]) -> numpy.ndarray:
    """The matrix [BN] of an attitude, which takes a vector's components in the frame to those in the body."""
    w, x, y, z = numpy.asarray(attitude_wxyz, float) / numpy.linalg.norm(attitude_wxyz)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
                        [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
                        [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]])


def rotate(attitude_wxyz: Sequence[float], vectors: numpy.ndarray) -> numpy.ndarray:
    """Vectors in body axes, in the last dimension, in those of the frame."""
    return numpy.asarray(vectors, float) @ dcm_of(attitude_wxyz)


def attitude_from_dcm(body_from_frame: numpy.ndarray) -> Tuple[float, float, float, float]:
    """Of a matrix [BN]; scalar not negative (Shepperd, Journal of Guidance and Control 1, 1978: by the largest of four)."""
    m = numpy.asarray(body_from_frame, float)
    squares = [1 + m[0, 0] + m[1, 1] + m[2, 2], 1 + m[0, 0] - m[1, 1] - m[2, 2],
               1 - m[0, 0] + m[1, 1] - m[2, 2], 1 - m[0, 0] - m[1, 1] + m[2, 2]]
    k = int(numpy.argmax(squares))
    s = 2 * squares[k] ** 0.5
    a, b, c = (m[1, 2] - m[2, 1]) / s, (m[2, 0] - m[0, 2]) / s, (m[0, 1] - m[1, 0]) / s
    xy, xz, yz = (m[0, 1] + m[1, 0]) / s, (m[0, 2] + m[2, 0]) / s, (m[1, 2] + m[2, 1]) / s
    q = numpy.array([(s / 4, a, b, c), (a, s / 4, xy, xz), (b, xy, s / 4, yz), (c, xz, yz, s / 4)][k])
    q = q / numpy.linalg.norm(q) * (-1 if q[0] < 0 else 1)
    return tuple(float(v) for v in q)


def attitude_from_mrp(sigma: Sequence[float]) -> Tuple[float, float, float, float]:
    """Of modified Rodrigues parameters, Basilisk's sigma_BN: e tan(angle / 4) (Schaub & Junkins 2018, 3.7)."""
    s = numpy.asarray(sigma, float)
    square = float(s @ s)
    q = numpy.array([1 - square, *(2 * s)]) / (1 + square)
    return tuple(float(v) for v in (-q if q[0] < 0 else q))


def mrp_of(attitude_wxyz: Sequence[float]) -> numpy.ndarray:
    """The same back, the short way round."""
    q = numpy.asarray(attitude_wxyz, float) / numpy.linalg.norm(attitude_wxyz)
    q = -q if q[0] < 0 else q
    return q[1:] / (1 + q[0])
