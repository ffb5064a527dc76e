#pragma once
// The transfer table: what each probe on an object meets along fixed directions of its half sphere, traced once,
// kept for good, since it is knowledge of the mesh and not of a frame (radiosity/irradiance_cache.h makes light of it).
//
// The directions are the paper's sixty (Peng et al. 2011), or 16 or 256, but in equal shares of irradiance
// instead of solid angle: a golden-angle spiral (Vogel, Math. Biosci. 44, 1979, 179) projected up from the
// disk (Malley), turned for each probe by an angle of its own. A probe's points share them in turn, so that a
// probe sees what its whole surface sees. Glass is passed. Each direction either is free, or meets another
// probe, or ends in the dark: behind the horizon of a rough place, or where no light is cached.
//
// Probes that no light can reach (the inside of a closed body, if nothing shines there) are left out; a point
// that sees nothing but what is nearer than half a cube is buried and does not count.

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/probes/surface_probes.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct TransferSettings {
    int directions = 60;           // a multiple of SurfaceProbe::kPoints, 256 at most
    std::size_t probes = 100'000;  // about, before those that no light reaches are left out
    bool enclosed = false;         // light can begin in closed rooms: lamps, materials that emit
};

// Is told, now and then, which share of the work is done, on any of its threads; what it throws ends the
// work.
using WorkWatcher = std::function<void(double share)>;

// The directions in local axes (z: the probe's normal), before a probe's own turn; those of a probe's first
// point come first, then those of its second, and so on.
std::vector<Vec3f> transfer_directions(int count);

class EmbreeScene;

class TransferTable {
  public:
    TransferTable() = default;
    // glass: per surface, whether it is. Throws InputError when memory runs out, and what the watcher throws.
    // Owner thread, on oneTBB; the same on any number of threads.
    TransferTable(const Mesh& mesh, std::span<const std::uint8_t> glass, const TransferSettings& settings,
                  const WorkWatcher& watcher = {});

    const SurfaceProbes& probes() const { return probes_; }
    std::size_t size() const { return probes_.probes().size(); }
    int directions() const { return directions_; }
    std::size_t bytes() const;

    // An entry says what a probe's directions meet.
    struct Entry {
        std::uint32_t probe : 24;
        std::uint32_t direction : 8;
    };
    static constexpr std::size_t kMaxProbes = (1u << 24) - 1;
    std::span<const Entry> entries(std::size_t probe) const {
        return {entries_.data() + first_entry_[probe], first_entry_[probe + 1] - first_entry_[probe]};
    }
    std::uint32_t first_entry(std::size_t probe) const { return first_entry_[probe]; }
    const Entry* entry(std::size_t number) const { return entries_.data() + number; }
    std::size_t entries() const { return entries_.size(); }
    // Bits by direction, 64 to a word: nothing is met.
    std::span<const std::uint64_t> free(std::size_t probe) const {
        return {free_.data() + probe * free_words(), free_words()};
    }
    bool is_free(std::size_t probe, std::size_t direction) const {
        return free(probe)[direction / 64] >> (direction % 64) & 1u;
    }
    // A direction belongs to one of the probe's points; those of buried points do not count.
    std::size_t directions_of_point() const {
        return static_cast<std::size_t>(directions_) / SurfaceProbe::kPoints;
    }
    std::size_t point_of(std::size_t direction) const { return direction / directions_of_point(); }
    bool is_live(std::size_t probe, std::size_t point) const {
        return (static_cast<unsigned>(live_[probe]) >> point & 1u) != 0;
    }
    // Directions that count: of live points, and above the surface there.
    int counted(std::size_t probe) const { return counted_[probe]; }
    // A direction's angle of turn about the normal, of this probe [cos, sin].
    Vec2f turn(std::size_t probe) const { return turns_[probe]; }

    // Gives files all that cannot be computed from the rest.
    template <class Archive>
    static void list(auto& self, Archive& archive) {
        SurfaceProbes::list(self.probes_, archive);
        archive(self.directions_), archive(self.first_entry_), archive(self.entries_), archive(self.free_),
            archive(self.live_), archive(self.counted_), archive(self.turns_);
    }
    bool is_whole() const;
    // Makes it the table of a mesh so many times as large: what is met does not change with the size.
    void scale(float factor) { probes_.scale(factor); }

  private:
    SurfaceProbes probes_;
    int directions_ = 0;
    std::vector<std::uint32_t> first_entry_;  // by probe, and one more
    std::vector<Entry> entries_;
    std::vector<std::uint64_t> free_;
    std::vector<std::uint8_t> live_;  // bits by point
    std::vector<std::uint16_t> counted_;
    std::vector<Vec2f> turns_;

    // The blocks of probes while the table is made, each with what its probes meet, one after the other.
    static constexpr std::size_t kBlock = 256;
    struct Link {
        std::uint32_t met;
        std::uint8_t direction;
    };
    struct Block {
        std::vector<Link> links;
        std::vector<std::size_t> counts;  // by probe
    };
    std::vector<Block> trace(const Mesh& mesh, std::span<const std::uint8_t> glass, const EmbreeScene& scene,
                             const WorkWatcher& watcher);
    static void for_each_probe(std::vector<Block>& blocks,
                               const std::function<void(std::size_t, std::span<Link>)>& visit);
    void drop_dead_ends(std::vector<Block>& blocks);
    std::vector<std::uint32_t> numbers_of_open(std::vector<Block>& blocks, bool enclosed);
    void pack(std::vector<Block>& blocks, std::span<const std::uint32_t> numbers);

    std::size_t free_words() const { return (static_cast<std::size_t>(directions_) + 63) / 64; }
};

}  // namespace hilcam
