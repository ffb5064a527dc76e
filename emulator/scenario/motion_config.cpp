#include "emulator/scenario/motion_config.h"

#include <algorithm>

#include "io/files/leap_seconds_file.h"
#include "render/sky/bodies.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Returns the names of the bodies in their order, then the Sun's.
std::vector<std::string> center_names() {
    std::vector<std::string> names(kBodyNames.begin(), kBodyNames.end());
    names.emplace_back("sun");
    return names;
}

std::vector<std::string> frame_names() { return {"world", "body_fixed", "lvlh", "object", "local"}; }

constexpr const char* kRadecIsWorlds =
    "is relative to ICRF; accepted: with frame: world, or another form of attitude";
constexpr const char* kOf = "thing to which the frames lvlh and object belong: an object's name, or camera";

}  // namespace

Fields fields(KeyframeConfig& k) {
    Fields list = {
        required(number("at_s", k.at_s, 1, {-1e9, 1e9}, "time after the scenario's start")),
        vector3("position_m", k.position_m, 1, {-kFarthestPlace_m, kFarthestPlace_m},
                "position in the motion's frame"),
        optional(vector3("velocity_m_s", k.velocity_m_s, 1, {-kFastestMotion_m_s, kFastestMotion_m_s},
                         "velocity in the motion's frame; left out: derived from the neighbouring keyframes"),
                 k.has_velocity),
    };
    for (Field& field : attitude_keys(k.attitude, {.frame = "the frame"})) {
        if (field.key == "attitude_wxyz")
            field.meaning += "; with no form of attitude: that of the keyframe before";
        list.push_back(std::move(field));
    }
    return list;
}

void validate(const KeyframeConfig& k) { check_attitude(k.attitude); }

Fields fields(KeplerConfig& k) {
    return {
        required(number("semi_major_axis_km", k.semi_major_axis_m, 1e3, {-1e10, 1e10},
                        "semi-major axis; negative for an eccentricity above 1")),
        number("eccentricity", k.eccentricity, 1, {0, 1e3}, "eccentricity, except 1"),
        number("inclination_deg", k.inclination_rad, kDegree_rad, {0, 180},
               "inclination to the equator of ICRF"),
        number("node_deg", k.node_rad, kDegree_rad, {-360, 360}, "right ascension of the ascending node"),
        number("periapsis_deg", k.periapsis_rad, kDegree_rad, {-360, 360}, "argument of periapsis"),
        optional(number("mean_anomaly_deg", k.mean_anomaly_rad, kDegree_rad, {-1e6, 1e6},
                        "mean anomaly at the epoch"),
                 k.has_mean),
        optional(number("true_anomaly_deg", k.true_anomaly_rad, kDegree_rad, {-360, 360},
                        "true anomaly at the epoch; replaces mean_anomaly_deg"),
                 k.has_true),
        text("epoch_utc", k.epoch_utc, "epoch of the anomaly, in UTC; left out: the scenario's start"),
    };
}

void validate(const KeplerConfig& k) {
    if (k.has_mean && k.has_true)
        throw InputError("found both 'mean_anomaly_deg' and 'true_anomaly_deg'; accepted: one of them");
    const bool ellipse = k.semi_major_axis_m > 0 && k.eccentricity < 1;
    const bool hyperbola = k.semi_major_axis_m < 0 && k.eccentricity > 1;
    if (!ellipse && !hyperbola)
        throw InputError(
            "found a 'semi_major_axis_km' that does not go with 'eccentricity'; accepted: above 0 with 0 to "
            "below "
            "1, below 0 with above 1");
    if (!k.epoch_utc.empty()) at_key("epoch_utc", [&] { parse_utc(k.epoch_utc); });
}

Fields fields(TleConfig& t) {
    return {
        required(path("file", t.file, "element sets: TLE, or OMM as KVN, XML, CSV or JSON")),
        text("satellite", t.satellite,
             "satellite's number (100001 or A0001), name or OBJECT_ID in the file; its newest set up to the "
             "scenario's start is used, or else its oldest"),
        choice("checksum", t.checksum, {"verify", "ignore"},
               "treatment of each line's checksum. verify: it must be right; ignore: it may be wrong or "
               "missing"),
        number("valid_days", t.valid_s, 86400, {0.01, 400},
               "number of days before and after its epoch for which the set is valid"),
    };
}

Fields fields(EphemerisFileConfig& f) {
    return {
        required(path("file", f.file, "CCSDS message as KVN (keyword = value) or XML")),
        text("object", f.object, "OBJECT_NAME or OBJECT_ID to read from a message with several objects"),
    };
}

