#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "emulator/check/check_report.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxObjects = 50;
constexpr std::size_t kMaxSurfaces = 20;  // number listed; `hilcam mesh` lists all

std::string place_text(const SeenObject& o) {
    switch (o.place) {
        case SeenObject::Place::kVisible:
            return fmt::format("{:.3g} % of the picture, {:.0f} % of it in sight", 100 * o.picture_share,
                               100 * o.visible_fraction);
        case SeenObject::Place::kHidden:
            return "hidden by something in front of it";
        case SeenObject::Place::kOutside:
            return "outside the field";
        case SeenObject::Place::kBehind:
            break;
    }
    return "behind the camera";
}

std::string phase_text(const SeenObject& o) {
    if (!std::isfinite(o.phase_rad)) return "no phase angle, as the camera is at its origin";
    return fmt::format("phase angle {:.1f} deg ({:.0f} % of a sphere would be lit)", degrees(o.phase_rad),
                       100 * lit_share(o.phase_rad));
}

void add_surfaces(const LoadedObject& o, std::string& out) {
    std::size_t listed = 0;
    for (const LoadedSurface& surface : o.surfaces) {
        if (surface.triangles == 0) continue;
        if (++listed > kMaxSurfaces) continue;
        out += fmt::format(
            "    {:<9} '{}': {} triangles, {:.4g} m2, reflectance {:.2f}, {}\n",
            listed == 1 ? "surfaces" : "", harmless(surface.name), surface.triangles, surface.area_m2,
            surface.reflectance,
            surface.rule.empty() ? "the mesh's own look" : "by rule '" + harmless(surface.rule) + "'");
    }
    if (listed > kMaxSurfaces)
        out +=
            fmt::format("    {:<9} and {} more: 'hilcam mesh FILE' lists them\n", "", listed - kMaxSurfaces);
}

void add_object(const SeenObject& o, std::size_t number, const CameraSheet& sheet, std::string& out) {
    const Vec3d size_m = o.loaded.max_m - o.loaded.min_m;
    out += fmt::format("  object {} '{}'\n", number, harmless(o.loaded.name));
    const auto line = [&](const char* name, const std::string& text) {
        out += fmt::format("    {:<9} {}\n", name, text);
    };
    line("size", fmt::format("{:.4g} x {:.4g} x {:.4g} m, {} triangles, mean reflectance {:.2f}", size_m.x,
                             size_m.y, size_m.z, o.loaded.triangles, o.loaded.mean_reflectance()));
    line("place", fmt::format("{:.6g} m away, {:.2f} deg off the boresight; {}", o.distance_m,
                              degrees(o.off_boresight_rad), place_text(o)));
    line("light", fmt::format("{}, {:.0f} % of the Sun is visible from it", phase_text(o), 100 * o.sunlit));
    line("expected",
         fmt::format(
             "about {:.0f} DN of {:.0f} where it is lit, {:.2g} of full scale, SNR {:.3g}, at {:.4g} ms and "
             "{:.1f} dB{}",
             o.expected.dn, sheet.max_dn, o.expected.full_scale, o.expected.snr, sheet.exposure_s * 1e3,
             sheet.camera.gain_db, sheet.camera.auto_exposure.on ? ", before automatic exposure" : ""));
    add_surfaces(o.loaded, out);
}

// Rounds to 1e-9 m, which removes rounding errors where two bodies' axes agree.
double to_a_nanometre(double length_m) { return std::round(length_m * 1e9) / 1e9 + 0.0; }

// Rounds, and writes a full turn as 0: "359.998" becomes "0.00".
std::string turn_text(double rad, int decimals) {
    const double steps = std::pow(10.0, decimals);
    return fmt::format("{:.{}f}", std::fmod(std::round(degrees(rad) * steps) / steps, 360) + 0.0, decimals);
}

// Writes metres, or kilometres for large lengths.
std::string length_text(double length_m) {
    return length_m < 1e4 ? fmt::format("{:.4g} m", length_m) : fmt::format("{:.5g} km", length_m * 1e-3);
}

void add_ground(const GroundSight& g, const CameraSheet& sheet, std::string& out) {
    out += fmt::format("  ground      the smooth {}, {} ahead: {} a pixel, {} x {} in the frame\n", g.body,
                       length_text(g.distance_m), length_text(g.pixel_m), length_text(g.wide_m),
                       length_text(g.high_m));
    out += fmt::format(
        "              seen {:.1f} deg off its vertical, the Sun {:.1f} deg {} its horizon{}\n",
        degrees(g.off_vertical_rad), std::abs(degrees(g.sun_elevation_rad)),
        g.sun_elevation_rad < 0 ? "below" : "above",
        g.expected ? fmt::format(": about {:.0f} DN of {:.0f}, {:.2g} of full scale, SNR {:.3g}",
                                 g.expected->dn, sheet.max_dn, g.expected->full_scale, g.expected->snr)
                   : "");
}

