#include "emulator/scenario/lamp_setup.h"

#include <algorithm>
#include <utility>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

[[noreturn]] void fail(const LampConfig& lamp, const std::string& what) {
    throw InputError("lamp " + in_quotes(lamp.name) + ": " + what);
}

// Throws an error with the place of the lamp's key.
[[noreturn]] void fail(const ScenarioConfig& s, std::size_t index, const std::string& key,
                       const std::string& what) {
    throw KeyError("lamps." + std::to_string(index) + "." + key,
                   "lamp " + in_quotes(s.lamps[index].name) + ": " + key + ": " + what);
}

// Returns the index as in WorldState: the camera's body, objects, then all their parts on joints.
std::size_t thing_of(std::size_t index, const ScenarioConfig& s) {
    const LampConfig& lamp = s.lamps[index];
    if (lamp.on == "camera") {
        if (lamp.joint != 0)
            fail(s, index, "joint", "found " + std::to_string(lamp.joint) + "; the camera has none");
        return 0;
    }
    std::size_t joints_before = 0;
    std::string all = "camera";
    for (std::size_t i = 0; i < s.objects.size(); ++i) {
        const ObjectConfig& object = s.objects[i];
        const auto joint = static_cast<std::size_t>(lamp.joint);
        if (object.name == lamp.on) {
            if (joint > object.joints.size())
                fail(s, index, "joint",
                     "found " + std::to_string(joint) + "; " + in_quotes(object.name) + " has " +
                         std::to_string(object.joints.size()));
            return joint == 0 ? 1 + i : s.objects.size() + joints_before + joint;
        }
        joints_before += object.joints.size();
        all += ", " + object.name;
    }
    fail(s, index, "on", "found " + in_quotes(lamp.on) + "; accepted: " + all);
}

// Returns the mean of a curve over each bin. The curve is dark beyond its ends, because a data sheet shows
// all the light; a single number is valid everywhere.
Spectrum average_dark_outside(const Curve& curve, const SpectralGrid& grid) {
    if (curve.wavelength_um.size() < 2) return grid.average(curve);
    Spectrum out;
    for (int b = 0; b < grid.size(); ++b) {
        const double from = std::max(grid.from_um(b), curve.wavelength_um.front());
        const double to = std::min(grid.to_um(b), curve.wavelength_um.back());
        if (from < to) out[b] = static_cast<float>(curve.mean(from, to) * ((to - from) / grid.width_um(b)));
    }
    return out;
}

Spectrum intensity_w_sr_um(const LampConfig& lamp, const SpectralGrid& grid) {
    if (lamp.has_spectral_intensity) return average_dark_outside(lamp.spectral_intensity_w_sr_um, grid);
    Curve scaled = lamp.spectrum;
    const double from = scaled.wavelength_um.front(), to = scaled.wavelength_um.back();
    const double area_um = scaled.mean(from, to) * (to - from);
    if (!(area_um > 0)) fail(lamp, "'spectrum' is dark everywhere");
    for (double& value : scaled.value) value *= lamp.intensity_w_sr / area_um;
    return average_dark_outside(scaled, grid);
}

LampBeam beam_of(const LampConfig& lamp) {
    if (lamp.has_beam_angle) return LampBeam::of_angle(lamp.beam_angle_rad);
    if (!lamp.has_beam) return {};
    Table by_angle_rad = lamp.beam;
    for (double& angle : by_angle_rad.x) angle *= kDegree_rad;
    return LampBeam::of_table(std::move(by_angle_rad));
}

}  // namespace

std::vector<LampMount> lamp_mounts(const ScenarioConfig& s) {
    if (s.lamps.size() > kMaxLamps)
        throw refused("lamps", std::to_string(s.lamps.size()), "at most " + std::to_string(kMaxLamps));
    std::vector<LampMount> mounts;
    for (std::size_t i = 0; i < s.lamps.size(); ++i) {
        const LampConfig& lamp = s.lamps[i];
        mounts.push_back({thing_of(i, s), lamp.position_m, normalized(lamp.axis), lamp.lit ? lamp.level : 0});
    }
    return mounts;
}

std::vector<SceneLamp> scene_lamps(const ScenarioConfig& s, const SpectralGrid& grid) {
    std::vector<SceneLamp> lamps;
    for (std::size_t i = 0; i < s.lamps.size(); ++i) {
        const LampConfig& lamp = s.lamps[i];
        lamps.push_back({lamp.name, thing_of(i, s), intensity_w_sr_um(lamp, grid), beam_of(lamp)});
    }
    return lamps;
}

}  // namespace hilcam
