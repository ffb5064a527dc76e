#pragma once
// Chooses the way in which a frame draws the Earth's model: from an impostor that is kept between frames,
// with finer levels of its map that are read on demand, or ray by ray.

#include <memory>
#include <string>

#include "render/background/background.h"
#include "render/earth/detail_stream.h"
#include "render/earth/earth_impostor_cache.h"
#include "render/shading/frame_context.h"

namespace hilcam {

class EarthView {
  public:
    // earth: null if the Earth has no model. keeps_picture: the quality asks for an impostor. Owner thread.
    EarthView(const EarthModel* earth, const Spectrum& sun_irradiance_1au_w_m2_um,
              const ImageGeometry& geometry, double top_m, bool keeps_picture);

    // Called once per frame, after the background is placed. Loop.
    void place(const WorldSnapshot& world, Background& background, FrameContext& frame);
    void stop_looking_ahead();

    const DetailStream* detail() const { return detail_.get(); }  // null: the whole map is in memory

  private:
    std::unique_ptr<EarthImpostorCache> picture_;  // null: none
    std::unique_ptr<DetailStream> detail_;

    void place_picture(const Background& background, FrameContext& frame);
    void place_detail(const WorldSnapshot& world, Background& background, const FrameContext& frame);
};

}  // namespace hilcam
