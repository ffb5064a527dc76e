#pragma once
// Rays by which paths go on from shading points whose light is cached (indirect_cache.h). Nothing is drawn: they go into fixed
// directions, by mirrors, lobes too narrow to be cached, lobes whose cached light hangs on few directions, and glass. What can
// add less than contribution_threshold is left out.

#include <array>
#include <cstddef>

#include "render/indirect/indirect_cache.h"
#include "render/paths/next_ray.h"
#include "render/shading/path_model.h"

namespace hilcam {

// Scratch memory for one thread.
class GlossyRays {
  public:
    // Begins with other shading points: no lobe is followed.
    void clear() { share_count_ = lobe_count_ = 0; }
    // Shading points whose light is cached, and what each leaves to rays.
    struct Asking {
        std::span<const ShadingPoint> points;
        std::span<const GlossyRequest> requests;
    };
    // Adds the rays of one of them: a mirror's one direction, which may be many, four of a narrow lobe, both of a sheet of glass. Loop.
    void add_of(Tile& tile, const Asking& asking, std::size_t number, NextRays& rays);
    // Adds what the rays of lobes have found, once all have come back, to the pixels that have it. Loop.
    void add_found(Tile& tile) const;

  private:
    static constexpr auto kMax = static_cast<std::size_t>(PathModel::kMaxShadingPoints);
    std::array<PixelShare, kMax> shares_;
    std::array<GlossyLobe, kMax> lobes_;
    std::size_t share_count_ = 0, lobe_count_ = 0;

    // The shading points whose lobes the same rays follow.
    struct Followers {
        std::array<const ShadingPoint*, IndirectCache::kMaxTogether> point;
        std::size_t count = 0;
        float samples = 0;           // that see them
        GlossyLobe* lobe = nullptr;  // gets the light that the rays find
    };
    Followers share_rays(const Tile& tile, const Asking& asking, std::size_t first);
    void send_glossy_rays(Tile& tile, const Asking& asking, std::size_t number, NextRays& rays);
};

}  // namespace hilcam
