"""What the comparisons with flight pictures share: where they are, how they are read, how hilcam's are made and shown."""
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
from PIL import Image

HILCAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
DATA = pathlib.Path(os.environ.get("HILCAM_SHARED_DATA", SOURCE.parent / "shared/data"))
PICTURE = sys.argv[3] if len(sys.argv) > 3 else None
SKIPPED = 77


def fits_arrays(path):
    """Returns the header, as text by keyword, and the array, None where there is none, of each part of a FITS file (FITS standard 4.0)."""
    kinds = {"8": ">u1", "16": ">i2", "32": ">i4", "-32": ">f4", "-64": ">f8"}
    data, at, parts = path.read_bytes(), 0, []
    while at + 2880 <= len(data):
        header, ended = {}, False
        while not ended:
            for card in (data[at + 80 * i:at + 80 * (i + 1)].decode("latin1") for i in range(36)):
                ended = ended or card.startswith("END     ")
                if card[8] == "=":
                    header[card[:8].strip()] = card[10:].split("/")[0].strip(" '")
            at += 2880
        shape = [int(header[f"NAXIS{k}"]) for k in range(int(header["NAXIS"]), 0, -1)]
        array = None
        if shape:
            count = int(numpy.prod(shape))
            array = numpy.frombuffer(data, kinds[header["BITPIX"]], count, at).reshape(shape)
            array = array * float(header.get("BSCALE", 1)) + float(header.get("BZERO", 0))
            at += -(-count * abs(int(header["BITPIX"])) // 8 // 2880) * 2880
        parts.append((header, array))
    return parts


def render(scenario, stage="frame", *settings):
    """Returns what hilcam makes of a scenario, given as text: digital numbers, or with the stage electrons their mean before noise. Settings: KEY=VALUE."""
    with tempfile.TemporaryDirectory() as folder:
        config, picture = pathlib.Path(folder, "scenario.yaml"), pathlib.Path(folder, "picture.fits")
        config.write_text(scenario)
        command = [HILCAM, "render", config, "--stage", stage, "--out", picture, *(word for s in settings for word in ("--set", s))]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return next(array for _, array in fits_arrays(picture) if array is not None)


def blurred(picture, sigma_px):
    """Returns the picture, which goes on behind its edges from the other side, under a Gaussian."""
    fy, fx = (numpy.fft.fftfreq(n) for n in picture.shape)
    return numpy.fft.ifft2(numpy.fft.fft2(picture) * numpy.exp(-2 * (numpy.pi * sigma_px) ** 2 * (fy[:, None] ** 2 + fx ** 2))).real


def correlation(a, b):
    """Returns how well two pictures correlate, -1 to 1."""
    return numpy.corrcoef(numpy.ravel(a), numpy.ravel(b))[0, 1]


def top(before, at, after):
    """Returns where the parabola through three values has its greatest, from the middle one."""
    return (before - after) / (2 * (before - 2 * at + after))


def shift_between(a, b, reach=12):
    """Returns by how much a lies right and lower of b [px], where they correlate best."""
    power = numpy.fft.ifft2(numpy.fft.fft2(a - a.mean()) * numpy.conj(numpy.fft.fft2(b - b.mean()))).real
    near = numpy.roll(power, (reach, reach), (0, 1))[:2 * reach + 1, :2 * reach + 1]
    row, column = numpy.unravel_index(numpy.argmax(near[1:-1, 1:-1]), (2 * reach - 1, 2 * reach - 1))
    row, column = row + 1, column + 1
    return (column - reach + top(*near[row, column - 1:column + 2]), row - reach + top(*near[row - 1:row + 2, column]))


def side_by_side(flight, rendered, path, zoom=1, gamma=1.0):
    """Writes two pictures of 0 to 1, and how they differ about middle grey, each enlarged by a whole number."""
    both = [numpy.clip(p, 0, 1) for p in (flight, rendered)]
    strip = numpy.concatenate([both[0] ** gamma, both[1] ** gamma, 0.5 + 0.5 * (both[0] - both[1])], axis=1)
    Image.fromarray((255 * numpy.clip(strip, 0, 1)).astype("uint8").repeat(zoom, 0).repeat(zoom, 1)).save(path)


class Judgement:
    """Collects what misses its bound, so that a test prints all its residuals before it fails."""

    def __init__(self):
        self.missed = []

    def most(self, name, value, bound, unit=""):
        """Prints the value; it must not lie above the bound."""
        print(f"{name}: {value:.3f} {unit} (at most {bound})")
        if not value <= bound:
            self.missed.append(name)

    def known(self, name, value, target, found, within):
        """Prints a value that misses its target, which docs/flight.md explains; it must stay what was found."""
        print(f"{name}: {value:.3f}, misses its target (at most {target}); known as {found} +- {within}")
        if abs(value - found) > within:
            self.missed.append(name)

    def status(self):
        """Returns the exit status, 0 where nothing missed."""
        if self.missed:
            print("missed: " + ", ".join(self.missed))
        return 1 if self.missed else 0


def propagated(place, velocity, duration_s, gm_km3_s2):
    """Returns the place [km] after so long about one point mass, by Runge and Kutta's fourth order in steps of 10 s at most."""
    steps = math.ceil(abs(duration_s) / 10)
    h, state = duration_s / steps, numpy.concatenate([place, velocity])

    def rate(s):
        return numpy.concatenate([s[3:], -gm_km3_s2 * s[:3] / numpy.linalg.norm(s[:3]) ** 3])

    for _ in range(steps):
        a = rate(state)
        b = rate(state + h / 2 * a)
        c = rate(state + h / 2 * b)
        state = state + h / 6 * (a + 2 * b + 2 * c + rate(state + h * c))
    return state[:3]
