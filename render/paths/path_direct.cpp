#include <array>

#include "render/paths/path_models.h"
#include "render/primary/primary_hits.h"
#include "render/shading/radiance_model.h"

namespace hilcam {
namespace {

class DirectPaths final : public PathModel {
  public:
    void trace(Tile& tile) override {
        PrimaryHits seen(tile);
        while (const std::size_t count = seen.next(points_))
            tile.frame.radiance->add_light(tile, {points_.data(), count}, BodySampling::kNone);
    }

  private:
    std::array<ShadingPoint, kMaxShadingPoints> points_;
};

}  // namespace

std::unique_ptr<PathModel> make_direct_paths() { return std::make_unique<DirectPaths>(); }

}  // namespace hilcam
