"""Attitudes in the forms that others use (docs/conventions.md has one attitude in all of them).

hilcam's own attitude is a unit quaternion, scalar first, that turns body axes into the frame's: v_frame = R(q) v_body.
"""
from typing import Sequence, Tuple

import numpy


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
