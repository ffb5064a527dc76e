#pragma once
// The light between the parts of one object, kept from frame to frame at its nodes (scene/light_nodes.h).
//
// For each source there is a term: the irradiance that reaches every node by way of other surfaces, all
// bounces, for one unit of the source. It is found from the table of directions (scene/transfer_table.h):
// what a node receives first is summed from what its directions meet, each seen from there as its own
// reflection law says; then light goes on as from white, grey or coloured paint until it stays the same
// (radiosity: Goral et al., SIGGRAPH 84), with the directions in place of form factors. No ray is traced but
// those that ask which nodes a source shines on, and nothing is drawn by chance.
//
// A term depends on nothing but the table and the place of its source in the object's own axes, rounded to a
// step: so frames stay functions of their commands. The light itself (eclipses, the Sun's distance, a lamp's
// level) is a factor at the pixel.
//
// The approximation: facets that other surfaces see are at least so wide that the directions find their
// light; from the second bounce on everything scatters as a diffuse surface of the same albedo; glass is
// clear.

#include <cstdint>
#include <memory>
#include <vector>

#include "render/light/kept_source.h"
#include "render/light/material_albedo.h"
#include "render/scene/brdf_microfacet.h"
#include "render/scene/color_bands.h"
#include "render/scene/embree_scene.h"
#include "render/scene/transfer_table.h"
#include "render/vocabulary/packed_spectrum.h"

namespace hilcam {

// Facet lobes narrower than this (GGX alpha) fall between the directions: rays follow them, for all of the
// lobe but its tails.
inline constexpr float kNarrowestKept = 0.12f;
// What is narrower than this is followed as a mirror, by one ray; else by four.
inline constexpr float kNarrowestLobe = 0.03f;
// The share of a narrow lobe that its ray does not stand for: facets turned by more than 11 degrees from the
// normal (GGX as seen along it: Walter et al., EGSR 2007, eq. 35 inverted).
inline float tail_share(float alpha) { return alpha * alpha / (alpha * alpha + 0.0378f); }

// What one source gives to every node, per unit of it.
struct KeptTerm {
    KeptSource source;
    std::vector<PackedSpectrum> irradiance;  // by way of other surfaces
    std::vector<PackedSpectrum> along;  // radiance along each entry of the nodes with facets; of the Sun only
    std::vector<std::uint8_t> seen;     // share of a cone that is free, of 255
};

class KeptLight {
  public:
    // What solving needs besides the result; one for all objects. Sized by reserve().
    class Workspace {
      public:
        void reserve(const KeptLight& light);

      private:
        friend class KeptLight;
        // What a node sends: radiance per unit of the source.
        struct alignas(64) Sender {
            PackedSpectrum diffuse;
            PackedSpectrum lobe;   // of facets, at normal incidence
            float received;        // irradiance
            std::uint32_t normal;  // packed
            float alpha;           // 0: no facets that shine
            float ni;              // cosine of the source
        };
        std::vector<Sender> senders_;
        std::vector<PackedSpectrum> radiosity_;  // over pi
        std::vector<Spectrum> first_, now_,
            before_;  // irradiance: of the first way, of all so far, a bounce ago
    };

    // materials: one per surface of the mesh. step_rad: of the grid that sources are rounded to.
    KeptLight(std::shared_ptr<const TransferTable> table, const std::vector<Material>& materials,
              const ColorBands& bands, float step_rad);

    const TransferTable& table() const { return *table_; }
    float step_rad() const { return step_rad_; }
    // Memory for a term of such a source.
    KeptTerm make_term(KeptSource::Kind kind) const;
    // Solves the term for its source, which has been rounded. scene: the object is placed in it. On oneTBB.
    // Loop: nothing is allocated.
    void solve(const KeptSource& source, const EmbreeScene& scene, std::size_t object, Workspace& work,
               KeptTerm& term) const;

    // --- lookup. Loop, any thread.

    const MaterialAlbedo& albedo(std::uint16_t surface) const { return albedos_[surface]; }
    static Spectrum irradiance(const KeptTerm& term, const NodesAbout& about) {
        Spectrum sum;
        for (std::size_t i = 0; i < static_cast<std::size_t>(about.count); ++i)
            sum += about.weight[i] * term.irradiance[about.node[i]].unpacked();
        return sum;
    }
    static float seen(const KeptTerm& term, const NodesAbout& about) {
        float sum = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(about.count); ++i)
            sum += about.weight[i] * static_cast<float>(term.seen[about.node[i]]);
        return sum * (1 / 255.0f);
    }
    // A facet lobe about a node's directions, or the tails of one that is narrow: what it finds of the kept
    // light along them. Shares are of what an even sky would give, Fresnel's term left out. normal, view_dir:
    // body axes, unit.
    struct Lobe {
        Spectrum kept;       // mean radiance of the term, times the share that meets it
        float free = 1;      // share of the whole lobe that goes free
        float occupied = 0;  // share that meets a node
    };
    Lobe lobe(const KeptTerm* sun, std::uint32_t node, Vec3f normal, Vec3f view_dir, float alpha) const;
    // Whether anything stands near a direction from a node, within about 20 degrees.
    bool is_near(std::uint32_t node, Vec3f dir) const;
    std::size_t bytes() const;

  private:
    static constexpr std::uint32_t kNoLobe = ~std::uint32_t{0};

    std::shared_ptr<const TransferTable> table_;
    std::vector<MaterialAlbedo> albedos_;
    std::vector<const Material*> materials_;
    float least_alpha_, step_rad_;  // of facets that another surface sees
    // Local directions, component by component, and after them some that never count, to full vectors.
    static constexpr std::size_t kMostDirections = 256, kLanes = 16;
    std::vector<float> local_x_, local_y_, local_z_, counts_;
    std::vector<Spectrum> colors_;            // by node where there are textures; else empty
    std::vector<PackedSpectrum> white_;       // by node: albedo over pi
    std::vector<std::uint32_t> first_along_;  // by node: of its entries in KeptTerm::along
    std::size_t along_ = 0;

    // Node axes.
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
    Local local(std::size_t node) const;
    bool all_free(std::size_t node) const;
    template <class Visit>
    void for_each_met(std::size_t node, const Visit& visit) const;
    void light_nodes(const KeptSource& source, const EmbreeScene& scene, std::size_t object, Workspace& work,
                     KeptTerm& term) const;
    void light_block(const KeptSource& source, const EmbreeScene& scene, std::size_t object,
                     std::size_t first, std::size_t last, Workspace& work, KeptTerm& term) const;
    void send(std::size_t node, Vec3f source_dir, Vec3f facing, float received,
              Workspace::Sender& sender) const;
    void gather_first(Workspace& work, KeptTerm& term) const;
    struct Progress {
        double change = 0, light = 0;  // sums over all nodes and bins
    };
    void bounce(Workspace& work) const;
    Progress gather_again(Workspace& work) const;
    float seen_of_cone(const KeptSource& source, std::size_t node) const;
};

}  // namespace hilcam
