#!/usr/bin/python3
"""Makes configs/maps/earth_albedo.png, the Earth's mean albedo with its clouds, from a grid of values.

    tools/make_earth_map.py Earth_ALB_2018_CERES_All_1x1.csv configs/maps/earth_albedo.png

The grid: 180 rows from the south pole up, 360 columns from 180 W on, broadband shortwave albedo at the top of the atmosphere, all sky,
mean of 2018: NASA CERES (Energy Balanced and Filled; Loeb et al., J. Climate 31, 895, 2018), as the Basilisk project distributes it.
The picture has north at the top and codes reflectance as sRGB, which is what hilcam reads.
"""
import sys

import numpy
from PIL import Image

grid = numpy.loadtxt(sys.argv[1], delimiter=",")
if grid.shape != (180, 360) or not ((grid >= 0) & (grid <= 1)).all():
    sys.exit(f"{sys.argv[1]}: accepted: 180 rows of 360 albedos from 0 to 1")
linear = numpy.flipud(grid)
srgb = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
Image.fromarray(numpy.rint(255 * srgb).astype(numpy.uint8), "L").convert("RGB").save(sys.argv[2], optimize=True)
