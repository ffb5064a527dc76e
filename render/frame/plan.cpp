#include "render/frame/plan.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "render/frame/sky_cost.h"
#include "render/indirect/indirect_cache.h"
#include "render/shading/lamp_light.h"
#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/units.h"

namespace hilcam {

RaySpace choose_ray_space(const WorldSnapshot& world, std::span<const double> radius_m, bool rays_still) {
    // Single precision resolves 6e-8 of the distance; beyond this many radii the error starts to show in a
    // pixel.
    constexpr double kFar = 20;
    const RaySpace at_camera{world.camera.position_world_m, 0};
    if (radius_m.empty() || !rays_still) return at_camera;
    Vec3d middle;
    for (const Pose& object : world.objects) middle = middle + object.position_world_m;
    middle = middle / static_cast<double>(world.objects.size());
    double reach_m = 0;
    for (std::size_t i = 0; i < radius_m.size(); ++i)
        reach_m = std::max(reach_m, length(world.objects[i].position_world_m - middle) + radius_m[i]);
    if (length(middle - world.camera.position_world_m) < kFar * reach_m) return at_camera;
    return {middle, 1.01 * reach_m};
}

namespace {

// A grid of n x n places gives the area inside an outline to about n^-1.5. The light of an object of s pixels
// grows with s^2 and its noise with s, so n ~ s^(2/3) keeps the error at a constant share of the noise.
double share_of_samples(double size_px) {
    return std::cbrt(std::min(1.0, size_px / kPoints_px * (size_px / kPoints_px)));
}
int point_samples_of(double size_px, const RayDensity& density) {
    return std::max(density.min_point_samples,
                    static_cast<int>(std::ceil(share_of_samples(size_px) * density.point_samples)));
}
// An even number, so that the picture has a middle. Not smaller than for an object of one pixel, which costs
// little more than its triangles.
int picture_px_of(double size_px) {
    constexpr int kMin_px = kPicture_px / 4;
    return std::max(kMin_px, 2 * static_cast<int>(std::ceil(share_of_samples(size_px) * kPicture_px / 2)));
}

}  // namespace

ObjectPlan plan_object(const ImageGeometry& geometry, const WorldSnapshot& world, const Pose& object,
                       double radius_m, RayDensity density) {
    ObjectPlan plan;
    const Vec3d to_object_m = object.position_world_m - world.camera.position_world_m;
    plan.distance_m = length(to_object_m);
    plan.use = ObjectUse::kMesh;
    plan.samples_per_axis = density.samples_per_axis;
    plan.size_px = geometry.padded_width();
    if (plan.distance_m <= radius_m) return plan;
    plan.size_px = 2 * radius_m / plan.distance_m * geometry.focal_length_px;
    if (plan.size_px < kPoints_px) plan.use = ObjectUse::kPoints;
    const double across = std::ceil(density.rays_across / plan.size_px);
    plan.samples_per_axis = std::max(density.samples_per_axis, static_cast<int>(std::min(16.0, across)));
    plan.point_samples = point_samples_of(plan.size_px, density);
    const bool is_point = plan.use == ObjectUse::kPoints;
    if (plan.size_px < kPictured_px && (is_point ? density.pictures_of_points : density.pictures_of_meshes))
        plan.picture_px = picture_px_of(plan.size_px), plan.samples_per_axis = density.samples_per_axis;
    return plan;
}

namespace {

const char* reason(ObjectUse use) {
    switch (use) {
        case ObjectUse::kHidden:
            return "no ray looks for it (outside the field); it still shades and is reflected";
        case ObjectUse::kPoints:
            return "points with the flux of its own little picture (below 8 pixels)";
        case ObjectUse::kMesh:
            return "traced (it may be in the field)";
    }
    return "";
}

std::string body_line(const FrameContext& f, std::size_t i, std::span<const double> costs_ms) {
    const PlacedBody& body = f.background->disks()[i];
    std::ostringstream line;
    line << f.background->name_of(body.id) << ", " << body.distance_m * 1e-3 << " km away, "
         << 2 * std::acos(body.disk_cosine) / kDegree_rad << " deg wide: "
         << (f.body_boxes[i].empty() ? "not drawn (outside the field)" : "may be in the field, then drawn")
         << (body.in_points ? " as points of its own little picture (below 8 pixels)" : "")
         << "; lights and is reflected where that reaches the threshold";
    if (body.may_be_eclipsed) line << "; another body may shadow it";
    const std::string look = f.background->describe(body);
    if (!look.empty()) line << "; " << look;
    if (f.earth_impostor && i == 0) line << "; seen as a kept picture";
    if (!costs_ms.empty() && !f.body_boxes[i].empty())
        line << "; its pixels take " << std::round(10 * costs_ms[i]) / 10 << " ms of a core";
    return line.str();
}

std::string sun_line(const FrameContext& f, const WorldSnapshot& world) {
    std::ostringstream line;
    line << "Sun, " << length(world.bodies.sun_world_m - world.camera.position_world_m) / kAstronomicalUnit_m
         << " au away: "
         << (f.sun_box.empty() ? "not drawn (outside the field)"
                               : "may be in the field, then its disk is drawn")
         << "; light from its " << (f.sun_is_disk ? "whole disk" : "middle (sun_disk: false)");
    const float seen = f.background->sun_seen_from(f.rays_world_m, kNoBody)[0];
    if (seen < 1) line << "; bodies leave " << 100 * seen << " % of it to the objects (first bin)";
    return line.str();
}

std::string lamp_line(const FrameContext& f, std::size_t i) {
    std::ostringstream line;
    line << "lamp " << i + 1 << " '" << f.lamps->all()[i].name << "': ";
    for (const PlacedLamp& lamp : f.lamps->lit()) {
        if (lamp.number != i) continue;
        line << "lit, " << length(lamp.position_m - f.camera_m)
             << " m from the camera: a shadow ray to it from every surface that its beam meets";
        return line.str();
    }
    const bool shines = max_component(f.lamps->all()[i].intensity_w_sr_um) > 0;
    line << (shines ? "off" : "dark, as its spectrum has nothing in the scenario's bins")
         << ": costs nothing";
    return line.str();
}

std::string part_line(const SkyPart& part) {
    std::ostringstream line;
    line << part.body << ": " << part.text;
    if (part.ms && *part.ms < part.resolved_ms)
        line << "; takes less than " << std::round(10 * part.resolved_ms) / 10 << " ms of a core";
    else if (part.ms)
        line << "; takes " << std::round(10 * *part.ms) / 10 << " ms of a core";
    if (part.bytes > 0) line << "; " << std::round(1e-5 * static_cast<double>(part.bytes)) / 10 << " MB";
    return line.str();
}

std::string air_line(const Background& background) {
    if (!background.air()) return "no atmosphere";
    return "atmosphere " + background.air()->describe() +
           (background.camera_in_air() ? "; objects are seen through it (the camera is in it)"
                                       : "; objects are not dimmed (the camera is outside it)");
}

}  // namespace

std::vector<std::string> explain(const PlannedFrame& planned, const WorldSnapshot& world) {
    const FrameContext& f = planned.frame;
    std::vector<std::string> lines;
    const auto add = [&](const auto&... parts) {
        std::ostringstream line;
        (line << ... << parts);
        lines.push_back(line.str());
    };
    const RenderQuality& q = planned.quality;
    if (q.uses_buffer())
        add(f.bins, " spectral bins; ", q.buffer_samples, " samples per pixel by the visibility buffer");
    else
        add(f.bins, " spectral bins; ", q.samples_per_axis, " x ", q.samples_per_axis, " rays per pixel",
            q.scatters_rays() ? ", scattered over it" : "",
            q.sees_ground() ? "; ground that is alone is seen once a pixel, sixteen pixels at a time" : "",
            q.sees_ground() && q.ground_step_px > 1 ? ", by every second one each way" : "");
    add("path model ", q.path_model, ", ", f.max_depth, " surfaces deep, paths end below ",
        f.contribution_threshold);
    add("rays begin at the ", f.start_before_m > 0 ? "objects (far away against their size)" : "camera");
    for (std::size_t i = 0; i < planned.plans.size(); ++i) {
        const ObjectPlan& plan = planned.plans[i];
        add("object ", i + 1, " '", planned.names[i], "', ", planned.triangles[i], " triangles (level ",
            plan.level, "), ", plan.distance_m, " m away, ", plan.size_px, " px: ", reason(plan.use),
            plan.picture_px > 0 ? "; its light is that of a picture of its own, " +
                                      std::to_string(plan.picture_px) + " px across"
                                : "");
        if (f.indirect)
            add("  light between its parts: ", f.indirect->keeps(i)
                                                   ? "cached, " + f.indirect->describe(i)
                                                   : std::string("random paths (nothing is cached)"));
    }
    lines.push_back(sun_line(f, world));
    const std::vector<double> costs_ms = sky_costs_ms(f);
    for (std::size_t i = 0; i < f.background->disks().size(); ++i) lines.push_back(body_line(f, i, costs_ms));
    std::string far;
    for (const PlacedBody& body : f.background->points())
        far.append(" ").append(f.background->name_of(body.id));
    lines.push_back(far.empty() ? "no body is a point" : "points (smaller than a pixel):" + far);
    for (std::size_t i = 0; i < f.lamps->all().size(); ++i) lines.push_back(lamp_line(f, i));
    if (f.lamps->all().empty()) lines.push_back("no lamps");
    lines.push_back(air_line(*f.background));
    for (const SkyPart& part : sky_parts(f)) lines.push_back(part_line(part));
    add(planned.stars, " stars to look through");
    add(f.has_glass ? "glass: shadow rays go through it" : "no glass: shadow rays end at the first surface");
    add(f.has_emission ? "surfaces emit" : "no emission");
    return lines;
}

}  // namespace hilcam
