#include "render/frame/earth_view.h"

#include <algorithm>

#include "render/earth/earth_model.h"
#include "render/shading/point_field.h"
#include "render/vocabulary/units.h"

namespace hilcam {

EarthView::EarthView(const EarthModel* earth, const Spectrum& sun_irradiance_1au_w_m2_um,
                     const ImageGeometry& geometry, double top_m, bool keeps_picture) {
    if (earth && keeps_picture)
        picture_ = std::make_unique<EarthImpostorCache>(*earth, sun_irradiance_1au_w_m2_um,
                                                        1 / geometry.focal_length_px, top_m);
    if (earth && earth->detail())
        detail_ =
            std::make_unique<DetailStream>(earth->detail(), earth->ground().first(), earth->detail_bytes());
}

void EarthView::stop_looking_ahead() {
    if (picture_) picture_->stop_looking_ahead();
    if (detail_) detail_->stop_looking_ahead();
}

void EarthView::place(const WorldSnapshot& world, Background& background, FrameContext& frame) {
    place_picture(background, frame);
    place_detail(world, background, frame);
}

void EarthView::place_picture(const Background& background, FrameContext& frame) {
    const bool smooth =
        frame.rays->is_still() || frame.rays->row_motion();  // directions, from pixel to pixel
    if (!picture_ || !smooth || !background.earth_in_patches()) return;
    const PlacedBody& earth = background.disks().front();
    if (picture_->place(earth.camera_m, earth.sun_dir, background.map_numbers()))
        frame.earth_impostor = &picture_->picture();
    const double au = kAstronomicalUnit_m * earth.sun_radius_rad / kSunRadius_m;
    frame.earth_impostor_factor = static_cast<float>(au * au);
}

// An impostor uses the map in memory, which is finer than its pixels.
void EarthView::place_detail(const WorldSnapshot& world, Background& background, const FrameContext& frame) {
    if (!detail_ || frame.earth_impostor) return;
    const auto disks = background.disks();
    const auto earth =
        std::find_if(disks.begin(), disks.end(), [](const PlacedBody& b) { return b.id == BodyId::kEarth; });
    if (earth == disks.end()) return;
    const Vec3d boresight =
        earth->fixed_from_world * (to_matrix(world.camera.world_from_body) * Vec3d{0, 0, 1});
    background.show_detail(detail_->place({earth->camera_m, boresight, earth->sun_dir,
                                           half_field_rad(frame.geometry) + frame.rays->sweep_rad(),
                                           1 / frame.geometry.focal_length_px}));
}

}  // namespace hilcam
