#pragma once
// The reference for a view of the zoo: the mean of frames with random light paths, and an estimate of its
// error.
//
// The reference also has the change of the picture when the scene moves by a quarter of a pixel. Its radiance
// image has four columns for each pixel, so the same light is shifted by one column and passes the lens
// again. That needs no further rays, and the change has less noise than two independent pictures.
//
// Frames form two halves, and half the difference of their means estimates the mean's error in each pixel.
// The number of frames is doubled until 99 % of the lit pixels are known to a given share of the sensor's
// noise.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/run/still_camera.h"
#include "emulator/tradeoff/picture_judge.h"
#include "io/cache/cache.h"

namespace hilcam {

// standard_error is |error| / sigma.
struct ZooReference : ReferencePicture {
    // Half the difference of the halves' means, each cut off at saturation [e-].
    ElectronImage error;
    ElectronImage change, change_error;  // the same for the change by the pan
};

// Returns KEY=VALUE in addition to reference_overrides(): one ray for each radiance pixel, 4 x 4 of which
// make a pixel, and the guard band of the shipped qualities, so that light just outside the picture, above
// all the Sun's, affects reference and frame alike.
std::vector<std::string> zoo_reference_overrides();
// Returns the pan of a reference at these settings [px]; 0 if its radiance image is as coarse as the picture.
double pan_px_of(const ScenarioConfig& reference);

// camera: for that scenario, in its present position. Owner thread.
ZooReference render_zoo_reference(StillCamera& camera, const ScenarioConfig& reference,
                                  const ReferenceLimits& limits,
                                  const std::function<void(const std::string&)>& log);

// Like kept_reference() and keep_reference() of reference_cache.h, with the key of reference_key(). A
// reference without a pan has another file.
std::optional<ZooReference> kept_zoo_reference(const Cache& cache, const std::string& key);
void keep_zoo_reference(const Cache& cache, const std::string& key, const ZooReference& reference);

}  // namespace hilcam
