#include <array>

#include "render/light/path_models.h"
#include "render/light/primary_rays.h"
#include "render/light/radiance_model.h"

namespace hilcam {
namespace {

class DirectPaths final : public PathModel {
  public:
    void trace(Tile& tile) override {
        const std::size_t count = trace_primary_rays(tile, vertices_);
        tile.frame.radiance->add_light(tile, {vertices_.data(), count}, LampLight::kNone);
    }

  private:
    std::array<Vertex, kMostSamples> vertices_;
};

}  // namespace

std::unique_ptr<PathModel> make_direct_paths() { return std::make_unique<DirectPaths>(); }

}  // namespace hilcam
