#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/check/camera_judge.h"
#include "emulator/check/scenario_verdict.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Longer than any spacecraft [m], but not than a file in millimetres.
constexpr double kLongest_m = 500;
// A smaller object that covers no pixel was probably scaled twice [m].
constexpr double kShortest_m = 0.05;
// Most objects of a constellation are elsewhere, so only this many are named.
constexpr std::size_t kMaxTold = 10;
// An object this many times larger than the field appears as a piece of its surface.
constexpr double kFillsFields = 20;
// Share of full scale below which a picture looks dark.
constexpr double kDim = 0.02;
// A smaller share of the Sun is an eclipse; a smaller lit share of the disk is its night side.
constexpr double kDark = 0.02;

std::string size_text(Vec3d size_m) {
    return fmt::format("{:.4g} x {:.4g} x {:.4g} m", size_m.x, size_m.y, size_m.z);
}

double longest_m(const SeenObject& o) {
    const Vec3d size_m = o.loaded.max_m - o.loaded.min_m;
    return std::max({size_m.x, size_m.y, size_m.z});
}

std::string longest_advice(const SeenObject& o) {
    if (!(longest_m(o) > kLongest_m)) return "";
    return "; the file is probably in millimetres: scale: 0.001";
}

// Poses and angles refer to the origin of a mesh, which may be far from the mesh itself.
std::string origin_advice(const SeenObject& o) {
    const double off_m = length(0.5 * (o.loaded.min_m + o.loaded.max_m));
    if (!(off_m > length(o.loaded.max_m - o.loaded.min_m))) return "";
    return fmt::format("; that is its origin, and the middle of its mesh is {:.4g} m from there", off_m);
}

// Warns when the picture shows only a detail of an object: the focal length may have another unit, or the
// place may be too close.
void judge_filling(const SeenObject& o, const CameraReport& camera, std::vector<std::string>& out) {
    constexpr double kAll = 0.999;
    const double fields = 2 * o.angular_radius_rad / camera.sheet.field_diagonal_rad;
    if (o.picture_share < kAll || fields < kFillsFields || !(o.angular_radius_rad < 0.5 * kPi)) return;
    out.push_back(fmt::format(
        "object '{}' fills the picture: it is {:.3g} deg large, and the field is {:.3g} deg "
        "(camera.focal_length_mm is {:.6g}, camera.pitch_um {:.4g})",
        harmless(o.loaded.name), degrees(2 * o.angular_radius_rad), degrees(camera.sheet.field_diagonal_rad),
        1e3 * camera.sheet.camera.focal_length_m, 1e6 * camera.sheet.camera.pitch_m));
}

void judge_place(const SeenObject& o, const CameraReport& camera, std::vector<std::string>& out) {
    const std::string name = "object '" + harmless(o.loaded.name) + "'";
    if (o.holds_camera) {
        out.push_back(fmt::format("the camera is inside the mesh of {}, which is {}{}", name,
                                  size_text(o.loaded.max_m - o.loaded.min_m), longest_advice(o)));
        return;
    }
    switch (o.place) {
        case SeenObject::Place::kBehind:
            out.push_back(fmt::format("{} is behind the camera, {:.1f} deg off its boresight{}", name,
                                      degrees(o.off_boresight_rad), origin_advice(o)));
            return;
        case SeenObject::Place::kOutside:
            out.push_back(fmt::format(
                "{} is outside the field: {:.2f} deg off the boresight, where the field ends {:.2f} deg "
                "off it at its corners{}",
                name, degrees(o.off_boresight_rad), degrees(0.5 * camera.sheet.field_diagonal_rad),
                origin_advice(o)));
            return;
        case SeenObject::Place::kHidden:
            out.push_back(name + " is hidden: something is in front of it");
            return;
        case SeenObject::Place::kVisible:
            break;
    }
    judge_filling(o, camera, out);
    if (longest_m(o) < kShortest_m && o.silhouette_px < 1)
        out.push_back(fmt::format("{} is {} large, {:.2g} pixels from {:.4g} m: is its scale too small?",
                                  name, size_text(o.loaded.max_m - o.loaded.min_m), o.silhouette_px,
                                  o.distance_m));
    // An asteroid has that size, too, but is seen from farther away.
    if (const std::string advice = longest_advice(o); !advice.empty() && o.distance_m < longest_m(o))
        out.push_back(fmt::format("{} is {} large and {:.4g} m away{}", name,
                                  size_text(o.loaded.max_m - o.loaded.min_m), o.distance_m, advice));
}

// Names the keys that make a signal too high or too low.
std::string exposure_keys(const CameraSheet& sheet, bool by_converter) {
    const std::string keys = std::string("camera.exposure_ms") +
                             (by_converter ? ", or camera.gain_dn_e with camera.gain_db," : "");
    return sheet.camera.offset_dn > 0.5 * sheet.max_dn ? "camera.offset_dn, which leaves little for light,"
                                                       : keys;
}

// Says what is wrong with the light of something that is lit and in the picture; empty: nothing.
std::string exposure_fault(const CameraSheet& sheet, const ExpectedSignal& expected) {
    const bool by_converter = sheet.converter_e < sheet.well_e;
    if (sheet.camera.auto_exposure.on) return {};
    if (expected.full_scale > 2)
        return fmt::format("saturates: about {:.3g} times the range of {}; {} is too high",
                           expected.full_scale, by_converter ? "the converter" : "a pixel",
                           exposure_keys(sheet, by_converter));
    if (expected.full_scale < kDim)
        return fmt::format("is dark: about {:.0f} DN of {:.0f}, {:.2g} % of full scale; {} is too low",
                           expected.dn, sheet.max_dn, 100 * expected.full_scale, exposure_keys(sheet, true));
    return {};
}

