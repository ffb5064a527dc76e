#!/usr/bin/python3
"""The centroid's error through an approach, from the log of hilcam-flight-example: figures as JSON, and a plot.

    plot_error.py LOG.csv [--out PLOT.png] [--settled-from-s 30] [--light LIGHT.csv] [--reference REFERENCE.csv]

Up to three errors, each the distance in pixels between the boresight and the target's centre of light, as its root mean
square over all frames from --settled-from-s on:

  measured  as the flight software found it in the camera's frames
  light     with --light (columns frame, error_x_px, error_y_px): the true one, of the same instants without noise
  pose      with --reference (columns range_m, x_m, y_m): the one that follows from the commanded poses and from where on the
            target, across the line of sight, its centre of light is from that far; no frame of the flight is in it

tests/protocol/flight_software/approach_test.py writes both files.
"""
import argparse
import csv
import json
import sys

import numpy

FOCAL_PX = 25e-3 / 5.5e-6


def rms(vectors):
    return float(numpy.sqrt((vectors**2).sum(axis=1).mean()))


class Log:
    def __init__(self, file, settled_from_s=30.0):
        with open(file, newline="") as lines:
            rows = list(csv.DictReader(lines))
        column = lambda *names: numpy.array([[float(row[name]) for name in names] for row in rows])
        self.frame = column("frame")[:, 0].astype(int)
        self.time_s = column("time_s")[:, 0]
        self.position_m = column("x_m", "y_m", "z_m")
        self.attitude = column("qw", "qx", "qy", "qz")
        self.found = column("found")[:, 0] == 1
        self.measured_px = column("error_x_px", "error_y_px")
        self.range_m = numpy.linalg.norm(self.position_m, axis=1)
        self.settled = (self.time_s >= settled_from_s) & self.found

    def origin_px(self):
        """Where the target's origin, the world's, is from the boresight, by the poses."""
        w, x, y, z = self.attitude.T
        # Columns of the rotation that turns body axes into world axes: the camera's axes in the world.
        axes = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
                            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
                            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]])
        across, down, along = numpy.einsum("ijn,nj->in", axes, -self.position_m)
        return FOCAL_PX * numpy.stack([across / along, down / along], axis=1)

    def pose_error(self, reference):
        """reference: rows of range and the centre of light's place from the target's origin, all [m]."""
        reference = reference[numpy.argsort(reference[:, 0])]
        place_m = [numpy.interp(self.range_m, reference[:, 0], reference[:, axis]) for axis in (1, 2)]
        return self.origin_px() + FOCAL_PX / self.range_m[:, None] * numpy.stack(place_m, axis=1)

    def figures(self, light=None, reference=None):
        figures = {"frames": len(self.frame), "not_found": int((~self.found).sum()),
                   "first_px": float(numpy.linalg.norm(self.measured_px[self.found][0])), "settled_frames": int(self.settled.sum()),
                   "measured_rms_px": rms(self.measured_px[self.settled])}
        if light is not None:
            figures["light_rms_px"] = rms(light[1][light[2]])
        if reference is not None:
            figures["pose_rms_px"] = rms(self.pose_error(reference)[self.settled])
        return figures


def light_error(file, log):
    """(times [s], true light's place [px]) of the frames that the file has."""
    with open(file, newline="") as lines:
        rows = list(csv.DictReader(lines))
    at = {frame: i for i, frame in enumerate(log.frame)}
    places = [(at[int(row["frame"])], float(row["error_x_px"]), float(row["error_y_px"])) for row in rows]
    index = numpy.array([place[0] for place in places], int)
    return log.time_s[index], numpy.array([place[1:] for place in places]), log.settled[index]


def read_reference(file):
    return numpy.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)


def plot(log, light, reference, out):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, (top, middle, bottom) = pyplot.subplots(3, 1, figsize=(9, 9), sharex=True, height_ratios=(3, 3, 1.3),
                                                    layout="constrained")
    figures = log.figures(light, reference)
    first = log.time_s[log.settled][0]
    after = log.time_s >= first
    # Not found is not a number: the line has a gap there.
    top.semilogy(log.time_s, numpy.linalg.norm(log.measured_px, axis=1), lw=0.8, color="C0",
                 label=f"measured in the frames, {figures['measured_rms_px']:.3f} px RMS")
    for axis, name in enumerate("xy"):
        middle.plot(log.time_s[after], log.measured_px[after, axis], lw=0.7, color=f"C{4 * axis}", alpha=0.7,
                    label=f"{name}, measured")
    if light is not None:
        top.semilogy(light[0], numpy.linalg.norm(light[1], axis=1), ".", ms=2, color="C2",
                     label=f"true centre of light, {figures['light_rms_px']:.3f} px RMS")
    if reference is not None:
        pose_px = log.pose_error(reference)
        top.semilogy(log.time_s, numpy.linalg.norm(pose_px, axis=1), lw=1, color="C1",
                     label=f"by the poses, {figures['pose_rms_px']:.3f} px RMS")
        for axis, name in enumerate("xy"):
            middle.plot(log.time_s[after], pose_px[after, axis], lw=1.4, color=f"C{1 + 2 * axis}", label=f"{name}, by the poses")
    top.axhline(0.1, color="0.5", lw=0.8, ls="--")
    top.axvline(first, color="0.5", lw=0.8, ls="--")
    top.set_ylabel("error [px]")
    top.legend(loc="upper right", title=f"RMS: from {first:.0f} s on")
    middle.set_ylabel("settled error [px]")
    middle.legend(ncols=4, loc="upper left")
    bottom.plot(log.time_s, log.range_m, color="0.3")
    bottom.set_ylabel("range [m]")
    bottom.set_xlabel("simulated time [s]")
    for axes in (top, middle, bottom):
        axes.grid(alpha=0.3)
    figure.savefig(out, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log")
    parser.add_argument("--out", help="plot, PNG or SVG")
    parser.add_argument("--settled-from-s", type=float, default=30)
    parser.add_argument("--light", help="true centres of light, CSV")
    parser.add_argument("--reference", help="where on the target the centre of light is, CSV")
    options = parser.parse_args()
    log = Log(options.log, options.settled_from_s)
    if not log.settled.any():
        sys.exit(f"{options.log}: no frame with the target after {options.settled_from_s} s")
    light = light_error(options.light, log) if options.light else None
    reference = read_reference(options.reference) if options.reference else None
    print(json.dumps(log.figures(light, reference), indent=2))
    if options.out:
        plot(log, light, reference, options.out)


if __name__ == "__main__":
    main()
