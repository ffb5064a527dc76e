#include "emulator/run/ground_footprint.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

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

double longitude_deg(Vec3d place) { return std::atan2(place.y, place.x) / kDegree_rad; }
double latitude_deg(Vec3d place) { return std::asin(std::clamp(place.z, -1.0, 1.0)) / kDegree_rad; }
Geodetic geodetic_of(Vec3d place) {
    return {longitude_deg(place) * kDegree_rad, latitude_deg(place) * kDegree_rad, 0};
}

// A frame's truth, for ground on a body in a given attitude.
class GroundView {
  public:
    GroundView(const FrameTruth& truth, const BodyState& body, const Figure& figure)
        : truth_(truth), figure_(figure) {
        fixed_from_camera_ = body.fixed_from_world * to_matrix(truth.camera.world_from_body);
        camera_m_ = body.fixed_from_world * (truth.camera.position_world_m - body.world_m);
    }

    int width() const { return truth_.raster.width_px; }
    int height() const { return truth_.raster.height_px; }
    Vec3d camera_m() const { return camera_m_; }
    // Returns pixels per radian at the centre of the frame.
    double focal_length_px() const {
        return truth_.geometry.focal_length_px / std::abs(truth_.raster.x.scale);
    }
    // True when the record has what the picture's rays found in each pixel.
    bool has_rays() const {
        return truth_.layers.position_m.planes() > 0 && truth_.layers.object.planes() > 0;
    }
    // Finds the point of the terrain at a pixel's centre, in camera axes; false: no terrain there.
    bool point_of(int x, int y, Vec3d& from_camera_m) const {
        const auto k = static_cast<std::size_t>(x);
        // The terrain is the last of the objects.
        const std::vector<std::uint32_t>& things = truth_.request.thing_of_object;
        if (things.empty() || truth_.layers.object.row(y)[k] != things.back() + 1) return false;
        const LengthImage& p = truth_.layers.position_m;
        from_camera_m = to_double(Vec3f{p.row(y, 0)[k], p.row(y, 1)[k], p.row(y, 2)[k]});
        return is_finite(from_camera_m);
    }
    // Finds the ellipsoid's normal at the ground in a pixel; false: no ground there.
    bool place(int x, int y, Vec3d& place) const {
        Vec3d from_camera_m;
        if (!point_of(x, y, from_camera_m)) return false;
        place = ellipsoid_normal(figure_, camera_m_ + fixed_from_camera_ * from_camera_m);
        return true;
    }
    // Finds where the ray through a place in the frame meets the body's ellipsoid, raised by a height; false:
    // it does not.
    bool meet(Vec2d frame_px, double raised_m, Vec3d& place, double& distance_m) const {
        const Vec2d image_px = truth_.raster.image_px(frame_px);
        const Vec3d dir =
            fixed_from_camera_ * normalized(truth_.geometry.direction_camera(image_px.x, image_px.y));
        const Figure raised{figure_.equatorial_radius_m + raised_m, figure_.polar_radius_m + raised_m};
        distance_m = intersect_ellipsoid(raised, camera_m_, dir);
        if (!(distance_m > 0 && std::isfinite(distance_m))) return false;
        place = ellipsoid_normal(raised, camera_m_ + distance_m * dir);
        return true;
    }
    // Finds a thing's place in the frame; false: outside the frame, or below the horizon.
    bool find(Vec3d place, Vec3d point_m, double diameter_m, SeenGroundThing& out) const {
        const Vec3d way_m = point_m - camera_m_;
        const Vec3d from_camera_m = transposed(fixed_from_camera_) * way_m;
        if (!(from_camera_m.z > 0 && dot(place, way_m) < 0)) return false;
        const Vec2d image_px = truth_.geometry.project_px(from_camera_m);
        if (!truth_.geometry.shows(from_camera_m, image_px)) return false;
        out.place_px = truth_.raster.frame_px(image_px);
        const int x = static_cast<int>(std::floor(out.place_px.x)),
                  y = static_cast<int>(std::floor(out.place_px.y));
        if (!(out.place_px.x >= 0 && out.place_px.y >= 0 && x < width() && y < height())) return false;
        out.longitude_deg = longitude_deg(place), out.latitude_deg = latitude_deg(place);
        out.diameter_m = diameter_m, out.distance_m = length(way_m);
        out.diameter_px = diameter_m / out.distance_m * focal_length_px();
        if (!has_rays()) return true;
        // The pixel's centre, and the mesh, may be some pixels away from the point.
        constexpr double kBeside_px = 3;
        const double miss_m = 0.5 * diameter_m + kBeside_px * out.distance_m / focal_length_px();
        Vec3d met_m;
        out.visible = point_of(x, y, met_m) && length(met_m - from_camera_m) < miss_m;
        return true;
    }

