#pragma once
// The light between the parts of an object, kept between frames at its probes (probes/surface_probes.h). See
// docs/rendering.md, "Cached light".
//
// Each source has a term: the irradiance that reaches every probe by way of other surfaces, with all bounces,
// per unit of the source (radiosity_solver.h computes it). A term depends only on the tables, on the source's
// position in the object's axes, rounded to a step, and on the relative poses of near objects, rounded too.
// So a frame depends only on its commands. The strength of the source (eclipses, the Sun's distance, a lamp's
// level) is a factor at the pixel.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/brdf/microfacet.h"
#include "render/planetshine/planetshine.h"
#include "render/probes/flat_mirrors.h"
#include "render/probes/transfer_table.h"
#include "render/radiosity/radiosity_source.h"
#include "render/scene/color_bands.h"
#include "render/scene/embree_scene.h"
#include "render/scene/material_albedo.h"
#include "render/scene/shown_object.h"
#include "render/vocabulary/packed_spectrum.h"

namespace hilcam {

class InterObjectLinks;

// Facet lobes narrower than this (GGX alpha) fall between a probe's directions: rays follow them, and the
// cache has their tails only.
inline constexpr float kMinCachedAlpha = 0.12f;
// A lobe narrower than this gets a mirror ray; a wider one may get glossy rays, which neighbours share.
inline constexpr float kNarrowestLobe = 0.02f;
// Lists of directions are padded to a multiple of this.
inline constexpr std::size_t kDirectionLanes = 16;
// Returns the share of a narrow lobe that its rays do not represent: facets that lean by more than 11 degrees
// from the normal (GGX seen along it: Walter et al., EGSR 2007, eq. 35 inverted).
inline float tail_share(float alpha) { return alpha * alpha / (alpha * alpha + 0.0378f); }

// The albedos of an object's materials, its mirrors, and the neighbours of its probes. Objects of one
// prototype share it.
struct ObjectAlbedos {
    // mesh: with the object's triangles. min_alpha: smallest alpha of facets as other surfaces see them.
    ObjectAlbedos(const ObjectSurfaces& surfaces, const MeshView& mesh, const SurfaceProbes& probes,
                  float min_alpha);

    std::vector<MaterialAlbedo> own, wide;  // by surface; `wide`: with facets as other surfaces see them
    std::vector<FlatMirror> mirrors;        // the object's flat mirrors; their sunlight is not in the cache
    ProbeNeighbours neighbours;
};

// The solution of a term: what one source gives to every probe, per unit of the source.
struct RadiositySolution {
    // Irradiance by way of other surfaces. If few directions bring it, it is averaged with the neighbours
    // (RadiositySolver::smooth).
    std::vector<PackedSpectrum> irradiance;
    // Radiance along each table entry of probes with facets, and along each link; for the Sun only.
    std::vector<PackedSpectrum> along, along_links;
    std::vector<std::uint8_t> seen;  // unblocked share of a cone, of 255

    std::size_t bytes() const {
        return (irradiance.size() + along.size() + along_links.size()) * sizeof(PackedSpectrum) + seen.size();
    }
};

class IrradianceCache {
  public:
    // A sphere that holds all probes; body axes.
    struct Bounds {
        Vec3f middle_m;
        float radius_m = 0;
        bool is_met(Vec3f origin_m, Vec3f unit_dir) const {
            const Vec3f way = middle_m - origin_m;
            const float along = dot(way, unit_dir), outside = dot(way, way) - radius_m * radius_m;
            return outside <= 0 || (along > 0 && along * along >= outside);
        }
    };

    // Returns the smallest GGX alpha that facets have for other surfaces, so that the table's directions find
    // their light.
    static float min_alpha(const TransferTable& table);
    // The object has a table and outlives this. step_rad: of the grid that sources are rounded to.
    IrradianceCache(const ShownObject& object, std::shared_ptr<const ObjectAlbedos> albedos,
                    const ColorBands& bands, float step_rad);

