#!/usr/bin/python3
"""The order of the rooms (docs/architecture.md): a room's includes point to itself or to rooms below it, and no file includes itself
by way of others.

Prints how many files, rooms and arrows there are, the biggest room, the median and the longest file; then what is wrong: includes that
climb or go in circles, third-party headers outside their few units, folders that ROOMS does not know, rooms that have no README.md,
tables of rooms in READMEs that are not ROOMS.
"""
import graphlib
import pathlib
import re
import statistics
import sys
from collections import Counter

TOP = pathlib.Path(__file__).resolve().parents[2]
LAYERS = ("emulator", "io", "sensor", "render")
# From the top down. A layer's own name stands for the files that lie in none of its rooms.
ROOMS = (
    "emulator", "emulator/subcommands",
    "emulator/zoo", "emulator/tradeoff", "emulator/campaign", "emulator/clone", "emulator/check", "emulator/bench", "emulator/characterise", "emulator/run", "emulator/recording",
    "emulator/loop", "emulator/scenario", "emulator/events", "emulator/send", "emulator/world", "emulator/motion", "emulator/progress", "emulator/ground",
    "io/gige", "io/gige/device", "io/gige/stream", "io/gige/face", "io/uvc", "io/v4l2", "io/vizard", "io/ip42", "io/preview", "io/packets", "io/shm", "io/truth", "io/commands", "io/lines",
    "io/spice", "io/maps", "io/meshes", "io/files", "io/cache", "io/images", "io/config", "io/contract", "io/ptp", "io/naif", "io/orbits", "io/system",
    "sensor/measure", "sensor", "sensor/stray", "sensor/convolution",
    "render/frame", "render/paths", "render/indirect", "render/sunlight", "render/ground_shading", "render/primary", "render/shading",
    "render/glossy", "render/radiosity", "render/visibility", "render/planetshine", "render/probes", "render/background", "render/ground", "render/scene", "render/earth", "render/sky",
    "render/lod", "render/brdf", "render/vocabulary",
)
GDAL_FILES = {"io/maps/gdal_file.cpp", "io/maps/gdal_file.h", "io/maps/gdal_placement.cpp", "io/maps/gdal_placement.h",
              "io/maps/gdal_raster.cpp"}
# Sources of others, each used by the one file that ONLY_IN names.
FROM_ELSEWHERE = {"sensor/convolution/pocketfft"}
ONLY_IN = {
    "embree": {"render/lod/closest_triangle.cpp", "render/scene/embree_scene.cpp"},
    "meshoptimizer": {"io/meshes/gltf_meshopt.cpp", "render/lod/mesh_lod.cpp", "render/lod/shaped_parts.cpp"},
    "draco": {"io/meshes/gltf_draco.cpp"},
    "yaml-cpp": {"io/config/config_yaml.cpp", "io/config/yaml_flag.cpp", "io/config/yaml_place.cpp", "io/config/yaml_value.cpp"},
    "assimp": {"io/meshes/mesh_scene.cpp", "io/meshes/scene_mesh.cpp"},
    "pugixml": {"io/files/ndm_xml.cpp"},
    "pocketfft": {"sensor/convolution/fourier.cpp"},
    "opencv2": {"emulator/clone/calibrate_lens.cpp"},
    "png": {"io/images/png_codec.cpp"},
    "turbojpeg": {"io/images/jpeg_codec.cpp"},
    "tiff": {"io/images/tiff_codec.cpp"},
    "webp": {"io/images/webp_codec.cpp"},
    "stb": {"io/images/stb_picture.cpp"},
    "OpenEXR": {"io/images/exr_file.cpp", "io/truth/truth_files.cpp"},
    "zlib": {"io/files/earth_map_file.cpp", "io/gige/device/gige_zip.cpp", "io/gige/face/unzip.cpp", "io/system/crc32.cpp"},
    "httplib": {"io/preview/sink_preview.cpp"},
    "google": {"io/vizard/vizard_message.cpp"},
    "vizard.pb": {"io/vizard/vizard_message.cpp"},
    "zmq": {"io/vizard/reply_socket.cpp"},
    "hwy": {"render/ground/crater_shape.cpp", "render/ground/double_lanes-inl.h", "render/ground/relief_noise.cpp", "render/shading/cluster_packet.cpp",
            "render/lod/coverage_map_sums.cpp", "render/ground_shading/ground_packet.cpp", "render/visibility/fragment_packet.cpp",
            "render/visibility/lane_vectors-inl.h", "render/visibility/sixteen_lanes-inl.h",
            "render/visibility/rolling_raster.cpp", "render/visibility/triangle_lanes-inl.h", "render/visibility/visibility_raster.cpp", "render/visibility/visibility_tile.cpp", "sensor/convolution/fourier.cpp",
            "sensor/convolution/moment_rows.cpp", "sensor/convolution/point_tables.cpp"},
    "gdal": GDAL_FILES,
    "ogr_": GDAL_FILES,
    "cpl_": GDAL_FILES,
    "libaec": {"io/packets/payload_ccsds_121.cpp"},
    "charls": {"io/packets/payload_jpeg_ls.cpp"},
    "openjpeg": {"io/packets/payload_jpeg_2000.cpp"},
    "seccomp": {"io/system/confinement.cpp"},
    "libusb": {"io/commands/command_link_usb.cpp", "io/commands/commands_usb.cpp", "io/commands/usb_device.cpp"},
    "erfa": {"render/sky/bodies.cpp", "render/sky/earth_frames.cpp", "render/sky/stars.cpp", "render/vocabulary/time.cpp",
             "render/vocabulary/time_system.cpp"},
}
ONLY_IN_LAYER = {"CLI": "emulator", "spdlog": "emulator"}


