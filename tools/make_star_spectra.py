#!/usr/bin/python3
"""Makes render/sky/star_spectra_table.inc, the spectra of stars by colour.

    tools/make_star_spectra.py FOLDER

FOLDER holds pickles_uk.fits and pickles_uk_1.fits to pickles_uk_131.fits: the library of Pickles, PASP 110, 863 (1998), in the form that the Space Telescope
Science Institute gives out. Spectra of normal composition are taken, dwarfs to G8 and giants from G5 on, as stars of those colours in the sky mostly are; they
rise in V-I. Needs python3-numpy.

Each is meaned over wavelengths about the table's, divided by its mean over V, and tilted by a power of the wavelength from 0.55 um on, flat beyond 0.85 um, so
that it has V-Ic as Pickles' paper has it for its type, with the zero points and passbands that hilcam uses. The paper's colours are those that the package
PyGaia quotes for 19 types, 0.970 times the synthetic ones less 0.043 mag (0.012 mag rms).
"""
import pathlib
import sys

import numpy

TABLE = pathlib.Path(__file__).resolve().parents[1] / "render/sky/star_spectra_table.inc"
TYPES = """O5V B0V B1V B3V B57V B8V B9V A0V A2V A3V A5V A7V F0V F2V F5V F6V F8V G0V G2V G5V G8V
G5III G8III K0III K1III K2III K3III K4III K5III M0III M1III M2III M3III M4III M5III M6III M7III""".split()
WAVELENGTHS_UM = numpy.concatenate([numpy.arange(0.20, 0.32, 0.02), numpy.arange(0.32, 1.10, 0.01), numpy.arange(1.10, 2.501, 0.1)])
# Bessell, PASP 102, 1181 (1990), table 2, for means of energy; zero points of Bessell, Castelli & Plez, A&A 333, 231 (1998), table A2 [1e-8 W m^-2 um^-1].
BANDS = {
    "B": (0.36, 0.01, "0 .030 .134 .567 .920 .978 1 .978 .935 .853 .740 .640 .536 .424 .325 .235 .150 .095 .043 .009 0", 6.32),
    "V": (0.47, 0.01, "0 .030 .163 .458 .780 .967 1 .973 .898 .792 .684 .574 .461 .359 .270 .197 .135 .081 .045 .025 .017 .013 .009 0", 3.631),
    "I": (0.70, 0.01, "0 .024 .232 .555 .785 .910 .965 .985 .990 .995 1 1 .990 .980 .950 .910 .860 .750 .560 .330 .150 .030 0", 1.126),
}
PAPER_SCALE, PAPER_SHIFT = 0.970, -0.043
FITS_BLOCK_BYTES, FITS_CARD_BYTES = 2880, 80


def fits_table(path):
    """Returns the first binary table of a FITS file."""
    data, at = path.read_bytes(), 0
    for _ in range(2):
        cards = {}
        while True:
            card = data[at:at + FITS_CARD_BYTES].decode("ascii")
            at += FITS_CARD_BYTES
            if card.startswith("END "):
                break
            cards[card[:8].strip()] = card[10:].split("/")[0].strip(" '")
        at = -(-at // FITS_BLOCK_BYTES) * FITS_BLOCK_BYTES
    kinds = {"E": ">f4", "D": ">f8"}
    columns = []
    for i in range(1, int(cards["TFIELDS"]) + 1):
        form = cards[f"TFORM{i}"]
        columns.append((cards[f"TTYPE{i}"], kinds.get(form[-1]) or f"S{form[:-1]}"))
    return numpy.frombuffer(data, numpy.dtype(columns), count=int(cards["NAXIS2"]), offset=at)


def magnitude(wavelength_um, flux, band):
    first, step, shares, zero = BANDS[band]
    shares = numpy.array(shares.split(), float)
    places = first + step * numpy.arange(len(shares))
    fine = numpy.arange(places[0], places[-1], 5e-4)
    weight = numpy.interp(fine, places, shares)
    return -2.5 * numpy.log10(numpy.sum(weight * numpy.interp(fine, wavelength_um, flux)) / numpy.sum(weight) / zero)


def tilt(wavelength_um):
    """Returns 0 to 0.55 um, and from there a logarithm that is 1 at 0.79 um and stays from 0.85 um on."""
    return numpy.log(numpy.clip(wavelength_um, 0.55, 0.85) / 0.55) / numpy.log(0.79 / 0.55)


def meaned(wavelength_um, flux):
    """Returns the means about the table's wavelengths, weighted by a triangle from neighbour to neighbour."""
    edges = numpy.concatenate([[WAVELENGTHS_UM[0]], WAVELENGTHS_UM, [WAVELENGTHS_UM[-1]]])
    out = []
    for before, here, after in zip(edges, edges[1:], edges[2:]):
        weight = numpy.interp(wavelength_um, [before - 1e-9, here, after + 1e-9], [0, 1, 0])
        out.append(numpy.sum(weight * flux) / numpy.sum(weight))
    return numpy.array(out)


def library(folder):
    """Yields type, V-I, B-V and the table's fluxes."""
    for number, row in enumerate(fits_table(folder / "pickles_uk.fits"), 1):
        kind = row["SPTYPE"].decode().strip()
        if kind not in TYPES:
            continue
        spectrum = fits_table(folder / f"pickles_uk_{number}.fits")
        wavelength_um, flux = (spectrum[name].astype(float) for name in spectrum.dtype.names[:2])
        wavelength_um *= 1e-4
        here = WAVELENGTHS_UM, meaned(wavelength_um, flux)

        def v_i(slope):
            tilted = here[1] * 10 ** (-0.4 * slope * tilt(here[0]))
            return magnitude(here[0], tilted, "V") - magnitude(here[0], tilted, "I")

        wanted = PAPER_SCALE * (magnitude(wavelength_um, flux, "V") - magnitude(wavelength_um, flux, "I")) + PAPER_SHIFT
        slope = 0.0
        for _ in range(20):
            slope += v_i(slope) - wanted
        tilted = here[1] * 10 ** (-0.4 * slope * tilt(here[0]))
        tilted /= 10 ** (-0.4 * magnitude(here[0], tilted, "V")) * BANDS["V"][3]
        # What is left of a spectrum's ultraviolet noise.
        tilted = numpy.maximum(tilted, 1e-5)
        yield kind, wanted, magnitude(here[0], tilted, "B") - magnitude(here[0], tilted, "V"), tilted


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = {kind: rest for kind, *rest in library(pathlib.Path(sys.argv[1]))}
    spectra = sorted(((kind, *found[kind]) for kind in TYPES), key=lambda row: row[1])
    with open(TABLE, "w", encoding="ascii") as file:
        print("// Made by tools/make_star_spectra.py: wavelengths [um]; type, V-Ic, B-V and fluxes over their mean in V of each star.", file=file)
        print("constexpr std::array kWavelengths_um{", file=file)
        print("    " + ", ".join(f"{w:.2f}" for w in WAVELENGTHS_UM) + "};", file=file)
        print("constexpr std::array<LibraryStar, %d> kLibrary{{" % len(spectra), file=file)
        for kind, v_i, b_v, flux in spectra:
            print(f'    {{"{kind}", {v_i:.3f}, {b_v:.3f}, {{' + ", ".join(f"{f:.4g}" for f in flux) + "}},", file=file)
        print("}};", file=file)


if __name__ == "__main__":
    main()
