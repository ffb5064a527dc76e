#!/usr/bin/python3
"""Includes point downwards only: emulator -> io -> sensor -> render; each third-party header stays in its few units."""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
ORDER = ["render", "sensor", "io", "emulator"]
ONLY_IN = {
    "embree": {"render/scene/embree_scene.cpp"},
    "yaml-cpp": {"io/config/config_yaml.cpp"},
    "assimp": {"io/files/mesh_import.cpp"},
    "fftw3": {"sensor/convolve.cpp", "sensor/psf.cpp", "sensor/zernike.cpp"},
    "opencv2": {"io/files/image_file.cpp", "io/files/kept_stderr.cpp", "io/files/picture_file.cpp", "emulator/tradeoff/structural_similarity.cpp"},
    "httplib": {"io/preview/sink_preview.cpp"},
    "google": {"io/vizard/vizard_message.cpp"},
    "vizard.pb": {"io/vizard/vizard_message.cpp"},
    "zmq": {"io/vizard/commands_vizard.cpp"},
    "libusb": {"io/commands/command_link_usb.cpp", "io/commands/commands_usb.cpp", "io/commands/usb_device.cpp"},
    "erfa": {"render/sky/bodies.cpp", "render/sky/earth_frames.cpp", "render/sky/stars.cpp", "render/vocabulary/time.cpp", "render/vocabulary/time_system.cpp"},
}


def main():
    faults, files = [], 0
    for folder in ORDER:
        for path in sorted(p for p in (TOP / folder).rglob("*") if p.suffix in (".h", ".cpp")):
            files += 1
            name = path.relative_to(TOP).as_posix()
            for line in path.read_text().splitlines():
                match = re.match(r'#include ["<]([^">]+)[">]', line)
                if not match:
                    continue
                target = match.group(1)
                head = target.split("/")[0]
                if head in ORDER and ORDER.index(head) > ORDER.index(folder):
                    faults.append(f"{name} includes {target}, which lies above it")
                for library, allowed in ONLY_IN.items():
                    if head.startswith(library) and name not in allowed:
                        faults.append(f"{name} includes {target}; only {', '.join(sorted(allowed))} may")
    print("\n".join(faults) or f"{files} files, all includes point down")
    sys.exit(1 if faults or files == 0 else 0)


main()
