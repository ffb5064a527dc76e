#!/usr/bin/python3
"""Makes maps of the Earth for hilcam (docs/earth.md says what each channel holds and where its scale comes from).

    tools/make_earth_map.py FOLDER configs/maps/earth.map [--width 4096] [--sea-ice NORTH SOUTH | --ice PICTURE]    land, water, ice, clouds and lights, packed
    tools/make_earth_map.py Earth_ALB_2018_CERES_All_1x1.csv configs/maps/earth_albedo.png      the mean albedo of a year

FOLDER holds equirectangular pictures, left edge 180 W, top 90 N, twice as wide as high: `blue_marble_albedo`, `_water`, `_cloud` and
`_glow`, each .jpg, .png or .tif (a GeoTIFF of 8 or 16 bits through GDAL's Python module, python3-gdal, where that is installed; it may begin
at any longitude; other projections and extents are refused).
Each of them can be given alone by --albedo, --water, --clouds, --lights.

The pictures have no sea ice. With --sea-ice it is put on the water about each pole, as far from it as makes the extents NORTH and SOUTH [million km^2]:
11.4 10.3 as the mean of August and February, 7.2 17.7 in August, 15.6 2.8 in February. Where ice really ends differs with the longitude.

With --ice it is where a picture of the same form is white: the share of the water that ice covers, as passive microwaves give it for each month.

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
CLOUD_POWER = 1.33
# Sea ice. Extents [million km^2] that --help names: August 7.20 and 17.72 (1981 to 2010: 6.01 are 16.53 % less, 18.66 are 5.30 % more; NOAA NCEI, Global
# Snow and Ice Report for August 2013); February 15.64 and, the least of the year, 2.78 (1979 to 2000: 14.58 are 1.06 less, 2.87 are 0.0885 more; NSIDC's news of March 2010).
# What is within the extent is ice by a share, assumed. Ice under snow has the spectrum of snow, whose albedo over the whole spectrum it has, too
# (first-year ice under more than 3 cm of snow, clear sky, spring: 0.81); the north's is taken as half a year bare (0.54), half a year under snow: Brandt, Warren,
# Worby & Grenfell, J. Climate 18, 3606, 2005, table 1.
SEA_ICE_SHARE, NORTH_ICE_OVER_SNOW = 0.8, 0.5 * (0.54 / 0.81 + 1)
EARTH_RADIUS_KM = 6371.0


def stop(message):
    sys.exit(f"make_earth_map: {message}")


def linear_of_srgb(code):
    v = numpy.arange(256) / 255
    return numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4).astype(numpy.float32)[code]


def read_geotiff(path):
    """A GeoTIFF's 8-bit values, from 180 W and 90 N on, through GDAL; none where GDAL's Python module is not installed."""
    try:
        from osgeo import gdal, osr
    except ImportError:
        print(f"{path}: GDAL's Python module (python3-gdal) is not installed, so its projection is not looked at", file=sys.stderr)
        return None
    gdal.UseExceptions()
    try:
        source = gdal.Open(str(path))
    except RuntimeError as error:
        stop(f"{path}: GDAL cannot read it: {error}")
    if source.GetProjection() and not osr.SpatialReference(wkt=source.GetProjection()).IsGeographic():
        stop(f"{path}: its projection is not read; accepted: longitude and latitude (gdalwarp -t_srs EPSG:4326 makes them)")
    first = source.GetRasterBand(1)
    if first.GetRasterColorTable():
        stop(f"{path}: its values are numbers of a palette; accepted: grey or colours (gdal_translate -expand rgb makes them)")
    kinds = {gdal.GDT_Byte: 1, gdal.GDT_UInt16: 257}
    if first.DataType not in kinds:
        stop(f"{path}: its values are {gdal.GetDataTypeName(first.DataType)}; accepted: Byte, UInt16 (gdal_translate -ot Byte -scale makes them)")
    bands = 3 if source.RasterCount >= 3 else 1
    values = numpy.stack([source.GetRasterBand(k + 1).ReadAsArray() for k in range(bands)], axis=-1)
    values = (values // kinds[first.DataType]).astype(numpy.uint8)
    x0, dx, _, y0, _, dy = source.GetGeoTransform()
    if source.GetProjection():
        if abs(dx * source.RasterXSize - 360) > 0.2 or abs(y0 - 90) > 0.1 or abs(dy * source.RasterYSize + 180) > 0.2 or abs(x0) > 180.1:
            stop(f"{path}: it does not cover the Earth from 90 N to 90 S and all around; accepted: the whole (gdalwarp -te -180 -90 180 90)")
        # Columns from wherever it begins to 180 W.
        values = numpy.roll(values, round((x0 + 180) / dx), axis=1)
    return Image.fromarray(values if bands == 3 else values[..., 0])


def read_picture(path, mode):
    """A picture as 8-bit values; GeoTIFFs through GDAL, which knows their projection."""
    Image.MAX_IMAGE_PIXELS = None
    picture = read_geotiff(path) if path.suffix.lower() in (".tif", ".tiff") else None
    if picture is None:
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


def waves(height, width, cycles, seed):
    """Smooth noise over the map, rms 1 and whole around it: thirty waves of about so many cycles a turn. The same in every run."""
    random = numpy.random.RandomState(seed)
    turn = 2 * numpy.pi * (numpy.arange(width) + 0.5) / width
    south = numpy.pi * (numpy.arange(height) + 0.5) / height
    out = numpy.zeros((height, width), numpy.float32)
    for _ in range(30):
        across, down = random.randint(1, cycles + 1), random.normal(0, cycles)
        phase = across * turn[None] + down * south[:, None] + 2 * numpy.pi * random.random_sample()
        out += numpy.sin(phase).astype(numpy.float32)
    return out / numpy.sqrt(15)


def sea_ice(water, extents_million_km2):
    """The share of ice in each texel [0..1]: on the water about each pole, as far from it as makes the extent. The
    edge wanders by two degrees and the cover by a tenth, which is invented: an even cap is seen to be one."""
    height, width = water.shape
    latitude_deg = 90 - (numpy.arange(height) + 0.5) / height * 180
    cell_km2 = 2 * numpy.pi * EARTH_RADIUS_KM**2 * numpy.cos(numpy.radians(latitude_deg)) * (numpy.pi / height) / width
    polar_deg = abs(latitude_deg)[:, None] + sum(degrees * waves(height, width, cycles, cycles)
                                               for degrees, cycles in ((1.6, 4), (0.8, 12), (0.5, 40), (0.5, 120), (0.5, 400)))
    cover = numpy.clip(SEA_ICE_SHARE + 0.06 * waves(height, width, 30, 3) + 0.06 * waves(height, width, 300, 4), 0, 1)
    share = numpy.zeros((height, width), numpy.float32)
    for rows, extent in zip((slice(0, height // 2), slice(height // 2, height)), extents_million_km2):
        # Water by its distance from the pole, nearest first, until the extent is full. Ice thins out over four degrees.
        order = numpy.argsort(-polar_deg[rows], axis=None)
        within = numpy.cumsum((water[rows] * cell_km2[rows, None]).ravel()[order], dtype=float)
        if extent > 0:
            edge_deg = polar_deg[rows].ravel()[order[min(numpy.searchsorted(within, extent * 1e6), order.size - 1)]]
            share[rows] = cover[rows] * numpy.clip((polar_deg[rows] - edge_deg) / 4 + 0.5, 0, 1)
    return share * water


def with_ice(land, water, ice):
    """Land with the ice, which is a share of the ground as the land's reflectance is one, and the water that is left."""
    height = ice.shape[0]
    bright = numpy.where(numpy.arange(height) < height / 2, NORTH_ICE_OVER_SNOW, 1.0).astype(numpy.float32)[:, None]
    snow = numpy.array([SNOW[2], SNOW[1], SNOW[0], SNOW_NIR], numpy.float32)
    return numpy.minimum(land + snow * (ice * bright)[..., None], 1), water - ice


