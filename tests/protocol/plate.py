"""A laboratory's white plate that fills the view of a camera 20 m above it, in one narrow band of light."""

MESH = "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n"


def scene(camera, sun_distance_au):
    """The scenario's text; the mesh is plate.obj beside it."""
    return f"""name: plate
time_utc: 2026-03-20T14:00:00Z
origin: {{kind: free}}
sun: {{direction: [0, 0, 1], distance_au: {sun_distance_au}}}
camera: {camera}
camera_pose: {{position_m: [0, 0, 20], attitude: look_at, look_at_m: [0, 0, 0], up: [0, 1, 0]}}
objects:
  - name: plate
    mesh: plate.obj
    materials: {{surfaces: [{{name: "*", material: {{model: lambert, reflectance: 0.5}}}}]}}
spectrum_edges_um: [0.54, 0.56]
quality: fast
loop: {{levels: fixed}}
"""


def write(folder, camera, sun_distance_au, more=""):
    """Writes plate.yaml and its mesh; returns the scenario's path."""
    (folder / "plate.obj").write_text(MESH)
    (folder / "plate.yaml").write_text(scene(camera, sun_distance_au) + more)
    return folder / "plate.yaml"