// Prints each data sheet once. earlier: cameras that have been printed.
void add_sheet(const CameraReport& c, std::span<const CameraReport> earlier, std::string& out) {
    const std::string sheet = to_text(c.sheet);
    for (const CameraReport& other : earlier)
        if (to_text(other.sheet) == sheet) {
            out += fmt::format("camera sheet: as camera {}'s\n", other.number);
            return;
        }
    out += sheet;
}

void add_frame_time(const CameraReport& c, std::string& out) {
    if (!c.frame_time) {
        out += "  a frame     is not timed: it has more than 32 million rays\n";
        return;
    }
    out += fmt::format(
        "  a frame     takes {:.3g} ms to render and {:.3g} ms in the sensor on {} threads here{}\n",
        c.frame_time->render_ms, c.frame_time->sensor_ms, c.frame_time->threads,
        c.period_s > 0 ? fmt::format("; {:.4g} frames/s leave {:.3g} ms", 1 / c.period_s, 1e3 * c.period_s)
                       : "");
    if (c.is_late())
        out +=
            "              longer than the frame period: a run lowers the quality, or misses exposures here "
            "(camera.frame_rate_hz, quality, loop.levels)\n";
}

void add_camera(const CameraReport& c, std::span<const CameraReport> earlier, std::size_t cameras,
                std::string& out) {
    if (cameras > 1) out += fmt::format("camera {} of {}\n", c.number, cameras);
    out += "first instant\n";
    const FirstSight& sight = c.sight;
    for (std::size_t i = 0; i < std::min(sight.objects.size(), kMaxObjects); ++i)
        add_object(sight.objects[i], i + 1, c.sheet, out);
    if (sight.objects.size() > kMaxObjects)
        out += fmt::format("  and {} more objects: --json has them\n", sight.objects.size() - kMaxObjects);
    out += fmt::format("  boresight   right ascension {} deg, declination {:.4f} deg, roll {} deg (ICRF)\n",
                       turn_text(sight.pointing.right_ascension_rad, 4),
                       degrees(sight.pointing.declination_rad), turn_text(sight.pointing.roll_rad, 2));
    if (sight.from_site_m)
        out +=
            fmt::format("  site        the camera is {:.6g} m east, {:.6g} m north, {:.6g} m above it ({})\n",
                        to_a_nanometre(sight.from_site_m->x), to_a_nanometre(sight.from_site_m->y),
                        to_a_nanometre(sight.from_site_m->z), sight.site_body);
    if (sight.height_above_ground_m)
        out += fmt::format("  terrain     the camera is {:.6g} m above it\n", *sight.height_above_ground_m);
    if (sight.ground) add_ground(*sight.ground, c.sheet, out);
    out += fmt::format(
        "  Sun         {:.4g} au away, {:.1f} deg off the boresight: ({:.3f}, {:.3f}, {:.3f}) in camera axes "
        "(right, "
        "down, ahead)\n",
        sight.sun_distance_au, degrees(sight.sun_off_boresight_rad), sight.sun_camera_dir.x,
        sight.sun_camera_dir.y, sight.sun_camera_dir.z);
    if (c.number > 1)
        out += fmt::format(
            "  baseline    {:.6g} m from camera 1: ({:.6g}, {:.6g}, {:.6g}) m in its axes, turned by {:.4f} "
            "deg\n",
            length(sight.from_first_m), to_a_nanometre(sight.from_first_m.x),
            to_a_nanometre(sight.from_first_m.y), to_a_nanometre(sight.from_first_m.z),
            degrees(sight.turned_rad));
    add_frame_time(c, out);
    add_sheet(c, earlier, out);
    out += fmt::format("plan\n  its bins have {:.1f} % of the camera's photo-electrons of sunlight\n",
                       100 * c.share_in_bins);
    for (const std::string& line : c.plan) out += "  " + harmless(line) + "\n";
}

}  // namespace

std::string to_text(const CheckReport& report) {
    std::string out = report.warnings.empty() ? "warnings: none\n" : "warnings:\n";
    for (const std::string& warning : report.warnings) out += "  " + harmless(warning) + "\n";
    out += fmt::format("scenario {} at {}\n", harmless(report.scenario), format_utc(report.time));
    const std::span<const CameraReport> all(report.reports);
    for (std::size_t i = 0; i < all.size(); ++i) add_camera(all[i], all.first(i), report.cameras, out);
    for (const std::string& line : report.maps) out += "map: " + harmless(line) + "\n";
    for (const std::string& line : report.run) out += line + "\n";
    if (report.memory_mb > 0)
        out += fmt::format("memory: {:.0f} MB with {} loaded\n", report.memory_mb,
                           report.reports.size() > 1 ? "the last camera's scene" : "everything");
    return out;
}

}  // namespace hilcam
