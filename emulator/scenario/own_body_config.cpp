#include "emulator/scenario/own_body_config.h"

#include <algorithm>

#include "emulator/motion/ephemeris.h"
#include "emulator/motion/kepler_orbit.h"
#include "emulator/motion/spice_coverage.h"
#include "emulator/motion/spice_sky.h"
#include "emulator/motion/world_frame.h"
#include "io/files/oem_file.h"
#include "io/spice/kernel_names.h"
#include "render/sky/earth_frames.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

std::vector<std::string> names_of_centers() {
    std::vector<std::string> names(kBodyNames.begin(), kBodyNames.end());
    names.emplace_back("sun");
    return names;
}

std::optional<BodyId> center_id(const OwnBodyConfig& c) {
    if (c.center == kBodyCount) return std::nullopt;
    return static_cast<BodyId>(c.center);
}

std::function<StateVector(TimeTai)> kepler_orbit(const OwnBodyConfig& c, TimeTai start) {
    const KeplerConfig& k = c.kepler.value();
    const double mean = k.has_true ? mean_anomaly(k.true_anomaly_rad, k.eccentricity) : k.mean_anomaly_rad;
    const TimeTai epoch = k.epoch_utc.empty() ? start : parse_utc(k.epoch_utc);
    const KeplerOrbit orbit(
        {k.semi_major_axis_m, k.eccentricity, k.inclination_rad, k.node_rad, k.periapsis_rad, mean},
        gravity_m3_s2({center_id(c)}));
    return
        [orbit, epoch](TimeTai time) { return orbit.at(static_cast<double>(time - epoch) * kSecondsPerNs); };
}

// Outside the ephemeris, the body stays at its nearest instant.
std::function<StateVector(TimeTai)> ephemeris_orbit(const OwnBodyConfig& c, TimeTai start) {
    auto segments =
        std::make_shared<const std::vector<OemSegment>>(load_oem(c.oem.value().file, c.oem->object));
    const std::string file = c.oem->file.string(), center = names_of_centers()[c.center];
    for (const OemSegment& s : *segments) {
        std::string name = ccsds_word(s.center_name);
        std::transform(name.begin(), name.end(), name.begin(),
                       [](char l) { return l >= 'A' && l <= 'Z' ? static_cast<char>(l - 'A' + 'a') : l; });
        const std::string where = file + ":" + std::to_string(s.line);
        if (name != center && name != center + " barycenter")
            throw InputError(where + ": CENTER_NAME: found " + in_quotes(s.center_name) +
                             "; accepted: " + center + ", as the body's 'center' says");
        if (s.frame != CcsdsFrame::kIcrf && s.frame != CcsdsFrame::kEme2000)
            throw InputError(where + ": REF_FRAME of a body; accepted: ICRF, GCRF, EME2000");
    }
    const MotionValidity validity = validity_of(*segments, start);
    if (validity.status != MotionStatus::kOk)
        throw InputError(file + ": does not know the scenario's start; the nearest instant in it is " +
                         format_utc(validity.nearest));
    return [segments, from_eme2000 = icrf_from_eme2000()](TimeTai time) {
        const MotionValidity known = validity_of(*segments, time);
        const TimeTai at = known.status == MotionStatus::kOk ? time : known.nearest;
        const OemSegment& segment = segment_of(*segments, at);
        const StateVector s = interpolate_state(segment, at);
        if (segment.frame == CcsdsFrame::kIcrf) return s;
        return StateVector{from_eme2000 * s.position_m, from_eme2000 * s.velocity_m_s};
    };
}

// Does the same from the kernels. Its axes come from them, too, unless the scenario gives its rotation.
void take_from_kernels(const OwnBodyConfig& c, const std::shared_ptr<SpiceKernels>& kernels, TimeTai start,
                       OwnBody& body) {
    if (!kernels)
        throw InputError("spice: the scenario has no kernels; accepted: with 'spice: {kernels: [...]}'");
    const int code = require_kernel_code(kernels->set.pool, c.spice.value().object, "spice.object");
    const int about = naif_code_in(*kernels, body.center);
    kernels->bodies.require(code, "spice.object");
    if (kernels->bodies.has(about)) kernels->bodies.require(about, "center");
    const SpiceCoverage coverage(kernels->bodies.coverage(code, about), kernels->set.time);
    const MotionValidity validity = coverage.validity(start);
    if (coverage.empty() || validity.status != MotionStatus::kOk)
        throw InputError(
            "spice.object: the kernels have no position relative to its center at the scenario's start" +
            (coverage.empty() ? "" : "; the nearest instant in them is " + format_utc(validity.nearest)));
    body.orbit = [kernels, coverage, code, about](TimeTai time) {
        StateVector s;
        const double et_s = coverage.et_s(coverage.validity(time).nearest);
        return kernels->bodies.state(code, about, et_s, s) ? s : kUnknownState;
    };
    const std::string id = std::to_string(code);
    if (c.has_pole || c.has_synchronous || !kernels->set.pool.find("BODY" + id + "_POLE_RA")) return;
    const int frame = kernels->frames.require("IAU_" + id, "spice.object");
    body.turn = [kernels, frame](TimeTai time) {
        FrameTurn turn;
        kernels->frames.turn(frame, kernels->set.time.et_s(time), turn);
        return transposed(turn.reference_from_frame);
    };
}

