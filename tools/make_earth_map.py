#!/usr/bin/python3
"""Makes maps of the Earth for hilcam (docs/earth.md says what each channel holds and where its scale comes from).

    tools/make_earth_map.py FOLDER configs/maps/earth.map [--width 4096]        land, water, clouds and lights, packed
    tools/make_earth_map.py Earth_ALB_2018_CERES_All_1x1.csv configs/maps/earth_albedo.png      the mean albedo of a year

FOLDER holds equirectangular pictures, left edge 180 W, top 90 N, twice as wide as high: `blue_marble_albedo`, `_water`, `_cloud` and
`_glow`, each .jpg, .png or .tif (a GeoTIFF through GDAL's Python module where that is installed: other projections and extents are refused).
Each of them can be given alone by --albedo, --water, --clouds, --lights.

The CSV: 180 rows from the south pole up, 360 columns from 180 W on, broadband shortwave albedo at the top of the atmosphere, all sky,
mean of 2018: NASA CERES (Energy Balanced and Filled; Loeb et al., J. Climate 31, 895, 2018), as the Basilisk project distributes it.
Its picture has north at the top and codes reflectance as sRGB, which is what hilcam reads.
"""
import argparse
import pathlib
import struct
import sys
import zlib

import numpy
from PIL import Image

TILE = 256
# Reflectances in the bands blue, green, red and near infrared (0.40-0.49, 0.49-0.58, 0.58-0.70, 0.72-0.95 um) and the linear
# values that the picture has there. Forest: the canopy of configs/materials/vegetation.yaml (PROSAIL) for the Amazon and the Congo. Sand: about
# what sensors in orbit see of the calibration site Libya-4 (28.55 N, 23.39 E), to a tenth; the site's place was looked up, a table of its reflectances was
# not found, so these are from memory. Snow: configs/materials/snow.yaml (Grenfell, Warren &
# Mullen 1994) for Dome C and Greenland. The picture is stretched for the eye: between these it is taken as a power law.
FOREST_RGB, FOREST = (0.0096, 0.0207, 0.0032), (0.020, 0.045, 0.029)
SAND_RGB, SAND, SAND_NIR = (0.616, 0.449, 0.248), (0.25, 0.35, 0.46), 0.58
SNOW_RGB, SNOW, SNOW_NIR = (0.89, 0.92, 0.93), (0.975, 0.98, 0.975), 0.93
FOREST_NIR = 0.40
# The cloud picture has no unit: white is taken as a cloud that nothing passes, and grey as this power of it, which is set so that the Earth's
# Bond albedo from 0.4 to 0.7 um comes out as 0.30 (0.297 by earthshine: Goode et al., Geophys. Res. Lett. 28, 1671, 2001).
CLOUD_POWER = 1.4


def stop(message):
    sys.exit(f"make_earth_map: {message}")


def linear_of_srgb(code):
    v = numpy.arange(256) / 255
    return numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4).astype(numpy.float32)[code]


def read_picture(path, mode):
    """A picture as 8-bit values; GeoTIFFs through GDAL, which knows their projection."""
    if path.suffix.lower() in (".tif", ".tiff"):
        try:
            from osgeo import gdal, osr
        except ImportError:
            print(f"{path}: GDAL's Python module is not installed, so its projection is not looked at", file=sys.stderr)
        else:
            source = gdal.Open(str(path))
            if source is None:
                stop(f"{path}: GDAL cannot read it")
            if source.GetProjection() and not osr.SpatialReference(wkt=source.GetProjection()).IsGeographic():
                stop(f"{path}: its projection is not read; accepted: longitude and latitude (gdalwarp -t_srs EPSG:4326 makes them)")
            x0, dx, _, y0, _, dy = source.GetGeoTransform()
            if source.GetProjection() and (abs(x0 + 180) > 0.1 or abs(y0 - 90) > 0.1 or abs(dx * source.RasterXSize - 360) > 0.2 or
                                           abs(dy * source.RasterYSize + 180) > 0.2):
                stop(f"{path}: it does not cover the Earth from 180 W, 90 N; accepted: the whole (gdalwarp -te -180 -90 180 90)")
    Image.MAX_IMAGE_PIXELS = None
    picture = Image.open(path)
    if picture.width != 2 * picture.height:
        stop(f"{path}: {picture.width} x {picture.height} pixels; accepted: twice as wide as high, 180 W to 180 E and 90 N to 90 S")
    return numpy.asarray(picture.convert(mode))


