#pragma once
// The irradiance caches (irradiance_cache.h) of all objects for one frame: updated to the sources' positions
// and looked up where a path meets a surface (cached_reflection.cpp). See docs/rendering.md, "Cached light".
//
// Cached: light between the parts of an object and between objects near each other, and the share of the
// bodies' light that the parts do not block. Rays find the light of the Sun and lamps on what a path meets,
// also by way of flat mirrors (mirror_sunlight.h). Not cached: light of terrain, and light between objects
// far apart.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/indirect/glossy_request.h"
#include "render/indirect/mirror_sunlight.h"
#include "render/planetshine/planetshine.h"
#include "render/radiosity/solve_ahead.h"
#include "render/scene/shown_object.h"
#include "render/shading/tile.h"

namespace hilcam {

class IndirectCache {
  public:
    struct Settings {
        float step_rad = 0;  // step of the grid to which sources are rounded
        std::size_t lamps = 0;
        bool emission = false;
    };
    // Objects that have a transfer table cache light. They must outlive this. Owner thread.
    IndirectCache(std::span<const ShownObject> objects, const EmbreeScene& scene, const ColorBands& bands,
                  const Settings& settings);

    // Prepares a frame after everything else has been placed: solves what has changed by a step, unless that
    // was done ahead. Loop.
    void place(const FrameContext& frame, const WorldSnapshot& world);
    // Lets the thread that works ahead solve the light of a placed frame; meanwhile frames do without it.
    // Returns true when that is done; place() then has to solve only what has changed since the first call.
    // Call it before the first place(). Loop; no allocation, no waiting.
    bool prepare(const FrameContext& frame, const WorldSnapshot& world);
    // Ends the thread that works ahead; light is then solved when a frame needs it. Owner thread.
    void stop_looking_ahead() { updates_->stop_looking_ahead(); }

    bool keeps(std::size_t object) const { return object < objects_.size() && objects_[object].light; }
    const IrradianceCache& light(std::size_t object) const { return *objects_[object].light; }
    // Returns the nearest of the probes about a point of an object, from which its light is looked up;
    // nothing if there are none. side: with its normal in world axes. Any thread.
    std::optional<std::uint32_t> nearest_probe(const FrameContext& frame, std::size_t object, Vec3f point_m,
                                               const SurfaceSide& side) const;
    // Describes in words what is cached on an object.
    std::string describe(std::size_t object) const;

    // Adds the cached light that shading points reflect to the tile's pixels, except narrow lobes. requests:
    // by shading point, gets what is left to rays. Loop, any thread.
    void add_reflected(Tile& tile, std::span<const ShadingPoint> points,
                       std::span<GlossyRequest> requests) const;
    // Adds the sunlight that they reflect by way of flat mirrors. Loop, any thread.
    void add_mirror_sunlight(Tile& tile, std::span<const ShadingPoint> points) const {
        mirror_sunlight_.add_light(tile, points);
    }
    // Returns the share of uniform light that the facets of a shading point reflect. Loop, any thread.
    Spectrum lobe_albedo(const ShadingPoint& at) const;
    const Planetshine& planetshine() const { return planetshine_; }
    // Adds the bodies' light that a lobe too narrow for the cache reflects. mirror: the lobe's middle. Loop,
    // any thread.
    void add_bodies_in_lobe(const FrameContext& frame, const ShadingPoint& at, Vec3f mirror, Spectrum weight,
                            Spectrum& radiance) const;

  private:
    struct Object {
        std::unique_ptr<IrradianceCache> light;
        Vec3f origin_m;  // in ray space
    };
    RadiosityTerms terms_;
    std::vector<Object> objects_;
    std::vector<const IrradianceCache*> lights_;  // cache of each object
    std::unique_ptr<SolveAhead> updates_;
    Planetshine planetshine_;
    MirrorSunlight mirror_sunlight_;
    // Inputs of this frame, of one up to kStride frames ago, and extrapolated ahead; and the keys that they
    // give.
    static constexpr std::uint64_t kStride = 16;  // frames
    SolveInputs now_, before_, long_before_, ahead_;
    SolveKey key_, ahead_key_;
    std::uint64_t frames_ = 0;
    bool is_asked_ = false;  // prepare() has been called