void require_possible(const StateVector& s, TimeTai start) {
    const std::string what = impossible_part({start, {s.position_m, {}}, s.velocity_m_s, {}});
    if (!what.empty()) throw InputError("about its center at the scenario's start: found " + what);
}

}  // namespace

// The default is a grey body with the law of dark powder.
OwnBodyConfig::OwnBodyConfig() {
    look.law = SurfaceLaw::kLommelSeeliger;
    look.albedo = Curve::constant(0.5);
}

Fields fields(OwnBodyConfig& c) {
    return {
        required(text("name", c.name, "name of the body")),
        required(number("equatorial_radius_km", c.equatorial_radius_m, 1e3, {1, 1e6}, "equatorial radius")),
        number("polar_radius_km", c.polar_radius_m, 1e3, {0, 1e6}, "polar radius; 0: the equatorial radius"),
        choice("center", c.center, names_of_centers(), "central body of the orbit"),
        section("kepler", c.kepler, "unperturbed orbital elements about center"),
        section("oem", c.oem, "orbit ephemeris message about center; replaces kepler"),
        section("spice", c.spice,
                "SPICE object; replaces kepler, and gives the body's axes if the kernels have them"),
        optional(flag("synchronous", c.synchronous,
                      "true: x points to center and z along the orbit normal; default: true unless pole_deg "
                      "is given"),
                 c.has_synchronous),
        optional(numbers("pole_deg", c.pole_rad, kDegree_rad, {-360, 360}, {2, 2},
                         "right ascension and declination of the north pole"),
                 c.has_pole),
        number("meridian_deg", c.meridian_rad, kDegree_rad, {-360, 360},
               "angle of the prime meridian at J2000 from the node on the equator of ICRF"),
        number("rate_deg_day", c.rate_rad_s, kDegree_rad / 86400, {-1e5, 1e5},
               "rate of rotation about the pole"),
        section("look", c.look, "look of the body, with the keys of a planet; default: grey"),
    };
}

void validate(const OwnBodyConfig& c) {
    const int given = int{c.kepler.has_value()} + int{c.oem.has_value()} + int{c.spice.has_value()};
    if (given != 1)
        throw KeyError(given > 0 ? "oem" : "kepler",
                       std::string("found ") + (given == 0 ? "none" : "more than one") +
                           " of 'kepler', 'oem' and 'spice'; accepted: one of them");
    if (c.polar_radius_m > 0 &&
        (c.polar_radius_m < 0.3 * c.equatorial_radius_m || c.polar_radius_m > 3 * c.equatorial_radius_m))
        throw KeyError("polar_radius_km", "accepted: a third to three times equatorial_radius_km");
    if (c.has_pole && c.has_synchronous && c.synchronous)
        throw KeyError("pole_deg", "has no effect with synchronous: true; accepted: one of them");
    if (!c.has_pole && (c.rate_rad_s != 0 || c.meridian_rad != 0))
        throw KeyError(c.rate_rad_s != 0 ? "rate_deg_day" : "meridian_deg",
                       "has no effect without pole_deg; accepted: both or neither");
    if (c.look.has_measured && c.look.measured_magnitude)
        throw KeyError("look.measured_magnitude", "there is no measured magnitude of it; accepted: false");
    if (c.look.rings) throw KeyError("look.rings", "accepted: false; rings are for saturn alone");
}

std::shared_ptr<const OwnBodies> load_own_bodies(const std::vector<OwnBodyConfig>& bodies,
                                                 const std::string& start_utc,
                                                 const std::shared_ptr<SpiceKernels>& kernels) {
    if (bodies.empty()) return nullptr;
    if (bodies.size() > kMaxOwnBodies)
        throw InputError("bodies: found " + std::to_string(bodies.size()) +
                         "; accepted: " + std::to_string(kMaxOwnBodies) + " at most");
    const TimeTai start = parse_utc(start_utc);
    auto out = std::make_shared<OwnBodies>();
    for (const OwnBodyConfig& c : bodies) {
        if (std::find(kBodyNames.begin(), kBodyNames.end(), c.name) != kBodyNames.end() || c.name == "sun")
            throw InputError("bodies: name: found " + in_quotes(c.name) +
                             "; accepted: not that of a planet, the Moon or the Sun");
        OwnBody& body = out->list.emplace_back();
        body.name = c.name;
        body.figure = {c.equatorial_radius_m,
                       c.polar_radius_m > 0 ? c.polar_radius_m : c.equatorial_radius_m};
        body.center = center_id(c);
        try {
            if (c.spice)
                take_from_kernels(c, kernels, start, body);
            else
                body.orbit = c.kepler ? kepler_orbit(c, start) : ephemeris_orbit(c, start);
            require_possible(body.orbit(start), start);
        } catch (const InputError& error) {
            throw InputError("body " + in_quotes(c.name) + ": " + error.what());
        }
        body.synchronous = !c.has_pole;
        if (c.has_pole)
            body.pole_right_ascension_rad = c.pole_rad[0], body.pole_declination_rad = c.pole_rad[1];
        body.meridian_rad = c.meridian_rad;
        body.rate_rad_s = c.rate_rad_s;
    }
    return out;
}

}  // namespace hilcam