def fitted(values, width):
    """Averages a picture down to a width; whole factors alone keep every pixel's light."""
    factor, rest = divmod(values.shape[1], width)
    if factor < 1 or rest:
        stop(f"--width {width}: accepted: what divides the pictures' width, {values.shape[1]}")
    shape = (width // 2, factor, width, factor) + values.shape[2:]
    return values.reshape(shape).mean(axis=(1, 3), dtype=numpy.float32)


def reflectances(rgb):
    """Four bands from linear colours, by power laws between forest, sand and snow."""
    bands = []
    for c in range(3):
        x = numpy.log(numpy.array([FOREST_RGB[c] / 8, FOREST_RGB[c], SAND_RGB[c], SNOW_RGB[c], 1.0]))
        y = numpy.log(numpy.array([FOREST[2 - c] / 4, FOREST[2 - c], SAND[2 - c], SNOW[2 - c], 0.985]))
        bands.append(numpy.exp(numpy.interp(numpy.log(numpy.maximum(rgb[..., c], 1e-4)), x, y)))
    red, green, blue = bands
    # Green against red tells canopy from soil, blue against red tells snow.
    soil_ratio, canopy_ratio = SAND[1] / SAND[2], FOREST[1] / FOREST[2]
    canopy = numpy.clip((green / red - soil_ratio) / (canopy_ratio - soil_ratio), 0, 1)
    snow = numpy.clip((blue / red - 0.6) / 0.3, 0, 1) * numpy.clip((red - 0.3) / 0.3, 0, 1)
    soil_nir = numpy.minimum(red * SAND_NIR / SAND[2], 0.9)
    nir = canopy * (FOREST_NIR * numpy.clip(green / FOREST[1], 0.3, 1.2)) + (1 - canopy) * soil_nir
    nir = snow * red * SNOW_NIR / SNOW[2] + (1 - snow) * nir
    return numpy.stack([blue, green, red, nir], axis=-1), snow


def channels(pictures, width):
    """Eight values from 0 to 1 a texel, in the light's own scale: four bands, water, cloud, cloud top, lights."""
    land, snow = reflectances(fitted(linear_of_srgb(pictures["albedo"]), width))
    water = fitted(pictures["water"], width) / 255
    # Shallow water is grey in the picture, and the colour there is the sea's: only what is darker is land.
    water = numpy.clip((water - 0.25) / 0.25, 0, 1)
    cloud = fitted(((numpy.arange(256) / 255) ** CLOUD_POWER).astype(numpy.float32)[pictures["clouds"]], width)
    # The cloud picture cannot tell ice from cloud: where the ground is snow, it is left out.
    cloud *= 1 - snow * (1 - water)
    # Thick clouds reach higher: 2 to 10 km. The picture knows no heights, so this is an assumption.
    top = numpy.where(cloud > 0.02, (2 + 8 * cloud) / 16, 2 / 16)
    lights = fitted(linear_of_srgb(pictures["lights"]), width) * (1 - water)
    # Bare sea has no colour of its own, which packs better.
    land *= (water < 0.999)[..., None]
    return numpy.concatenate([land, water[..., None], cloud[..., None], top[..., None], lights[..., None]], axis=-1)


ROOTS = (0, 1, 2, 3, 7)  # channels that are kept as square roots, so that dark ones keep their digits
STEPS = (2, 2, 2, 2, 1, 5, 16, 2)  # codes are rounded to these, far below what the pictures are good for, to pack better


def codes_of(values):
    out = values.copy()
    out[..., ROOTS] = numpy.sqrt(out[..., ROOTS])
    steps = numpy.array(STEPS)
    return numpy.minimum(numpy.rint(255 * numpy.clip(out, 0, 1) / steps) * steps, 255).astype(numpy.uint8)


def predicted(tile):
    """What each value is expected to be from its neighbours to the left and above: the middle one of left, above and left + above - corner."""
    out = numpy.zeros_like(tile)
    left, above, corner = tile[:, 1:, :-1], tile[:, :-1, 1:], tile[:, :-1, :-1]
    out[:, 1:, 1:] = numpy.maximum(numpy.minimum(left, above), numpy.minimum(numpy.maximum(left, above), left + above - corner))
    out[:, 0, 1:] = tile[:, 0, :-1]
    out[:, 1:, 0] = tile[:, :-1, 0]
    return out


def packed(values):
    codes = codes_of(values)
    height, width = codes.shape[:2]
    if height & (height - 1) or height < TILE:
        stop(f"a map of {width} x {height}; accepted: heights that are powers of two, from {TILE} on")
    streams = []
    for y in range(0, height, TILE):
        for x in range(0, width, TILE):
            tile = codes[y:y + TILE, x:x + TILE].transpose(2, 0, 1).astype(numpy.int16)
            streams.append(zlib.compress(((tile - predicted(tile)) % 256).astype(numpy.uint8).tobytes(), 9))
    head = b"HILEARTH" + struct.pack("<5I", 1, width, height, TILE, codes.shape[2])
    return head + struct.pack(f"<{len(streams)}I", *map(len, streams)) + b"".join(streams)


def albedo_picture(source, out):
    grid = numpy.loadtxt(source, delimiter=",")
    if grid.shape != (180, 360) or not ((grid >= 0) & (grid <= 1)).all():
        stop(f"{source}: accepted: 180 rows of 360 albedos from 0 to 1")
    linear = numpy.flipud(grid)
    srgb = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    Image.fromarray(numpy.rint(255 * srgb).astype(numpy.uint8), "L").convert("RGB").save(out, optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--width", type=int, default=4096)
    names = {"albedo": "albedo", "water": "water", "clouds": "cloud", "lights": "glow"}
    for key in names:
        parser.add_argument(f"--{key}", type=pathlib.Path)
    options = parser.parse_args()
    if options.source.suffix == ".csv":
        return albedo_picture(options.source, options.out)
    pictures = {}
    for key, word in names.items():
        given = getattr(options, key)
        found = [given] if given else sorted(p for p in options.source.glob(f"blue_marble_{word}.*"))
        if not found:
            stop(f"{options.source}: no blue_marble_{word}.jpg, .png or .tif, and no --{key}")
        pictures[key] = read_picture(found[0], "RGB" if key == "albedo" else "L")
    options.out.write_bytes(packed(channels(pictures, options.width)))


main()
