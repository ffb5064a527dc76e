#!/usr/bin/python3
"""Aravis as the client of a camera with another's face: opens it, reads every feature, and works with it by the vendor's names.

    face_client.py ADDRESS [BLACK]

BLACK: what no light gives, as a share of full scale. A process of its own: a client that crashes is a result, too. Prints JSON
on one line.
"""
import json
import math
import re
import sys
import time

import gi

gi.require_version("Aravis", "0.8")
from gi.repository import Aravis, GLib  # noqa: E402

FRAME_TIMEOUT_US = 5_000_000


# --- every feature

def walk(genicam, name="Root", seen=None):
    """Names of the features that categories lead to, in the description's order."""
    seen = set() if seen is None else seen
    node = genicam.get_node(name)
    if node is None or name in seen:
        return
    seen.add(name)
    if isinstance(node, Aravis.GcCategory):
        for below in node.get_features():
            yield from walk(genicam, below, seen)
    else:
        yield name


def limit(read, otherwise):
    """A limit, or what holds where the description gives none."""
    try:
        return read()
    except GLib.Error as error:
        if "node not found" in error.message:
            return otherwise
        raise


SINGLE = re.compile(r"(Offset[XY]|Binning\w+|\w*Selector)$")  # may have a range of one value


def number_wrong(node, value, name):
    """Why a number with limits is not one that a camera would show; empty: it is right."""
    low, high = limit(node.get_min, -math.inf), limit(node.get_max, math.inf)
    whole = isinstance(node, Aravis.GcInteger) and not isinstance(node, Aravis.GcFloat)
    if not math.isfinite(value):
        return f"{value}"
    slack = 1e-6 * max(1.0, abs(value))
    if not low - slack <= value <= high + slack:
        return f"{value:g} is not within {low:g} to {high:g}"
    if whole and limit(node.get_inc, 1) < 1:
        return f"steps of {node.get_inc()}"
    # Limits that the description itself gives may be equal.
    given = node.get_actual_access_mode() != Aravis.GcAccessMode.RW or SINGLE.match(name) or "Max" in fixed(node)
    return f"a range of {low:g} to {high:g}" if low == high and not given else ""


def fixed(node):
    """The limits that are numbers in the description, as tags."""
    found, at = [], node.get_first_child()
    while at is not None:
        found.append(at.get_node_name())
        at = at.get_next_sibling()
    return found


def wrong(node, name):
    if isinstance(node, Aravis.GcEnumeration):
        text = node.get_string_value()
        return "" if text else f"no entry has its value {node.get_int_value()}"
    if isinstance(node, Aravis.GcBoolean):
        node.get_value()
        return ""
    if isinstance(node, Aravis.GcString):
        text = node.get_value()
        return "" if text is not None and text.isprintable() else f"{text!r}"
    if isinstance(node, (Aravis.GcFloat, Aravis.GcInteger)):
        return number_wrong(node, node.get_value(), name)
    return None  # a register, a command


def read_features(genicam):
    result = {"available": 0, "read": 0, "absent": 0, "wrong": {}}
    for name in walk(genicam):
        node = genicam.get_node(name)
        try:
            if not node.is_implemented() or not node.is_available():
                result["absent"] += 1
                continue
            if isinstance(node, Aravis.GcCommand) or node.get_actual_access_mode() == Aravis.GcAccessMode.WO:
                continue
            why = wrong(node, name)
        except GLib.Error as error:
            # What is in a chunk or in an event's data has no value now.
            if "chunk" in error.message.lower() or "event" in error.message.lower() or name.startswith(("Chunk", "Event")):
                continue
            why = error.message
        if why is None:
            continue
        result["available"] += 1
        if why:
            result["wrong"][name] = why
        else:
            result["read"] += 1
    return result


# --- what the picture does

