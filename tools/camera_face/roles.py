"""The features that hilcam acts on, by the names that vendors give them (SFNC 1.x and 2.x, and older ones)."""
import dataclasses
import math
import re


@dataclasses.dataclass(frozen=True)
class Role:
    feature: str  # hilcam's (docs/genicam.md)
    names: tuple
    kind: str = "number"  # number, choice, switch, command
    unit: str = ""  # what hilcam counts in
    selector: str = ""
    limits: bool = False  # hilcam knows its least and largest value


ROLES = (
    Role("SensorWidth", ("SensorWidth",)), Role("SensorHeight", ("SensorHeight",)),
    Role("BinningHorizontal", ("BinningHorizontal",), selector="BinningSelector", limits=True),
    Role("BinningVertical", ("BinningVertical",), selector="BinningSelector", limits=True),
    Role("OffsetX", ("OffsetX",), limits=True), Role("OffsetY", ("OffsetY",), limits=True),
    Role("WidthMax", ("WidthMax",)), Role("HeightMax", ("HeightMax",)),
    Role("Width", ("Width",), limits=True), Role("Height", ("Height",), limits=True),
    Role("ReverseX", ("ReverseX",), "switch"), Role("ReverseY", ("ReverseY",), "switch"),
    Role("PixelFormat", ("PixelFormat",), "choice"),
    Role("PayloadSize", ("PayloadSize",)),
    Role("AcquisitionMode", ("AcquisitionMode",), "choice"),
    Role("AcquisitionStart", ("AcquisitionStart",), "command"),
    Role("AcquisitionStop", ("AcquisitionStop",), "command"),
    Role("AcquisitionAbort", ("AcquisitionAbort",), "command"),
    Role("AcquisitionFrameCount", ("AcquisitionFrameCount",), limits=True),
    Role("ExposureAuto", ("ExposureAuto",), "choice"),
    Role("ExposureTime", ("ExposureTime", "ExposureTimeAbs", "ExposureTimeRaw", "Shutter"), unit="us", limits=True),
    Role("AcquisitionFrameRate", ("AcquisitionFrameRate", "AcquisitionFrameRateAbs"), unit="Hz", limits=True),
    Role("AcquisitionResultingFrameRate", ("AcquisitionResultingFrameRate", "ResultingFrameRate", "ResultingFrameRateAbs",
                                           "BslResultingAcquisitionFrameRate"), unit="Hz"),
    Role("Gain", ("Gain", "GainAbs", "GainRaw"), unit="dB", selector="GainSelector", limits=True),
    Role("BlackLevel", ("BlackLevel", "BlackLevelRaw"), unit="DN", selector="BlackLevelSelector", limits=True),
    Role("TriggerSource", ("TriggerSource",), "choice", selector="TriggerSelector"),
    Role("TriggerActivation", ("TriggerActivation",), "choice", selector="TriggerSelector"),
    Role("TriggerDelay", ("TriggerDelay", "TriggerDelayAbs"), unit="us", selector="TriggerSelector", limits=True),
    Role("TriggerMode", ("TriggerMode",), "choice", selector="TriggerSelector"),
    Role("TriggerSoftware", ("TriggerSoftware",), "command", selector="TriggerSelector"),
    Role("ChunkModeActive", ("ChunkModeActive",), "switch"),
    Role("ChunkEnable", ("ChunkEnable",), "switch", selector="ChunkSelector"),
    Role("DeviceTemperature", ("DeviceTemperature", "TemperatureAbs"), unit="C", selector="DeviceTemperatureSelector", limits=True),
    Role("PtpEnable", ("PtpEnable", "GevIEEE1588"), "switch"),
    Role("PtpDataSetLatch", ("PtpDataSetLatch", "GevIEEE1588DataSetLatch"), "command"),
    Role("PtpStatus", ("PtpStatus", "GevIEEE1588StatusLatched", "GevIEEE1588Status"), "choice"),
    Role("PtpOffsetFromMaster", ("PtpOffsetFromMaster", "GevIEEE1588OffsetFromMaster"), unit="ns"),
    Role("TLParamsLocked", ("TLParamsLocked",)),
    Role("DeviceReset", ("DeviceReset",), "command"),
    Role("UserSetSelector", ("UserSetSelector",), "choice"),
    Role("UserSetLoad", ("UserSetLoad",), "command"), Role("UserSetSave", ("UserSetSave",), "command"),
)
# What a formula of a register may be: what depends on nothing else that changes.
COMPUTED = ("SensorWidth", "SensorHeight", "WidthMax", "HeightMax", "DeviceTemperature", "AcquisitionResultingFrameRate")
COUNTED = ("SensorWidth", "SensorHeight", "WidthMax", "HeightMax", "Width", "Height", "OffsetX", "OffsetY", "PayloadSize",
           "BinningHorizontal", "BinningVertical", "AcquisitionFrameCount", "TLParamsLocked")
