#!/usr/bin/python3
"""Makes configs/maps/moon_color.png and moon_height.png, the Moon's colour and relief, from NASA's CGI Moon Kit.

    tools/make_moon_map.py lroc_color_poles_2k.tif ldem_4.tif configs/maps

The kit (NASA's Scientific Visualization Studio, https://svs.gsfc.nasa.gov/4720) has a colour map of the "Hapke Normalized WAC Mosaic" by LROC's
Wide Angle Camera (at the poles LOLA's albedo) and LOLA's heights over 1737.4 km, equirectangular from 180 W and 90 N on. Its page says how
the colours were coded: red is the band at 643 nm, green and blue are combinations of 566 and 415 nm for 532 and 472 nm; "a gamma of 2.8 was applied
(the LROC data is linear), and the channels were multiplied by (0.935, 1.005, 1.04)"; then 0.16 to 0.4 became 0 to 255. The mosaic is the radiance
factor I/F at 60 deg of incidence and phase, seen from above (LROC's page of WAC_HAPKE_NORMALIZED). So each code is an I/F. Read in
this order of steps the colours of the median ground, 532 and 472 nm over 643, are 0.80 and 0.69, as LROC's bands have them; with the factors before the
gamma they would be 0.91 and 0.84. Written are

    moon_color.png   reflectance coded as sRGB, which is what hilcam reads. Red, linear: 0.5 is the I/F that hilcam's law of the Moon has at 60 deg.
                     Green and blue are scaled so that the median ground between 30 S and 30 N has the value that it has in red: colour is the law's.
    moon_height.png  16-bit grey, metres over 1737.4 km and 10 000 more
"""
import pathlib
import sys

import numpy
from PIL import Image

# I/F of the law of render/sky/body_photometry.h at 643 nm, 60 deg of incidence and phase, seen from above (tests: PlanetshineSource.
# TheMoonsReflectanceFactorIsThatOfItsParameters).
LAW_AT_60_DEG = 0.04582
FACTORS, GAMMA, FROM, TO = (0.935, 1.005, 1.04), 2.8, 0.16, 0.4


def radiance_factor(codes):
    """Returns I/F at 60 deg of incidence and phase for the kit's codes, each channel by itself."""
    return ((FROM + (TO - FROM) * codes / 255.0) / numpy.array(FACTORS)) ** GAMMA


def color_map(codes):
    """Returns what hilcam reads, 8-bit sRGB, for the kit's codes."""
    found = radiance_factor(codes)
    latitude_deg = 90 - (numpy.arange(codes.shape[0]) + 0.5) / codes.shape[0] * 180
    median = numpy.median(found[abs(latitude_deg) < 30].reshape(-1, 3), axis=0)
    linear = numpy.clip(0.5 / LAW_AT_60_DEG * found * median[0] / median, 0, 1)
    srgb = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return numpy.rint(255 * srgb).astype(numpy.uint8)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    color, height, folder = (pathlib.Path(argument) for argument in sys.argv[1:])
    Image.fromarray(color_map(numpy.asarray(Image.open(color))), "RGB").save(folder / "moon_color.png", optimize=True)
    heights_m = 1000 * numpy.asarray(Image.open(height)).astype(float)
    Image.fromarray(numpy.rint(heights_m + 10_000).astype(numpy.uint16)).save(folder / "moon_height.png", optimize=True)


if __name__ == "__main__":
    main()
