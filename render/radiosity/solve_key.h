#pragma once
// The key of what is solved for a frame (irradiance_cache.h): the positions of the sources and the relative
// poses of the objects, all rounded.

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

// The exact positions of everything that matters in a frame; world axes.
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

    // Extrapolates from `then` to `now` and beyond by `by` times their difference. Returns false if the two
    // do not contain the same things. Allocates in the first calls only.
    static bool extrapolate(const SolveInputs& then, const SolveInputs& now, double by, SolveInputs& out);
};

struct SolveKey {
    std::vector<std::vector<NeighbourObject>> near;     // by object
    std::vector<std::vector<RadiositySource>> sources;  // by object and term; kNone: the source is off
    std::vector<std::uint32_t> group;  // by object: objects with the same number are near each other

    // Allocates everything that set() can need. Owner thread.
    void reserve(std::size_t objects, const RadiosityTerms& terms);
    // lights: by object, null if the object caches no light. Without reserve() it allocates at the first
    // call, and for more neighbours than ever before. Loop.
    void set(const SolveInputs& inputs, std::span<const IrradianceCache* const> lights,
             const RadiosityTerms& terms);
    bool operator==(const SolveKey& o) const { return near == o.near && sources == o.sources; }
};

}  // namespace hilcam
