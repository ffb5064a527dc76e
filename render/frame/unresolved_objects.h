#pragma once
// All objects whose light a frame draws as points. Each has an ObjectImpostor or is traced by its thread's
// UnresolvedObject. Points are added in the order of the objects, whatever the number of threads.

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
    // samples: the largest number of rays along one axis of an object's picture. The frame context must have
    // its pointers and sizes already. Owner thread.
    UnresolvedObjects(const FrameSetup& setup, int samples);
    // Returns the largest number of points of one object.
    static std::size_t max_points(const FrameSetup& setup);

    // Appends the points of the placed frame's objects, and returns the costs of tracing. Loop; no allocation
    // while the vector has room.
    TileStats add_points(const FrameSetup& setup, const FrameTracer& tracer, const PointField& field,
                         std::vector<PointSource>& points);

  private:
    struct Seen {
        std::size_t object;
        std::size_t first;  // index of its first glimpse
        bool pictured = false;
        std::size_t count = 0;  // number of its glimpses
        TileStats stats;
    };
    void find_seen(const FrameSetup& setup, const PointField& field);
    void look(const FrameSetup& setup, const FrameTracer& tracer, Seen& seen);

    std::vector<std::unique_ptr<UnresolvedObject>> by_rays_;  // by slot of the thread pool
    std::vector<Seen> seen_;
    std::optional<ObjectImpostor> picture_;
    std::vector<Glimpse> glimpses_;  // those of all objects, with room for the most
};

}  // namespace hilcam
