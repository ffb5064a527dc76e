#pragma once
// The parts of the light in a pixel, by the way it came. A picture can be taken apart into them
// (docs/pictures.md). All light that a ray finds behind the first surface counts as that ray's part.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace hilcam {

enum class LightPart : std::uint8_t {
    kEmission,      // surfaces that glow
    kSun,           // the Sun, on surfaces that the camera sees
    kLamps,         // lamps, on the same surfaces
    kPlanetshine,   // Earth, Moon and planets, directly on the same surfaces
    kMirroredSun,   // the Sun by way of flat mirrors
    kDiffuse,       // light from other surfaces, from the cache, scattered diffusely
    kGlossy,        // the same, scattered by facet lobes
    kGlossyRays,    // light found by rays along a glossy lobe
    kMirrorRays,    // light found by mirror rays
    kTransmission,  // light seen through glass
    kPath,          // light found by random paths, or along the directions of a hemisphere
    kBackground,    // bodies and the Sun's disk where no object covers them
    kAir,           // air between the camera and the surface
    kPoints,        // stars, lamps and small things drawn as points, which the sensor adds to the picture
};
inline constexpr std::size_t kLightParts = 14;
// The parts that are in the radiance image: all but points.
inline constexpr std::size_t kImageParts = kLightParts - 1;

// The layers' names, as renderers have them: `direct.` comes straight from its source, `indirect.` by way of
// another surface.
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
