#pragma once
// The light that probes of an object send of a source's own: the first step of a solution. No ray is traced but those that ask
// which probes the source shines on.

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "render/radiosity/inter_object_links.h"
#include "render/radiosity/irradiance_cache.h"

namespace hilcam {

// An object of a group: what it meets of the others, the source in its own axes, and where the result
// goes.
struct RadiosityMember {
    std::size_t object;
    const InterObjectLinks* links;
    RadiositySource source;
    RadiositySolution* out;
};

// The points of a probe in the light of a source, per unit of it.
struct LitPoints {
    std::size_t count = 0;                                          // points that lie open
    std::array<std::uint32_t, SurfaceProbe::kPoints> normal{};      // packed
    std::array<float, SurfaceProbe::kPoints> cosine{}, received{};  // the source's to the normal; irradiance

    float sum() const { return std::accumulate(received.begin(), received.end(), 0.0f); }
    float mean() const { return count > 0 ? sum() / static_cast<float>(count) : 0.0f; }
    // Returns the cosine that the source has where it is received, in the mean. Only where some is.
    float mean_cosine() const {
        const float at = std::inner_product(cosine.begin(), cosine.end(), received.begin(), 0.0f);
        return std::clamp(at / sum(), 1e-3f, 1.0f);
    }
};
// The radiance that a probe sends, per unit of the source.
struct alignas(64) ProbeSender {
    PackedSpectrum diffuse;
    PackedSpectrum lobe;  // the lobe of its facets at normal incidence, per irradiance
    float gain;           // irradiance that facets send of one that they receive
    float alpha;          // 0: no facets that shine
    LitPoints lit;        // where there are facets
};
// The senders of all probes of all objects, which are numbered through.
class ProbeSenders {
  public:
    // lights: of all objects, by number; null where none is cached; they outlive this. Owner thread.
    ProbeSenders(std::span<const IrradianceCache* const> lights, const EmbreeScene& scene);

    // Finds what an object's probes send, and fills what of a body's light comes without a way. On oneTBB.
    void light(const RadiosityMember& member);

    // Number of an object's first probe, and of all probes.
    std::size_t first(std::size_t object) const { return base_[object]; }
    std::size_t count() const { return senders_.size(); }
    const ProbeSender& operator[](std::size_t probe) const { return senders_[probe]; }
    // It sends anything, as most of the dark side does not.
    bool shines(std::size_t probe) const { return shines_[probe] != 0; }
    const EmbreeScene& scene() const { return scene_; }

    // Has probes seen to in blocks, so that one who waits for a block does not wait for all of them. No
    // result depends on them.
    static constexpr std::size_t kBlock = 256;  // probes

  private:
    std::vector<const IrradianceCache*> lights_;
    const EmbreeScene& scene_;
    std::vector<std::size_t> base_;  // by object: of its probes in what follows
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
