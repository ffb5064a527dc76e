#pragma once
// The way in which a frame sees the Earth by its model: by a picture of it that is kept from frame to frame, by finer levels of its map that are read as
// they are needed, or ray by ray.

#include <memory>
#include <string>

#include "render/background/background.h"
#include "render/earth/detail_stream.h"
#include "render/earth/earth_impostor_cache.h"
#include "render/shading/frame_context.h"

namespace hilcam {

class EarthView {
  public:
    // earth: null: it has no model. keeps_picture: as the quality says. Owner thread.
    EarthView(const EarthModel* earth, const Spectrum& sun_irradiance_1au_w_m2_um,
              const ImageGeometry& geometry, double top_m, bool keeps_picture);

    // Once per frame, when the background is placed. Loop.
    void place(const WorldSnapshot& world, Background& background, FrameContext& frame);
    void stop_looking_ahead();

    const DetailStream* detail() const { return detail_.get(); }  // null: the Earth's map is in memory

  private:
    std::unique_ptr<EarthImpostorCache> picture_;  // null: none
    std::unique_ptr<DetailStream> detail_;

    void place_picture(const Background& background, FrameContext& frame);
    void place_detail(const WorldSnapshot& world, Background& background, const FrameContext& frame);
};

}  // namespace hilcam
