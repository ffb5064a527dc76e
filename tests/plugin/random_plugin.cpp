// The smallest path model of a plug-in that follows light: one random direction at each surface, whose light the Sun and lamps have
// not counted. Built by tests/CMakeLists.txt; used in a scenario by
//     plugins: [{file: librandom_plugin.so}]
//     quality: {path_model: random}

#include "render/paths/path_plugin.h"

namespace {

using namespace hilcam;

class RandomPaths final : public PathPlugin {
  public:
    void light(PathView& view, std::span<const PathPoint> points) override {
        view.add_direct_light(points);
        for (const PathPoint& at : points) {
            const auto next = view.random_direction(at);
            if (!next) continue;
            const PathRay ray{.dir = next->dir,
                              .throughput = at.throughput * next->weight,
                              .part = LightPart::kPath,
                              .background_part = LightPart::kPath,
                              .below = next->transmits,
                              .sees_sun = next->sees_sun};
            view.follow(at, {&ray, 1}, *this);
        }
    }
};

}  // namespace

HILCAM_PATH_PLUGIN("random", RandomPaths)