    void set_key(const FrameContext& frame, const WorldSnapshot& world);
    void take_inputs(const FrameContext& frame, const WorldSnapshot& world);
    void look_ahead();

    // For each body, the radiance that a lobe reflects of it if nothing is in the way. If a texture colours
    // the facets (has_own_colors()), it is that of white facets, with the cosine for Fresnel's term.
    using SentOfBodies = std::array<Planetshine::Glossy, Planetshine::kMaxBodies>;
    // A shading point during the lookup. Many are processed together, so that none waits for memory.
    struct Place {
        const ShadingPoint* at;
        std::uint32_t quad;  // square of four pixels that sees it
        SurfaceProbes::Search search;
        ProbeWeights about;
        std::uint32_t nearest;  // nearest probe, if there is one
        bool found;
        // Radiance that it reflects to the viewer: without facets, and by facets from other surfaces and from
        // bodies. If a texture colours the facets, the latter are those of white facets.
        Spectrum diffuse, met;
        SentOfBodies bodies;
        SentOfBodies unhidden;                            // `bodies` if nothing were in the way
        std::array<float, Planetshine::kMaxBodies> free;  // unblocked share of each body
        float directions;   // effective number of directions that bring `met` (IrradianceCache::Lobe)
        bool mirrors_near;  // see GlossyRequest
        bool has_bodies;    // see GlossyRequest
    };
    // A shading point, its number, and the place whose light it uses.
    struct Use {
        const ShadingPoint* at;
        std::uint32_t number;
        Place* place;
    };
    // Shading points that are processed together, and their places.
    struct Together {
        std::array<Place, 32> places;
        std::array<Use, 128> uses;
        std::size_t place_count = 0, use_count = 0;
    };
    // The light of other surfaces that a lobe reflects.
    struct MetByLobe {
        Spectrum radiance;  // white or coloured like Place::met
        // Unblocked share of each body's light.
        std::array<float, Planetshine::kMaxBodies> free;
        float directions;
    };
    std::size_t gather(const Tile& tile, std::span<const ShadingPoint> points, std::size_t first,
                       Together& block) const;
    Place* shared_place(std::span<Place> places, const ShadingPoint& at, std::uint32_t quad) const;
    void find(const FrameContext& frame, std::span<Place> places) const;
    static bool is_lit(const Place& place) { return !place.found || place.about.count > 0; }
    bool is_near(const FrameContext& frame, const Place& place) const;
    template <class Where>
    Spectrum others(const FrameContext& frame, const IrradianceCache& light, const Where& where) const;
    Spectrum reflect_diffuse(const FrameContext& frame, const Place& place) const;
    Spectrum direct_irradiance(std::size_t body, const Place& place) const;
    Spectrum reflect_body(std::size_t body, const Place& place) const;
    Spectrum reflect_bodies(const Place& place) const;
    Spectrum radiance_of(const Place& place, const Spectrum& irradiance) const;
    void reflect_clusters(const FrameContext& frame, Place& place) const;
    void reflect_lobe(const FrameContext& frame, Place& place) const;
    void reflect_far_bodies(Place& place) const;
    MetByLobe met_by_lobe(const FrameContext& frame, const Place& place, bool whole) const;
    SentOfBodies sent_of_bodies(const ShadingPoint& at) const;
    void add_use(Tile& tile, const Use& use, std::span<GlossyRequest> requests) const;
    float share_of_rays(const Tile& tile, const ShadingPoint& at, const Place& place,
                        const Spectrum& met) const;
    GlossyPoint* leave_to_rays(Tile& tile, const ShadingPoint& at, const Place& place,
                               const Spectrum& met) const;
    Planetshine::Glossy sent_of_body(std::size_t body, const ShadingPoint& at, Vec3f normal,
                                     float reflectance) const;
    Planetshine::Glossy sent_by_parts(std::size_t body, const ShadingPoint& at, float reflectance) const;
    // Returns it in the shading point's colours.
    static Spectrum colored(const Bsdf& at, const Planetshine::Glossy& sent);
    Spectrum sum_of_bodies(const ShadingPoint& at, const SentOfBodies& sent) const;
};

}  // namespace hilcam
