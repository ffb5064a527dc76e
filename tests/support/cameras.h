#pragma once
// Cameras for tests of the sensor.

#include "render/sky/stars.h"
#include "sensor/chain.h"
#include "sensor/optics.h"

namespace hilcam {

// 64 x 64 pixels of 5.5 um behind 50 mm at f/4, 12 bits, one DN per electron, no noise.
inline CameraModel camera_64() {
    CameraModel c;
    c.width_px = c.height_px = 64;
    c.focal_length_m = 0.05;
    c.f_number = 4;
    c.bits = 12;
    c.gain_dn_e = 1, c.has_gain_dn_e = true;
    c.full_well_e = 1e6;
    return c;
}

// The same with a lens that blurs nothing and a detector that blurs as a Gaussian: every profile is a closed
// form.
inline CameraModel gaussian_camera(double sigma_px) {
    CameraModel c = camera_64();
    c.measured_mtf.mtf = {{0, 1e5}, {1, 1}};
    c.diffusion_m = sigma_px * c.pitch_m;
    return c;
}

// A camera, its chain and its images, for one bin.
struct Bench {
    CameraModel camera;
    SpectralGrid grid{{0.5, 0.6}};
    SensorSampling sampling;
    SensorChain chain;
    RadianceImage radiance;
    ElectronImage electrons;
    DnImage frame;

    explicit Bench(const CameraModel& c, const SensorSampling& s = {8, 1, 1}, const DetectorPictures& p = {})
        : camera(c),
          sampling(s),
          chain(c, grid, s, p),
          electrons(array_size(c)[0], array_size(c)[1]),
          frame(frame_size(c)[0], frame_size(c)[1]) {
        const ImageGeometry g = geometry_of(c, s.guard_px, s.oversampling);
        radiance = RadianceImage(g.padded_width(), g.padded_height(), 1);
    }
    void fill(float value) {
        for (float& v : radiance.all()) v = value;
    }
    // Light only.
    ElectronImage& expose(const Exposure& exposure, std::span<const PointSource> points = {}) {
        chain.expose(radiance, points, exposure, electrons);
        return electrons;
    }
    // A flat of so many electrons in the mean of each pixel, without optics.
    DnImage& digitise_flat(float mean_e, std::uint64_t frame_id = 1, const Exposure& exposure = {}) {
        for (float& v : electrons.all()) v = mean_e;
        chain.digitise(electrons, exposure, {7, frame_id}, frame);
        return frame;
    }
};

// Electrons per second and unit of radiance, on the axis.
inline double per_radiance(const CameraModel& c, const SpectralGrid& grid) {
    return static_cast<double>(electrons_per_s_per_radiance(c, grid)[0]);
}

inline double at(const ElectronImage& image, int x, int y) {
    return static_cast<double>(image.row(y)[static_cast<std::size_t>(x)]);
}
inline double sum(const ElectronImage& image) {
    double total = 0;
    for (const float v : image.all()) total += static_cast<double>(v);
    return total;
}

inline PointSource point_at(double x, double y, double irradiance) {
    PointSource p;
    p.position_px = {static_cast<float>(x), static_cast<float>(y)};
    p.irradiance_w_m2_um[0] = static_cast<float>(irradiance);
    return p;
}

}  // namespace hilcam
