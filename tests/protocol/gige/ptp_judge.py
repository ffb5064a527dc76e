#!/usr/bin/python3
"""Judges a camera's clock from outside: reads it over GVCP between two readings of this machine's clock, whatever the camera says.

    ptp_judge.py CAMERA CLIENT [--enable] [--until STATUS] [--until-steps COUNT] [--until-parent ID] [--settle SECONDS] [--seconds SECONDS] [--clock realtime|tai]

Prints JSON: "samples" of [seconds, offset_ns, half_width_ns] (camera minus machine; the offset is right to the half width), the
names and values of PTP's features after a latch, and how long --until took.
"""
import argparse
import json
import sys
import time

import gvcp_client as g
from genicam_client import Features

CLOCKS = {"realtime": time.CLOCK_REALTIME, "tai": 11}  # CLOCK_TAI (linux/time.h)
LATCHED = """PtpStatus PtpServoStatus PtpOffsetFromMaster PtpMeanPropagationDelay PtpClockID PtpParentClockID
    PtpGrandmasterClockID PtpTimeScale PtpCurrentUtcOffset PtpSteps GevIEEE1588StatusLatched GevIEEE1588OffsetFromMaster
    GevIEEE1588ParentClockId""".split()


def sample(camera, clock):
    """The fastest of some readings, as half the width of the interval is the error."""
    best = None
    for _ in range(8):
        before = time.clock_gettime_ns(clock)
        camera.write_register(g.TIMESTAMP_CONTROL, 2)
        after = time.clock_gettime_ns(clock)
        high, low = camera.read_register(g.TIMESTAMP_HIGH), camera.read_register(g.TIMESTAMP_LOW)
        half = (after - before) // 2
        if best is None or half < best[1]:
            best = ((high << 32 | low) - before - half, half)
    return best


def latched(features, name):
    features.execute("PtpDataSetLatch")
    return features.get(name)


def is_come(name, value, wanted):
    """Steps only count up."""
    return value >= wanted if name == "PtpSteps" else value == wanted


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("camera")
    parser.add_argument("client")
    parser.add_argument("--enable", action="store_true")
    parser.add_argument("--until")
    parser.add_argument("--until-steps", type=int)
    parser.add_argument("--until-parent", type=int)
    parser.add_argument("--settle", type=float, default=0)
    parser.add_argument("--seconds", type=float, default=1)
    parser.add_argument("--clock", choices=CLOCKS, default="realtime")
    a = parser.parse_args()
    with g.GvcpClient(a.camera, a.client) as camera:
        camera.control()
        features = Features(camera)
        if a.enable:
            features.set("PtpEnable", 1)
        begun = time.monotonic()
        wanted = {name: value for name, value in (("PtpSteps", a.until_steps), ("PtpParentClockID", a.until_parent),
                                                  ("PtpStatus", a.until)) if value is not None}
        while name := next((name for name, value in wanted.items() if not is_come(name, latched(features, name), value)), None):
            if time.monotonic() > begun + 60:
                sys.exit(f"{name} is {latched(features, name)} after 60 s, not {wanted[name]}")
            time.sleep(0.1)
            camera.keep_control()
        took = time.monotonic() - begun
        settled = time.monotonic() + a.settle
        while time.monotonic() < settled:
            time.sleep(0.2)
            camera.keep_control()
        samples, begin = [], time.monotonic()
        while time.monotonic() < begin + a.seconds:
            samples.append((time.monotonic() - begin, *sample(camera, CLOCKS[a.clock])))
            time.sleep(0.1)
        features.execute("PtpDataSetLatch")
        camera.release()
        print(json.dumps({"took_s": took, "samples": samples, "features": {name: features.get(name) for name in LATCHED}}))


if __name__ == "__main__":
    main()