KNIVES = ("SwissKnife", "IntSwissKnife")
BY_NAME = {name: role for role in ROLES for name in role.names}

# The entry of a selector that hilcam's single feature is, best first; where none is there, the first one.
PREFERRED = {"GainSelector": ("All", "AnalogAll", "Analog", "DigitalAll"), "BlackLevelSelector": ("All", "AnalogAll", "DigitalAll"),
             "BinningSelector": ("All", "Sensor", "Region0"), "DeviceTemperatureSelector": ("Sensor", "Coreboard", "Mainboard")}
# Entries of selectors whose features hilcam has once for each entry.
SELECTED = {"TriggerSelector": {"FrameStart": "FrameStart", "AcquisitionStart": "AcquisitionStart",
                                "FrameBurstStart": "FrameBurstStart"},
            "ChunkSelector": {"FrameID": "FrameID", "Framecounter": "FrameID", "FrameCounter": "FrameID",
                              "Timestamp": "Timestamp", "ExposureTime": "ExposureTime", "Gain": "Gain", "GainAll": "Gain",
                              "BlackLevel": "BlackLevel", "OffsetX": "OffsetX", "OffsetY": "OffsetY", "Width": "Width",
                              "Height": "Height", "PixelFormat": "PixelFormat"}}
# What hilcam can say in a chunk: its chunk, the unit, and the vendors' names of the value.
CHUNKS = (
    ("FrameID", "", ("ChunkFrameID", "ChunkFramecounter", "ChunkFrameCounter")), ("Timestamp", "", ("ChunkTimestamp",)),
    ("ExposureTime", "us", ("ChunkExposureTime",)), ("Gain", "dB", ("ChunkGain", "ChunkGainAll")),
    ("BlackLevel", "DN", ("ChunkBlackLevel",)), ("OffsetX", "", ("ChunkOffsetX",)), ("OffsetY", "", ("ChunkOffsetY",)),
    ("Width", "", ("ChunkWidth",)), ("Height", "", ("ChunkHeight",)), ("PixelFormat", "", ("ChunkPixelFormat",)),
)
# Entries of choices under other names than hilcam's.
ENTRIES = {
    "PixelFormat": {"RGB8Packed": "RGB8", "YUYVPacked": "YUV422_8", "YUV422_YUYV_Packed": "YUV422_8"},
    "TriggerSource": {"SWTrigger": "Software", "SoftwareTrigger": "Software", "Software0": "Software", "Action": "Action1",
                      "Action0": "Action1", "Trigger": "Line0", "FixedRate": None, "Freerun": None, "All": None},
    "AcquisitionMode": {"SingleFrame": "SingleFrame", "MultiFrame": "MultiFrame", "Continous": "Continuous"},
    "TriggerActivation": {"RisingEdge": "RisingEdge", "FallingEdge": "FallingEdge", "AnyEdge": "AnyEdge"},
    "TriggerMode": {"On": "On", "Off": "Off"},
    "UserSetSelector": {"Factory": "Default", "Default": "Default", "UserSet1": "UserSet1", "UserSet2": "UserSet2",
                        "User1": "UserSet1", "User2": "UserSet2", "UserSet0": "UserSet1"},
}
MONO = ("Mono8", "Mono10", "Mono12", "Mono14", "Mono16", "Mono10Packed", "Mono12Packed", "Mono10p", "Mono12p", "RGB8")
COLOUR = ("8", "10", "12", "12Packed", "16")
UNITS = {"ns": 1e-3, "us": 1.0, "µs": 1.0, "ms": 1e3, "s": 1e6, "sec": 1e6, "seconds": 1e6}


