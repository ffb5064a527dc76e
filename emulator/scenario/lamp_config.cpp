#include "emulator/scenario/lamp_config.h"

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(LampConfig& l) {
    return {
        required(text("name", l.name, "name of the lamp in messages")),
        text("on", l.on, "carrier of the lamp: an object's name, or camera: the body of the first camera"),
        integer("joint", l.joint, {0, 65535},
                "joint of the object that carries the lamp, counted from 1; 0: the object itself"),
        vector3("position_m", l.position_m, 1, {-1e6, 1e6},
                "position in the carrier's axes, outside its mesh"),
        vector3("axis", l.axis, 1, {-1e6, 1e6}, "direction of the beam, in the carrier's axes"),
        optional(curve("intensity_w_sr_um", l.spectral_intensity_w_sr_um, {0, 1e9},
                       "radiant intensity on the beam's axis by wavelength"),
                 l.has_spectral_intensity),
        optional(number("intensity_w_sr", l.intensity_w_sr, 1, {0, 1e9},
                        "radiant intensity on the beam's axis, integrated over wavelength, used with "
                        "spectrum; replaces intensity_w_sr_um"),
                 l.has_intensity),
        optional(
            curve("spectrum", l.spectrum, {0, 1e9}, "spectral distribution of intensity_w_sr, in any unit"),
            l.has_spectrum),
        optional(number("beam_angle_deg", l.beam_angle_rad, kDegree_rad, {0.1, 179},
                        "full angle of the beam at half intensity, with the profile cos^n; with neither this "
                        "nor beam, the lamp is isotropic"),
                 l.has_beam_angle),
        optional(table("beam", l.beam, {"angle_deg", "intensity_ratio"}, {0, 180}, {0, 1e3},
                       "intensity over that on the beam's axis, by angle from the axis; 0 beyond the last "
                       "angle; replaces beam_angle_deg"),
                 l.has_beam),
        flag("lit", l.lit, "true: the lamp is on at the start of the run"),
        number("level", l.level, 1, {0, 1},
               "share of full intensity of a lamp that is on, at the start of the run"),
    };
}

void validate(const LampConfig& l) {
    if (!(length(l.axis) > 1e-9)) throw InputError("'axis' has no direction: found a vector of length 0");
    if (l.has_spectral_intensity == l.has_intensity)
        throw InputError("a lamp has either 'intensity_w_sr_um' or 'intensity_w_sr'; found " +
                         std::string(l.has_intensity ? "both" : "neither"));
    if (l.has_intensity != l.has_spectrum)
        throw InputError("'intensity_w_sr' and 'spectrum' go together; found one of them");
    if (l.has_spectrum && l.spectrum.wavelength_um.size() < 2)
        throw InputError("'spectrum' is a number; accepted: [[wavelength_um, value], ...]");
    if (l.has_beam_angle && l.has_beam)
        throw InputError("a lamp has either 'beam_angle_deg' or 'beam'; found both");
    if (l.has_beam && l.beam.x.front() > 0)
        throw InputError("'beam' begins off the axis; accepted: a first angle of 0 degrees, the axis");
}

}  // namespace hilcam
