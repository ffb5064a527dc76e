#!/usr/bin/python3
"""A picture of Eros by MSI on NEAR against hilcam's of its shape of 7,790 facets: limb, terminator, and how bright it is.

    near_msi_test.py HILCAM SOURCE_DIR [PICTURE.png]

Needs shared/data beside the source folder, or where HILCAM_SHARED_DATA says; skipped without. docs/flight.md has the residuals.
PICTURE.png: the flight picture, hilcam's and the difference side by side.
"""
import math
import pathlib
import sys
import tempfile

import numpy

from flight_pictures import (DATA, PICTURE, SKIPPED, SOURCE, Judgement, blurred, correlation, fits_arrays, propagated, render, shift_between,
                             side_by_side, top)

# The label has the attitude, the Sun and the distance from Eros, but not from where. Place and velocity in ICRF relative to Eros, 6.4
# hours later [km, km/s]: instrument position of m0126888978f7_2p in DOI-USGS/ale, tests/pytests/data/isds/msi_isd.json, after NEAR's
# kernels; likewise the rotation from the spacecraft's axes to the camera's, and Eros' pole and prime meridian (PCK 8).
PLACE_KM = numpy.array([69.13367389282288, -276.40770781355167, 222.2546049363491])
VELOCITY_KM_S = numpy.array([0.0007228575310681222, -0.00018739946234989447, -0.0005859505443754926])
PLACE_ET_S = 4750816.53996159
PICTURE_ET_S = (54 * 24 + 17) * 3600 + 16 * 60 + 12.7005 + 64.184  # 2000-02-25T05:16:12.7005 UTC; TDB is 64.184 s before UTC
EROS_KM3_S2 = 4.463e-4  # Yeomans et al., Science 289, 2085, 2000
CAMERA_FROM_SPACECRAFT = numpy.array([[-0.0014422521585656, 6.97819591591e-07, 0.9999989599535714],
                                      [-0.0004838401563600, -0.9999998829493447, 0.0],
                                      [0.9999988429030378, -0.0004838396531438, 0.0014422523273822]])
POLE_DEG, MERIDIAN_DEG, RATE_DEG_DAY = (11.35, 17.22), 326.07, 1639.38864745
LINES, WIDTH, HEIGHT, LINE_PX = 244, 537, 412, 27 / 16  # a line of the flight picture is 27 um, a pixel of hilcam's 16
# Hapke's terms of Eros: Li, A'Hearn and McFadden, Icarus 172, 415, 2004: w 0.33 at 550 nm, following the spectrum; g -0.25; 28 degrees.
# The mean spectrum of the S class (configs/materials/asteroid_s.yaml) is 1.085 times as bright at 950 nm. Surge: Domingue et al. 2002.
MATERIAL = "{model: hapke, reflectance: 0.358, lobe_width: 0.25, lobe_backward: 1, slope_deg: 28, surge_amplitude: 1.4, surge_width: 0.01}"
SCENARIO = """\
name: flight_near_msi
time_utc: 2000-02-25T05:16:12.70Z
seed: 1
origin: {kind: free}
sun: {direction: [%(sun)s], distance_au: %(sun_au)s}
camera: %(camera)s
camera_pose: {position_m: [%(place)s], attitude_dcm: [%(camera_from_world)s]}
objects:
  - name: thing
    mesh: %(mesh)s
    pose: {position_m: [0, 0, 0], attitude_dcm: [%(thing_from_world)s]}
    materials: {surfaces: [{name: "*", material: %(material)s}]}
spectrum_edges_um: [0.92, 0.98]
quality: {visibility: rays, samples_per_axis: 4, path_model: path, max_depth: 3, lod_error_px: 0, sun_disk: true, watertight: true}
"""


