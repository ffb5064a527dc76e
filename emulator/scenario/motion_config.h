#pragma once
// The section `motion`: the source of a thing's positions and attitudes until commands replace it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emulator/motion/attitude_jitter.h"
#include "emulator/scenario/attitude_keys.h"
#include "emulator/scenario/spice_config.h"
#include "io/files/element_set.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/earth_orientation.h"

namespace hilcam {

struct KeyframeConfig {
    double at_s = 0;
    Vec3d position_m, velocity_m_s;
    AttitudeForms attitude;
    bool has_velocity = false;
};
Fields fields(KeyframeConfig& keyframe);
void validate(const KeyframeConfig& keyframe);

struct KeplerConfig {
    double semi_major_axis_m = 0, eccentricity = 0, inclination_rad = 0, node_rad = 0, periapsis_rad = 0;
    double mean_anomaly_rad = 0, true_anomaly_rad = 0;
    bool has_mean = false, has_true = false;
    std::string epoch_utc;  // empty: scenario's start
};
Fields fields(KeplerConfig& kepler);
void validate(const KeplerConfig& kepler);

struct TleConfig {
    std::filesystem::path file;
    std::string satellite;
    TleChecksum checksum = TleChecksum::kVerify;
    double valid_s = 30 * 86400.0;
};
Fields fields(TleConfig& tle);

struct EphemerisFileConfig {
    std::filesystem::path file;
    std::string object;
};
Fields fields(EphemerisFileConfig& file);

// The same kinds as PlacedFrame::Kind (emulator/motion/placed_frame.h).
enum class MotionFrame { kWorld, kBodyFixed, kLvlh, kThing, kLocal };

struct AttitudeConfig {
    enum class Law {
        kHeld,
        kNadir,
        kThing,
        kSun,
        kVelocity,
        kKeyframes,
        kAem,
        kSpice,
        kPole
    } law = Law::kHeld;
    MotionFrame frame = MotionFrame::kWorld;
    std::string of;
    AttitudeForms attitude;
    std::size_t nadir_of = 2;  // numbered like MotionConfig::center
    Vec3d rate_body_rad_s;
    Vec3d axis{0, 0, 1}, second_axis{0, -1, 0};
    enum class Second { kNorth, kVelocity, kOrbitNormal, kNadir, kSun } second = Second::kNorth;
    std::optional<EphemerisFileConfig> aem;
    std::optional<SpiceFrameConfig> spice;
    std::optional<JitterBand> jitter;
    std::vector<double> pole_rad;  // right ascension, declination
    double meridian_rad = 0, pole_rate_rad_s = 0;
    bool has_nadir_of = false, has_pole = false;
};
Fields fields(AttitudeConfig& attitude);
void validate(const AttitudeConfig& attitude);

struct MotionConfig {
    enum class Kind { kFixed, kKeyframes, kKepler, kTle, kOem, kCw, kSpice } kind = Kind::kFixed;
    MotionFrame frame = MotionFrame::kWorld;
    std::string of;          // thing for frames lvlh and thing: an object's name, or "camera"
    std::size_t center = 2;  // index of a BodyId, or kBodyCount for the Sun; 2 is the Earth
    Vec3d position_m, velocity_m_s;
    std::vector<KeyframeConfig> keyframes;
    std::optional<KeplerConfig> kepler;
    std::optional<TleConfig> tle;
    std::optional<EphemerisFileConfig> oem;
    std::optional<SpiceObjectConfig> spice;
    AttitudeConfig attitude;
    enum class Outside { kRefuse, kHold } outside = Outside::kRefuse;
};
Fields fields(MotionConfig& motion);
void validate(const MotionConfig& motion);

Fields fields(EarthOrientation& orientation);

// Leap seconds of the scenario, in place of ERFA's own.
struct LeapSecondsConfig {
    std::filesystem::path file;
    enum class Expired { kRefuse, kWarn } expired = Expired::kRefuse;
};
Fields fields(LeapSecondsConfig& leap);

// Makes the file's table the whole program's. Returns the warning to print, or an empty text. Throws
// InputError when the scenario begins after the table expires. Call before any other thread asks for a time.
std::string apply_leap_seconds(const LeapSecondsConfig& config, const std::string& scenario_utc);

}  // namespace hilcam