class Client:
    def __init__(self, address):
        begin = time.monotonic()
        self.camera = Aravis.Camera.new(address)
        self.device = self.camera.get_device()
        self.open_s = time.monotonic() - begin
        self.genicam = self.device.get_genicam()
        # Aravis's ring of raw packets loses some of the loopback's on a busy machine.
        self.camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)

    def has(self, *names):
        """Returns the first name that the description has and makes available."""
        for name in names:
            node = self.genicam.get_node(name)
            try:
                if node is not None and node.is_implemented() and node.is_available():
                    return name
            except GLib.Error:
                continue
        return None

    def set(self, name, value):
        node = self.genicam.get_node(name)
        if isinstance(node, Aravis.GcEnumeration):
            node.set_string_value(value)
        elif isinstance(node, Aravis.GcFloat):
            node.set_value(float(value))
        elif isinstance(node, Aravis.GcBoolean):
            node.set_value(bool(value))
        else:
            node.set_value(int(value))

    def get(self, name):
        node = self.genicam.get_node(name)
        return node.get_string_value() if isinstance(node, Aravis.GcEnumeration) else node.get_value()

    def execute(self, name):
        self.genicam.get_node(name).execute()

    def entries(self, name):
        return list(self.genicam.get_node(name).dup_available_string_values() or ())

    def frames(self, count, between=None, timeout_us=FRAME_TIMEOUT_US, tries=3):
        """Takes frames with the vendor's own AcquisitionStart; between(i) is called before each is awaited."""
        stream = self.camera.create_stream(None, None)
        payload = self.camera.get_payload()
        for _ in range(count + 2):
            stream.push_buffer(Aravis.Buffer.new_allocate(payload))
        self.locked(1)
        self.execute("AcquisitionStart")
        taken = []
        try:
            for i in range(count * tries):
                if len(taken) == count:
                    break
                if between:
                    between(i)
                buffer = stream.timeout_pop_buffer(timeout_us)
                if buffer is None:
                    break
                if buffer.get_status() == Aravis.BufferStatus.SUCCESS:
                    taken.append(picture(buffer))
                stream.push_buffer(buffer)
        finally:
            self.execute("AcquisitionStop")
            self.locked(0)
            del stream
        return taken

    def locked(self, yes):
        """Aravis locks the parameters around an acquisition that its own functions start."""
        if self.genicam.get_node("TLParamsLocked") is not None:
            try:
                self.set("TLParamsLocked", yes)
            except GLib.Error:
                pass

    def mean(self):
        """Mean of the second frame: the first may have begun before the change."""
        return self.frames(3)[-1]["mean"]


