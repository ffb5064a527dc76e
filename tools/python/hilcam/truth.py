"""Truth of frames as dataclasses: docs/truth.md has every value, its axes and its unit; names are the same."""
import dataclasses
import json
import pathlib
from typing import Any, Dict, List, Optional, Tuple, Union

Vector = Tuple[float, float, float]
Quaternion = Tuple[float, float, float, float]


@dataclasses.dataclass(frozen=True)
class Image:
    width_px: int
    height_px: int
    focal_length_px: Tuple[float, float]
    principal_point_px: Tuple[float, float]  # from the corner; OpenCV's are smaller by 0.5
    projection: str
    distortion: Tuple[float, ...]

    @property
    def matrix(self) -> List[List[float]]:
        """The camera matrix, from the corner of the picture."""
        (fx, fy), (cx, cy) = self.focal_length_px, self.principal_point_px
        return [[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]]


@dataclasses.dataclass(frozen=True)
class Thing:
    """An object or a body. What truth was not asked for, or does not know, is None."""
    id: int
    name: str
    position_m: Vector
    position_camera_m: Vector
    distance_m: float
    attitude_wxyz: Optional[Quaternion] = None
    camera_from_body_wxyz: Optional[Quaternion] = None
    phase_rad: Optional[float] = None
    center_px: Optional[Tuple[float, float]] = None
    radius_m: Optional[float] = None
    sunlit_fraction: Optional[float] = None
    visible_px: Optional[int] = None
    visible_box_px: Optional[Tuple[int, int, int, int]] = None
    visible_center_px: Optional[Tuple[float, float]] = None
    silhouette_px: Optional[float] = None
    silhouette_box_px: Optional[Tuple[int, int, int, int]] = None
    silhouette_cut: Optional[bool] = None
    visible_fraction: Optional[float] = None


@dataclasses.dataclass(frozen=True)
class FrameTruth:
    frame: int
    time_tai_ns: int
    time_utc: str
    exposure_s: float
    gain_db: float
    image: Image
    position_m: Vector
    attitude_wxyz: Quaternion
    velocity_m_s: Vector
    rate_rad_s: Vector
    sun_direction: Vector
    sun_direction_camera: Vector
    sun_distance_m: float
    objects: Tuple[Thing, ...]
    bodies: Tuple[Thing, ...]
    raw: Dict[str, Any] = dataclasses.field(repr=False, compare=False, default_factory=dict)  # the line, with all that is not above

    @classmethod
    def of(cls, line: Dict[str, Any]) -> "FrameTruth":
        """From a line of truth that was read as JSON."""
        pose, sun = line["pose"], line["sun"]
        return cls(line["frame"], line["time_tai_ns"], line["time_utc"], line["exposure_s"], line["gain_db"], _chosen(Image, line["image"]),
                   tuple(pose["position_m"]), tuple(pose["attitude_wxyz"]), tuple(pose["velocity_m_s"]), tuple(pose["rate_rad_s"]),
                   tuple(sun["direction"]), tuple(sun["direction_camera"]), sun["distance_m"],
                   tuple(_chosen(Thing, o) for o in line["objects"]), tuple(_chosen(Thing, b) for b in line["bodies"]), line)


def _chosen(kind, values):
    """Fields that later versions add are left out; lists become tuples."""
    known = {field.name for field in dataclasses.fields(kind)}
    return kind(**{k: tuple(v) if isinstance(v, list) else v for k, v in values.items() if k in known})


def read_truth(file: Union[str, pathlib.Path]) -> List[FrameTruth]:
    """The frames of truth.jsonl, or of a picture's FILE.truth.jsonl; the first line, which names the run, is left out."""
    with open(file, encoding="utf-8") as lines:
        return [FrameTruth.of(line) for line in map(json.loads, lines) if "frame" in line]
