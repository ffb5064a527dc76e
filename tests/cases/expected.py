"""The right value of each file of shared/cases, where it comes from, and how hilcam's is measured.

What is right does not depend on hilcam: it is the closed form that the file was made of, a standard, or another program's figure.
"""
import math

import numpy

import measures

GM_KM3_S2, ORBIT_KM, INCLINATION, NODE = 398600.4418, 7000.0, math.radians(51.6), math.radians(10)
REFUSED = "refused: "


def circle(t_s):
    """Returns the place [m] in EME2000 at a time after 12:00 of the orbit that the messages of ccsds were made of."""
    u = math.sqrt(GM_KM3_S2 / ORBIT_KM ** 3) * t_s
    x, y = ORBIT_KM * math.cos(u), ORBIT_KM * math.sin(u)
    return 1e3 * numpy.array([x * math.cos(NODE) - y * math.cos(INCLINATION) * math.sin(NODE),
                              x * math.sin(NODE) + y * math.cos(INCLINATION) * math.cos(NODE), y * math.sin(INCLINATION)])


def turned(axis, angle):
    """Returns the matrix that turns the axes by an angle [rad] about one of them, R_axis of the textbooks."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    m = numpy.eye(3)
    m[i, i], m[i, j], m[j, i], m[j, j] = c, s, -s, c
    return m


def of_date_from_2000(centuries):
    """Returns the mean equator and equinox of date from EME2000 (Lieske et al. 1977), to 0.01 arcsec for a century."""
    seconds = math.pi / 180 / 3600
    t = centuries
    zeta = (2306.2181 * t + 0.30188 * t ** 2 + 0.017998 * t ** 3) * seconds
    z = (2306.2181 * t + 1.09468 * t ** 2 + 0.018203 * t ** 3) * seconds
    theta = (2004.3109 * t - 0.42665 * t ** 2 - 0.041833 * t ** 3) * seconds
    return turned(2, -z) @ turned(1, theta) @ turned(2, -zeta)


def nutation(centuries):
    """Returns the true equator and equinox from the mean ones by the four greatest terms of IAU 1980 (Seidelmann 1982), to 0.3 arcsec: 10 m."""
    seconds, degree, t = math.pi / 180 / 3600, math.pi / 180, centuries
    node, sun, moon = (125.04452 - 1934.136261 * t) * degree, (280.4665 + 36000.7698 * t) * degree, (218.3165 + 481267.8813 * t) * degree
    longitude = (-17.20 * math.sin(node) - 1.32 * math.sin(2 * sun) - 0.23 * math.sin(2 * moon) + 0.21 * math.sin(2 * node)) * seconds
    obliquity = (9.20 * math.cos(node) + 0.57 * math.cos(2 * sun) + 0.10 * math.cos(2 * moon) - 0.09 * math.cos(2 * node)) * seconds
    mean = (23.439291 - 0.0130042 * t) * degree
    return turned(0, -mean - obliquity) @ turned(2, -longitude) @ turned(0, mean)


CENTURIES = (2461120.0 - 2451545.0) / 36525  # 20 March 2026, 12:00


class Row:
    """A file, what is right, its source, and a measure that returns (is it right, what was found)."""

    def __init__(self, file, right, source, measure):
        self.file, self.right, self.source, self.measure = file, right, source, measure


def shown(value):
    return value if isinstance(value, str) else repr(value)


# ---- orbit and attitude messages
def place(file, kind="oem", right=None, within_m=1.0, words="the circle that it was made of", source="closed form", time="2026-03-20T12:05:30Z", more=""):
    def measure(program, path):
        at = measures.pose(program, kind, '%s: {file: "%s"%s}' % (kind, path, more), time)
        if isinstance(at, str):
            return False, at
        off = float(numpy.linalg.norm(at["place"] - (circle(330) if right is None else right)))
        return off < within_m, "%.3g m off" % off
    return Row(file, "%s, within %g m" % (words, within_m), source, measure)


def refused(file, naming, source, kind="oem", more=""):
    def measure(program, path):
        at = measures.pose(program, kind, '%s: {file: "%s"%s}' % (kind, path, more))
        if not isinstance(at, str):
            return False, "taken"
        return naming.lower() in at.lower(), at
    return Row(file, "refused, naming " + naming, source, measure)


def attitude(file, source="6 deg/s about +z, closed form", right_deg=132.0, within_deg=0.02, time="2026-03-20T12:00:22Z"):
    def measure(program, path):
        law = '{law: aem, aem: {file: "%s"}}' % path
        at = measures.pose(program, "fixed", "frame: world, position_m: [7000000, 0, 0]", time, law)
        if isinstance(at, str):
            return False, at
        turn_deg = math.degrees(2 * math.atan2(at["turn"][3], at["turn"][0])) % 360
        return abs((turn_deg - right_deg + 180) % 360 - 180) < within_deg, "%.4f deg about +z" % turn_deg
    return Row(file, "%g deg about +z, within %g" % (right_deg, within_deg), source, measure)


CHORD = "the mean of two quaternions, closed form"
BY_CHORD_DEG = round(2 * math.degrees(math.atan2(0.8 * math.sin(math.radians(60)) + 0.2, 0.8 * math.cos(math.radians(60)))), 3)
BIAS = "closed form; EME2000 is 0.77 m from ICRF there"
STANDARD = "CCSDS 502.0-B-3"
MESSAGES = [place("ccsds/%s.oem" % name, source=BIAS) for name in (
    "bom", "crlf_bom", "doy", "duplicate_epoch", "fortran_d_exponent", "gmat_order_2", "hermite_even_8",
    "lower_case_values", "no_fraction_z", "stk_mixed_case", "tabs", "time_gps", "time_tai", "time_tt", "units_in_brackets",
    "unknown_keyword", "unsaid_4min", "usable", "v3_header", "hermite_1")]
TDB_LESS_TT_S = 0.001657 * math.sin(math.radians(357.53 + 0.9856003 * 36525 * CENTURIES))  # Explanatory Supplement 1992, 2.222
MESSAGES += [
    place("ccsds/time_tdb.oem", right=circle(330 + TDB_LESS_TT_S), source=BIAS),
    place("ccsds/lagrange_1.oem", right=(circle(300) + circle(360)) / 2, words="the middle of the chord", source=BIAS),
    place("ccsds/linear.oem", right=(circle(300) + circle(360)) / 2, words="the middle of the chord", source=BIAS),
    refused("ccsds/degree_more_than_states.oem", "states", "degree 11 asks for six states, the file has four"),
    place("ccsds/oem.xml", source=BIAS),
    place("ccsds/tod.oem", right=(nutation(CENTURIES) @ of_date_from_2000(CENTURIES)).T @ circle(330), within_m=30, words="the circle turned from the true equator of date",
          source="Lieske 1977 and four terms of IAU 1980, own coding"),
    place("ccsds/teme_of_2000.oem", within_m=600, source="TEME of 2000-01-01 is EME2000 to its nutation"),
    refused("ccsds/mrt_time.oem", "MRT", STANDARD),
    refused("ccsds/barycentre_center.oem", "EARTH BARYCENTER", STANDARD), refused("ccsds/opm.opm", "OPM", STANDARD),
    attitude("ccsds/aem_plain.aem"), attitude("ccsds/aem_sign_flips.aem"), attitude("ccsds/aem_sign_flips_hermite.aem"), attitude("ccsds/aem_lower_case.aem"),
    attitude("ccsds/aem_hermite_1.aem", right_deg=BY_CHORD_DEG, source=CHORD), attitude("ccsds/aem_lagrange_1.aem", right_deg=BY_CHORD_DEG, source=CHORD), attitude("ccsds/aem_v1_quaternion_rate.aem"),
    attitude("ccsds/aem_star_tracker_frame.aem"), attitude("ccsds/aem_instrument_frame.aem"),
]


# ---- element sets
def as_plain(file, more="", within_m=1.0, kind="tle", words="the place of plain.tle", source="the same elements"):
    def measure(program, path):
        plain = measures.pose(program, "tle", 'tle: {file: "%s"}' % path.with_name("plain.tle"))
        at = measures.pose(program, kind, '%s: {file: "%s"%s}' % (kind, path, more))
        if isinstance(at, str):
            return False, at
        off = float(numpy.linalg.norm(at["place"] - plain["place"]))
        return off < within_m, "%.3g m off" % off
    return Row(file, "%s, within %g m" % (words, within_m), source, measure)


def read(file, more=""):
    def measure(program, path):
        at = measures.pose(program, "tle", 'tle: {file: "%s"%s}' % (path, more))
        radius_km = math.inf if isinstance(at, str) else float(numpy.linalg.norm(at["place"])) / 1e3
        return 6500 < radius_km < 7000, at if isinstance(at, str) else "%.1f km from the centre" % radius_km
    return Row(file, "an orbit 6500 to 7000 km wide", "15.5 turns a day", measure)


def read_message(file, source):
    def measure(program, path):
        at = measures.pose(program, "oem", 'oem: {file: "%s"}' % path)
        return not isinstance(at, str) and abs(float(numpy.linalg.norm(at["place"])) - 7e6) < 1, at if isinstance(at, str) else "7000 km from the centre"
    return Row(file, "taken, 7000 km from the centre", source, measure)


MESSAGES += [read_message("ccsds/itrf97.oem", STANDARD + ", annex B: ITRF-97"), read_message("ccsds/teme_of_date.oem", STANDARD)]
ELEMENTS = [as_plain("tle/%s.tle" % name) for name in (
    "plain", "crlf_trailing", "bom", "name_starts_with_1", "name_starts_with_2", "hash_name", "long_name", "epoch_space_day")]
ELEMENTS += [as_plain("tle/%s.tle" % name, within_m=300, source="the same but for drag in 5 min") for name in (
    "ndd_plus_exponent", "bstar_plus_sign", "bstar_positive_exp")]
ELEMENTS += [refused("tle/%s.tle" % name, "drag (B*)", "columns 54 to 61 hold a number", "tle") for name in ("bstar_blank_exp", "bstar_zero_blank")]
ELEMENTS += [
    as_plain("tle/alpha5.tle", ', satellite: "100001"', source="Space-Track: A0001 is 100001"), as_plain("tle/spaces_number.tle", ', satellite: "04859"'),
    as_plain("tle/no_checksum.tle", ", checksum: ignore"), read("tle/angles_leading_dot.tle"), read("tle/plus_signs.tle"), read("tle/tabs_lower.tle"),
    refused("tle/ephemeris_type_4.tle", "SGP4-XP", "Space-Track's format description", "tle"), refused("tle/nbsp.tle", "blank", "only ASCII in the format", "tle"),
    read("tle/decaying.tle"),
] + [as_plain("tle/omm." + kind) for kind in ("xml", "kvn", "csv")]


# ---- meshes
def sized(file, size, triangles=None, area=None, source="made so", saying=None):
    def measure(program, path):
        found = measures.mesh(program, path)
        if isinstance(found, str):
            return False, found
        right = all(abs(a - b) < 0.002 * max(1, b) for a, b in zip(found["size"], size)) and (triangles is None or found["triangles"] == triangles) and \
            (area is None or abs(found["area"] - area) < 0.01 * area) and (saying is None or saying in found["said"])
        return right, "%g x %g x %g m, %d triangles, %g m2" % (*found["size"], found["triangles"], found["area"])
    words = ["%g x %g x %g m" % size, triangles and "%d triangles" % triangles, area and "%g m2" % area, saying and "'%s' said" % saying]
    return Row(file, ", ".join(word for word in words if word), source, measure)


def refused_mesh(file, naming, source):
    def measure(program, path):
        found = measures.mesh(program, path)
        return isinstance(found, str) and naming.lower() in found.lower(), found if isinstance(found, str) else "taken"
    return Row(file, "refused, naming " + naming, source, measure)


def looks(file, right, within=0.05, source="Khronos glTF 2.0", middle=0.0, width=2.0):
    def measure(program, path):
        found = measures.row(program, path, middle, width, len(right))
        if isinstance(found, str):
            return False, found
        return all(abs(a - b) < within for a, b in zip(found, right)), "%s of white" % (found,)
    return Row(file, "%s of white, within %g" % (right, within), source, measure)


def linear(byte):
    """Returns the reflectance of an sRGB value (IEC 61966-2-1)."""
    v = byte / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def says(file, word, source):
    """A look that may be left out, if `hilcam mesh` says so."""
    def measure(program, path):
        found = measures.mesh(program, path)
        said = (found if isinstance(found, str) else found["said"]).replace(str(path), "")
        return word in said.lower(), "said" if word in said.lower() else "not said"
    return Row(file, "taken, or '%s' is in what is said" % word, source, measure)


DARK, BRIGHT = round(linear(20), 3), round(linear(230), 3)
GLTF = [
    sized("gltf/quantized.gltf", (2, 2, 0), 2, 4, "glTF 2.0, 3.12; KHR_mesh_quantization"),
    sized("gltf/instancing.gltf", (10, 2, 0), 6, 12, "EXT_mesh_gpu_instancing"),
    sized("gltf/instances_rotated.gltf", (34, 6, 0), 10, 64, "EXT_mesh_gpu_instancing"),
    sized("gltf/required_unknown.gltf", (2, 2, 0), 2, 4, "glTF 2.0, 3.12: refused by who has no meshopt; no view of it is compressed"), refused_mesh("gltf/basisu.gltf", "basisu", "glTF 2.0, 3.12"),
    looks("gltf/vertex_colours.gltf", (0.1, 0.9)), looks("gltf/alpha_mask.gltf", (round(linear(200), 3), 0.0)),
    looks("gltf/texture_transform.gltf", (BRIGHT, DARK)), looks("gltf/second_uv_set.gltf", (DARK, BRIGHT)),
    looks("gltf/wrap_clamp.gltf", (DARK,) * 3 + (BRIGHT,) * 3, within=0.09), looks("gltf/wrap_mirror.gltf", (BRIGHT, DARK, DARK, BRIGHT, BRIGHT, DARK), within=0.09),
    looks("gltf/spec_gloss.gltf", (0.2, 0.2)), looks("gltf/metal_rough_texture.gltf", (0.17, 0.8), within=0.06, source="GGX of roughness 0.157, 8.8 degrees off its peak"), says("gltf/emissive.gltf", "emi", "KHR_materials_emissive_strength"),
    sized("gltf/morph_weight_1.gltf", (4, 2, 0), 2, 8), sized("gltf/skin.gltf", (2, 2, 0), 2, 4, saying="x 4 to 6"), sized("gltf/node_invisible.gltf", (2, 2, 0), 2, 4, "KHR_node_visibility"),
    sized("gltf/percent_encoded_uri.gltf", (2, 2, 0), 2, 4, "RFC 3986"), sized("gltf/second_scene.gltf", (10, 10, 0), 2, 100), sized("gltf/sparse_accessor.gltf", (2, 2, 0), 2, 4),
    sized("gltf/strip.gltf", (2, 2, 0), 2, 4), sized("gltf/fan.gltf", (2, 2, 0), 2, 4),
]
HALVES = (DARK, BRIGHT)
OBJ = [looks("obj/%s.obj" % name, HALVES, source="the picture's two halves") for name in (
    "backslash", "case_differs", "map_options", "spaces", "beside_mtl", "ppm", "tga", "absolute_windows", "texture_beside_mtl")]
OBJ += [
    looks("obj/map_options_scaled.obj", (DARK, BRIGHT, DARK, BRIGHT), source="Wavefront's appendix B: -s 2 1 1"),
    looks("obj/kd_zero_map.obj", (0.0, 0.0), source="Wavefront: the map is multiplied by Kd"),
    looks("obj/unused_bad_texture.obj", (1.0, 1.0), source="no face uses the texture"), looks("obj/two_libs.obj", (0.2, 0.2), source="Wavefront: several libraries"),
    looks("obj/dissolve.obj", (0.16, 0.16), source="d 0.2 of Kd 0.8 before black"),
    looks("obj/vertex_colours.obj", tuple(round(0.1 + 0.8 * (i + 0.5) / 4, 2) for i in range(4)), source="a ramp from 0.1 to 0.9"),
    looks("obj/coloured.ply", tuple(round(DARK + (BRIGHT - DARK) * (i + 0.5) / 4, 3) for i in range(4)), within=0.08, source="a ramp from 20 to 230"),
    sized("obj/bom.obj", (2, 2, 0), 2, 4), sized("obj/bom_shift.obj", (1, 1, 0), 1, 0.5), sized("obj/negative_indices.obj", (2, 2, 0), 2, 4),
    sized("obj/continued_lines.obj", (2, 2, 0), 2, 4), sized("obj/mac_cr.obj", (2, 2, 0), 2, 4), sized("obj/concave.obj", (4, 4, 0), 3, 10),
    sized("obj/line_and_faces.obj", (2, 2, 0), 2, 4), sized("obj/winding_reversed.obj", (2, 2, 0), None, None), sized("obj/normals_opposed.obj", (2, 2, 0)),
    sized("obj/empty_solid.stl", (1, 1, 0), 1, 0.5), sized("obj/two_solids.stl", (2, 1, 0), 2, 1.5), sized("obj/binary_header_solid.stl", (1, 1, 0)),
    sized("obj/binary_trailing.stl", (1, 1, 0), 1, 0.5), refused_mesh("obj/binary_count_zero.stl", "triangle", "its count is 0"),
    sized("obj/double_big_endian.ply", (1, 1, 0), 1, 0.5), sized("obj/tristrips.ply", (2, 2, 0), 2, 4, "Stanford's scans"),
]
OBJ += [looks("obj/normals_%s.stl" % name, (1.0, 1.0), source="STL's facets are flat", middle=0.0) for name in ("right", "sideways", "zero", "long", "opposed")]
SHAPES = [
    sized("shape/damit_plain.tab", (4, 2, 2), 8, None, "DAMIT's layout"), sized("shape/damit_three.tab", (4, 2, 2), 8), sized("shape/plates.plt", (4, 2, 2), 8),
    sized("shape/plates_d.plt", (4, 2, 2), 8), sized("shape/vf_commas.tab", (4, 2, 2), 8), sized("shape/vf_trailing.tab", (4, 2, 2), 8),
    sized("shape/lat_lon_radius.tab", (4, 2, 2), None, None, "the places of its lines"),
]


# ---- height maps
def hill(file, source="made so", right_m=4100.0, within_m=20.0, body="moon", longitude=92.5, latitude=22.5, keys=""):
    def measure(program, path):
        found = measures.height(program, path, longitude, latitude, body, keys)
        return not isinstance(found, str) and abs(found - right_m) < within_m, found if isinstance(found, str) else "%g m" % found
    return Row(file, "%g m at %g E, %g N" % (right_m, longitude, latitude), source, measure)


def refused_map(file, naming, source):
    def measure(program, path):
        found = measures.height(program, path, 92.5, 22.5)
        return isinstance(found, str) and naming in found, found if isinstance(found, str) else "%g m" % found
    return Row(file, "refused, naming " + naming, source, measure)


def step(file, latitude, source):
    """A step of 1000 m: below it 0 m, above it 1000 m, within a post of 0.05 degrees."""
    def measure(program, path):
        found = [measures.height(program, path, 2.5, latitude + d, "mars") for d in (-0.06, 0.06)]
        return not any(isinstance(f, str) for f in found) and abs(found[0]) < 50 and abs(found[1] - 1000) < 50, "%s, %s m at %.3f -+ 0.06 N" % (*found, latitude)
    return Row(file, "the step at %.3f N, geodetic" % latitude, source, measure)


CENTRIC = "tan gd = tan gc (3396.19 / 3376.20)^2"
MAPS = [hill("dem/%s" % name) for name in (
    "east.lbl", "east_270.lbl", "east_270.cub", "attached.img", "base_multiplier.cub", "bigendian.tif", "float64.tif", "lon0_360.tif",
    "lower_case_dir.lbl", "missing.lbl", "missing_hex.lbl", "missing_unsaid.lbl", "moon_1738.tif", "nan.tif", "nodata_flt_min.tif", "flt_min_unsaid.tif", "plain.tif",
    "point.tif", "prefix.lbl", "real_be.lbl", "real_le.lbl", "scale_m_pix.lbl", "scale_metres.lbl", "southup.tif", "tiled.cub",
    "uint16.tif", "unsigned.lbl", "null_pixel.cub", "minus9999_unsaid.tif")]
MAPS += [hill("dem/west.lbl", "PDS3: samples go right with east"), hill("dem/west_90.cub", "ISIS: the same ground as east_270"), hill("dem/earth_sphere.tif", body="earth"),
         refused_map("dem/mola_offset.lbl", "bounds_deg: [0, -90, 360, 90]", "the label's own bounds in degrees"),
         hill("dem/mola_offset.lbl", "the label's own bounds in degrees", keys=", bounds_deg: [0, -90, 360, 90]"),
         hill("dem/half_offset.lbl", "the label's own bounds in degrees", keys=", bounds_deg: [0, -90, 360, 90]"), hill("dem/km_unit.lbl", "UNIT = KILOMETER"),
         refused_map("dem/lola_radius.lbl", "offset: -1737400", "LOLA's radii less 1737.4 km"), hill("dem/lola_radius.lbl", "LOLA's radii less 1737.4 km", keys=", offset: -1737400"),
         refused_map("dem/radius_metres.lbl", "radius", "a radius in m where PDS3 has km"),
         hill("dem/minus9999_unsaid.tif", "-9999 is a hole, which is filled to height 0", 0.0, 1.0, "moon", -152.5, 62.5),
         step("dem/mars_sphere.lbl", 42.837, CENTRIC), step("dem/mars_ellipsoid.lbl", 42.837, CENTRIC), step("dem/mars_graphic.lbl", 42.5, "planetographic is geodetic")]


# ---- the rest
def said(file, words, source, scenario):
    def measure(program, path):
        found = measures.checked(program, scenario % path)
        return all(word in found for word in words), "said" if all(word in found for word in words) else found[:300]
    return Row(file, "check says " + " and ".join(words), source, measure)


LEAP = measures.ORBIT % {"camera": measures.FLAT_CAMERA % 50, "kind": "fixed", "source": "frame: world, position_m: [7000000, 0, 0]", "time": "2026-03-20T12:00:00Z",
                         "attitude": "{law: held}"} + 'spice: {kernels: [{file: "%s"}]}\n'
AIR = measures.GROUND.replace("terrain", "#") % {"camera": measures.FLAT_CAMERA % 50, "body": "earth", "longitude": 0, "latitude": 0, "map": "", "keys": ""}


def air(file):
    def measure(program, path):
        text = AIR.replace("quality: fast", 'atmosphere: {model: table, table: "%s"}\nquality: fast' % path)
        found = measures.checked(program, text)
        return "SOL_SCAT" not in found and not found.startswith(REFUSED + "no column"), found.splitlines()[0][:200] if found else ""
    return Row(file, "its columns are read", "MODTRAN's public source: fields of 7, 11, 9 and 8", measure)


def camera(file):
    def measure(program, path):
        status, _, messages = program.run("check", path)
        return status == 0, "described" if status == 0 else program.refusal(messages)
    return Row(file, "is described", "its papers", measure)


REST = [said("spice/old.tls", ("2015", "2017"), "IERS Bulletin C 52: leap seconds of July 2015 and January 2017", LEAP),
        air("modtran/modtran4.csv"), air("modtran/modtran5.csv")] + [camera("cameras/%s.yaml" % name) for name in ("cassini_iss_nac", "junocam", "dart_draco")]
ROWS = MESSAGES + ELEMENTS + GLTF + OBJ + SHAPES + MAPS + REST