def channels(pictures, width, sea_ice_million_km2):
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
    ice = fitted(pictures["ice"], width) / 255 * water if "ice" in pictures else sea_ice(water, sea_ice_million_km2)
    land, water = with_ice(land, water, ice)
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
    parser.add_argument("--sea-ice", type=float, nargs=2, default=(0, 0), metavar=("NORTH", "SOUTH"))
    names = {"albedo": "albedo", "water": "water", "clouds": "cloud", "lights": "glow"}
    for key in names:
        parser.add_argument(f"--{key}", type=pathlib.Path)
    parser.add_argument("--ice", type=pathlib.Path)
    options = parser.parse_args()
    if options.ice and any(options.sea_ice):
        stop("--ice and --sea-ice both say where ice is; accepted: one of them")
    if options.source.suffix == ".csv":
        return albedo_picture(options.source, options.out)
    pictures = {}
    for key, word in names.items():
        given = getattr(options, key)
        found = [given] if given else sorted(p for p in options.source.glob(f"blue_marble_{word}.*"))
        if not found:
            stop(f"{options.source}: no blue_marble_{word}.jpg, .png or .tif, and no --{key}")
        pictures[key] = read_picture(found[0], "RGB" if key == "albedo" else "L")
    if options.ice:
        pictures["ice"] = read_picture(options.ice, "L")
    options.out.write_bytes(packed(channels(pictures, options.width, options.sea_ice)))


if __name__ == "__main__":
    main()
