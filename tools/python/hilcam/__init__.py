"""hilcam from Python: a bench, its commands, its truth, its campaigns.

    import hilcam
    with hilcam.Bench("lockstep", frames=3) as bench, hilcam.Client(bench.tcp) as camera:
        camera.send(hilcam.Pose(time_tai_ns=bench.start_tai_ns, position_m=(40, 27, 13),
                                attitude_wxyz=hilcam.look_at((40, 27, 13), (0, 0, 0))))
        camera.send(hilcam.Expose(time_tai_ns=bench.start_tai_ns))

    campaign = hilcam.Campaign("poses")
    campaign.column("phase_deg")            # numpy, a number for each case
    campaign.truth(17)[0].objects[0].position_camera_m

Pure Python with numpy; pictures are read with Pillow, where it is there. docs/python.md is the manual.
"""
from .bench import Bench, BenchFailed
from .campaign import Campaign, Case
from .client import (Acknowledgement, Client, Expose, Fault, FrameReport, Housekeeping, Joint, Lamp, NoAnswer, Ping, Pose, Refused,
                     Settings, Start, Stop, Subscribe, look_at)
from .conventions import (attitude_from_dcm, attitude_from_mrp, dcm_of, mrp_of, rotate, tai_ns_of_utc, utc_of_tai_ns)
from .exr import read_exr
from .masks import mask_of_run_lengths
from .shm import Overtaken, SharedFrame, SharedFrameReport, SharedFrames, SharedMemoryError
from .truth import FrameTruth, read_truth

__all__ = ["Acknowledgement", "Bench", "BenchFailed", "Campaign", "Case", "Client", "Expose", "Fault", "FrameReport", "FrameTruth",
           "Housekeeping", "Joint", "Lamp", "NoAnswer", "Overtaken", "Ping", "Pose", "Refused", "Settings",
           "SharedFrame", "SharedFrameReport", "SharedFrames", "SharedMemoryError", "Start", "Stop", "Subscribe",
           "attitude_from_dcm", "attitude_from_mrp", "dcm_of", "look_at", "mask_of_run_lengths", "mrp_of", "read_exr", "read_truth", "rotate",
           "tai_ns_of_utc", "utc_of_tai_ns"]