def includes(path):
    return re.findall(r'^#include ["<]([^">]+)[">]', path.read_text(), re.MULTILINE)


def fault_of_include(name, room, target):
    """What is wrong with an include of a file in a room, or None."""
    to = str(pathlib.PurePosixPath(target).parent)
    if target.split("/")[0] in LAYERS:
        if not (TOP / target).is_file():
            return f"{name} includes {target}, which is not there"
        if to in ROOMS and ROOMS.index(to) < ROOMS.index(room):
            return f"{name} includes {target}, which lies above it"
    for library, allowed in ONLY_IN.items():
        if target.split("/")[0].startswith(library) and name not in allowed:
            return f"{name} includes {target}; only {', '.join(sorted(allowed))} may"
    for library, layer in ONLY_IN_LAYER.items():
        if target.startswith(library + "/") and not name.startswith(layer + "/"):
            return f"{name} includes {target}; only {layer}/ may"
    return None


def faults_of_table(layer):
    """What is wrong with the table of rooms in a layer's README.md; it lists them in the order of ROOMS, or there is none."""
    rows = re.findall(r"^\| \[([^\]]+)/\]\(", (TOP / layer / "README.md").read_text(), re.MULTILINE)
    rooms = [room[len(layer) + 1:] for room in ROOMS if room.startswith(layer + "/")]
    return [f"{layer}/README.md: its table has the rooms {', '.join(rows)}; ROOMS has {', '.join(rooms)}"] if rows and rows != rooms else []


def circle(graph):
    """Files that include each other in a circle, or an empty list."""
    try:
        graphlib.TopologicalSorter(graph).prepare()
        return []
    except graphlib.CycleError as error:
        return error.args[1]


def main():
    files = sorted(p for layer in LAYERS for p in (TOP / layer).rglob("*")
                   if p.suffix in (".h", ".cpp") and p.parent.relative_to(TOP).as_posix() not in FROM_ELSEWHERE)
    faults, arrows, filled, graph = [], set(), Counter(), {}
    for path in files:
        name, room = path.relative_to(TOP).as_posix(), path.parent.relative_to(TOP).as_posix()
        if room not in ROOMS:
            faults.append(f"{name}: no such room in the order of {pathlib.Path(__file__).name}")
            continue
        filled[room] += 1
        graph[name] = includes(path)
        for target in graph[name]:
            to = str(pathlib.PurePosixPath(target).parent)
            if to in ROOMS and to != room:
                arrows.add((room, to))
            fault = fault_of_include(name, room, target)
            if fault:
                faults.append(fault)
    for room in ROOMS:
        if filled[room] == 0:
            faults.append(f"{room}: nothing in it")
        if not (TOP / room / "README.md").is_file():
            faults.append(f"{room}: no README.md")
    for layer in LAYERS:
        faults += faults_of_table(layer)
    around = circle(graph)
    if around:
        faults.append("a circle of includes: " + " -> ".join(around))
    lines = sorted((len(p.read_text().splitlines()), p.relative_to(TOP).as_posix()) for p in files)
    up = sum(ROOMS.index(to) < ROOMS.index(room) for room, to in arrows)
    fullest = max(filled, key=filled.get)
    print(f"{len(files)} files in {len(filled)} rooms, {len(arrows)} arrows between rooms, {up} of them upwards, "
          f"{'no' if not around else 'at least one'} circle; biggest room {fullest} ({filled[fullest]} files); lines: median {statistics.median(n for n, _ in lines):.0f}, most {lines[-1][0]} ({lines[-1][1]})")
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


main()
