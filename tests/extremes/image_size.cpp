// How many pixels: the renderer and all of the sensor, from one to 67 million.

#include "tests/extremes/groups.h"
#include "tests/extremes/light_truth.h"
#include "tests/support/stage.h"

namespace hilcam::extremes {
namespace {

constexpr int kGuard_px = 8;
constexpr double kExposure_s = 1e-3, kFullWell_e = 1000, kGain_dn_e = 0.5;

CameraModel camera_of(int width, int height) {
    CameraModel c = camera_64();
    c.width_px = width, c.height_px = height;
    // A field of 14 degrees to each side at most, whatever the size.
    c.focal_length_m = 2 * (std::max(width, height) + 2 * kGuard_px) * c.pitch_m;
    c.cos_power = 0;
    c.full_well_e = kFullWell_e, c.gain_dn_e = kGain_dn_e, c.offset_dn = 16;
    return c;
}

// A plate that fills the field, in sunlight that makes twice a full well of it.
std::vector<Found> measure(int width, int height) {
    const CameraModel c = camera_of(width, height);
    const double radiance = 2 * kFullWell_e / (electrons_per_radiance(c, 0.5, 0.6) * kExposure_s);
    Worst of_radiance, of_charge, of_frame;
    Stage s;
    s.grid = SpectralGrid({0.5, 0.6});
    s.geometry = geometry_of(c, kGuard_px);
    s.radiance = RadianceImage(s.geometry.padded_width(), s.geometry.padded_height(), 1);
    s.quality.path_model = "direct";
    s.scene.sun_irradiance_1au_w_m2_um[0] = static_cast<float>(kPi * radiance);
    s.add(plate(lambert(1), s.grid), {0, 0, 3});
    s.world.bodies.sun_world_m = {0, 0, 3 - kAstronomicalUnit_m};
    s.render();
    for (const float value : s.radiance.all()) of_radiance.add(relative(value, radiance));

    SensorChain chain(c, s.grid, {kGuard_px, 1, 1});
    const Exposure exposure{.exposure_s = kExposure_s};
    ElectronImage electrons(width, height);
    chain.expose(s.radiance, {}, exposure, electrons);
    for (const float q : electrons.all()) of_charge.add(relative(q, 2 * kFullWell_e));
    DnImage frame(width, height);
    chain.digitise(electrons, exposure, {1, 1}, frame);
    const double dn = kFullWell_e * kGain_dn_e + 16;
    for (const std::uint16_t value : frame.all()) of_frame.add(std::abs(value - dn));
    return {{radiance, of_radiance.value()}, {2 * kFullWell_e, of_charge.value()}, {dn, of_frame.value()}};
}

}  // namespace

Group image_sizes() {
    Group group{
        "ImageSizes",
        "Image size: a plate that fills the field, rendered, exposed and read",
        "size [px]",
        {"radiance [W m^-2 sr^-1 um^-1]", "charge [e-]", "frame [DN]"},
        "E / pi; L A (pitch/f)^2 T eta t int lambda / (h c) dlambda; a full well in DN. The error is that of "
        "the worst pixel.",
        "8 roundings to single precision; an FFT pair's grain and 16 roundings; 0.",
        {}};
    struct Size {
        int width, height;
    };
    for (const Size size : {Size{1, 1},
                            {2, 1},
                            {1, 2},
                            {3, 3},
                            {7, 13},
                            {31, 33},
                            {64, 64},
                            {1023, 1025},
                            {8192, 1},
                            {1, 8192},
                            {2048, 2048},
                            {8192, 8192}}) {
        const double pixels = static_cast<double>(size.width + 2 * kGuard_px) * (size.height + 2 * kGuard_px);
        group.cases.push_back({std::to_string(size.width) + " x " + std::to_string(size.height),
                               {8 * kFloatGrain, fft_pair_grain(pixels) + 16 * kFloatGrain, 0},
                               [size] { return measure(size.width, size.height); },
                               pixels > 3e6});
    }
    return group;
}

}  // namespace hilcam::extremes
