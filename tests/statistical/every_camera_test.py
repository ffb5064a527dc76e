#!/usr/bin/python3
"""Every shipped camera, measured from its own frames as in a laboratory, is the one of its data sheet.

    every_camera_test.py HILCAM SOURCES [CAMERA ...]
"""
import json
import pathlib
import subprocess
import sys
import time

# As characterise_test.cpp asks of its cameras: relative deviations; of the MTF the absolute one. Three of the laboratory's own
# uncertainties come on top: a noisy camera is known less well, and 20 cameras times 8 figures are more than a hundred trials.
BOUNDS = {"gain_dn_e": 0.01, "qe_peak": 0.01, "read_noise_e": 0.02, "dark_current_e_s": 0.02, "prnu_fraction": 0.05, "dsnu_e": 0.05}
MTF_BOUND = 0.01
MTFS = ("mtf_nyquist", "mtf_nyquist_vertical")
UNCERTAINTIES = 3
# Cameras that cannot be measured so, and what is said of them: JunoCam's filters are strips of 128 rows.
REFUSED = {"junocam": "slanted edge: too few pixels"}


def faults_of(report):
    """Figures that are farther from the data sheet than they may be; figures that a camera does not have are null."""
    faults, judged = [], 0
    for key in (*BOUNDS, *MTFS):
        figure = report[key]
        configured, measured, uncertainty = (figure.get(name) for name in ("configured", "measured", "uncertainty"))
        if configured is None or measured is None:
            continue
        judged += 1
        bound = (MTF_BOUND if key in MTFS else BOUNDS[key] * abs(configured)) + UNCERTAINTIES * (uncertainty or 0)
        if not abs(measured - configured) <= bound:
            faults.append(f"{key}: configured {configured:.6g}, measured {measured:.6g} +- {uncertainty:.2g}, may be off by {bound:.2g}")
    if judged < 4:
        faults.append(f"only {judged} figures could be judged")
    return faults


def main():
    hilcam, sources, *names = sys.argv[1:]
    cameras = sorted(pathlib.Path(sources, "configs/cameras").glob("*.yaml"))
    if names:
        cameras = [camera for camera in cameras if camera.stem in names]
    bad = not cameras
    for camera in cameras:
        begin = time.monotonic()
        result = subprocess.run([hilcam, "characterise", camera, "--json"], capture_output=True, text=True)
        faults = faults_of(json.loads(result.stdout)) if result.returncode == 0 else [result.stderr]
        if camera.stem in REFUSED:
            faults = [] if result.returncode == 2 and REFUSED[camera.stem] in result.stderr else ["it is refused no longer"]
        print(f"{camera.stem}: {'; '.join(faults) or REFUSED.get(camera.stem, 'as its data sheet says')} ({time.monotonic() - begin:.0f} s)", flush=True)
        bad = bad or faults != []
    sys.exit(1 if bad else 0)


main()
