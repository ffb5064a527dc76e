#include "emulator/run/ground_footprint.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "emulator/run/still_camera.h"
#include "emulator/run/truth_source.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/scenario/site.h"
#include "io/truth/truth_files.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

// A picture's rays to the ground, in the body's axes.
class SeenGround {
  public:
    SeenGround(const ScenarioConfig& s, double time_offset_s)
        : camera_(s, time_offset_s), truth_(empty_truth(s, camera_.renderer())), body_(ground_body(s)) {
        camera_.tell(truth_);
        const BodyState& state = camera_.world().bodies[ground_body_id(s)];
        fixed_from_camera_ = state.fixed_from_world * to_matrix(truth_.camera.world_from_body);
        camera_m_ = state.fixed_from_world * (truth_.camera.position_world_m - state.world_m);
        find_extent();
    }

    const MappedBody& body() const { return body_; }
    int width() const { return truth_.raster.width_px; }
    int height() const { return truth_.raster.height_px; }
    Vec3d middle() const { return middle_; }
    double within_m() const { return within_m_; }
    double nearest_m() const { return nearest_m_; }
    // Pixels per radian in the middle of the frame.
    double focal_length_px() const {
        return truth_.geometry.focal_length_px / std::abs(truth_.raster.x.scale);
    }
    // The normal of the ground that a pixel shows; false: it shows none.
    bool place(int x, int y, Vec3d& place) const {
        Vec3d from_camera_m;
        if (!point_of(x, y, from_camera_m)) return false;
        place = ellipsoid_normal(body_.figure, camera_m_ + fixed_from_camera_ * from_camera_m);
        return true;
    }

    struct Seen {
        Vec2d px;
        double distance_m = 0;
        bool visible = false;
    };
    // Finds a point of the ground in the frame; false: it is beside the frame. size_m: what a ray may miss it by.
    bool find(Vec3d point_m, double size_m, Seen& out) const {
        const Vec3d from_camera_m = transposed(fixed_from_camera_) * (point_m - camera_m_);
        if (!(from_camera_m.z > 0)) return false;
        const Vec2d image_px = truth_.geometry.project_px(from_camera_m);
        if (!truth_.geometry.shows(from_camera_m, image_px)) return false;
        out.px = truth_.raster.frame_px(image_px);
        const int x = static_cast<int>(std::floor(out.px.x)), y = static_cast<int>(std::floor(out.px.y));
        if (!(out.px.x >= 0 && out.px.y >= 0 && x < width() && y < height())) return false;
        out.distance_m = length(from_camera_m);
        // The pixel's middle, and the mesh, may be beside the point by some pixels.
        constexpr double kBeside_px = 3;
        const double miss_m = size_m + kBeside_px * out.distance_m / focal_length_px();
        Vec3d met_m;
        out.visible = point_of(x, y, met_m) && length(met_m - from_camera_m) < miss_m;
        return true;
    }

  private:
    StillCamera camera_;
    FrameTruth truth_;
    MappedBody body_;
    Mat3d fixed_from_camera_;
    Vec3d camera_m_, middle_;
    double within_m_ = 0, nearest_m_ = 0;

    static FrameTruth empty_truth(const ScenarioConfig& s, const Renderer& renderer) {
        TruthWishes wishes = truth_wishes(s);
        wishes.stars = wishes.visibility = false;
        wishes.object = wishes.position = true;
        FrameTruth truth = make_truth(s, renderer, wishes);
        truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling),
                                 {s.camera.binning_x, s.camera.binning_y});
        return truth;
    }
    // The point of the terrain that a pixel's middle shows, camera axes.
    bool point_of(int x, int y, Vec3d& from_camera_m) const {
        const auto k = static_cast<std::size_t>(x);
        const std::size_t objects =
            truth_.wishes.thing_of_object.empty() ? 0 : truth_.wishes.thing_of_object.back() + 1;
        // The terrain is the last of the objects.
        if (truth_.layers.object.row(y)[k] != objects) return false;
        const LengthImage& p = truth_.layers.position_m;
        from_camera_m = to_double(Vec3f{p.row(y, 0)[k], p.row(y, 1)[k], p.row(y, 2)[k]});
        return is_finite(from_camera_m);
    }
    void find_extent() {
        std::vector<Vec3d> places;
        nearest_m_ = std::numeric_limits<double>::infinity();
        Vec3d sum{0, 0, 0};
        for (int y = 0; y < height(); ++y)
            for (int x = 0; x < width(); ++x) {
                Vec3d at, from_camera_m;
                if (!place(x, y, at)) continue;
                point_of(x, y, from_camera_m);
                nearest_m_ = std::min(nearest_m_, length(from_camera_m));
                places.push_back(at), sum = sum + at;
            }
        if (places.empty())
            throw InputError(
                "--footprint: no ground is in the picture; accepted: an instant when there is some "
                "(--time-offset-s)");
        middle_ = normalized(sum);
        for (const Vec3d& at : places)
            within_m_ = std::max(within_m_, body_.figure.equatorial_radius_m * length(at - middle_));
    }
};

