#pragma once
// The Earth of a model before a camera, lit from one side.

#include <memory>

#include "render/earth/earth_model.h"
#include "tests/support/stage.h"

namespace hilcam {

// size_px: of the square picture; half_width: tangent of half its field. kept: by a kept picture; else by rays, so many along
// a side of each pixel.
inline Stage earth_stage(int size_px, double half_width, bool kept, int rays, EarthMap ground,
                         CloudMaps clouds) {
    Stage s;
    s.camera(size_px, half_width);
    s.earth(0.3);
    s.scene.earth = std::make_shared<const EarthModel>(EarthConfig{}, std::move(ground), std::move(clouds),
                                                       nullptr, s.grid);
    s.quality.earth_impostor = kept;
    s.quality.visibility = kept ? "buffer" : "rays";
    s.quality.samples_per_axis = kept ? 1 : rays;
    s.sun({0.3, 0.5, -1});
    return s;
}

}  // namespace hilcam