bool any_lamp_lit(const ScenarioConfig& s) {
    return std::any_of(s.lamps.begin(), s.lamps.end(), [](const LampConfig& lamp) { return lamp.lit; });
}

// key: the object's.
void judge_light(const ScenarioConfig& s, const SeenObject& o, const CameraReport& camera,
                 const std::string& key, std::vector<std::string>& out) {
    if (o.place != SeenObject::Place::kVisible || o.holds_camera || any_lamp_lit(s)) return;
    if (!std::isfinite(o.phase_rad)) return;  // nothing is expected of what the camera is within
    const std::string name = "object '" + harmless(o.loaded.name) + "'";
    const auto warn = [&](const std::string& text) { out.push_back(s.places.at(key, name + " " + text)); };
    const bool needs_sun = !SpectralGrid(s.spectrum_edges_um).has_thermal();
    if (needs_sun && o.sunlit < kDark)
        warn(fmt::format("is in eclipse: {:.2g} % of the Sun is visible from it, and no lamp is lit",
                         100 * o.sunlit));
    else if (needs_sun && lit_share(o.phase_rad) < kDark)
        warn(fmt::format("shows its night side: phase angle {:.1f} deg", degrees(o.phase_rad)));
    else if (o.expected.snr < 1)
        warn(fmt::format("is lost in the noise: about {:.3g} e- of light, {:.3g} e- of noise",
                         o.expected.signal_e, camera.sheet.dark_total_e));
    else if (const std::string fault = exposure_fault(camera.sheet, o.expected); !fault.empty())
        out.push_back(s.places.at("camera.exposure_ms", name + " " + fault));
}

// Warns when the lit ground at the boresight would be far too bright or too dark. The bounds are wide,
// because the estimate ignores air and clouds.
void judge_ground(const ScenarioConfig& s, const CameraReport& camera, std::vector<std::string>& out) {
    const std::optional<GroundSight>& ground = camera.sight.ground;
    constexpr double kHigh_rad = 10 * kDegree_rad;
    if (!ground || !ground->expected || ground->sun_elevation_rad < kHigh_rad || any_lamp_lit(s)) return;
    if (const std::string fault = exposure_fault(camera.sheet, *ground->expected); !fault.empty())
        out.push_back(
            s.places.at("camera.exposure_ms", "the ground of the body '" + ground->body + "' " + fault));
}

void judge_terrain(const ScenarioConfig& s, const FirstSight& sight, std::vector<std::string>& out) {
    if (!s.terrain) return;
    if (!sight.height_above_ground_m)
        out.push_back(s.places.at("terrain",
                                  "the camera is outside the terrain's map: check terrain.place or pose, "
                                  "heights.spacing_m, and the camera's position"));
    else if (*sight.height_above_ground_m < 0)
        out.push_back(
            s.places.at("camera_pose", fmt::format("the camera is {:.4g} m below the ground of the terrain",
                                                   -*sight.height_above_ground_m)));
}

// True when anything in the picture sends light.
bool shows_light(const ScenarioConfig& s, const FirstSight& sight) {
    if (sight.shows_sun || sight.shows_body || s.terrain || (s.stars && !s.stars->catalogue.empty()) ||
        any_lamp_lit(s) || models_of(s).radiance != "reflected")
        return true;
    return std::any_of(sight.objects.begin(), sight.objects.end(), [](const SeenObject& o) {
        return o.place == SeenObject::Place::kVisible && o.sunlit >= kDark && lit_share(o.phase_rad) >= kDark;
    });
}

}  // namespace

std::vector<std::string> verdict_on_view(const ScenarioConfig& s, const CameraReport& camera) {
    std::vector<std::string> out;
    std::size_t left = 0;
    for (std::size_t i = 0; i < camera.sight.objects.size(); ++i) {
        const SeenObject& o = camera.sight.objects[i];
        std::vector<std::string> own;
        judge_place(o, camera, own);
        const std::string key = fmt::format("objects.{}", i);
        for (std::string& line : own) line = s.places.at(key, line);
        judge_light(s, o, camera, key, own);
        if (out.size() < kMaxTold)
            out.insert(out.end(), own.begin(), own.end());
        else
            left += own.empty() ? 0u : 1u;
    }
    if (left > 0)
        out.push_back(s.places.at(
            "objects",
            fmt::format("and {} more objects have warnings: --json gives the place of each", left)));
    if (!shows_light(s, camera.sight))
        out.push_back(s.places.at("camera_pose", "nothing that is lit is in the picture: it will be black"));
    for (std::string& line : judge_camera(camera.sheet, camera.period_s > 0, s.places))
        out.push_back(std::move(line));
    judge_ground(s, camera, out);
    judge_terrain(s, camera.sight, out);
    if (camera.share_in_bins < 0.5)
        out.push_back(s.places.at(
            "spectrum_edges_um",
            fmt::format("spectrum_edges_um exclude {:.0f} % of the sunlight that the camera detects",
                        100 * (1 - camera.share_in_bins))));
    return out;
}

}  // namespace hilcam
