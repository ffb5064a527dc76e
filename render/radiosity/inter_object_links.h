#pragma once
// Links from an object's probes to other objects near it: the part of the transfer table
// (probes/transfer_table.h) that depends on the objects' relative poses, traced again when those change by a
// step. Turning parts are objects here. Glass of other objects is transparent.

#include <cstdint>
#include <span>
#include <vector>

#include "render/radiosity/irradiance_cache.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

// Another object's pose relative to this one, rounded, so that cached light depends on the rounded pose
// alone.
struct NeighbourObject {
    std::size_t object = 0;
    Mat3f axes;     // rotate from this object's axes to the other's
    Vec3f shift_m;  // this object's origin in the other's axes

    Vec3f place(Vec3f point_m) const { return axes * point_m + shift_m; }
    Vec3f dir(Vec3f d) const { return axes * d; }
    bool operator==(const NeighbourObject& o) const {
        return object == o.object && axes.x == o.axes.x && axes.y == o.axes.y && axes.z == o.axes.z &&
               shift_m == o.shift_m;
    }
    // step_rad: step of the rotation. min_m: smallest step of the shift, which is otherwise rounded to about
    // a hundredth.
    static NeighbourObject rounded(const Pose& self, const Pose& other, std::size_t object, float step_rad,
                                   float min_m);
};

class InterObjectLinks {
  public:
    struct Link {
        std::uint32_t probe;  // number in the other object's table
        std::uint16_t object;
        std::uint16_t direction;
    };

    const std::vector<NeighbourObject>& near() const { return near_; }
    const NeighbourObject& neighbour(std::size_t object) const;
    bool empty() const { return links_.empty(); }
    std::size_t size() const { return links_.size(); }
    std::size_t first(std::size_t probe) const { return first_[probe]; }
    std::span<const Link> of(std::size_t probe) const {
        if (links_.empty()) return {};
        return {links_.data() + first_[probe], first_[probe + 1] - first_[probe]};
    }
    // Returns bits by direction, like the table's, without those that meet another object.
    std::span<const std::uint64_t> free(const TransferTable& table, std::size_t probe) const {
        if (free_.empty()) return table.free(probe);
        const std::size_t words = table.free(probe).size();
        return {free_.data() + probe * words, words};
    }
    std::size_t bytes() const;

    // Traces the links. lights: of all objects, by number; null if the object caches no light. Runs on
    // oneTBB; the result does not depend on the number of threads.
    void make(std::span<const NeighbourObject> near, std::size_t self,
              std::span<const IrradianceCache* const> lights, const EmbreeScene& scene);

  private:
    std::vector<NeighbourObject> near_;
    std::vector<std::uint32_t> first_;  // by probe, and one more
    std::vector<Link> links_;
    std::vector<std::uint64_t> free_;
};

}  // namespace hilcam
