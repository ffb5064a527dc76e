#pragma once
// Solves cached light (irradiance_cache.h) for a source, over objects that stand near each other together.
//
// What a probe receives first is summed from what its directions meet (probes/transfer_table.h, inter_object_links.h),
// each seen from there as its own reflection law says, point by point as these lean. What is bright of the Sun's light goes on so
// once more within an object, by lobes about what a probe's directions have brought; then light goes on as from white, grey or
// coloured paint until it stays the same (radiosity: Goral et al., SIGGRAPH 84), with the directions in place of form
// factors. No ray is traced but those that ask which probes a source shines on, and nothing is drawn by
// chance.
//
// What flat mirrors throw of the Sun goes on from where it falls, but is not in what is cached: who looks that
// up has it sharp (mirror_sunlight.h).
//
// The approximation: facets that other surfaces see are at least so wide that the directions find their
// light; from the third bounce on (of what is dim, of lamps and bodies, and between objects from the second) everything
// scatters as a diffuse surface of the same albedo; glass is clear.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <span>
#include <vector>

#include "render/radiosity/probe_senders.h"

namespace hilcam {

class RadiositySolver {
  public:
    using Member = RadiosityMember;

    // lights: of all objects, by number; null where none is cached; they outlive this. Owner thread.
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
    // One term. On oneTBB; where its group of tasks is canceled, what comes out is worth nothing. Nothing is allocated but
    // by links that are more than ever before.
    void solve(std::span<const Member> group);

  private:
    // The light that a probe's directions bring the first way, by its brightest bin: sums of it and of its squares.
    struct Brought {
        float sum = 0, squares = 0;

        Brought& operator+=(const Brought& other) {
            sum += other.sum, squares += other.squares;
            return *this;
        }
    };
    struct Progress {
        double change = 0, light = 0;  // weighed sums over all probes and bins
    };

    std::vector<const IrradianceCache*> lights_;
    ProbeSenders senders_;             // their numbers of probes are those of all that follows
    std::vector<Spectrum> radiosity_;  // over pi
    std::vector<Brought> brought_;
    std::vector<Spectrum> first_, now_, before_;  // irradiance: of the first way, of all so far, a bounce ago
    // Light that has come by one way and goes on by the lobes of bright facets: whether a probe has such, the part of what it
    // sends, over pi, which therefore is no radiosity, and the irradiance that others' make.
    std::vector<std::uint8_t> sends_on_;
    std::vector<Spectrum> by_lobes_, second_;
    // Radiance along the entries of probes with facets that meet such probes, by object; and the number of each probe's first.
    std::vector<std::vector<PackedSpectrum>> second_along_;
    std::vector<std::uint32_t> first_second_;
    // The Sun's light that flat mirrors throw on the first's probes; empty: none does.
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
    // Returns what a probe of another object sends along a link: all of it as paint does.
    Spectrum radiosity_to(const InterObjectLinks::Link& link) const {
        const std::size_t n = senders_.first(link.object) + link.probe;
        return radiosity_[n] + by_lobes_[n];
    }
    // Returns a probe's irradiance without what mirrors throw there. Only of an object that has such.
    Spectrum unmirrored(const std::vector<Spectrum>& irradiance, std::size_t probe) const;
    void bounce(std::span<const Member> group);
    Progress gather_again(const Member& member);
    void smooth(const Member& member);
    void store(const Member& member);
};

}  // namespace hilcam
