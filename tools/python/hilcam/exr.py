"""OpenEXR pictures as hilcam writes them, into numpy: scan lines, ZIP or no compression, 32 bits a value.

By the format's description (openexr.com, "OpenEXR File Layout"). Other files are refused; OpenImageIO reads all.
"""
import pathlib
import struct
import zlib
from typing import Dict, Union

import numpy

_UINT, _FLOAT = 0, 2
_NONE, _ZIPS, _ZIP = 0, 2, 3
_LINES = {_NONE: 1, _ZIPS: 1, _ZIP: 16}
_LONG_NAMES = 0x400  # names of more than 31 characters, as layers of parts of the light have


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _header(data):
    magic, version = struct.unpack_from("<II", data)
    if magic != 20000630 or version & 0xFFFFFF00 & ~_LONG_NAMES:
        raise ValueError("no OpenEXR picture of one part in scan lines")
    attributes, at = {}, 8
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size, = struct.unpack_from("<I", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def _channels(value):
    at, out = 0, []
    while value[at]:
        name, at = _text(value, at)
        kind, _, step_x, step_y = struct.unpack_from("<IIII", value, at)
        if kind not in (_UINT, _FLOAT) or (step_x, step_y) != (1, 1):
            raise ValueError(f"channel {name} is not of 32 bits at every pixel")
        out.append((name, "<u4" if kind == _UINT else "<f4"))
        at += 16
    return out


def _unpacked(block, compression, size):
    if compression == _NONE or len(block) == size:  # what does not get smaller is kept as it is
        return block
    mixed = numpy.frombuffer(zlib.decompress(block), numpy.uint8)
    # Differences that were taken modulo 256 about 128, then the even bytes before the odd ones.
    steps = mixed.astype(numpy.int64)
    steps[1:] -= 128
    whole = (numpy.cumsum(steps) & 255).astype(numpy.uint8)
    out, half = numpy.empty(size, numpy.uint8), (size + 1) // 2
    out[0::2], out[1::2] = whole[:half], whole[half:]
    return out.tobytes()


def read_exr(file: Union[str, pathlib.Path]) -> Dict[str, numpy.ndarray]:
    """Each channel, height x width, by its name: "object.ID", "depth.Z", "flow.X", ... ValueError for another kind of file."""
    data = pathlib.Path(file).read_bytes()
    attributes, at = _header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = attributes["compression"][0]
    if compression not in _LINES:
        raise ValueError(f"{file}: compression {compression}; accepted: none, ZIPS, ZIP")
    channels = _channels(attributes["channels"])
    out = {name: numpy.empty((height, width), kind) for name, kind in channels}
    lines = _LINES[compression]
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at):
        y, size = struct.unpack_from("<iI", data, offset)
        rows = min(lines, y1 - y + 1)
        block = _unpacked(data[offset + 8:offset + 8 + size], compression, 4 * width * len(channels) * rows)
        values = numpy.frombuffer(block, "<u4").reshape(rows, len(channels), width)
        for c, (name, kind) in enumerate(channels):
            out[name][y - y0:y - y0 + rows] = numpy.ascontiguousarray(values[:, c]).view(kind)
    return out
