#pragma once
// Keeps reference pictures on disk, because one takes minutes to make.

#include <optional>
#include <span>
#include <string>

#include "emulator/tradeoff/picture_judge.h"
#include "io/cache/cache.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

// Returns everything that a reference depends on, and more, as text: the limits, the pose of the camera's
// body, and the scenario at the reference's settings (scenario_listing.h: a file by its name, length and
// CRC-32, a generated mesh by the generator's arguments). Quality keys at their defaults are left out, so
// that a new key with no effect on the reference does not invalidate it; kReferenceVersion covers changes of
// defaults.
std::string reference_key(const ScenarioConfig& reference, const Pose& body, const ReferenceLimits& limits);

// Raised when the same key would give another reference, after changes of the path tracer, the sensor's
// optics, a default, or a generated mesh.
inline constexpr std::uint32_t kReferenceVersion = 6;

// Returns the name of the key's file in the cache.
std::string reference_name(const std::string& key);
// Returns the stored reference bit by bit, and fills the images `beside` it, which have its size. Returns
// nothing when the file is missing, damaged, of another key or version, or has another number of images; the
// content of `beside` is then undefined.
std::optional<ReferencePicture> kept_reference(const Cache& cache, const std::string& key,
                                               std::span<ElectronImage* const> beside = {});
// Stores a reference. A folder that cannot be written is ignored.
void keep_reference(const Cache& cache, const std::string& key, const ReferencePicture& picture,
                    std::span<const ElectronImage* const> beside = {});

}  // namespace hilcam
