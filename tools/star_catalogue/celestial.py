"""Reads stars.14.json of d3-celestial (npm): the Hipparcos stars of XHIP (Anderson and Francis, Astron. Lett. 38, 331, 2012), places at J2000 to 0.0001 degrees."""
import json

PLACE_STEP_ARCSEC = 0.36


def stars(path):
    """Returns (V, B-V or None, right ascension, declination [deg]) by Hipparcos number."""
    found = {}
    for star in json.loads(path.read_text())["features"]:
        b_v = star["properties"]["bv"]
        ra_deg, dec_deg = star["geometry"]["coordinates"]
        found[int(star["id"])] = (float(star["properties"]["mag"]), float(b_v) if b_v != "" else None, ra_deg, dec_deg)
    return found
