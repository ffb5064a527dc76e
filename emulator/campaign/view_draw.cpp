#include "emulator/campaign/view_draw.h"

#include <algorithm>
#include <cmath>

#include "emulator/check/expected_signal.h"
#include "emulator/run/truth_source.h"
#include "render/vocabulary/units.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

using Dimension = CaseDraw::View;

struct Axes {
    Vec3d x, y;
};
// Returns two unit vectors perpendicular to z and to each other, the first as close to `hint` as possible.
Axes across(Vec3d z, Vec3d hint) {
    Vec3d x = hint - dot(hint, z) * z;
    if (!(length(x) > 1e-6)) x = cross(z, std::abs(z.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
    x = normalized(x);
    return {x, cross(z, x)};
}

Vec3d on_cone(Vec3d axis, double cosine, double around_rad) {
    const Axes a = across(axis, {0, 0, 1});
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return cosine * axis + sine * (std::cos(around_rad) * a.x + std::sin(around_rad) * a.y);
}

// Returns the attitude for which a direction in camera axes points along a direction in the world. The
// picture's up is the world's +z, turned by roll.
Quat camera_that_sees(Vec3d in_camera, Vec3d in_world, double roll_rad) {
    const Axes c = across(in_camera, {0, -1, 0});
    const Axes w = across(in_world, {0, 0, 1});
    const Vec3d up = std::cos(roll_rad) * w.x + std::sin(roll_rad) * w.y;
    const Vec3d beside = cross(in_world, up);
    const auto column = [&](Vec3d camera_axis) {
        return dot(camera_axis, in_camera) * in_world + dot(camera_axis, c.x) * up +
               dot(camera_axis, c.y) * beside;
    };
    const Vec3d x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
    // from_dcm() takes the matrix whose rows are the body's axes in the frame.
    return from_dcm(Mat3d{x, y, z});
}

class ViewMaker {
  public:
    ViewMaker(const ViewConfig& view, const CaseDraw& draw, std::uint32_t attempt, CaseCamera& camera,
              CasePlan& plan)
        : view_(view), draw_(draw), attempt_(attempt), camera_(camera), plan_(plan) {
        TruthRequest request;
        request.visibility = request.stars = false;
        truth_ = truth_record(camera, request);
        camera.camera().report(truth_);
    }

    void make() {
        const SeenThing& target = truth_.things[camera_.target()];
        const Vec3d target_m = target.world.position_world_m;
        const Vec3d to_sun = normalized(camera_.camera().world().bodies.sun_world_m - target_m);
        const Vec3d to_camera = direction_to_camera(target_m, to_sun);
        const double range_m = range(target.radius_m);
        const Vec3d place_m = target_m + range_m * to_camera;
        const double roll_rad = kDegree_rad * (view_.roll_deg ? drawn(*view_.roll_deg, Dimension::kRoll)
                                                              : 360 * place(Dimension::kRoll));
        const Quat attitude = camera_that_sees(target_in_camera(), -to_camera, roll_rad);
        const Vec3d velocity_m_s = camera_.camera().velocity_m_s(camera_.target());
        std::erase_if(plan_.overrides, [](const std::string& o) { return o.starts_with("camera_pose."); });
        set_override(plan_.overrides, "camera_motion", "null");
        set_override(plan_.overrides, "camera_pose",
                     "{position_m: " + yaml_text(place_m) + ", attitude_wxyz: " + yaml_text(attitude) +
                         ", velocity_m_s: " + yaml_text(velocity_m_s) + "}");
        if (view_.signal_dn)
            expose(target, range_m, std::acos(std::clamp(dot(to_sun, to_camera), -1.0, 1.0)));
    }

  private:
    const ViewConfig& view_;
    const CaseDraw& draw_;
    std::uint32_t attempt_;
    CaseCamera& camera_;
    CasePlan& plan_;
    FrameTruth truth_;

    double place(Dimension dimension) const { return draw_.view_place(plan_.number, attempt_, dimension); }
    double drawn(const NumberDraw& number, Dimension dimension) const {
        return number_at(number, place(dimension));
    }
    void add(const char* column, double value) { plan_.parameters.emplace_back(column, exact_number(value)); }

    Vec3d direction_to_camera(Vec3d target_m, Vec3d to_sun) {
        if (view_.before) {
            const Bodies& bodies = camera_.camera().world().bodies;
            const Vec3d to_body_m = bodies[view_.before->body].world_m - target_m;
            const double radius_m = bodies.figure(view_.before->body).equatorial_radius_m;
            if (!(length(to_body_m) > radius_m))
                throw InputError("view.before: the target is within the body");
            const double edge = std::sqrt(1 - std::pow(radius_m / length(to_body_m), 2));
            const double around_rad = 2 * kPi * place(Dimension::kDiskY);
            const bool is_before = place(Dimension::kBefore) < view_.before->share;
            plan_.parameters.emplace_back("view.before", is_before ? "1" : "0");
            // Uniform over the disk, or over everything outside it.
            const double least = is_before ? edge : -1, most = is_before ? 1 : edge;
            return -on_cone(normalized(to_body_m), least + place(Dimension::kDiskX) * (most - least),
                            around_rad);
        }
        if (view_.phase_deg) {
            const double phase_rad = kDegree_rad * drawn(*view_.phase_deg, Dimension::kPhase);
            return on_cone(to_sun, std::cos(phase_rad), 2 * kPi * place(Dimension::kAround));
        }
        return direction_at(place(Dimension::kPhase), place(Dimension::kAround));
    }

    double focal_length_px() const {
        return std::abs(intrinsics_of(truth_.geometry, truth_.raster).focal_length_px.x);
    }

    double range(double radius_m) {
        const double min_m = 1.0001 * radius_m;
        double range_m = 0;
        if (view_.range_m) {
            range_m = drawn(*view_.range_m, Dimension::kSize);
        } else {
            const double size_px = drawn(*view_.size_px, Dimension::kSize);
            if (!(size_px > 0))
                throw InputError("view.size_px: found " + exact_number(size_px) + "; accepted: above 0");
            add("view.size_px", size_px);
            range_m = range_of_size_m(radius_m, size_px, focal_length_px());
        }
        if (!(range_m > min_m))
            throw InputError("view: the camera would stand " + exact_number(range_m) +
                             " m from the target's origin, within the sphere of " + exact_number(radius_m) +
                             " m that holds it");
        return range_m;
    }

    // Returns the direction in camera axes of the place in the frame where the target should be.
    Vec3d target_in_camera() {
        const auto share = [&](Dimension dimension) {
            return view_.offset_share ? drawn(*view_.offset_share, dimension) : 0.0;
        };
        const double x = share(Dimension::kOffsetX), y = share(Dimension::kOffsetY);
        const Vec2d place_px{0.5 * truth_.raster.width_px * (1 + x), 0.5 * truth_.raster.height_px * (1 + y)};
        const Vec2d image_px = truth_.raster.image_px(place_px);
        return normalized(truth_.geometry.direction_camera(image_px.x, image_px.y));
    }

    // Sets the exposure: light and dark current are proportional to it.
    void expose(const SeenThing& target, double range_m, double phase_rad) {
        const double dn = drawn(*view_.signal_dn, Dimension::kSignal);
        const ScenarioConfig& s = camera_.scenario();
        const CameraSheet& sheet = camera_.sheet();
        const double radius_px = focal_length_px() * target.radius_m / range_m;
        const ExpectedSignal expected = expected_signal(
            sheet, {camera_.camera().objects()[camera_.target()].mean_reflectance(), phase_rad,
                    truth_.sun_distance_m / kAstronomicalUnit_m,
                    std::isfinite(target.sunlit) ? target.sunlit : 1, kPi * radius_px * radius_px,
                    emitted_e(sheet, SpectralGrid(s.spectrum_edges_um),
                              camera_.camera().objects()[camera_.target()].mean_emission())});
        const double rate_e_s = expected.signal_e / sheet.exposure_s + sheet.dark_e_s;
        const double wanted_e = (dn - s.camera.offset_dn) / sheet.gain_dn_e;
        const auto [min_s, max_s] = exposure_range_s(s.camera);
        const double exposure_s =
            std::clamp(rate_e_s > 0 && wanted_e > 0 ? wanted_e / rate_e_s : max_s, min_s, max_s);
        const std::string text = exact_number(exposure_s * 1e3);
        set_override(plan_.overrides, "camera.exposure_ms", text);
        add("view.signal_dn", dn);
        plan_.parameters.emplace_back("camera.exposure_ms", text);
    }

    static std::pair<double, double> exposure_range_s(const CameraModel& camera) {
        constexpr double kMin_s = 1e-6, kMax_s = 1e3;  // range of the key
        if (camera.exposure_range_s.size() == 2)
            return {std::max(kMin_s, camera.exposure_range_s[0]),
                    std::min(kMax_s, camera.exposure_range_s[1])};
        return {kMin_s, kMax_s};
    }
};

}  // namespace

double range_of_size_m(double radius_m, double size_px, double focal_length_px) {
    return radius_m / std::sin(std::atan(0.5 * size_px / focal_length_px));
}

FrameTruth truth_record(const CaseCamera& camera, const TruthRequest& request) {
    const ScenarioConfig& s = camera.scenario();
    TruthRequest all = truth_request(s);
    all.visibility = request.visibility;
    all.stars = request.stars;
    all.object = request.object, all.range = request.range, all.depth = request.depth;
    all.normal = request.normal, all.position = request.position, all.part = request.part;
    all.silhouettes = request.silhouettes;
    FrameTruth truth = make_truth(s, camera.camera().renderer(), all);
    truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling),
                             {s.camera.binning_x, s.camera.binning_y});
    return truth;
}

std::vector<std::string> view_columns(const ViewConfig& view) {
    std::vector<std::string> out;
    if (view.before) out.push_back("view.before");
    if (view.size_px) out.push_back("view.size_px");
    if (view.signal_dn) out.insert(out.end(), {"view.signal_dn", "camera.exposure_ms"});
    return out;
}

void draw_view(const ViewConfig& view, const CaseDraw& draw, std::uint32_t attempt, CaseCamera& camera,
               CasePlan& plan) {
    ViewMaker(view, draw, attempt, camera, plan).make();
}

}  // namespace hilcam
