#pragma once
// The cached light of all objects (irradiance_cache.h) as one frame has it: brought up to where the sources are, and
// looked up where a path meets a surface (cached_reflection.cpp).
//
// Cached are the light between the parts of an object and between objects that stand near each other, and what
// of the bodies' light reaches them past their parts. The Sun and lamps shine on what a path meets by rays as
// ever, and by way of flat mirrors (mirror_sunlight.h). Not cached: light of terrain, between objects far apart.

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
    // Light is cached on the objects that have a table. They outlive this. Owner thread.
    IndirectCache(std::span<const ShownObject> objects, const EmbreeScene& scene, const ColorBands& bands,
                  const Settings& settings);

    // Prepares a frame, after everything else is placed; solves for what has moved by a step, where that was
    // not done ahead. Loop.
    void place(const FrameContext& frame, const WorldSnapshot& world);
    // Has the light of a frame that is placed solved by the thread that looks ahead, for who can do without
    // it meanwhile. True: that is done, and place() has no more to solve than what has moved since the first
    // call. Before the first place(); loop, nothing is allocated and nobody waited for.
    bool prepare(const FrameContext& frame, const WorldSnapshot& world);
    // From now on nothing is made before a frame asks for it, and no thread is left that would. Owner thread.
    void stop_looking_ahead() { updates_->stop_looking_ahead(); }

    bool keeps(std::size_t object) const { return object < objects_.size() && objects_[object].light; }
    const IrradianceCache& light(std::size_t object) const { return *objects_[object].light; }
    // Returns the probe whose light is looked up at a point of an object, the nearest of those about it; none: there are none.
    // side: its normal by world axes. Any thread.
    std::optional<std::uint32_t> nearest_probe(const FrameContext& frame, std::size_t object, Vec3f point_m,
                                               const SurfaceSide& side) const;
    // Says in words what is cached on an object.
    std::string describe(std::size_t object) const;

    // Adds to the tile's pixels what shading points whose light is cached reflect of it, narrow lobes apart. requests: gets what
    // is left to rays, by the shading point's number. Loop, any thread.
    void add_reflected(Tile& tile, std::span<const ShadingPoint> points,
                       std::span<GlossyRequest> requests) const;
    // Adds what they reflect of the Sun by way of flat mirrors. Loop, any thread.
    void add_mirror_sunlight(Tile& tile, std::span<const ShadingPoint> points) const {
        mirror_sunlight_.add_light(tile, points);
    }
    // Returns what the facets of a shading point whose light is cached reflect of light from everywhere. Loop, any thread.
    Spectrum lobe_albedo(const ShadingPoint& at) const;
    const Planetshine& planetshine() const { return planetshine_; }
    // Adds what a lobe too narrow to be cached reflects of the bodies; mirror: its middle. Loop, any thread.
    void add_bodies_in_lobe(const FrameContext& frame, const ShadingPoint& at, Vec3f mirror, Spectrum weight,
                            Spectrum& radiance) const;

  private:
    struct Object {
        std::unique_ptr<IrradianceCache> light;
        Vec3f origin_m;  // in ray space
    };
    RadiosityTerms terms_;
    std::vector<Object> objects_;
    std::vector<const IrradianceCache*> lights_;  // the light kept on each of them
    std::unique_ptr<SolveAhead> updates_;
    Planetshine planetshine_;
    MirrorSunlight mirror_sunlight_;
    // The inputs now, some frames ago, and as far ahead, and the keys that they ask for.
    static constexpr std::uint64_t kStride = 16;  // frames
    SolveInputs now_, before_, long_before_, ahead_;
    SolveKey key_, ahead_key_;
    std::uint64_t frames_ = 0;
    bool is_asked_ = false;  // prepare() has been called

    void set_key(const FrameContext& frame, const WorldSnapshot& world);
    void take_inputs(const FrameContext& frame, const WorldSnapshot& world);
    void look_ahead();

    // The radiance that a lobe sends of each body, if nothing is in the way; where a texture colours facets
    // (has_own_colors()) white, with the cosine that Fresnel's term has.
    using SentOfBodies = std::array<Planetshine::Glossy, Planetshine::kMaxBodies>;
    // A shading point on its way through the lookup: many go together, so that none waits for memory.
    struct Place {
        const ShadingPoint* at;
        std::uint32_t quad;  // square of four pixels in which it is seen
        SurfaceProbes::Search search;
        ProbeWeights about;
        std::uint32_t nearest;  // probe, where there is one
        bool found;
        // Radiance that is reflected to the viewer: by all but facets, and by those of other surfaces and of bodies. Where a
        // texture colours facets, theirs is what white ones would reflect.
        Spectrum diffuse, met;
        SentOfBodies bodies;
        SentOfBodies unhidden;                            // the latter, if nothing were in the way
        std::array<float, Planetshine::kMaxBodies> free;  // share of each that nothing is in the way of
        float directions;                                 // that bring what is met (IrradianceCache::Lobe)
        bool mirrors_near;                                // see GlossyRequest
        bool has_bodies;                                  // likewise
    };
    // A shading point, its number, and the place whose light it has.
    struct Use {
        const ShadingPoint* at;
        std::uint32_t number;
        Place* place;
    };
    // Shading points that go together, and where they are.
    struct Together {
        std::array<Place, 32> places;
        std::array<Use, 128> uses;
        std::size_t place_count = 0, use_count = 0;
    };
    // A lobe's reflection of other surfaces.
    struct MetByLobe {
        Spectrum radiance;  // white or coloured as that of a place
        // Share of each body's light that comes without a way.
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
    // Returns it in the colours that a shading point has.
    static Spectrum colored(const Bsdf& at, const Planetshine::Glossy& sent);
    Spectrum sum_of_bodies(const ShadingPoint& at, const SentOfBodies& sent) const;
};

}  // namespace hilcam
