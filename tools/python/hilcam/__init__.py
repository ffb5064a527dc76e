"""hilcam from Python: a bench, its commands, its truth, its campaigns.

    import hilcam
    with hilcam.Bench("lockstep", frames=3) as bench, hilcam.Client(bench.tcp) as camera:
        camera.send(hilcam.Pose(time_tai_ns=bench.start_tai_ns, position_m=(40, 27, 13),
                                attitude_wxyz=hilcam.look_at((40, 27, 13), (0, 0, 0))))
        camera.send(hilcam.Expose(time_tai_ns=bench.start_tai_ns))

    campaign = hilcam.Campaign("poses")
    campaign.column("phase_deg")            # numpy, a number for each case
    campaign.truth(17)[0].objects[0].position_camera_m

Pure Python; what gives arrays needs numpy, and pictures are read with Pillow. docs/python.md is the manual.
"""
import importlib
import typing

from .bench import Bench, BenchFailed
from .client import (Acknowledgement, Client, Expose, Fault, FrameReport, Housekeeping, Joint, Lamp, NoAnswer, Ping, Pose, Refused,
                     Settings, Start, Stop, Subscribe, look_at)
from .times import tai_ns_of_utc, utc_of_tai_ns
from .truth import FrameTruth, read_truth

if typing.TYPE_CHECKING:
    from .campaign import Campaign, Case
    from .conventions import attitude_from_dcm, attitude_from_mrp, dcm_of, mrp_of, rotate
    from .exr import read_exr
    from .masks import mask_of_run_lengths
    from .shm import Overtaken, SharedFrame, SharedFrameReport, SharedFrames, SharedMemoryError

# The version of the hilcam that it belongs to (project() in CMakeLists.txt).
__version__ = "0.3.0"

# What needs numpy, and where it is: loaded when it is asked for, so that a bench and its commands need nothing beside Python.
_WITH_NUMPY = {
    "campaign": ("Campaign", "Case"),
    "conventions": ("attitude_from_dcm", "attitude_from_mrp", "dcm_of", "mrp_of", "rotate"),
    "exr": ("read_exr",),
    "masks": ("mask_of_run_lengths",),
    "shm": ("Overtaken", "SharedFrame", "SharedFrameReport", "SharedFrames", "SharedMemoryError"),
}

__all__ = ["Acknowledgement", "Bench", "BenchFailed", "Campaign", "Case", "Client", "Expose", "Fault", "FrameReport", "FrameTruth",
           "Housekeeping", "Joint", "Lamp", "NoAnswer", "Overtaken", "Ping", "Pose", "Refused", "Settings",
           "SharedFrame", "SharedFrameReport", "SharedFrames", "SharedMemoryError", "Start", "Stop", "Subscribe", "__version__",
           "attitude_from_dcm", "attitude_from_mrp", "dcm_of", "look_at", "mask_of_run_lengths", "mrp_of", "read_exr", "read_truth", "rotate",
           "tai_ns_of_utc", "utc_of_tai_ns"]


def __getattr__(name: str) -> typing.Any:
    for module, names in _WITH_NUMPY.items():
        if name not in names:
            continue
        try:
            return getattr(importlib.import_module("." + module, __name__), name)
        except ModuleNotFoundError as missing:
            if missing.name != "numpy":
                raise
            raise ImportError(f"hilcam.{name} needs numpy: 'pip install numpy', or Debian's python3-numpy") from missing
    raise AttributeError(f"module 'hilcam' has no attribute '{name}'")
