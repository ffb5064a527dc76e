"""Says the V-Ic of an M star by its spectral class, which its B-V does not tell: from M0 to M6 giants have B-V of 1.5 to 1.65.

The colours are those of Pickles, PASP 110, 863 (1998), as tools/make_star_spectra.py has them; those of supergiants go on at 0.15 mag a class from its K4 I.
"""
import re

# V-Ic by class from M0 on.
GIANTS = (1.64, 1.75, 1.86, 2.08, 2.40, 2.80, 3.26, 3.88)
SUPERGIANTS = (1.93, 2.08, 2.24, 2.40, 2.70, 3.00, 3.40, 3.90)
DWARFS = (1.70, 1.86, 2.01, 2.43, 2.77, 3.14, 3.71)
# M2, gM4, M1-M2Ia-Iab, M0/1III, M3.5V.
TYPE = re.compile(r"\s*([gds])?M(\d(?:\.\d)?)(?:\s*[-/]\s*M?(\d(?:\.\d)?))?(.*)")


def colours_of(prefix, rest):
    if prefix == "d" or re.match(r"[^IV]*V(?!I)", rest):
        return DWARFS
    if prefix == "s" or re.match(r"[^IV]*I(ab|a|b|[^IV]|$)", rest):
        return SUPERGIANTS
    return GIANTS


def v_i(spectral_type):
    """Returns V-Ic, or None for a star that is not of class M or of no known subclass."""
    found = TYPE.match(spectral_type)
    if not found:
        return None
    prefix, first, last, rest = found.groups()
    subclass = (float(first) + float(last or first)) / 2
    colours = colours_of(prefix, rest)
    below = min(int(subclass), len(colours) - 2)
    share = min(subclass - below, 1.0)
    return (1 - share) * colours[below] + share * colours[below + 1]
