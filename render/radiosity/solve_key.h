#pragma once
// The key of what is solved for a frame (irradiance_cache.h): where the sources are and how the objects stand to each
// other, all of it rounded.

#include <array>
#include <span>
#include <vector>

#include "render/planetshine/planetshine.h"
#include "render/radiosity/inter_object_links.h"
#include "render/scene/lamp.h"

namespace hilcam {

// The terms of an object, by number.
struct RadiosityTerms {
    static constexpr std::size_t kSun = 0, kBodies = 1, kLamps = 1 + Planetshine::kMaxBodies;
    std::size_t lamps = 0;
    bool emission = false;

    std::size_t glow() const { return kLamps + lamps; }
    std::size_t count() const { return kLamps + lamps + (emission ? 1 : 0); }
    RadiositySource::Kind kind(std::size_t term) const;
};

// The places of all that matters in a frame, as they are; world axes.
struct SolveInputs {
    struct Lamp {
        std::size_t number;
        Vec3d position_world_m;
        Vec3f axis;
        const LampBeam* beam;
    };
    struct Body {
        Vec3f dir;
        float cosine;
    };
    std::vector<Pose> objects;
    bool sun = false;
    Vec3f sun_dir;
    std::size_t body_count = 0;
    std::array<Body, Planetshine::kMaxBodies> bodies;
    std::vector<Lamp> lamps;

    // Finds what comes after `now`, as far from it as `by` times what lies between it and `then`, everything
    // moving on as it did. False where they have not the same things in them. No allocation but at the first
    // calls.
    static bool extrapolate(const SolveInputs& then, const SolveInputs& now, double by, SolveInputs& out);
};

struct SolveKey {
    std::vector<std::vector<NeighbourObject>> near;     // by object
    std::vector<std::vector<RadiositySource>> sources;  // by object and term; kNone: it does not shine
    std::vector<std::uint32_t> group;  // by object: those of one number stand near each other

    // Makes all the room that set() can need. Owner thread.
    void reserve(std::size_t objects, const RadiosityTerms& terms);
    // lights: by object, null where none is cached. No allocation after reserve(); without it at the first call
    // and for neighbours that are more than ever before. Loop.
    void set(const SolveInputs& inputs, std::span<const IrradianceCache* const> lights,
             const RadiosityTerms& terms);
    bool operator==(const SolveKey& o) const { return near == o.near && sources == o.sources; }
};

}  // namespace hilcam
