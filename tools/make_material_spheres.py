#!/usr/bin/python3
"""Makes docs/materials.png: a sphere of each material of configs/materials, side by side, as a colour camera sees them.

    tools/make_material_spheres.py [HILCAM]        default: build/release/bin/hilcam

Needs Python's standard library alone. Prints the materials in the picture's order.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
COLUMNS, SPACING_M, RADIUS_M = 5, 1.15, 0.5
RINGS, SEGMENTS = 64, 128
CAMERA_M, SUN_ANGLE_DEG = 30.0, 40.0  # how far away; between the Sun, which is near +x at an equinox, and the camera
TILE_PX = 88


def materials():
    """Names of the files that are one material."""
    return sorted(path.stem for path in (SOURCE / "configs/materials").glob("*.yaml") if "\nsurfaces:" not in "\n" + path.read_text())


def sphere(centre, name, first):
    """Lines of Wavefront OBJ. first: the number of its first vertex."""
    lines = [f"usemtl {name}"]
    for ring in range(RINGS + 1):
        polar = math.pi * ring / RINGS
        for segment in range(SEGMENTS):
            turn = 2 * math.pi * segment / SEGMENTS
            normal = (math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar))
            lines.append("v " + " ".join(f"{c + RADIUS_M * n:.6f}" for c, n in zip(centre, normal)))
            lines.append("vn " + " ".join(f"{n:.6f}" for n in normal))
    for ring in range(RINGS):
        for segment in range(SEGMENTS):
            a, b = (first + ring * SEGMENTS + s for s in (segment, (segment + 1) % SEGMENTS))
            lines.append("f " + " ".join(f"{v}//{v}" for v in (a, a + SEGMENTS, b + SEGMENTS, b)))
    return lines


def main():
    hilcam = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else SOURCE / "build/release/bin/hilcam").resolve()
    names = materials()
    rows = -(-len(names) // COLUMNS)
    angle = math.radians(SUN_ANGLE_DEG)
    right = (-math.sin(angle), math.cos(angle), 0.0)  # in the picture, of a camera that looks back along its own direction
    lines, first = [], 1
    for i, name in enumerate(names):
        across, up = ((i % COLUMNS) - (COLUMNS - 1) / 2) * SPACING_M, ((rows - 1) / 2 - i // COLUMNS) * SPACING_M
        lines += sphere((across * right[0], across * right[1], up), name, first)
        first += (RINGS + 1) * SEGMENTS
    width, height = COLUMNS * TILE_PX, rows * TILE_PX
    pitch_um = 7.4
    scenario = {
        "name": "materials", "time_utc": "2026-03-20T14:00:00Z", "seed": 1,
        "origin": {"kind": "earth_fixed", "longitude_deg": -120, "latitude_deg": 0, "height_km": 35786},
        "camera": str(SOURCE / "configs/cameras/msl_mardi.yaml"),
        "camera_pose": {"position_m": [CAMERA_M * math.cos(angle), CAMERA_M * math.sin(angle), 0], "attitude": "look_at",
                        "look_at_m": [0, 0, 0], "up": [0, 0, 1]},
        "objects": [{"name": "spheres", "mesh": "spheres.obj", "materials": {"surfaces": [
            {"name": name, "material": str(SOURCE / f"configs/materials/{name}.yaml")} for name in names]}}],
        "spectrum_edges_um": [0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70],
        "quality": str(SOURCE / "configs/quality/still.yaml")}
    sets = {"camera.width_px": width, "camera.height_px": height, "camera.exposure_ms": 0.3,
            "camera.focal_length_mm": round(CAMERA_M * TILE_PX * pitch_um / SPACING_M / 1000, 3)}
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "spheres.obj").write_text("\n".join(lines) + "\n")
        file = pathlib.Path(folder) / "materials.yaml"
        file.write_text(json.dumps(scenario))  # which is YAML, too
        command = [str(hilcam), "render", str(file), "--out", folder + "/numbers.png", "--view", str(SOURCE / "docs/materials.png")]
        for key, value in sets.items():
            command += ["--set", f"{key}={value}"]
        subprocess.run(command, check=True)
    for begin in range(0, len(names), COLUMNS):
        print(", ".join(names[begin:begin + COLUMNS]))


if __name__ == "__main__":
    main()