def from_quaternion(q):
    """Returns the matrix of a quaternion, scalar first, as SPICE has it."""
    w, x, y, z = numpy.array(q) / numpy.linalg.norm(q)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def turned(axis, angle_deg):
    """Returns the matrix that takes a vector's components to axes turned by an angle about x (0) or z (2)."""
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return numpy.array([[1, 0, 0], [0, c, s], [0, -s, c]] if axis == 0 else [[c, s, 0], [-s, c, 0], [0, 0, 1]])


def listed(values):
    """Returns numbers as a list of YAML."""
    return ", ".join(repr(float(v)) for v in numpy.ravel(values))


def write_shape(tab, obj):
    """Writes the shape, in km, as an OBJ file in metres."""
    rows = [line.split() for line in tab.read_text().splitlines() if line.strip()]
    faces = [[int(n) for n in row[1:4]] for row in rows if row[0] == "f"]
    first = min(min(f) for f in faces)
    with obj.open("w") as out:
        for row in rows:
            if row[0] == "v":
                out.write("v %.3f %.3f %.3f\n" % tuple(1000 * float(n) for n in row[1:4]))
        for f in faces:
            out.write("f %d %d %d\n" % tuple(n - first + 1 for n in f))


def limb_rows(picture):
    """Returns, by column, where the picture, blurred by a pixel, falls most from one row to the next: haze moves that least [px]."""
    fall = -numpy.diff(blurred(picture, 1), axis=0)
    found = numpy.full(picture.shape[1], numpy.nan)
    for x, values in enumerate(fall.T):
        row = numpy.argmax(values[2:-2]) + 2
        found[x] = row + 0.5 + top(*values[row - 1:row + 2])
    return found


def terminator_rows(picture):
    """Returns, by column, where the picture, from above, first rises to a quarter of what it has 4 to 12 px on; nan where it does not."""
    found = numpy.full(picture.shape[1], numpy.nan)
    for x, column in enumerate(picture.T):
        lit = numpy.nonzero(column > 0.006)[0]
        if len(lit) == 0 or lit[0] < 5 or lit[0] > len(column) - 20:
            continue
        level = numpy.median(column[lit[0] + 4:lit[0] + 12]) / 4
        row = numpy.nonzero(column > level)[0][0]
        found[x] = row - (column[row] - level) / (column[row] - column[row - 1])
    return found