Geodetic geodetic_of(Vec3d place) {
    return {std::atan2(place.y, place.x), std::asin(std::clamp(place.z, -1.0, 1.0)), 0};
}

}  // namespace

std::string survey_footprint(const ScenarioConfig& s, const GroundSurvey& survey,
                             const GroundFootprint& footprint) {
    const SeenGround seen(s, footprint.time_offset_s);
    const GlobeConfig& globe = *s.terrain->globe;
    const auto kind =
        survey.what == GroundSurvey::What::kCraters ? GroundThings::kCraters : GroundThings::kBoulders;
    const double smallest_m =
        std::max(survey.smallest_m, footprint.smallest_px * seen.nearest_m() / seen.focal_length_px());
    GroundHeights heights(globe, seen.body());
    const std::optional<PlaceConfig> site = site_of(s);
    const LocalPlane plane(site ? site->place : geodetic_of(seen.middle()), seen.body().figure);
    std::string out =
        std::string(kPlaceColumns) + things_columns(kind) + ",x_px,y_px,diameter_px,distance_m,visible\n";
    for (const GroundThing& thing :
         find_things(kind, globe, seen.body(), seen.middle(), seen.within_m(), smallest_m)) {
        // A boulder's middle is on its top, a crater's on its floor.
        constexpr double kFine = 0.05;
        const Vec3d point_m =
            heights.point_m(thing.place, heights.height_m(thing.place, kFine * thing.diameter_m));
        SeenGround::Seen at;
        if (!seen.find(point_m, 0.5 * thing.diameter_m, at)) continue;
        const double diameter_px = thing.diameter_m / at.distance_m * seen.focal_length_px();
        if (diameter_px < footprint.smallest_px) continue;
        out += fmt::format("{},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f},{:.4f},{:d}\n", plane.text_of(thing.place),
                           thing.diameter_m, thing.figure, at.px.x, at.px.y, diameter_px, at.distance_m,
                           at.visible);
    }
    return out;
}

void write_hazards(const ScenarioConfig& s, const GroundSurvey& survey, const GroundFootprint& footprint,
                   const std::filesystem::path& file) {
    const SeenGround seen(s, footprint.time_offset_s);
    const LocalPlane plane(geodetic_of(seen.middle()), seen.body().figure);
    const HeightSquare square = GroundHeights(*s.terrain->globe, seen.body())
                                    .square(plane, seen.within_m() + survey.spacing_m, survey.spacing_m);
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const std::size_t pixels =
        static_cast<std::size_t>(seen.width()) * static_cast<std::size_t>(seen.height());
    std::vector<float> slopes(pixels, kNone), steps(pixels, kNone), hazards(pixels, kNone);
    for (int y = 0; y < seen.height(); ++y)
        for (int x = 0; x < seen.width(); ++x) {
            Vec3d place;
            if (!seen.place(x, y, place)) continue;
            const Vec2d at_m = plane.along(place);
            const auto post = [&](double along_m) {
                return std::clamp(static_cast<int>(std::lround(along_m / square.spacing_m)), -square.half,
                                  square.half);
            };
            const GroundSlope slope = square.slope(post(at_m.x), post(at_m.y));
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.width()) +
                                  static_cast<std::size_t>(x);
            slopes[i] = static_cast<float>(slope.slope_rad / kDegree_rad);
            steps[i] = static_cast<float>(slope.step_m);
            hazards[i] = survey.limits.is_hazard(slope) ? 1.0f : 0.0f;
        }
    const std::array<NamedChannel, 3> channels = {
        {{"slope_deg", slopes}, {"step_m", steps}, {"hazard", hazards}}};
    write_channels_exr(file, seen.width(), seen.height(),
                       "slope_deg: deg, step_m: m, hazard: 1 where a limit is exceeded", channels);
}

}  // namespace hilcam
