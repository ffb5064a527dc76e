#pragma once
// Solves cached light (irradiance_cache.h) for one source, over a group of objects near each other. It is
// radiosity (Goral et al., SIGGRAPH 84) with a fixed set of directions in place of form factors; nothing is
// random, and the only rays test which probes the source lights. See docs/rendering.md, "Cached light".
//
// - The first light of a probe is summed over what its directions meet (probes/transfer_table.h,
// inter_object_links.h). Each sender uses its own BRDF, at each of its points.
// - Within an object, bright sunlight makes one more step by facet lobes, over what the probe's directions
// have brought.
// - Then light bounces as between white, grey or coloured paint until it no longer changes.
//
// Sunlight from flat mirrors is included in what bounces further but not in what is cached; mirror_sunlight.h
// adds it sharply at lookup.
//
// Approximations: facets that other surfaces see have a minimum width, so that the directions find their
// light. From the third bounce on, everything scatters like a diffuse surface of the same albedo; for dim
// light, for lamps and bodies, and between objects this starts at the second bounce. Glass is clear.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <span>
#include <vector>

#include "render/radiosity/probe_senders.h"

namespace hilcam {

class RadiositySolver {
  public:
    using Member = RadiosityMember;

    // lights: of all objects, by number; null if the object caches no light. They must outlive this. Owner
    // thread.
    RadiositySolver(std::span<const IrradianceCache* const> lights, const EmbreeScene& scene);

    const EmbreeScene& scene() const { return senders_.scene(); }
    std::span<const IrradianceCache* const> lights() const { return lights_; }
    // Returns an object's share of the workspace.
    std::size_t bytes(std::size_t object) const {
        constexpr std::size_t kOfProbe =
            sizeof(ProbeSender) + sizeof(Brought) + sizeof(std::uint32_t) + 2 + 6 * sizeof(Spectrum);
        return lights_[object]->table().size() * (kOfProbe + (mirrored_.empty() ? 0 : sizeof(Spectrum))) +
               second_along_[object].size() * sizeof(PackedSpectrum);
    }
    // Solves one term. Runs on oneTBB; if its task group is cancelled, the result is undefined. Allocates
    // only if there are more links than ever before.
    void solve(std::span<const Member> group);

  private:
    // The first light that a probe's directions bring, by its brightest bin: sum, and sum of squares.
    struct Brought {
        float sum = 0, squares = 0;

        Brought& operator+=(const Brought& other) {
            sum += other.sum, squares += other.squares;
            return *this;
        }
    };
    struct Progress {
        double change = 0, light = 0;  // weighted sums over all probes and bins
    };

    std::vector<const IrradianceCache*> lights_;
    ProbeSenders senders_;             // probes have the same numbers in all that follows
    std::vector<Spectrum> radiosity_;  // divided by pi
    std::vector<Brought> brought_;
    // Irradiance: of the first step, of all steps so far, one bounce ago.
    std::vector<Spectrum> first_, now_, before_;
    // The second step, by bright facet lobes. By probe: whether it has such a lobe; what it sends by it, over
    // pi, which is therefore not in radiosity_; and the irradiance that it receives from such lobes.
    std::vector<std::uint8_t> sends_on_;
    std::vector<Spectrum> by_lobes_, second_;
    // By object, the radiance along table entries that meet such probes; by probe, the index of its first
    // one.
    std::vector<std::vector<PackedSpectrum>> second_along_;
    std::vector<std::uint32_t> first_second_;
    // Sunlight that flat mirrors reflect onto probes in the first step; empty if there are no mirrors.
    std::vector<Spectrum> mirrored_;

    using Probes = tbb::blocked_range<std::size_t>;
    static constexpr std::size_t kBlock = ProbeSenders::kBlock;
    template <class Body>
    static void for_probes(std::size_t count, const Body& body) {
        tbb::parallel_for(Probes(0, count, kBlock), body, tbb::simple_partitioner{});
    }
    void gather_first(const Member& member, std::span<const Member> group);
    void gather_second(const Member& member);
    void part_lobes(const Member& member);
    std::size_t number_second(const Member& member);
    Spectrum sent_on(const Member& member, std::size_t probe, float choice, Vec3f to) const;
    // Returns what a probe of another object sends along a link, all of it as from paint.
    Spectrum radiosity_to(const InterObjectLinks::Link& link) const {
        const std::size_t n = senders_.first(link.object) + link.probe;
        return radiosity_[n] + by_lobes_[n];
    }
    // Returns a probe's irradiance without the sunlight of mirrors. For objects with mirrors only.
    Spectrum unmirrored(const std::vector<Spectrum>& irradiance, std::size_t probe) const;
    void bounce(std::span<const Member> group);
    Progress gather_again(const Member& member);
    void smooth(const Member& member);
    void store(const Member& member);
};

}  // namespace hilcam