def picture(buffer):
    width, height = buffer.get_image_width(), buffer.get_image_height()
    code = buffer.get_image_pixel_format()
    data = buffer.get_image_data() if hasattr(buffer, "get_image_data") else buffer.get_data()
    bits = code >> 16 & 0xFF
    pixels = width * height
    plain = bytes(data)[:(pixels * bits + 7) // 8]
    return {"width": width, "height": height, "format": code, "bytes": len(plain), "wanted": (pixels * bits + 7) // 8,
            "mean": mean_of(plain, code, pixels)}


def mean_of(data, code, pixels):
    """Mean of a picture's samples, as a share of full scale where it is not of one or two bytes."""
    bits = code >> 16 & 0xFF
    if bits == 16:
        depth = {0x01100003: 10, 0x01100005: 12, 0x01100025: 14}.get(code, 16)
        samples = memoryview(data).cast("H")
        return sum(samples[::7]) / len(samples[::7]) / (1 << depth)
    if bits == 12:  # GigE Vision's packing and PFNC's differ in the lower bits alone for a mean of the upper ones
        upper = data[0::3] + data[2::3] if code in (0x010C0004, 0x010C0006) else data[1::3]
        return sum(upper) / max(1, len(upper)) / 256
    return sum(data[::5]) / max(1, len(data[::5])) / 256


def chosen_format(client):
    """The format of most bits that mean_of() knows."""
    best = ("Mono16", "Mono14", "Mono12", "Mono10", "Mono8")
    entries = client.entries("PixelFormat")
    for name in best + tuple(entries):
        if name in entries:
            try:
                client.set("PixelFormat", name)
                return name
            except GLib.Error:
                continue
    return None


def prepare(client):
    if client.has("TriggerSelector") and "FrameStart" in client.entries("TriggerSelector"):
        client.set("TriggerSelector", "FrameStart")
    if client.has("TriggerMode"):
        client.set("TriggerMode", "Off")
    if client.has("AcquisitionMode") and "Continuous" in client.entries("AcquisitionMode"):
        client.set("AcquisitionMode", "Continuous")
    return chosen_format(client)


def exposure(client, result, black):
    name = client.has("ExposureTime", "ExposureTimeAbs", "ExposureTimeRaw")
    if not name:
        return shutter(client, result, black)
    node = client.genicam.get_node(name)
    short = max(node.get_min(), 150.0)
    means = []
    for factor in (1, 3):
        client.set(name, short * factor)
        means.append(client.mean() - black)
        took = client.get(name)
    result["exposure_ratio"] = round(means[1] / max(means[0], 1e-9) / (took / short), 3)
    client.set(name, short)
    return "yes" if abs(result["exposure_ratio"] - 1) < 0.06 else "no"


def shutter(client, result, black):
    """An exposure by a list of times, as Shutter1_100 is 1/100 s."""
    name = client.has("Shutter")
    if not name:
        return "none"
    times = {entry: int(part[0]) / int(part[1]) for entry in client.entries(name)
             if len(part := re.findall(r"\d+", entry)) == 2}
    short, longer = sorted((t for t in times if times[t] > 0.00025), key=times.get)[:2]  # enough light for 8 bits
    means = []
    for entry in (short, longer):
        client.set(name, entry)
        means.append(client.mean() - black)
    client.set(name, short)
    result["exposure_ratio"] = round(means[1] / max(means[0], 1e-9) / (times[longer] / times[short]), 3)
    return "yes" if abs(result["exposure_ratio"] - 1) < 0.06 else "no"


def gain(client, result, black):
    name = client.has("Gain", "GainAbs", "GainRaw")
    if not name:
        return "none"
    node = client.genicam.get_node(name)
    low, high = node.get_min(), node.get_max()
    unit = (node.get_unit() if hasattr(node, "get_unit") else None) or ""
    if unit.lower() != "db" and low == 1 and high < 100 and name != "GainRaw":
        more, factor = 2.0, 2.0  # a factor
    elif name == "GainRaw" and low > 0:
        more = low + (high - low) // 4  # steps over hilcam's range of 24 dB
        factor = 10 ** (24 * (more - low) / (high - low) / 20)
    elif name == "GainRaw" and high > 100:
        more = low + (high - low) // 4
        factor = 10 ** (24 * (more - low) / (high - low) / 20)
    else:
        more, factor = min(high, low + 6), 10 ** (min(high - low, 6) / 20)
    means = []
    for value in (low, more):
        client.set(name, value)
        means.append(client.mean() - black)
    client.set(name, low)
    result["gain_ratio"] = round(means[1] / max(means[0], 1e-9) / factor, 3)
    return "yes" if abs(result["gain_ratio"] - 1) < 0.08 else "no"


def window(client, result):
    width = client.genicam.get_node("Width")
    height = client.genicam.get_node("Height")
    full = (width.get_value(), height.get_value())
    grain = math.lcm(max(1, width.get_inc()), 8)
    wanted = (max(width.get_min(), full[0] // 2 // grain * grain),
              max(height.get_min(), full[1] // 2 // max(1, height.get_inc()) * max(1, height.get_inc())))
    if wanted[0] > full[0]:
        wanted = full
    client.set("Width", wanted[0])
    client.set("Height", wanted[1])
    frame = client.frames(1)
    ok = bool(frame) and (frame[0]["width"], frame[0]["height"]) == wanted and frame[0]["bytes"] == frame[0]["wanted"]
    client.set("Width", full[0])
    client.set("Height", full[1])
    result["window"] = [*full, *wanted]
    return "yes" if ok else "no"


def trigger(client, result):
    if not client.has("TriggerMode") or not client.genicam.get_node("TriggerSoftware"):
        return "none"
    client.set("TriggerMode", "On")
    if client.has("TriggerSource"):
        entries = client.entries("TriggerSource")
        software = next((e for e in entries if "oftware" in e), None)
        if software:
            client.set("TriggerSource", software)
    frames = client.frames(3, between=lambda i: (time.sleep(0.15), client.execute("TriggerSoftware")), timeout_us=1_500_000)
    silent = client.frames(1, timeout_us=400_000, tries=1)
    client.set("TriggerMode", "Off")
    result["triggered"] = [len(frames), len(silent)]
    return "yes" if len(frames) == 3 and not silent else "no"


def formats(client, result):
    good, bad = [], []
    before = client.get("PixelFormat")
    for name in client.entries("PixelFormat"):
        try:
            client.set("PixelFormat", name)
            frame = client.frames(1)
            right = frame and frame[0]["bytes"] == frame[0]["wanted"] and client.get("PixelFormat") == name
            (good if right else bad).append(name)
        except GLib.Error as error:
            bad.append(f"{name}: {error.message}")
    client.set("PixelFormat", before)
    result["formats"], result["formats_refused"] = good, bad
    return "yes" if good else "no"


def main(address, black):
    client = Client(address)
    result = {"open_s": round(client.open_s, 2), "xml_kb": round(len(client.device.get_genicam_xml()[0]) / 1000)}
    result.update(read_features(client.genicam))
    acts = {}
    result["pixel_format"] = prepare(client)
    for what, act in (("start", lambda: "yes" if len(client.frames(3)) == 3 else "no"),
                      ("window", lambda: window(client, result)), ("exposure", lambda: exposure(client, result, black)),
                      ("gain", lambda: gain(client, result, black)), ("trigger", lambda: trigger(client, result)),
                      ("format", lambda: formats(client, result))):
        try:
            acts[what] = act()
        except (GLib.Error, TypeError, AttributeError, IndexError) as error:
            acts[what] = "no: " + str(error)
    result["acts"] = acts
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 0.0)
