"""Masks of COCO's compressed run lengths."""
from typing import List

import numpy


def mask_of_run_lengths(text: str, height: int, width: int) -> numpy.ndarray:
    """Booleans, height x width. ValueError for another size."""
    counts: List[int] = []
    value = shift = 0
    for letter in text:
        bits = ord(letter) - 48
        value |= (bits & 31) << shift
        shift += 5
        if bits & 32:
            continue
        if bits & 16:
            value -= 1 << shift
        # From the third on counts are differences to the one before the last.
        counts.append(value + (counts[-2] if len(counts) > 2 else 0))
        value = shift = 0
    if sum(counts) != height * width:
        raise ValueError(f"run lengths of {sum(counts)} pixels; accepted: {height} x {width}")
    return numpy.repeat(numpy.arange(len(counts)) % 2 == 1, counts).reshape(width, height).T