class Camera:
    """What a camera file says of the camera behind the face: the values at the start, and the limits."""

    def __init__(self, values):
        number = lambda key, default: float(values.get(key, default))  # noqa: E731
        self.width, self.height = int(number("width_px", 0)), int(number("height_px", 0))
        self.bits = int(number("bits", 8))
        mosaic = values.get("color_filter")
        rows = str(mosaic.get("pattern", "") if isinstance(mosaic, dict) else "").split()
        self.pattern = "".join(rows) if len(rows) == 2 else ""
        self.formats = tuple(f"Bayer{self.pattern[:2]}{end}" for end in COLOUR) + ("RGB8", "YUV422_8") if self.pattern else MONO
        bits = next(b for b in (8, 10, 12, 14, 16) if self.bits <= b)
        self.native = f"Bayer{self.pattern[:2]}{16 if bits == 14 else bits}" if self.pattern else f"Mono{bits}"
        span = lambda key, default: [float(x) for x in values.get(key, default)]  # noqa: E731
        exposure, gain, rate = span("exposure_range_ms", (0.001, 10000)), span("gain_range_db", (0, 24)), \
            span("frame_rate_range_hz", (0.01, 200))
        binning = 1
        while not self.pattern and binning < 8 and 8 * binning <= min(self.width, self.height):
            binning *= 2
        full = 2 ** self.bits - 1
        self.values = {
            "SensorWidth": self.width, "SensorHeight": self.height, "WidthMax": self.width, "HeightMax": self.height,
            "Width": self.width, "Height": self.height, "OffsetX": 0, "OffsetY": 0, "BinningHorizontal": 1,
            "BinningVertical": 1, "ReverseX": 0, "ReverseY": 0, "PixelFormat": self.native,
            "PayloadSize": self.width * self.height * (1 if bits == 8 else 2), "AcquisitionMode": "Continuous",
            "AcquisitionFrameCount": 1, "ExposureAuto": "Off", "ExposureTime": 1000 * number("exposure_ms", 1),
            "AcquisitionFrameRate": number("frame_rate_hz", 10), "AcquisitionResultingFrameRate": number("frame_rate_hz", 10),
            "Gain": number("gain_db", 0), "BlackLevel": number("offset_dn", 0), "TriggerSource": "Software",
            "TriggerActivation": "RisingEdge", "TriggerDelay": 0, "TriggerMode": "Off", "ChunkModeActive": 0, "ChunkEnable": 0,
            "DeviceTemperature": number("temperature_c", 20), "PtpEnable": 0, "PtpStatus": "Disabled",
            "PtpOffsetFromMaster": 0, "TLParamsLocked": 0, "UserSetSelector": "Default",
        }
        self.limits = {
            "Width": (1, self.width), "Height": (1, self.height), "OffsetX": (0, 0), "OffsetY": (0, 0),
            "BinningHorizontal": (1, binning), "BinningVertical": (1, binning), "AcquisitionFrameCount": (1, 65535),
            "ExposureTime": (1000 * exposure[0], 1000 * exposure[1]), "AcquisitionFrameRate": tuple(rate), "Gain": tuple(gain),
            "BlackLevel": (0, 2 ** self.bits / 4), "TriggerDelay": (0, 1e7),
            "DeviceTemperature": (-273.15, 1000),
        }
        self.full_scale = full


def entry_of(feature, name, camera):
    """Returns hilcam's entry for a vendor's; None: hilcam has no such."""
    known = ENTRIES.get(feature, {})
    if name in known:
        name = known[name]
    elif feature == "TriggerSource" and re.fullmatch(r"(Line|Input|LineIn|CC|In)_?\d+", name):
        name = "Line0"
    elif feature == "UserSetSelector":
        return None
    if feature == "PixelFormat":
        return name if name in camera.formats else None
    if feature == "AcquisitionMode" and name not in ("Continuous", "SingleFrame", "MultiFrame"):
        return None
    if feature in ("TriggerMode", "TriggerActivation") and name not in known:
        return None
    if feature == "ExposureAuto" and name not in ("Off", "Once", "Continuous"):
        return None
    if feature == "TriggerSource" and name not in ("Software", "Line0", "Action1"):
        return None
    return name


def number_of_entry(role, name, camera):
    """Returns hilcam's number for an entry of a list (Binning2, Shutter1_100); None: it is out of hilcam's range."""
    digits = re.findall(r"\d+", name)
    if role.unit != "us":
        return int(digits[0]) if digits else 1
    if len(digits) != 2 or int(digits[1]) == 0:
        return None
    least, most = camera.limits[role.feature]
    time_us = 1e6 * int(digits[0]) / int(digits[1])  # as shutter times are written, 1/100 s
    return time_us if least <= time_us <= most else None


def to_hilcam(role, node_name, unit, least, most, camera):
    """Returns the function from a vendor's number to hilcam's, and back."""
    same = (lambda v: v, lambda v: v)
    if role.unit == "us" and unit:
        factor = UNITS.get(unit.strip().lower(), 1.0)
        return (lambda v: v * factor, lambda v: v / factor)
    if role.feature in ("OffsetX", "OffsetY") and least == 1:  # counted from 1
        return (lambda v: v - 1, lambda v: v + 1)
    if role.feature == "BlackLevel" and unit.lower() in ("%", "percent"):
        factor = camera.full_scale / 100
        return (lambda v: v * factor, lambda v: v / factor)
    if role.feature == "Gain" and unit.lower() != "db":
        low, high = camera.limits["Gain"]
        if least == 1 and node_name != "GainRaw":  # a factor
            return (lambda v: 20 * math.log10(v), lambda v: 10 ** (v / 20))
        if node_name == "GainRaw" and least is not None and most is not None and 0 < most - least < 65000 and high > low:
            step = (high - low) / (most - least)  # the vendor's steps, spread over hilcam's range
            return (lambda v: low + (v - least) * step, lambda v: least + (v - low) / step)
    return same
