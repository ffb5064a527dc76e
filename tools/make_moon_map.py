#!/usr/bin/python3
"""Makes configs/maps/moon_color.png and moon_height.png, the Moon's colour and relief, from NASA's CGI Moon Kit.

    tools/make_moon_map.py lroc_color_poles_2k.tif ldem_4.tif configs/maps

The kit (NASA's Scientific Visualization Studio, https://svs.gsfc.nasa.gov/4720) has a colour map by LROC's Wide Angle Camera (643, 566 and
415 nm; at the poles LOLA's albedo) and LOLA's heights over 1737.4 km, equirectangular from 180 W and 90 N on. The colour map's codes are
proportional to reflectance: they spread about their median as the single-scattering albedos of Sato et al. (J. Geophys. Res. Planets 119,
1775, 2014) do. Written are

    moon_color.png   reflectance coded as sRGB, which is what hilcam reads; linear 0.5 is each channel's median from 30 S to 30 N
    moon_height.png  16-bit grey, metres over 1737.4 km and 10 000 more
"""
import pathlib
import sys

import numpy
from PIL import Image

if len(sys.argv) != 4:
    sys.exit(__doc__)
color, height, folder = (pathlib.Path(argument) for argument in sys.argv[1:])
codes = numpy.asarray(Image.open(color)).astype(float)
latitude_deg = 90 - (numpy.arange(codes.shape[0]) + 0.5) / codes.shape[0] * 180
linear = numpy.clip(0.5 * codes / numpy.median(codes[abs(latitude_deg) < 30].reshape(-1, 3), axis=0), 0, 1)
srgb = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
Image.fromarray(numpy.rint(255 * srgb).astype(numpy.uint8), "RGB").save(folder / "moon_color.png", optimize=True)
heights_m = 1000 * numpy.asarray(Image.open(height)).astype(float)
Image.fromarray(numpy.rint(heights_m + 10_000).astype(numpy.uint16)).save(folder / "moon_height.png", optimize=True)
