#pragma once
// Reference pictures kept on disk: one takes minutes.

#include <optional>
#include <span>
#include <string>

#include "emulator/tradeoff/picture_judge.h"
#include "io/cache/cache.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

// All that a reference depends on, and more than that, as text: the limits, where the camera's body stands,
// and the scenario at the reference's settings (scenario_listing.h: a file by its name, length and CRC-32; a
// generated mesh by the generator's arguments). A key of the quality at its default is not in it, so that a
// new one that the reference has no use for makes no other reference; kReferenceVersion stands for the
// defaults.
std::string reference_key(const ScenarioConfig& reference, const Pose& body, const ReferenceLimits& limits);

// Raised when the same key would give another reference: the path tracer, the sensor's optics, a default, a
// generated mesh.
inline constexpr std::uint32_t kReferenceVersion = 4;

// The name of that key's file in the cache.
std::string reference_name(const std::string& key);
// Returns the reference that is kept there, bit by bit, and fills the images `beside` it, which have its size. None when
// there is no file, or it is damaged, has another number of images, or is another key's or version's; `beside` then
// holds anything.
std::optional<ReferencePicture> kept_reference(const Cache& cache, const std::string& key,
                                               std::span<ElectronImage* const> beside = {});
// A folder that cannot be written is no failure.
void keep_reference(const Cache& cache, const std::string& key, const ReferencePicture& picture,
                    std::span<const ElectronImage* const> beside = {});

}  // namespace hilcam