    const TransferTable& table() const { return *table_; }
    const Bounds& bounds() const { return bounds_; }
    float step_rad() const { return step_rad_; }
    std::uint16_t surface_of(std::uint32_t triangle) const {
        return shown_->levels.front()->triangles[triangle].surface;
    }
    bool is_glass(std::uint16_t surface) const { return materials_[surface]->transmits(); }
    // True when a probe mirrors sunlight that is not cached (mirror_sunlight.h).
    bool throws_sun(std::size_t probe) const { return !throws_sun_.empty() && throws_sun_[probe] != 0; }
    bool throws_sun() const { return !throws_sun_.empty(); }
    // True when the surface reflects nothing except in a narrow lobe.
    bool is_mirror(std::uint16_t surface) const {
        const Material& m = *materials_[surface];
        return m.ggx_alpha < kMinCachedAlpha && m.is_bare();
    }
    // Returns a probe's direction in body axes.
    Vec3f direction(std::size_t probe, std::size_t d) const {
        return local(lobes_[probe]).body({local_x_[d], local_y_[d], local_z_[d]});
    }

    // --- probes, for the solver

    // The axes of a probe.
    struct Local {
        Frame frame;
        Vec2f turn;
        Vec3f dir(Vec3f body) const {
            const Vec3f l = frame.to_local(body);
            return {turn.x * l.x + turn.y * l.y, turn.x * l.y - turn.y * l.x, l.z};
        }
        Vec3f body(Vec3f l) const {
            return frame.to_world({turn.x * l.x - turn.y * l.y, turn.y * l.x + turn.x * l.y, l.z});
        }
    };
    Local axes(std::size_t probe) const { return local(lobes_[probe]); }
    // Returns a direction in probe axes, which is the same for all probes; its z is zero beyond the table's
    // own directions.
    Vec3f local_direction(std::size_t d) const { return {local_x_[d], local_y_[d], local_z_[d]}; }
    const Material& material(std::uint16_t surface) const { return *materials_[surface]; }
    // Returns the albedo with facets that are at least min_alpha() wide, as other surfaces see them.
    const MaterialAlbedo& wide_albedo(std::uint16_t surface) const { return albedos_->wide[surface]; }
    // Returns a probe's albedo for uniform light, divided by pi.
    Spectrum white(std::size_t probe) const { return white_[probe].unpacked(); }
    // Multiplies a spectrum by the texture's colour at a probe.
    Spectrum colored(std::size_t probe, const Spectrum& of) const {
        return colors_.empty() ? of : colors_[probe] * of;
    }
    // Multiplies a spectrum of a probe's facets by the texture's colour, if the material has no body below
    // them.
    Spectrum facet_color(std::size_t n, const Spectrum& of) const {
        const bool colored = !colors_.empty() && materials_[table_->probes().probes()[n].surface]->is_bare();
        return colored ? colors_[n] * of : of;
    }
    // Index of a probe's first entry in RadiositySolution::along; kNoLobe: it has no facets.
    static constexpr std::uint32_t kNoLobe = ~std::uint32_t{0};
    std::uint32_t first_along(std::size_t probe) const { return lobes_[probe].first_along; }
    // Total number of entries of probes with facets.
    std::size_t entries_along() const { return along_; }

    // Adds a term for a source of this kind and returns its number. Owner thread.
    std::size_t add_term(RadiositySource::Kind kind);
    RadiositySolution make_solution(RadiositySource::Kind kind) const;
    // Swaps in a term's new solution; `solution` then has the old one. Loop, one thread.
    void adopt(std::size_t term, RadiositySolution& solution);
    // Uses these links to other objects from now on; they must outlive this. Loop, one thread.
    void adopt(const InterObjectLinks& links);

    // --- lookup. Loop, any thread.

