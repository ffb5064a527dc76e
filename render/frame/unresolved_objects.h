#pragma once
// The objects that a frame draws as points, or lights so, all of them: each has an ObjectImpostor, or is traced by an
// UnresolvedObject of the thread that takes it, and its points are added in the objects' order, whatever the number of threads.

#include <memory>
#include <optional>
#include <vector>

#include "render/frame/object_impostor.h"
#include "render/frame/unresolved_object.h"
#include "render/shading/point_field.h"
#include "render/vocabulary/point_source.h"

namespace hilcam {

class FrameSetup;
class FrameTracer;

class UnresolvedObjects {
  public:
    // samples: the most rays along an axis of an object's picture. The frame's view must have its pointers and sizes
    // by now. Owner thread.
    UnresolvedObjects(const FrameSetup& setup, int samples);
    // Returns the most points that an object gives.
    static std::size_t max_points(const FrameSetup& setup);

    // Adds the points of the placed frame's objects. Loop; no allocation while the vector has room. Returns what it
    // took to trace.
    TileStats add_points(const FrameSetup& setup, const FrameTracer& tracer, const PointField& field,
                         std::vector<PointSource>& points);

  private:
    struct Seen {
        std::size_t object;
        std::size_t first;  // number of its first glimpse
        bool pictured = false;
        std::size_t count = 0;  // number of its glimpses
        TileStats stats;
    };
    void find_seen(const FrameSetup& setup, const PointField& field);
    void look(const FrameSetup& setup, const FrameTracer& tracer, Seen& seen);

    std::vector<std::unique_ptr<UnresolvedObject>> by_rays_;  // by slot of the thread pool
    std::vector<Seen> seen_;
    std::optional<ObjectImpostor> picture_;
    std::vector<Glimpse> glimpses_;  // glimpses of all objects, with room for the most
};

}  // namespace hilcam
