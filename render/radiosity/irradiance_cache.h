#pragma once
// The light between the parts of an object, kept from frame to frame at its probes (probes/surface_probes.h).
//
// For each source there is a term: the irradiance that reaches every probe by way of other surfaces, all
// bounces, for one unit of the source (radiosity_solver.h finds it). A term depends on nothing but the tables, the
// place of its source in the object's own axes, rounded to a step, and how near objects stand to each other,
// rounded as well: so frames stay functions of their commands. The light itself (eclipses, the Sun's
// distance, a lamp's level) is a factor at the pixel.

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

// Facet lobes narrower than this (GGX alpha) fall between the directions: rays follow them, for all of the
// lobe but its tails.
inline constexpr float kMinCachedAlpha = 0.12f;
// A lobe narrower than this is followed as a mirror, by one ray; a wider one by four.
inline constexpr float kNarrowestLobe = 0.02f;
// Lists of directions are filled up to a multiple of this.
inline constexpr std::size_t kDirectionLanes = 16;
// The share of a narrow lobe that its ray does not stand for: facets turned by more than 11 degrees from the
// normal (GGX as seen along it: Walter et al., EGSR 2007, eq. 35 inverted).
inline float tail_share(float alpha) { return alpha * alpha / (alpha * alpha + 0.0378f); }

// The albedos of an object's materials, its mirrors, and which of its probes lie side by side. Objects of one prototype share it.
struct ObjectAlbedos {
    // mesh: with the object's triangles. min_alpha: of facets as other surfaces see them.
    ObjectAlbedos(const ObjectSurfaces& surfaces, const MeshView& mesh, const SurfaceProbes& probes,
                  float min_alpha);

    std::vector<MaterialAlbedo> own, wide;  // by surface; the latter of facets as other surfaces see them
    std::vector<FlatMirror> mirrors;  // flat mirrors of the object; whoever looks them up has their sunlight
    ProbeNeighbours neighbours;
};

// A term that is solved: what one source gives to every probe, per unit of it.
struct RadiositySolution {
    // By way of other surfaces; where few directions bring it, the mean with the probes beside (RadiositySolver::smooth).
    std::vector<PackedSpectrum> irradiance;
    // Radiance along each entry of probes with facets, and along each link; of the Sun only.
    std::vector<PackedSpectrum> along, along_links;
    std::vector<std::uint8_t> seen;  // share of a cone that is free, of 255

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

    // Facets that another surface sees are at least so wide (GGX alpha), for its directions to find them.
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
    // True when a probe mirrors sunlight, which is not cached: mirror_sunlight.h has it.
    bool throws_sun(std::size_t probe) const { return !throws_sun_.empty() && throws_sun_[probe] != 0; }
    bool throws_sun() const { return !throws_sun_.empty(); }
    // All that it reflects, it reflects in a narrow lobe.
    bool is_mirror(std::uint16_t surface) const {
        const Material& m = *materials_[surface];
        return m.ggx_alpha < kMinCachedAlpha && m.is_bare();
    }
    // A probe's direction, body axes.
    Vec3f direction(std::size_t probe, std::size_t d) const {
        return local(lobes_[probe]).body({local_x_[d], local_y_[d], local_z_[d]});
    }

    // --- probes, as the solver asks for them

    // Probe axes.
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
    // Returns the direction of that number in the axes of every probe; zero in z beyond a table's own.
    Vec3f local_direction(std::size_t d) const { return {local_x_[d], local_y_[d], local_z_[d]}; }
    const Material& material(std::uint16_t surface) const { return *materials_[surface]; }
    // Returns the albedo of facets that are as wide as lobes of other surfaces find them (min_alpha()).
    const MaterialAlbedo& wide_albedo(std::uint16_t surface) const { return albedos_->wide[surface]; }
    // Returns what a probe reflects over pi of light from everywhere.
    Spectrum white(std::size_t probe) const { return white_[probe].unpacked(); }
    // Returns a spectrum of a probe's surface in its texture's colour.
    Spectrum colored(std::size_t probe, const Spectrum& of) const {
        return colors_.empty() ? of : colors_[probe] * of;
    }
    // Returns a spectrum of a probe's facets in its texture's colour, which those have that no body lies below.
    Spectrum facet_color(std::size_t n, const Spectrum& of) const {
        const bool colored = !colors_.empty() && materials_[table_->probes().probes()[n].surface]->is_bare();
        return colored ? colors_[n] * of : of;
    }
    // Number of a probe's first entry in RadiositySolution::along, or kNoLobe: it has no facets.
    static constexpr std::uint32_t kNoLobe = ~std::uint32_t{0};
    std::uint32_t first_along(std::size_t probe) const { return lobes_[probe].first_along; }
    // Number of the entries of all probes with facets.
    std::size_t entries_along() const { return along_; }

