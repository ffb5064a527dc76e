#pragma once
// The reference of a view of the zoo: random paths alone, frame upon frame, and how far their mean may be off.
//
// Beside the picture it has what the picture becomes when the scene moves by a quarter of a pixel. The reference's
// radiance image has four columns to a pixel, so that is the same light, moved by a column, through the lens once more:
// no other rays are needed, and the change has less noise than two pictures have.
//
// Frames come in two halves; half the halves' difference estimates the mean's error by pixel. Frames are added, twice as many
// each time, until 99 % of the lit pixels are known to a share of the sensor's noise.

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
    ElectronImage error;                 // half the difference of the halves' means, cut off as they are [e-]
    ElectronImage change, change_error;  // the same of the difference that the pan makes
};

// KEY=VALUE beside reference_overrides(): one ray a radiance pixel, of which a pixel has 4 x 4, and the guard band of the shipped
// qualities: what shines just beside the picture, the Sun above all, must shine into both or into none.
std::vector<std::string> zoo_reference_overrides();
// The pan of a reference at these settings [px]; 0 where its radiance image is as coarse as the picture.
double pan_px_of(const ScenarioConfig& reference);

// camera: of that scenario, as it stands. Owner thread.
ZooReference render_zoo_reference(StillCamera& camera, const ScenarioConfig& reference,
                                  const ReferenceLimits& limits,
                                  const std::function<void(const std::string&)>& log);

// As kept_reference() and keep_reference() of reference_cache.h, by the key that reference_key() gives. The file of a
// reference without its pan is another one.
std::optional<ZooReference> kept_zoo_reference(const Cache& cache, const std::string& key);
void keep_zoo_reference(const Cache& cache, const std::string& key, const ZooReference& reference);

}  // namespace hilcam