def main():
    path, shape = DATA / "flight/near_msi/m0126865998f4_2p_iof.fit", DATA / "shapes/eros007790.tab"
    if not path.exists() or not shape.exists():
        print(f"skipped: no {path} or no {shape}")
        return SKIPPED
    label = dict(line.split("=", 1) for line in path.with_suffix(".lbl").read_text().replace("\n      ", " ").splitlines() if "=" in line)
    label = {key.strip(): value.strip() for key, value in label.items()}
    numbers = {key: [float(n) for n in label[key].replace("<km>", "").strip("() ").split(",")] for key in
               ("EMECL_SC_QUATERNION", "SUN_SC_POSITION_VECTOR", "TARGET_CENTER_DISTANCE")}
    raw = next(array for _, array in fits_arrays(path) if array is not None).astype(float)
    place_of_row = (LINES / 2 - 0.5) + (numpy.arange(HEIGHT) - (HEIGHT / 2 - 0.5)) / LINE_PX
    flight = numpy.stack([numpy.interp(place_of_row, numpy.arange(LINES), column) for column in raw.T], axis=1)

    place = propagated(PLACE_KM, VELOCITY_KM_S, PICTURE_ET_S - PLACE_ET_S, EROS_KM3_S2)
    print(f"distance {numpy.linalg.norm(place):.2f} km, the label's {numbers['TARGET_CENTER_DISTANCE'][0]}")
    camera = CAMERA_FROM_SPACECRAFT @ from_quaternion(numbers["EMECL_SC_QUATERNION"])
    sun_km = -numpy.array(numbers["SUN_SC_POSITION_VECTOR"])
    sun = sun_km / numpy.linalg.norm(sun_km)
    eros = (turned(2, MERIDIAN_DEG + RATE_DEG_DAY * PICTURE_ET_S / 86400) @ turned(0, 90 - POLE_DEG[1]) @ turned(2, 90 + POLE_DEG[0]))
    keys = {"camera": SOURCE / "configs/cameras/near_msi.yaml", "sun": listed(sun), "sun_au": numpy.linalg.norm(sun_km) / 1.495978707e8}
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder, "eros.obj")
        write_shape(shape, mesh)
        electrons = render(SCENARIO % {**keys, "mesh": mesh, "place": listed(1000 * place), "camera_from_world": listed(camera),
                                       "thing_from_world": listed(eros), "material": MATERIAL}, "electrons")
        # What a white sheet that faces the Sun gives is I/F 1.
        sheet = pathlib.Path(folder, "sheet.obj")
        sheet.write_text("v -50 -50 0\nv 50 -50 0\nv 50 50 0\nv -50 50 0\nf 1 2 3\nf 1 3 4\n")
        side = numpy.cross(sun, [0, 0, 1])
        side /= numpy.linalg.norm(side)
        axes = numpy.stack([side, numpy.cross(sun, side), sun])
        white = render(SCENARIO % {**keys, "mesh": sheet, "place": listed(1000 * sun), "material": "{model: lambert, reflectance: 0.1}",
                                   "camera_from_world": listed(axes * [[1], [-1], [-1]]), "thing_from_world": listed(axes)}, "electrons")
    dark = numpy.median(electrons[:100, :100])
    made = (electrons - dark) / ((white[200:212, 262:274].mean() - dark) / 0.1)
    judged = Judgement()
    x, y = shift_between(blurred(flight, 1), blurred(made, 1))
    print(f"nothing fitted: flight lies {x:.2f} px right, {y:.2f} lower; correlation {correlation(flight, made):.4f}")
    moved = numpy.roll(made, (round(y), round(x)), (0, 1))
    lit = (flight > 0.01) & (moved > 0.01)
    print(f"I/F, flight over hilcam: median {numpy.median(flight[lit] / moved[lit]):.3f}, of the sums {flight[lit].sum() / moved[lit].sum():.3f}; "
          f"mean of hilcam {moved[lit].mean():.4f}, {lit.sum()} px")
    for sigma in (0, 3, 6):
        print(f"correlation where both are lit, blurred by {sigma} px: "
              f"{correlation(*(blurred(p, sigma)[lit] if sigma else p[lit] for p in (flight, moved))):.4f}")
    columns = slice(100, 520)  # the asteroid's tip and the picture's edge are left out
    limb = limb_rows(flight) - limb_rows(made)
    terminator = terminator_rows(flight) - terminator_rows(made)
    rest = []
    for name, difference in (("limb", limb[columns]), ("terminator", terminator[columns])):
        difference = difference[numpy.isfinite(difference)]
        rest.append((numpy.median(difference), numpy.std(difference)))
        print(f"{name}: flight lies {rest[-1][0]:.2f} px lower, rms about that {rest[-1][1]:.2f} px; {len(difference)} columns")
    edge = limb_rows(made)[150:500]
    for out in (8, 16, 32, 64):
        rows = numpy.round(edge + out).astype(int)
        print(f"{out} px beyond the limb: flight {flight[rows, numpy.arange(150, 500)].mean():.5f}, "
              f"hilcam {made[rows, numpy.arange(150, 500)].mean():.5f}")
    # Against change; docs/flight.md judges.
    judged.most("place across, flight against hilcam", abs(x), 1, "px")
    judged.most("place down", abs(y), 2, "px")
    judged.most("limb's place", abs(rest[0][0]), 1, "px")
    judged.most("limb's rms", rest[0][1], 1, "px")
    judged.most("terminator's rms", rest[1][1], 10, "px")
    judged.most("1 - correlation", 1 - correlation(flight, made), 0.05)
    if PICTURE:
        side_by_side(flight[:280] / 0.06, moved[:280] / 0.06, PICTURE, gamma=0.7)
    return judged.status()


if __name__ == "__main__":
    sys.exit(main())
