"""One case of approaches.yaml: flies hilcam-flight-example from a pointing error by the case's seed, and judges it once it has settled.

    approach_case.py SLOT UDP_PORT SEED CASE_FOLDER
"""
import csv
import json
import math
import subprocess
import sys

SETTLED_FROM_S = 12.0
MOST_MRAD = 25.0  # off about each axis at the start

slot, port, seed, folder = sys.argv[1:5]
off_mrad = [MOST_MRAD * (2 * ((int(seed) >> shift) % 4096) / 4095 - 1) for shift in (0, 12)]
flight = subprocess.run(["hilcam-flight-example", "--camera", f"127.0.1.{slot}", "--commands", f"127.0.0.1:{port}", "--log", f"{folder}/log.csv",
                         "--frames", "100", "--off-pointing-mrad", *map(str, off_mrad)])
if flight.returncode:
    sys.exit(f"hilcam-flight-example ended with status {flight.returncode}")
with open(f"{folder}/log.csv", newline="") as lines:
    frames = [row for row in csv.DictReader(lines) if float(row["time_s"]) > SETTLED_FROM_S]
errors_px = [math.hypot(float(row["error_x_px"]), float(row["error_y_px"])) for row in frames if row["found"] == "1"]
if len(errors_px) < len(frames):
    sys.exit(f"the target was lost in {len(frames) - len(errors_px)} of {len(frames)} frames")
with open(f"{folder}/result.json", "w") as out:
    json.dump({"off_x_mrad": off_mrad[0], "off_y_mrad": off_mrad[1],
               "error_rms_px": math.sqrt(sum(e * e for e in errors_px) / len(errors_px))}, out)
