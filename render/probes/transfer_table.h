#pragma once
// The transfer table: what each probe of an object meets along fixed directions of its hemisphere. It depends
// on the mesh only, so it is traced once and kept on disk; radiosity/irradiance_cache.h computes light from
// it. See docs/rendering.md, "Cached light".
//
// There are sixty directions as in the paper (Peng et al. 2011), or 16 or 256, in equal shares of irradiance
// instead of solid angle: a golden-angle spiral (Vogel, Math. Biosci. 44, 1979, 179) projected up from the
// disk (Malley), rotated for each probe by an angle of its own. They are divided among the probe's points, so
// that a probe sees what its whole surface sees. Glass is transparent. A direction is free, meets another
// probe, or ends in the dark: below the horizon of a rough place, or on a surface without cached light.
//
// Probes that no light can reach (inside a closed body, unless something shines there) are left out. A point
// that sees only things nearer than half a cube is buried and does not count.

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/probes/surface_probes.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct TransferSettings {
    int directions = 60;           // multiple of SurfaceProbe::kPoints, at most 256
    std::size_t probes = 100'000;  // approximate number, before those without light are left out
    bool enclosed = false;         // light can start in closed rooms: lamps, materials that emit
};

// Called now and then, on any thread of the work, with the share that is done. An exception from it ends the
// work.
using WorkWatcher = std::function<void(double share)>;

// Returns the directions in local axes (z: the probe's normal), before the probe's own rotation: first those
// of its first point, then those of its second, and so on.
std::vector<Vec3f> transfer_directions(int count);

class EmbreeScene;

class TransferTable {
  public:
    TransferTable() = default;
    // glass: for each surface, whether it is glass. Throws InputError if memory runs out, and whatever the
    // watcher throws. Owner thread, runs on oneTBB; the result does not depend on the number of threads.
    TransferTable(const Mesh& mesh, std::span<const std::uint8_t> glass, const TransferSettings& settings,
                  const WorkWatcher& watcher = {});

    const SurfaceProbes& probes() const { return probes_; }
    std::size_t size() const { return probes_.probes().size(); }
    int directions() const { return directions_; }
    std::size_t bytes() const;

    // The probe that a direction meets.
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
    // Returns one bit per direction, 64 in a word; 1: it meets nothing.
    std::span<const std::uint64_t> free(std::size_t probe) const {
        return {free_.data() + probe * free_words(), free_words()};
    }
    bool is_free(std::size_t probe, std::size_t direction) const {
        return free(probe)[direction / 64] >> (direction % 64) & 1u;
    }
    // Each direction belongs to one of the probe's points; those of buried points do not count.
    std::size_t directions_of_point() const {
        return static_cast<std::size_t>(directions_) / SurfaceProbe::kPoints;
    }
    std::size_t point_of(std::size_t direction) const { return direction / directions_of_point(); }
    bool is_live(std::size_t probe, std::size_t point) const {
        return (static_cast<unsigned>(live_[probe]) >> point & 1u) != 0;
    }
    // Returns the number of directions that count: those of live points, above the surface there.
    int counted(std::size_t probe) const { return counted_[probe]; }
    // Returns the rotation of a probe's directions about its normal [cos, sin].
    Vec2f turn(std::size_t probe) const { return turns_[probe]; }

    // Lists, for files, all data that cannot be computed from the rest.
    template <class Archive>
    static void list(auto& self, Archive& archive) {
        SurfaceProbes::list(self.probes_, archive);
        archive(self.directions_), archive(self.first_entry_), archive(self.entries_), archive(self.free_),
            archive(self.live_), archive(self.counted_), archive(self.turns_);
    }
    bool is_whole() const;
    // Scales the table for a mesh that is larger by this factor; what directions meet stays the same.
    void scale(float factor) { probes_.scale(factor); }

  private:
    SurfaceProbes probes_;
    int directions_ = 0;
    std::vector<std::uint32_t> first_entry_;  // by probe, and one more
    std::vector<Entry> entries_;
    std::vector<std::uint64_t> free_;
    std::vector<std::uint8_t> live_;  // one bit per point
    std::vector<std::uint16_t> counted_;
    std::vector<Vec2f> turns_;

    // Blocks of probes during construction; each lists what its probes meet, probe by probe.
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