Fields fields(AttitudeConfig& a) {
    Fields list = {
        choice("law", a.law,
               {"held", "nadir", "object", "sun", "velocity", "keyframes", "aem", "spice", "pole"},
               "law of the attitude. held: attitude relative to frame (inertial, spin, lvlh, ...), turned by "
               "rate_deg_s; nadir, object, sun, velocity: axis points there; keyframes, aem, spice: "
               "attitudes from that source; pole: IAU rotation by pole_deg, meridian_deg and rate_deg_day"),
        choice("frame", a.frame, frame_names(),
               "axes that the law held refers to; keyframes use the motion's frame"),
        text("of", a.of, std::string(kOf) + "; with the law object, the target"),
    };
    for (Field& field : attitude_keys(a.attitude, {.frame = "the frame"})) list.push_back(std::move(field));
    Fields rest = {
        vector3("rate_deg_s", a.rate_body_rad_s, kDegree_rad, {-1e5, 1e5},
                "angular rate about the body axes, for the law held"),
        optional(choice("nadir_of", a.nadir_of, center_names(),
                        "body at whose centre the law nadir points; left out: center, or with the motion's "
                        "frame local the site's body"),
                 a.has_nadir_of),
        vector3("axis", a.axis, 1, {-1e6, 1e6}, "axis of the body that points at the law's target"),
        vector3("second_axis", a.second_axis, 1, {-1e6, 1e6}, "axis of the body that points near 'second'"),
        choice("second", a.second, {"north", "velocity", "orbit_normal", "nadir", "sun"},
               "direction near which second_axis points; north: +z of the world"),
        optional(numbers("pole_deg", a.pole_rad, kDegree_rad, {-360, 360}, {2, 2},
                         "right ascension and declination in ICRF of the body's +z, for the law pole"),
                 a.has_pole),
        number("meridian_deg", a.meridian_rad, kDegree_rad, {-1e7, 1e7},
               "angle of the body's +x at J2000 from the node on the equator of ICRF, for the law pole"),
        number("rate_deg_day", a.pole_rate_rad_s, kDegree_rad / 86400, {-1e7, 1e7},
               "rate of rotation about the pole, for the law pole"),
        section("aem", a.aem, "attitude ephemeris message, CCSDS 504.0-B"),
        section("spice", a.spice, "frame of the scenario's SPICE kernels"),
        section("jitter", a.jitter, "jitter about the body axes"),
    };
    for (Field& field : rest) list.push_back(std::move(field));
    return list;
}

void validate(const AttitudeConfig& a) {
    using Law = AttitudeConfig::Law;
    check_attitude(a.attitude);
    if (a.attitude.given() && a.law != Law::kHeld)
        throw KeyError(given_key(a.attitude), "has no effect with this law; accepted: law: held, or no '" +
                                                  std::string(given_key(a.attitude)) + "'");
    if (a.attitude.has_radec && a.frame != MotionFrame::kWorld)
        throw KeyError("attitude_radec_deg", kRadecIsWorlds);
    if (a.law == Law::kPole && !a.has_pole) throw KeyError("law", "found pole; it needs 'pole_deg'");
    if (a.law != Law::kPole && (a.has_pole || a.meridian_rad != 0 || a.pole_rate_rad_s != 0))
        throw KeyError(a.has_pole            ? "pole_deg"
                       : a.meridian_rad != 0 ? "meridian_deg"
                                             : "rate_deg_day",
                       "has no effect with this law; accepted: law: pole");
    if (a.has_nadir_of && a.law != Law::kNadir)
        throw KeyError("nadir_of", "has no effect with this law; accepted: law: nadir, or no 'nadir_of'");
}

Fields fields(MotionConfig& m) {
    return {
        required(choice("kind", m.kind, {"fixed", "keyframes", "kepler", "tle", "oem", "cw", "spice"},
                        "source of the positions; cw: relative motion near a thing on a circular orbit "
                        "(Clohessy-Wiltshire)")),
        choice("frame", m.frame, frame_names(),
               "axes of the kinds fixed and keyframes; local: x east, y north, z up at the site"),
        text("of", m.of, kOf),
        choice("center", m.center, center_names(),
               "central body of the orbit or of lvlh, or the body of body_fixed"),
        vector3("position_m", m.position_m, 1, {-kFarthestPlace_m, kFarthestPlace_m},
                "position at the start, for the kinds fixed and cw"),
        vector3("velocity_m_s", m.velocity_m_s, 1, {-kFastestMotion_m_s, kFastestMotion_m_s},
                "velocity in the frame, for the kinds fixed and cw"),
        sections("keyframes", m.keyframes, "waypoints in order of time"),
        section("kepler", m.kepler, "elements of an unperturbed orbit"),
        section("tle", m.tle, "element set (TLE or OMM), propagated by SGP4"),
        section("oem", m.oem, "orbit ephemeris message, CCSDS 502.0-B"),
        section("spice", m.spice, "SPICE object, relative to center"),
        section("attitude", m.attitude, "attitude during the motion"),
        choice("outside", m.outside, {"refuse", "hold"},
               "treatment of times that the file does not cover. refuse: a start outside and gaps are "
               "errors; hold: the body stands still"),
    };
}

