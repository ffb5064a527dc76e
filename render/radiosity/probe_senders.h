#pragma once
// The light that the probes of an object send when a source lights them: the first step of a solution. The
// only rays are those that test which probes the source lights.

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "render/radiosity/inter_object_links.h"
#include "render/radiosity/irradiance_cache.h"

namespace hilcam {

// An object of a group: its links to the others, the source in its axes, and where the result goes.
struct RadiosityMember {
    std::size_t object;
    const InterObjectLinks* links;
    RadiositySource source;
    RadiositySolution* out;
};

// The points of a probe in the light of a source, per unit of it.
struct LitPoints {
    std::size_t count = 0;                                      // points that are open
    std::array<std::uint32_t, SurfaceProbe::kPoints> normal{};  // packed
    // `cosine`: of the source to the normal; `received`: irradiance.
    std::array<float, SurfaceProbe::kPoints> cosine{}, received{};

    float sum() const { return std::accumulate(received.begin(), received.end(), 0.0f); }
    float mean() const { return count > 0 ? sum() / static_cast<float>(count) : 0.0f; }
    // Returns the mean cosine of the source, weighted by the received light, which must not be zero.
    float mean_cosine() const {
        const float at = std::inner_product(cosine.begin(), cosine.end(), received.begin(), 0.0f);
        return std::clamp(at / sum(), 1e-3f, 1.0f);
    }
};
// The radiance that a probe sends, per unit of the source.
struct alignas(64) ProbeSender {
    PackedSpectrum diffuse;
    PackedSpectrum lobe;  // facet lobe at normal incidence, per irradiance
    float gain;           // irradiance that facets send per irradiance received
    float alpha;          // 0: no facets that shine
    LitPoints lit;        // set if there are facets
};
// The senders of all probes of all objects, numbered consecutively.
class ProbeSenders {
  public:
    // lights: of all objects, by number; null if the object caches no light. They must outlive this. Owner
    // thread.
    ProbeSenders(std::span<const IrradianceCache* const> lights, const EmbreeScene& scene);

    // Computes what an object's probes send, and the unblocked share of a body's light. Runs on oneTBB.
    void light(const RadiosityMember& member);

    // Index of an object's first probe, and the number of all probes.
    std::size_t first(std::size_t object) const { return base_[object]; }
    std::size_t count() const { return senders_.size(); }
    const ProbeSender& operator[](std::size_t probe) const { return senders_[probe]; }
    // True when the probe sends any light; most of the dark side sends none.
    bool shines(std::size_t probe) const { return shines_[probe] != 0; }
    const EmbreeScene& scene() const { return scene_; }

    // Probes are processed in blocks of this size, so that a thread that waits for a block does not wait for
    // all. Results do not depend on it.
    static constexpr std::size_t kBlock = 256;  // probes

  private:
    std::vector<const IrradianceCache*> lights_;
    const EmbreeScene& scene_;
    std::vector<std::size_t> base_;  // by object: index of its first probe
    std::vector<ProbeSender> senders_;
    std::vector<std::uint8_t> shines_;

    void light_block(const RadiosityMember& member, std::size_t first, std::size_t last);
    std::uint32_t blocked(const RadiosityMember& member, const RayPacket& rays) const;
    static void send(const IrradianceCache& light, std::size_t probe, const LitPoints& lit,
                     ProbeSender& sender);
    static void widen(const IrradianceCache& light, std::size_t probe, const RadiositySource& source,
                      ProbeSender& sender);
    static float seen_of_cone(const RadiosityMember& member, const IrradianceCache& light, std::size_t probe);
};

}  // namespace hilcam
