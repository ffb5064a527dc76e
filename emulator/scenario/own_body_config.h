#pragma once
// The section `bodies`: round bodies that the scenario adds to the Moon and the planets
// (render/sky/own_bodies.h).

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
    double equatorial_radius_m = 0, polar_radius_m = 0;  // polar 0: a sphere
    std::size_t center = 5;                              // numbered like MotionConfig::center; 5 is Jupiter
    std::optional<KeplerConfig> kepler;
    std::optional<EphemerisFileConfig> oem;
    std::optional<SpiceObjectConfig> spice;  // exactly one of kepler, oem and spice
    bool synchronous = true, has_synchronous = false, has_pole = false;
    std::vector<double> pole_rad;  // right ascension, declination
    double meridian_rad = 0, rate_rad_s = 0;
    BodyConfig look;
};
Fields fields(OwnBodyConfig& body);
void validate(const OwnBodyConfig& body);

// Reads the bodies' ephemerides. kernels: the scenario's, or null. Returns null when there are no bodies.
// Throws InputError.
std::shared_ptr<const OwnBodies> load_own_bodies(const std::vector<OwnBodyConfig>& bodies,
                                                 const std::string& start_utc,
                                                 const std::shared_ptr<SpiceKernels>& kernels = nullptr);

}  // namespace hilcam
