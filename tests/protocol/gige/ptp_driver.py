#!/usr/bin/python3
"""What the ROS 2 driver camera_aravis2 does about PTP, by Aravis: in the order of its calls (camera_driver_gv.cpp of 2025).

    ptp_driver.py CAMERA [--frames 30]

PtpEnable at the start. Then, at each frame: PtpStatus is read and, when it is Faulty, Disabled, Initializing or Uncalibrated, PtpEnable
goes off and on, PtpDataSetLatch is executed and PtpStatus read again. From Slave on, so many frames. Prints JSON: how often it reset
PTP, the frames' time stamps with CLOCK_REALTIME after their arrival (ns), and the values after a latch.
"""
import argparse
import json
import sys
import time

import gi

gi.require_version("Aravis", "0.8")
from gi.repository import Aravis  # noqa: E402

RESET_AT = ("Faulty", "Disabled", "Initializing", "Uncalibrated")


def check_ptp(camera):
    """True when it reset the clock."""
    if camera.get_string("PtpStatus") not in RESET_AT:
        return False
    camera.set_boolean("PtpEnable", False)
    camera.set_boolean("PtpEnable", True)
    camera.execute_command("PtpDataSetLatch")
    camera.get_string("PtpStatus")
    return True


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("camera")
    parser.add_argument("--frames", type=int, default=30)
    a = parser.parse_args()
    camera = Aravis.Camera.new(a.camera)
    if not camera.get_boolean("PtpEnable"):
        camera.set_boolean("PtpEnable", True)
    resets = int(check_ptp(camera))
    # Aravis's ring of raw packets loses some of the loopback's on a busy machine.
    camera.gv_set_stream_options(Aravis.GvStreamOption.PACKET_SOCKET_DISABLED)
    stream = camera.create_stream(None, None)
    for _ in range(10):
        stream.push_buffer(Aravis.Buffer.new_allocate(camera.get_payload()))
    camera.start_acquisition()
    begun, stamps, took_s = time.monotonic(), [], None
    while len(stamps) < a.frames:
        if time.monotonic() > begun + 60:
            sys.exit(f"{camera.get_string('PtpStatus')} after 60 s, {resets} resets, {len(stamps)} frames")
        buffer = stream.timeout_pop_buffer(1_000_000)
        if buffer is None:
            continue
        if buffer.get_status() == Aravis.BufferStatus.SUCCESS:
            stamp = (buffer.get_timestamp(), time.clock_gettime_ns(time.CLOCK_REALTIME))
            resets += check_ptp(camera)
            if camera.get_string("PtpStatus") == "Slave":
                took_s = took_s or time.monotonic() - begun
                stamps.append(stamp)
        stream.push_buffer(buffer)
    camera.stop_acquisition()
    camera.execute_command("PtpDataSetLatch")
    values = {name: camera.get_integer(name) for name in ("PtpOffsetFromMaster", "PtpMeanPropagationDelay", "PtpParentClockID",
                                                          "PtpGrandmasterClockID", "PtpSteps")}
    values |= {name: camera.get_string(name) for name in ("PtpStatus", "PtpServoStatus", "PtpTimeScale")}
    print(json.dumps({"resets": resets, "took_s": took_s, "stamps": stamps, "values": values}))


if __name__ == "__main__":
    main()
