#pragma once
// Where light comes from that is kept (kept_light.h): a place in an object's own axes, rounded, so that what
// is kept for it is a function of the place alone.

#include <cstdint>

#include "render/scene/lamp.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A source in an object's own axes.
struct KeptSource {
    enum class Kind : std::uint8_t {
        kNone,
        kSun,   // a point far away; unit: 1 W m^-2 um^-1 across the way
        kCone,  // a body's disk, of even radiance; the same unit on a surface that faces it
        kLamp,  // a lamp; unit: intensity on its axis
        kGlow   // what the materials emit
    };
    Kind kind = Kind::kNone;
    Vec3f dir{};            // to it; unit. A lamp's axis
    float cone_cosine = 1;  // of the cone's half angle
    Vec3f position_m{};     // of a lamp
    const LampBeam* beam = nullptr;

    bool operator==(const KeptSource& o) const {
        return kind == o.kind && dir == o.dir && cone_cosine == o.cone_cosine && position_m == o.position_m &&
               beam == o.beam;
    }
    // At the middle of its cell of a grid of about `step_rad`, and of a hundredth of what is near for a
    // lamp's place.
    KeptSource rounded(float step_rad) const;
};

}  // namespace hilcam