  private:
    const FrameTruth& truth_;
    Figure figure_;
    Mat3d fixed_from_camera_;
    Vec3d camera_m_;  // body axes
};

// A part of the ground that contains everything in the frame.
struct Extent {
    Vec3d middle;
    double within_m = 0, nearest_m = std::numeric_limits<double>::infinity();

    bool any() const { return within_m > 0; }
    // Returns the diameter that is `px` wide where the ground is nearest.
    double smallest_m(double px, const GroundView& view) const {
        return px * nearest_m / view.focal_length_px();
    }
};

Extent extent_of(const std::vector<Vec3d>& places, double nearest_m, const Figure& figure) {
    Extent out;
    Vec3d sum{0, 0, 0};
    for (const Vec3d& at : places) sum = sum + at;
    if (places.empty() || !(length(sum) > 0)) return out;
    out.middle = normalized(sum), out.nearest_m = nearest_m;
    for (const Vec3d& at : places)
        out.within_m = std::max(out.within_m, figure.equatorial_radius_m * length(at - out.middle));
    return out;
}
// Finds the extent from all rays of the picture.
Extent extent_by_rays(const GroundView& view, const Figure& figure) {
    std::vector<Vec3d> places;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int y = 0; y < view.height(); ++y)
        for (int x = 0; x < view.width(); ++x) {
            Vec3d at, from_camera_m;
            if (!view.place(x, y, at)) continue;
            view.point_of(x, y, from_camera_m);
            nearest_m = std::min(nearest_m, length(from_camera_m));
            places.push_back(at);
        }
    return extent_of(places, nearest_m, figure);
}
// Finds the extent from some places of the frame and the height of the ground below the camera, with a margin
// for relief and for places in between.
Extent extent_by_ellipsoid(const GroundView& view, const Figure& figure, double ground_m) {
    constexpr int kAcross = 16;
    constexpr double kMargin = 1.15;
    std::vector<Vec3d> places;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int j = 0; j <= kAcross; ++j)
        for (int i = 0; i <= kAcross; ++i) {
            Vec3d at;
            double distance_m = 0;
            if (!view.meet({1.0 * i * view.width() / kAcross, 1.0 * j * view.height() / kAcross}, ground_m,
                           at, distance_m))
                continue;
            places.push_back(at), nearest_m = std::min(nearest_m, distance_m);
        }
    Extent out = extent_of(places, nearest_m / kMargin, figure);
    out.within_m *= kMargin;
    return out;
}

// Limits of a list of a frame's craters or boulders.
struct ThingLimits {
    double smallest_m, smallest_px;
    const char* keys;          // keys that would shorten the list
    double most = kMaxListed;  // largest number of entries
};

