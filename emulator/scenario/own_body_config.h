#pragma once
// `bodies` in a scenario: round bodies of its own beside the Moon and the planets (render/sky/own_bodies.h).

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulator/scenario/motion_config.h"
#include "render/sky/body_photometry.h"
#include "render/sky/own_bodies.h"

namespace hilcam {

struct OwnBodyConfig {
    OwnBodyConfig();

    std::string name;
    double equatorial_radius_m = 0, polar_radius_m = 0;  // polar 0: round
    std::size_t center = 5;                              // numbered as MotionConfig::center: Jupiter
    std::optional<KeplerConfig> kepler;
    std::optional<EphemerisFileConfig> oem;
    std::optional<SpiceObjectConfig> spice;  // one of these three
    bool synchronous = true, has_synchronous = false, has_pole = false;
    std::vector<double> pole_rad;  // right ascension, declination
    double meridian_rad = 0, rate_rad_s = 0;
    BodyConfig look;
};
Fields fields(OwnBodyConfig& body);
void validate(const OwnBodyConfig& body);

// Reads their ephemerides. kernels: the scenario's, or none. Throws InputError. Null: there are none.
std::shared_ptr<const OwnBodies> load_own_bodies(const std::vector<OwnBodyConfig>& bodies,
                                                 const std::string& start_utc,
                                                 const std::shared_ptr<SpiceKernels>& kernels = nullptr);

}  // namespace hilcam
