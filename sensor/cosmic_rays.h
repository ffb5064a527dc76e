#pragma once
// Tracks of charged particles through the detector: a Poisson number for each exposure, in isotropic
// directions, straight through the depleted depth. The charge per um is log-normal with the given mean and
// spread, so no track is negative, and large losses are rare, as in thin layers (Landau, J. Phys. USSR 8,
// 201, 1944).
//
// A minimum ionising particle leaves about 80 e-/um in silicon (Particle Data Group, Review of Particle
// Physics, 2022, section 34); protons of 10-100 MeV leave some hundreds.

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/random.h"

namespace hilcam {

struct CosmicRayConfig {
    double rate_cm2_s = 0;
    double depth_um = 10;
    double electrons_per_um = 80;
    double spread_fraction = 0.3;  // standard deviation over mean of a track's electrons per um
};
Fields fields(CosmicRayConfig& config);

// Adds the tracks of one exposure, at most kMaxTracks. Loop, one thread.
inline constexpr std::uint32_t kMaxTracks = 1'000'000;
void add_tracks(const CosmicRayConfig& config, double pitch_m, double exposure_s, RandomKey key,
                ElectronImage& charge_e);

}  // namespace hilcam