// Returns the craters or boulders in a part of the ground that are in the frame.
std::vector<SeenGroundThing> seen_things(GroundThings kind, const GlobeConfig& globe, const MappedBody& body,
                                         GroundHeights& heights, const GroundView& view, const Extent& extent,
                                         const ThingLimits& limits) {
    std::vector<SeenGroundThing> out;
    const double min_m = std::max(limits.smallest_m, extent.smallest_m(limits.smallest_px, view));
    for (const GroundThing& thing :
         find_things(kind, globe, body, extent.middle, extent.within_m, min_m, limits.keys)) {
        // The centre of a boulder is on its top, that of a crater on its floor.
        constexpr double kFine = 0.05;
        const Vec3d point_m =
            heights.point_m(thing.place, heights.height_m(thing.place, kFine * thing.diameter_m));
        SeenGroundThing seen;
        if (!view.find(thing.place, point_m, thing.diameter_m, seen) || seen.diameter_px < limits.smallest_px)
            continue;
        seen.figure = thing.figure;
        out.push_back(seen);
        // Stops here, because computing more heights would take long.
        if (static_cast<double>(out.size()) > limits.most)
            throw InputError(
                fmt::format("{}: the picture has more of them than a list can hold; accepted: {:.0f}",
                            limits.keys, limits.most));
    }
    return out;
}

// The truth of a still picture, with rays.
class StillView {
  public:
    StillView(const ScenarioConfig& s, double time_offset_s)
        : camera_(s, time_offset_s), truth_(empty_truth(s, camera_.renderer())), body_(ground_body(s)) {
        camera_.report(truth_);
        view_.emplace(truth_, camera_.world().bodies[ground_body_id(s)], body_.figure);
        extent_ = extent_by_rays(*view_, body_.figure);
        if (!extent_.any())
            throw InputError(
                "--footprint: no ground is in the picture; accepted: an instant when there is some "
                "(--time-offset-s)");
    }
    const MappedBody& body() const { return body_; }
    const GroundView& view() const { return *view_; }
    const Extent& extent() const { return extent_; }

  private:
    StillCamera camera_;
    FrameTruth truth_;
    MappedBody body_;
    std::optional<GroundView> view_;
    Extent extent_;

    static FrameTruth empty_truth(const ScenarioConfig& s, const Renderer& renderer) {
        TruthRequest request = truth_request(s);
        request.stars = request.visibility = false;
        request.object = request.position = true;
        FrameTruth truth = make_truth(s, renderer, request);
        truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling),
                                 {s.camera.binning_x, s.camera.binning_y});
        return truth;
    }
};

class RunGround final : public GroundTruth {
  public:
    RunGround(const ScenarioConfig& s, double smallest_px)
        : globe_(*s.terrain->globe),
          body_(ground_body(s)),
          id_(ground_body_id(s)),
          origin_(s.origin),
          smallest_px_(smallest_px),
          heights_(globe_, body_) {}

    SeenGroundThings find(const FrameTruth& truth) const override {
        const std::lock_guard lock(mutex_);
        SeenGroundThings out;
        try {
            const Bodies bodies = bodies_at(truth.time, origin_);
            const GroundView view(truth, bodies[id_], body_.figure);
            const Vec3d below = ellipsoid_normal(body_.figure, view.camera_m());
            const double ground_m = heights_.height_m(below, 1);
            const Extent extent = extent_by_ellipsoid(view, body_.figure, ground_m);
            if (!extent.any()) return out;
            const auto list = [&](GroundThings kind) {
                return seen_things(kind, globe_, body_, heights_, view, extent,
                                   {0, smallest_px_, "outputs.truth.ground_px", kMaxInLine});
            };
            if (globe_.craters) out.craters = list(GroundThings::kCraters);
            if (globe_.boulders) out.boulders = list(GroundThings::kBoulders);
        } catch (const InputError& error) {
            out = {};
            out.left_out = error.what();
        }
        return out;
    }

  private:
    static constexpr double kMaxInLine = 4096;  // things of each kind; at most 1.5 MB of text
    GlobeConfig globe_;
    MappedBody body_;
    BodyId id_;
    OriginConfig origin_;
    double smallest_px_;
    mutable std::mutex mutex_;  // heights are looked up by one thread at a time
    mutable GroundHeights heights_;
};

}  // namespace