    const MaterialAlbedo& albedo(std::uint16_t surface) const { return albedos_->own[surface]; }
    std::span<const MaterialAlbedo> albedos() const { return albedos_->own; }
    std::span<const FlatMirror> mirrors() const { return albedos_->mirrors; }
    std::span<const std::uint32_t> neighbours(std::size_t probe) const {
        return albedos_->neighbours.of(probe);
    }
    // Returns the irradiance by way of other surfaces, per unit of the source.
    Spectrum irradiance(std::size_t term, const ProbeWeights& about) const {
        return PackedSpectrum::weighted_sum(irradiance_.data() + term, terms_.size(), about.probe.data(),
                                            about.weight.data(), about.count);
    }
    // The same at one probe.
    Spectrum irradiance(std::size_t term, std::uint32_t probe) const {
        return irradiance_[probe * terms_.size() + term].unpacked();
    }
    // Returns the unblocked share of a cone's light.
    float seen(std::size_t term, const ProbeWeights& about) const {
        float sum = 0;
        for (std::size_t i = 0; i < about.count; ++i)
            sum += about.weight[i] * static_cast<float>(terms_[term].seen[about.probe[i]]);
        return sum * (1 / 255.0f);
    }
    // Prefetches the memory that irradiance() and lobe() read.
    void prefetch(const ProbeWeights& about) const {
        for (std::size_t i = 0; i < about.count; ++i)
            __builtin_prefetch(&irradiance_[about.probe[i] * terms_.size()]);
    }
    void prefetch_lobe(std::uint32_t probe) const { __builtin_prefetch(&lobes_[probe]); }
    void prefetch_along(std::size_t term, std::uint32_t probe) const;
    // The cached light that a facet lobe finds along a probe's directions; for a narrow lobe, the light that
    // its tails find. Shares are relative to a uniform sky, without Fresnel's term. normal, view_dir: body
    // axes, unit.
    struct Lobe {
        Spectrum cached;  // mean radiance of the term, times the share of the lobe that meets it
        // For each cone, the unblocked share of what it gives to the whole lobe.
        std::array<float, Planetshine::kMaxBodies> free{1, 1};
        // Factor on the probe's irradiance that gives the radiance of what it meets, times the share.
        float of_irradiance = 0;
        // Effective number of directions that bring `cached`: square of the sum over sum of the squares
        // (Kish, Survey Sampling, 1965, section 8.2). 0: nothing is cached.
        float directions = 0;
    };
    struct Cone {
        Vec3f dir;  // body axes
        float cosine;
    };
    static constexpr std::size_t kNoTerm = ~std::size_t{0};
    Lobe lobe(std::size_t sun, std::span<const Cone> cones, std::uint32_t probe, Vec3f normal, Vec3f view_dir,
              float alpha) const;
    // The same for a solution and links that are not in use yet; null: there are none.
    Lobe lobe(const RadiositySolution* sun, const InterObjectLinks* links, std::span<const Cone> cones,
              std::uint32_t probe, Vec3f normal, Vec3f view_dir, float alpha) const;
    static constexpr float kNear = 0.88f;  // cosine of 28 degrees, wider than the gap to the next direction
    // True when something is near a direction from a probe, within the angle whose cosine is kNear.
    bool is_near(std::uint32_t probe, Vec3f dir) const;
    std::size_t bytes() const;

  private:
    // The values of a probe that lookups of lobes read, side by side.
    struct alignas(32) LobeProbe {
        std::uint32_t normal;              // packed
        std::array<std::int16_t, 2> turn;  // in units of 1 / 32767
        std::uint32_t first_entry;
        std::uint32_t first_along;  // see first_along()
        std::uint64_t free;         // the first 64 directions
        std::uint16_t entries, counted;
        std::uint8_t live;  // bits by point
        bool all_free;
    };
    static_assert(sizeof(LobeProbe) == 32);

    const ShownObject* shown_;
    std::shared_ptr<const TransferTable> table_;
    const InterObjectLinks* links_ = nullptr;
    std::shared_ptr<const ObjectAlbedos> albedos_;
    std::vector<const Material*> materials_;
    Bounds bounds_;
    float step_rad_;
    // Local directions by component, padded with directions that never count.
    static constexpr std::size_t kMaxDirections = 256;
    std::vector<float> local_x_, local_y_, local_z_;
    std::vector<float> per_cosine_;         // 1 / local_z_, or 0
    std::vector<Spectrum> colors_;          // by probe; empty without textures
    std::vector<PackedSpectrum> white_;     // by probe: albedo over pi
    std::vector<LobeProbe> lobes_;          // by probe
    std::vector<std::uint8_t> throws_sun_;  // by probe; empty if there are none
    std::size_t along_ = 0;
    std::vector<RadiositySolution> terms_;    // their irradiance is in irradiance_
    std::vector<PackedSpectrum> irradiance_;  // by probe, then by term

    static Local local(const LobeProbe& probe);
    void describe_lobe(std::size_t probe);
    void find_what_throws();
    template <class Visit>
    void for_each_met(std::size_t probe, const Visit& visit) const;
};

}  // namespace hilcam
