"""Reads stars.14.json of d3-celestial (npm): Johnson V and B-V of the Hipparcos stars, from XHIP (Anderson and Francis, Astron. Lett. 38, 331, 2012)."""
import json


def magnitudes(path):
    """Returns (V, B-V or None) by Hipparcos number."""
    found = {}
    for star in json.loads(path.read_text())["features"]:
        b_v = star["properties"]["bv"]
        found[int(star["id"])] = (float(star["properties"]["mag"]), float(b_v) if b_v != "" else None)
    return found