void validate(const MotionConfig& m) {
    const auto need = [](bool given, const char* key, const char* kind) {
        if (!given) throw InputError(std::string("has no '") + key + "'; kind " + kind + " needs it");
    };
    using Kind = MotionConfig::Kind;
    const auto forbid = [](bool given, const char* key) {
        if (given)
            throw KeyError(key, std::string("has no effect: kind is not ") + key +
                                    "; accepted: kind: " + key + ", or no '" + key + "'");
    };
    forbid(!m.keyframes.empty() && m.kind != Kind::kKeyframes, "keyframes");
    forbid(m.kepler && m.kind != Kind::kKepler, "kepler");
    forbid(m.tle && m.kind != Kind::kTle, "tle");
    forbid(m.oem && m.kind != Kind::kOem, "oem");
    forbid(m.spice && m.kind != Kind::kSpice, "spice");
    if (m.kind == Kind::kKeyframes) need(!m.keyframes.empty(), "keyframes", "keyframes");
    if (m.kind == Kind::kKepler) need(m.kepler.has_value(), "kepler", "kepler");
    if (m.kind == Kind::kTle) need(m.tle.has_value(), "tle", "tle");
    if (m.kind == Kind::kOem) need(m.oem.has_value(), "oem", "oem");
    if (m.kind == Kind::kSpice) need(m.spice.has_value(), "spice", "spice");
    if (m.kind == Kind::kCw) need(!m.of.empty(), "of", "cw");
    if (m.frame == MotionFrame::kLvlh || m.frame == MotionFrame::kThing)
        need(!m.of.empty(), "of", "with frames lvlh and object");
    for (std::size_t i = 0; i < m.keyframes.size(); ++i)
        if (m.keyframes[i].attitude.has_radec && m.frame != MotionFrame::kWorld)
            throw KeyError("keyframes." + std::to_string(i) + ".attitude_radec_deg", kRadecIsWorlds);
    const AttitudeConfig& a = m.attitude;
    if (a.law == AttitudeConfig::Law::kAem && !a.aem)
        throw InputError("attitude has no 'aem'; law aem needs it");
    if (a.law == AttitudeConfig::Law::kSpice && !a.spice)
        throw InputError("attitude has no 'spice'; law spice needs it");
    if (a.law == AttitudeConfig::Law::kKeyframes && m.kind != Kind::kKeyframes)
        throw InputError("attitude: law keyframes needs kind keyframes");
    const bool any_given = std::any_of(m.keyframes.begin(), m.keyframes.end(),
                                       [](const KeyframeConfig& k) { return k.attitude.given(); });
    if (a.law == AttitudeConfig::Law::kKeyframes && !any_given)
        throw KeyError("attitude.law",
                       "is keyframes, and none of them has an attitude; accepted: attitudes in the "
                       "keyframes, or another law, as nadir");
    const bool of_thing = a.law == AttitudeConfig::Law::kThing ||
                          (a.law == AttitudeConfig::Law::kHeld && a.frame == MotionFrame::kThing);
    if (of_thing && a.of.empty()) throw InputError("attitude has no 'of': the object that it is about");
}

Fields fields(EarthOrientation& o) {
    return {
        number("ut1_minus_utc_s", o.ut1_minus_utc_s, 1, {-0.9, 0.9}, "UT1 - UTC on the day of the run"),
        number("pole_x_arcsec", o.pole_x_rad, kArcsecond_rad, {-2, 2},
               "pole coordinate x, towards Greenwich"),
        number("pole_y_arcsec", o.pole_y_rad, kArcsecond_rad, {-2, 2},
               "pole coordinate y, towards 90 deg west"),
    };
}

Fields fields(LeapSecondsConfig& l) {
    return {
        required(path("file", l.file, "leap-seconds.list of the IERS, as in /usr/share/zoneinfo")),
        choice("expired", l.expired, {"refuse", "warn"},
               "treatment of a scenario that starts after the file's expiry"),
    };
}

std::string apply_leap_seconds(const LeapSecondsConfig& config, const std::string& scenario_utc) {
    const LeapSecondsFile file = load_leap_seconds(config.file);
    use_leap_seconds(file.table);
    if (parse_utc(scenario_utc) < file.expires) return "";
    const std::string what = config.file.string() + ": expired at " + format_utc(file.expires) +
                             ", before the scenario's time_utc, " + scenario_utc;
    if (config.expired == LeapSecondsConfig::Expired::kRefuse)
        throw InputError(what + "; accepted: a newer leap-seconds.list (or expired: warn)");
    return what;
}

}  // namespace hilcam
