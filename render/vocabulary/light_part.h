#pragma once
// The parts of the light in a pixel, by the way it came: a picture can be taken apart into them (docs/pictures.md). Light that a ray
// finds behind the first surface belongs to the part of that ray, whatever lights what it meets.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace hilcam {

enum class LightPart : std::uint8_t {
    kEmission,      // surfaces that glow
    kSun,           // the Sun on what the camera sees
    kLamps,         // lamps on it
    kPlanetshine,   // Earth, Moon and planets on it, without a detour
    kMirroredSun,   // the Sun by way of flat mirrors
    kDiffuse,       // light by way of other surfaces, from the cache, to all sides
    kGlossy,        // the same by facets
    kGlossyRays,    // light that rays along a glossy lobe meet
    kMirrorRays,    // light that a mirror shows
    kTransmission,  // light that is seen through glass
    kPath,          // light that random paths, or the directions of a hemisphere, find
    kBackground,    // bodies and the Sun's disk, where no object stands before them
    kAir,           // air between the camera and what it sees
    kPoints,  // stars, lamps and small things that are drawn as points: the sensor adds them to the picture
};
inline constexpr std::size_t kLightParts = 14;
// Parts that are in the radiance image: all but points.
inline constexpr std::size_t kImageParts = kLightParts - 1;

// Names of layers as renderers have them: `direct.` is light from its source, `indirect.` has met another surface.
inline constexpr std::array<std::string_view, kLightParts> kLightPartNames = {"emission",
                                                                              "direct.sun",
                                                                              "direct.lamps",
                                                                              "direct.planetshine",
                                                                              "indirect.mirrored_sun",
                                                                              "indirect.diffuse",
                                                                              "indirect.glossy",
                                                                              "rays.glossy",
                                                                              "rays.mirror",
                                                                              "rays.transmission",
                                                                              "rays.path",
                                                                              "background",
                                                                              "air",
                                                                              "points"};
constexpr std::string_view name_of(LightPart part) { return kLightPartNames[static_cast<std::size_t>(part)]; }
constexpr std::optional<LightPart> light_part_of(std::string_view name) {
    for (std::size_t i = 0; i < kLightParts; ++i)
        if (kLightPartNames[i] == name) return static_cast<LightPart>(i);
    return std::nullopt;
}

}  // namespace hilcam