std::string survey_footprint(const ScenarioConfig& s, const GroundSurvey& survey,
                             const GroundFootprint& footprint) {
    const StillView still(s, footprint.time_offset_s);
    const GlobeConfig& globe = *s.terrain->globe;
    const auto kind =
        survey.what == GroundSurvey::What::kCraters ? GroundThings::kCraters : GroundThings::kBoulders;
    GroundHeights heights(globe, still.body());
    const std::optional<PlaceConfig> site = site_of(s);
    const LocalPlane plane(site ? site->place : geodetic_of(still.extent().middle), still.body().figure);
    std::string out =
        std::string(kPlaceColumns) + things_columns(kind) + ",x_px,y_px,diameter_px,distance_m,visible\n";
    for (const SeenGroundThing& seen :
         seen_things(kind, globe, still.body(), heights, still.view(), still.extent(),
                     {survey.smallest_m, footprint.smallest_px, "--smallest-m, --smallest-px"})) {
        const Geodetic at{seen.longitude_deg * kDegree_rad, seen.latitude_deg * kDegree_rad, 0};
        out += fmt::format("{},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f},{:.4f},{:d}\n",
                           plane.text_of(LocalPlane(at, still.body().figure).up), seen.diameter_m,
                           seen.figure, seen.place_px.x, seen.place_px.y, seen.diameter_px, seen.distance_m,
                           seen.visible.value_or(true));
    }
    return out;
}

void write_hazards(const ScenarioConfig& s, const GroundSurvey& survey, const GroundFootprint& footprint,
                   const std::filesystem::path& file) {
    const StillView still(s, footprint.time_offset_s);
    const GroundView& view = still.view();
    const LocalPlane plane(geodetic_of(still.extent().middle), still.body().figure);
    const HeightSquare square =
        GroundHeights(*s.terrain->globe, still.body())
            .square(plane, still.extent().within_m + survey.spacing_m, survey.spacing_m);
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const auto width = static_cast<std::size_t>(view.width());
    const std::size_t pixels = width * static_cast<std::size_t>(view.height());
    std::vector<float> slopes(pixels, kNone), steps(pixels, kNone), hazards(pixels, kNone);
    for (int y = 0; y < view.height(); ++y)
        for (int x = 0; x < view.width(); ++x) {
            Vec3d place;
            if (!view.place(x, y, place)) continue;
            const Vec2d at_m = plane.along(place);
            const auto post = [&](double along_m) {
                return std::clamp(static_cast<int>(std::lround(along_m / square.spacing_m)), -square.half,
                                  square.half);
            };
            const GroundSlope slope = square.slope(post(at_m.x), post(at_m.y));
            const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            slopes[i] = static_cast<float>(slope.slope_rad / kDegree_rad);
            steps[i] = static_cast<float>(slope.step_m);
            hazards[i] = survey.limits.is_hazard(slope) ? 1.0f : 0.0f;
        }
    const std::array<NamedChannel, 3> channels = {
        {{"slope_deg", slopes}, {"step_m", steps}, {"hazard", hazards}}};
    write_channels_exr(file, view.width(), view.height(),
                       "slope_deg: deg, step_m: m, hazard: 1 where a limit is exceeded", channels);
}

std::shared_ptr<const GroundTruth> ground_truth_of(const ScenarioConfig& s) {
    const TruthConfig& config = s.outputs.config<TruthConfig>();
    if (!(config.ground_px > 0)) return nullptr;
    if (!s.terrain || !s.terrain->globe)
        throw InputError("outputs.truth.ground_px: there is no terrain.globe in this scenario; accepted: 0");
    return std::make_shared<RunGround>(s, config.ground_px);
}

}  // namespace hilcam