    // Makes room for what a source of this kind gives; its number. Owner thread.
    std::size_t add_term(RadiositySource::Kind kind);
    RadiositySolution make_solution(RadiositySource::Kind kind) const;
    // Takes a term's solution and gives back the one before. Loop, one thread.
    void adopt(std::size_t term, RadiositySolution& solution);
    // Takes over what the probes meet of other objects, from now on; `links` outlives this. Loop, one thread.
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
    // The same, at one probe.
    Spectrum irradiance(std::size_t term, std::uint32_t probe) const {
        return irradiance_[probe * terms_.size() + term].unpacked();
    }
    // Share of a cone's light that comes without a way.
    float seen(std::size_t term, const ProbeWeights& about) const {
        float sum = 0;
        for (std::size_t i = 0; i < about.count; ++i)
            sum += about.weight[i] * static_cast<float>(terms_[term].seen[about.probe[i]]);
        return sum * (1 / 255.0f);
    }
    // Asks for the memory of what irradiance() and lobe() read.
    void prefetch(const ProbeWeights& about) const {
        for (std::size_t i = 0; i < about.count; ++i)
            __builtin_prefetch(&irradiance_[about.probe[i] * terms_.size()]);
    }
    void prefetch_lobe(std::uint32_t probe) const { __builtin_prefetch(&lobes_[probe]); }
    void prefetch_along(std::size_t term, std::uint32_t probe) const;
    // A facet lobe about a probe's directions, or the tails of one that is narrow: what it finds of the cached
    // light along them. Shares are of what an even sky would give, Fresnel's term left out. normal, view_dir:
    // body axes, unit.
    struct Lobe {
        Spectrum cached;  // mean radiance of the term, times the share that meets it
        // Share of what each cone gives to the whole lobe that comes without a way.
        std::array<float, Planetshine::kMaxBodies> free{1, 1};
        float of_irradiance = 0;  // radiance of what it meets, times the share, over the probe's irradiance
        // Number of directions of equal light whose sum would vary as much as that of what `cached` is made of: the
        // square of the sum over the sum of squares (Kish, Survey Sampling, 1965, section 8.2). 0: nothing is cached.
        float directions = 0;
    };
    struct Cone {
        Vec3f dir;  // body axes
        float cosine;
    };
    static constexpr std::size_t kNoTerm = ~std::size_t{0};
    Lobe lobe(std::size_t sun, std::span<const Cone> cones, std::uint32_t probe, Vec3f normal, Vec3f view_dir,
              float alpha) const;
    // The same of a solution, and of links, that need not be those that are shown; null: there are none.
    Lobe lobe(const RadiositySolution* sun, const InterObjectLinks* links, std::span<const Cone> cones,
              std::uint32_t probe, Vec3f normal, Vec3f view_dir, float alpha) const;
    static constexpr float kNear = 0.88f;  // cosine of 28 degrees: further than the next direction
    // True when anything stands near a direction from a probe, within the angle of that cosine.
    bool is_near(std::uint32_t probe, Vec3f dir) const;
    std::size_t bytes() const;

  private:
    // The values of a probe that lookups of lobes read, side by side.
    struct alignas(32) LobeProbe {
        std::uint32_t normal;              // packed
        std::array<std::int16_t, 2> turn;  // the turn in units of 1 / 32767
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
    // Local directions, component by component, and after them some that never count, to full vectors.
    static constexpr std::size_t kMaxDirections = 256;
    std::vector<float> local_x_, local_y_, local_z_;
    std::vector<float> per_cosine_;         // one over local_z_, or 0
    std::vector<Spectrum> colors_;          // by probe where there are textures; else empty
    std::vector<PackedSpectrum> white_;     // by probe: albedo over pi
    std::vector<LobeProbe> lobes_;          // by probe
    std::vector<std::uint8_t> throws_sun_;  // by probe; empty: none does
    std::size_t along_ = 0;
    std::vector<RadiositySolution> terms_;    // their irradiance is in the next
    std::vector<PackedSpectrum> irradiance_;  // by probe and term

    static Local local(const LobeProbe& probe);
    void describe_lobe(std::size_t probe);
    void find_what_throws();
    template <class Visit>
    void for_each_met(std::size_t probe, const Visit& visit) const;
};

}  // namespace hilcam
