#!/usr/bin/python3
"""tools/make_earth_map.py with pictures of one's own: PNG, GeoTIFF where GDAL's Python module is installed, sea ice, and what is refused.

    earth_map_tool_test.py SOURCE_DIR
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy
from PIL import Image

SOURCE = pathlib.Path(sys.argv[1])
TOOL = SOURCE / "tools/make_earth_map.py"
sys.path.insert(0, str(SOURCE / "tools"))
import make_earth_map  # noqa: E402

HEIGHT, WIDTH = 256, 512


def error_of(*arguments):
    done = subprocess.run([sys.executable, TOOL, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode != 0, arguments
    return done.stderr


def pictures(folder):
    """A blue planet with one continent, as PNGs."""
    land = numpy.zeros((HEIGHT, WIDTH), bool)
    land[100:150, 200:330] = True
    colors = numpy.where(land[..., None], (200, 180, 140), (5, 10, 30)).astype(numpy.uint8)
    for name, values in (("albedo", colors), ("water", numpy.where(land, 0, 255).astype(numpy.uint8)),
                         ("cloud", numpy.zeros((HEIGHT, WIDTH), numpy.uint8)), ("glow", numpy.where(land, 40, 0).astype(numpy.uint8))):
        Image.fromarray(values).save(folder / f"blue_marble_{name}.png")
    return land, colors


def check_sea_ice(folder):
    read = {key: make_earth_map.read_picture(folder / f"blue_marble_{word}.png", "RGB" if key == "albedo" else "L")
            for key, word in (("albedo", "albedo"), ("water", "water"), ("clouds", "cloud"), ("lights", "glow"))}
    bare, icy = (make_earth_map.channels(read, WIDTH, extents) for extents in ((0, 0), (12.0, 6.0)))
    water, left = bare[..., 4], icy[..., 4]
    rows = numpy.cos(numpy.radians(90 - (numpy.arange(HEIGHT) + 0.5) / HEIGHT * 180))[:, None]
    cell_million_km2 = 2 * numpy.pi**2 * 6.371**2 / HEIGHT / WIDTH * rows
    ice = (water - left) * cell_million_km2
    # The cover is 0.8 of the extent, and its edge is as much within as beyond.
    for half, extent in ((slice(0, HEIGHT // 2), 12.0), (slice(HEIGHT // 2, HEIGHT), 6.0)):
        assert abs(ice[half].sum() / (0.8 * extent) - 1) < 0.05, (extent, ice[half].sum())
    # Its albedo in the red, of what it covers: snow's in the south, half a year bare in the north.
    red = icy[..., 2].sum(axis=1) / (water - left).sum(axis=1).clip(1e-9)
    assert abs(red[-1] - 0.975) < 0.01 and abs(red[0] - 0.975 * 0.8333) < 0.01, (red[-1], red[0])
    # The rest is as it was.
    assert (icy[100:150] == bare[100:150]).all()
    # By a picture: half of the water of the last rows.
    read["ice"] = numpy.zeros((HEIGHT, WIDTH), numpy.uint8)
    read["ice"][240:] = 128
    icy = make_earth_map.channels(read, WIDTH, (0, 0))
    assert abs(icy[-1, :, 4].mean() - (1 - 128 / 255)) < 1e-3 and abs(icy[-1, :, 2].mean() - 0.975 * 128 / 255) < 0.005
    assert (icy[:240] == bare[:240]).all()


def check_land_colors():
    """The same law stands in render/earth/land_colors.cpp, whose test LandColors.AreTheToolsOwn has these figures."""
    colors = [[0.0096, 0.0207, 0.0032], [0.616, 0.449, 0.248], [0.89, 0.92, 0.93], [0.05, 0.06, 0.02], [0.3, 0.2, 0.1], [0.7, 0.72, 0.7]]
    expected = [[0.02, 0.045, 0.029, 0.4], [0.25, 0.35, 0.46, 0.58], [0.975, 0.98, 0.975, 0.93], [0.05796, 0.09148, 0.08678, 0.24687],
                [0.14755, 0.20414, 0.28525, 0.35967], [0.72771, 0.68933, 0.59717, 0.57005]]
    bands, _ = make_earth_map.reflectances(numpy.array(colors))
    assert numpy.allclose(bands, expected, atol=2e-5), bands


def check_geotiff(folder, colors):
    from osgeo import gdal, osr
    gdal.UseExceptions()

    def write(name, west_deg, values, kind=gdal.GDT_Byte, epsg=4326):
        out = gdal.GetDriverByName("GTiff").Create(str(folder / name), WIDTH, HEIGHT, values.shape[2], kind)
        place = osr.SpatialReference()
        place.ImportFromEPSG(epsg)
        out.SetProjection(place.ExportToWkt())
        out.SetGeoTransform((west_deg, 360 / WIDTH, 0, 90, 0, -180 / HEIGHT))
        for k in range(values.shape[2]):
            out.GetRasterBand(k + 1).WriteArray(values[..., k])
        return folder / name

    same = write("same.tif", -180, colors)
    assert (make_earth_map.read_picture(same, "RGB") == colors).all()
    # From Greenwich on, in 16 bits.
    east = write("east.tif", 0, numpy.roll(colors, WIDTH // 2, axis=1).astype(numpy.uint16) * 257, gdal.GDT_UInt16)
    assert (make_earth_map.read_picture(east, "RGB") == colors).all()
    out = folder / "out.map"
    flat = write("flat.tif", -180, colors, epsg=3857)
    assert "its projection is not read; accepted: longitude and latitude" in error_of(folder, out, "--width", WIDTH, "--albedo", flat)
    real = write("real.tif", -180, colors.astype(numpy.float32), gdal.GDT_Float32)
    assert "its values are Float32; accepted: Byte, UInt16" in error_of(folder, out, "--width", WIDTH, "--albedo", real)
    subprocess.run([sys.executable, TOOL, folder, folder / "png.map", "--width", str(WIDTH)], check=True)
    subprocess.run([sys.executable, TOOL, folder, folder / "tif.map", "--width", str(WIDTH), "--albedo", east], check=True)
    assert (folder / "png.map").read_bytes() == (folder / "tif.map").read_bytes()


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        _, colors = pictures(folder)
        check_sea_ice(folder)
        check_land_colors()
        Image.fromarray(colors[:200]).save(folder / "wide.png")
        assert "512 x 200 pixels; accepted: twice as wide as high" in error_of(folder, folder / "out.map", "--albedo", folder / "wide.png")
        try:
            import osgeo  # noqa: F401
        except ImportError:
            print("GeoTIFFs are not tried: python3-gdal is not installed")
        else:
            check_geotiff(folder, colors)


main()
