#include "emulator/check/first_sight.h"

#include <algorithm>
#include <cmath>

#include "emulator/run/truth_source.h"
#include "emulator/scenario/site.h"
#include "render/vocabulary/units.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

FrameTruth truth_of(const ScenarioConfig& s, const Renderer& renderer) {
    TruthRequest request = truth_request(s);
    request.visibility = true;
    request.stars = false;
    request.object = request.range = request.depth = request.normal = request.position = false;
    FrameTruth truth = make_truth(s, renderer, request);
    truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling),
                             {s.camera.binning_x, s.camera.binning_y});
    renderer.report_truth(truth);
    return truth;
}

bool is_within(Vec3d p, Vec3d least, Vec3d most) {
    return p.x > least.x && p.x < most.x && p.y > least.y && p.y < most.y && p.z > least.z && p.z < most.z;
}

double off_boresight(Vec3d camera) { return std::atan2(std::hypot(camera.x, camera.y), camera.z); }

bool is_in_frame(const SeenThing& thing, const FrameRaster& raster) {
    const Vec2d p = thing.center_px;
    return thing.has_center && p.x >= 0 && p.y >= 0 && p.x <= raster.width_px && p.y <= raster.height_px;
}

SeenObject::Place place_of(const SeenThing& thing, const FrameRaster& raster, const CameraSheet& sheet,
                           double off_rad, double radius_rad) {
    // A thing smaller than a pixel may have no pixel and still be visible; one smaller than a 64th has no
    // silhouette either.
    if (thing.visible_px > 0 || thing.visible_fraction > 0) return SeenObject::Place::kVisible;
    if (thing.silhouette_px == 0 && is_in_frame(thing, raster) && radius_rad < sheet.ifov_rad)
        return SeenObject::Place::kVisible;
    if (off_rad - radius_rad > 0.5 * kPi) return SeenObject::Place::kBehind;
    // Without other things it would be in the frame, so something hides it.
    const bool alone =
        thing.silhouette_px > 0 && thing.has_center && off_rad < 0.5 * sheet.field_diagonal_rad;
    return alone ? SeenObject::Place::kHidden : SeenObject::Place::kOutside;
}

SeenObject seen(const ScenarioConfig& s, const SeenThing& thing, const LoadedObject& loaded,
                const FrameTruth& truth, const CameraSheet& sheet) {
    SeenObject out;
    out.loaded = loaded;
    out.distance_m = thing.distance_m;
    out.off_boresight_rad = off_boresight(thing.position_camera_m);
    out.angular_radius_rad =
        thing.distance_m > thing.radius_m ? std::asin(thing.radius_m / thing.distance_m) : kPi;
    out.phase_rad = thing.phase_rad;
    out.sunlit = std::isfinite(thing.sunlit) ? thing.sunlit : 1;
    out.silhouette_px = thing.silhouette_px;
    const double frame_px = static_cast<double>(truth.raster.width_px) * truth.raster.height_px;
    out.picture_share = static_cast<double>(thing.visible_px) / frame_px;
    out.visible_fraction = std::isfinite(thing.visible_fraction) ? thing.visible_fraction : 0;
    out.place = place_of(thing, truth.raster, sheet, out.off_boresight_rad, out.angular_radius_rad);
    const Vec3d camera_in_object_m = transposed(to_matrix(thing.world.world_from_body)) *
                                     (truth.camera.position_world_m - thing.world.position_world_m);
    out.holds_camera = s.mount.thing != thing.id && is_within(camera_in_object_m, loaded.min_m, loaded.max_m);
    out.expected =
        expected_signal(sheet, {loaded.mean_reflectance(), thing.phase_rad,
                                truth.sun_distance_m / kAstronomicalUnit_m, out.sunlit, thing.silhouette_px,
                                emitted_e(sheet, SpectralGrid(s.spectrum_edges_um), loaded.mean_emission())});
    return out;
}

void report_site(const ScenarioConfig& s, FirstSight& out) {
    const std::optional<PlaceConfig> site = site_of(s);
    if (!site || s.origin.center() != site->body) return;
    const WorldFrame frame(parse_utc(s.time_utc), s.origin);
    const PlacedAxes axes = axes_of(local_frame(*site), {frame, {}});
    out.from_site_m =
        transposed(axes.axes.icrf_from_axes) * (out.camera.position_world_m - axes.origin.position_m);
    out.site_body = kBodyNames[index_of(site->body)];
}

}  // namespace

FirstSight first_sight(const ScenarioConfig& s, const Renderer& renderer,
                       const std::vector<LoadedObject>& objects, const CameraSheet& sheet,
                       const Pose& first_camera) {
    const FrameTruth truth = truth_of(s, renderer);
    FirstSight out;
    out.camera = truth.camera;
    out.pointing = radec_of(truth.camera.world_from_body);
    report_site(s, out);
    out.height_above_ground_m = truth.height_above_ground_m;
    out.ground = ground_sight(s, out.camera, sheet);
    out.sun_camera_dir = truth.sun_camera_dir;
    out.sun_off_boresight_rad = off_boresight(truth.sun_camera_dir);
    out.sun_distance_au = truth.sun_distance_m / kAstronomicalUnit_m;
    for (const SeenThing& thing : truth.things) {
        if (thing.is_body && thing.visible_px > 0)
            (thing.id == kSunId ? out.shows_sun : out.shows_body) = true;
        // Terrain comes after the objects and is made during the run, so nothing is known of it here.
        if (thing.is_body || thing.id > s.objects.size()) continue;
        out.objects.push_back(seen(s, thing, objects[thing.id - 1], truth, sheet));
    }
    const Mat3d first_from_world = transposed(to_matrix(first_camera.world_from_body));
    out.from_first_m = first_from_world * (truth.camera.position_world_m - first_camera.position_world_m);
    const Quat turn = conjugate(first_camera.world_from_body) * truth.camera.world_from_body;
    out.turned_rad = 2 * std::atan2(std::hypot(turn.x, turn.y, turn.z), std::abs(turn.w));
    return out;
}

}  // namespace hilcam
