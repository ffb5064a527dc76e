#!/usr/bin/python3
"""The shipped colour map of the Moon against the kit that it is made from, and the kit's codes against what LROC says of the Moon's colour.

    moon_map_test.py SOURCE_DIR

Needs shared/data/moon beside the source folder, or where HILCAM_SHARED_DATA says; skipped without.
"""
import os
import pathlib
import sys

import numpy
from PIL import Image

SOURCE = pathlib.Path(sys.argv[1])
DATA = pathlib.Path(os.environ.get("HILCAM_SHARED_DATA", SOURCE.parent / "shared/data"))
SKIPPED = 77
sys.path.insert(0, str(SOURCE / "tools"))
import make_moon_map  # noqa: E402


def main():
    kit = DATA / "moon/lroc_color_poles_2k.tif"
    if not kit.exists():
        print(f"skipped: no {kit}")
        return SKIPPED
    codes = numpy.asarray(Image.open(kit))
    shipped = numpy.asarray(Image.open(SOURCE / "configs/maps/moon_color.png"))
    assert (shipped == make_moon_map.color_map(codes)).all(), "moon_color.png is not what tools/make_moon_map.py makes of the kit"
    # Codes at the ends of the range, by hand from the kit's page: (0.16 / 0.935)^2.8 and (0.4 / 0.935)^2.8.
    ends = make_moon_map.radiance_factor(numpy.array([[[0, 0, 0], [255, 255, 255]]]))[0, :, 0]
    assert abs(ends - (0.007133, 0.092789)).max() < 1e-5, ends
    # The map's red, decoded as hilcam does, is I/F over twice the law's: 0.5 stands for it.
    red = shipped[..., 0] / 255
    linear = numpy.where(red <= 0.04045, red / 12.92, ((red + 0.055) / 1.055) ** 2.4)
    found = make_moon_map.radiance_factor(codes)
    off = abs(linear * 2 * make_moon_map.LAW_AT_60_DEG - found[..., 0])[linear < 1]
    assert off.max() < 4e-4, off.max()  # half a code of 255 at the bright end
    # LROC's bands (medians of the mosaic's ratios to 566 nm: 415 nm 0.691, 643 nm 1.147), straight between them at 472 and 532 nm: 0.704 and 0.811 of red.
    # A wrong order of the kit's steps has 0.84 and 0.91.
    median = numpy.median(found[abs(90 - (numpy.arange(1024) + 0.5) * 180 / 1024) < 70].reshape(-1, 3), axis=0)
    print(f"colour of the median ground over red: {median[1] / median[0]:.3f}, {median[2] / median[0]:.3f}; I/F at 60 deg {median[0]:.4f}")
    assert abs(median[1] / median[0] - 0.811) < 0.02 and abs(median[2] / median[0] - 0.704) < 0.02
    return 0


sys.exit(main())
