// An example of a plug-in: a path model that gives the distance of what the camera sees [m] instead of its
// radiance, in every bin. Built by tests/CMakeLists.txt; used in a scenario by
//     plugins: [{file: libdistance_plugin.so}]
//     quality: {path_model: distance}

#include <array>

#include "render/frame/plugin.h"
#include "render/primary/primary_hits.h"

namespace {

class DistancePaths final : public hilcam::PathModel {
  public:
    void trace(hilcam::Tile& tile) override {
        hilcam::PrimaryHits seen(tile);
        while (const std::size_t count = seen.next(points_))
            for (const hilcam::ShadingPoint& at : std::span(points_.data(), count)) {
                const auto distance_m =
                    static_cast<float>(length(hilcam::to_double(at.point_m) - tile.frame.camera_m));
                tile.add(at, hilcam::LightPart::kPath, distance_m * at.throughput);
            }
    }

  private:
    std::array<hilcam::ShadingPoint, kMaxShadingPoints> points_;
};

void add(hilcam::Modules& modules) {
    modules.paths.add("distance", [] { return std::make_unique<DistancePaths>(); });
}

}  // namespace

HILCAM_PLUGIN(add)
