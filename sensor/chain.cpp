#include "sensor/chain.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "sensor/convolve.h"
#include "sensor/mtf.h"
#include "sensor/noise.h"
#include "sensor/optics.h"
#include "sensor/psf.h"

namespace hilcam {
namespace {

using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

const tbb::blocked_range<int> rows_of(int height) { return {0, height, 16}; }

}  // namespace

struct SensorChain::Implementation {
    CameraModel camera;
    ImageGeometry geometry;
    int bins;
    Spectrum per_radiance;    // e- s^-1 per W m^-2 sr^-1 um^-1
    Spectrum per_irradiance;  // e- s^-1 per W m^-2 um^-1
    OpticsMtf optics;
    PointSpread point_spread;
    Convolver convolver;
    std::vector<float> falloff;  // cos^n over the padded image

    Implementation(const CameraModel& c, const SpectralGrid& grid, int guard_px, int samples_per_axis)
        : camera(c),
          geometry(geometry_of(c, guard_px)),
          bins(grid.size()),
          per_radiance(electrons_per_s_per_radiance(c, grid)),
          per_irradiance(electrons_per_s_per_irradiance(c, grid)),
          optics(c, grid),
          point_spread(c, optics),
          convolver(geometry.padded_width(), geometry.padded_height(), [&](double u, double v) {
              const double pixel =
                  pixel_aperture_mtf(u, c.fill_factor) * pixel_aperture_mtf(v, c.fill_factor);
              const double rays = ray_grid_mtf(u, samples_per_axis) * ray_grid_mtf(v, samples_per_axis);
              return optics.at(std::hypot(u, v)) * pixel / rays;
          }) {
        falloff.reserve(static_cast<std::size_t>(geometry.padded_width()) *
                        static_cast<std::size_t>(geometry.padded_height()));
        for (int y = 0; y < geometry.padded_height(); ++y)
            for (int x = 0; x < geometry.padded_width(); ++x)
                falloff.push_back(static_cast<float>(
                    cos_falloff(geometry, x - guard_px + 0.5, y - guard_px + 0.5, c.cos_power)));
    }

    void collapse_row(const RadianceImage& radiance, const Spectrum& factor, int y) {
        const int width = geometry.padded_width();
        constexpr int kBlock_px = RadianceImage::kBlock_px;
        for (int x = 0; x < width; x += kBlock_px) {
            const int end = std::min(x + kBlock_px, width);
            if (radiance.dark(x, y))
                std::fill(convolver.row(y).begin() + x, convolver.row(y).begin() + end, 0.0f);
            else
                collapse(radiance, factor, y, static_cast<std::size_t>(x), static_cast<std::size_t>(end));
        }
    }
    void collapse(const RadianceImage& radiance, const Spectrum& factor, int y, std::size_t begin,
                  std::size_t end) {
        float* out = convolver.row(y).data();
        const float* first = radiance.row(y, 0).data();
        for (std::size_t x = begin; x < end; ++x) out[x] = factor[0] * first[x];
        for (int b = 1; b < bins; ++b) {
            const float* in = radiance.row(y, b).data();
            const float f = factor[b];
            for (std::size_t x = begin; x < end; ++x) out[x] += f * in[x];
        }
        const float* cosine =
            falloff.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(geometry.padded_width());
        for (std::size_t x = begin; x < end; ++x) out[x] *= cosine[x];
    }
    // Ringing of a band-limited edge can dip below zero and float overflow could leave infinities; charge is
    // neither.
    void crop_row(int y, float dark_e, float most_e, ElectronImage& mean_e) const {
        const float* in = convolver.row(y + geometry.guard_px).data() + geometry.guard_px;
        float* out = mean_e.row(y).data();
        for (int x = 0; x < geometry.width_px; ++x) {
            const float value = in[x] > 0 ? in[x] : 0.0f;
            out[x] = (value < most_e ? value : most_e) + dark_e;
        }
    }
};

SensorChain::SensorChain(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
                         const DetectorPictures&)
    : implementation_(
          std::make_unique<Implementation>(camera, grid, sampling.guard_px, sampling.samples_per_axis)) {}
SensorChain::~SensorChain() = default;

void SensorChain::expose(const RadianceImage& radiance, std::span<const PointSource> points,
                         const Exposure& exposure, ElectronImage& mean_e) {
    Implementation& my = *implementation_;
    const double exposure_s = exposure.exposure_s;
    HILCAM_CHECK(radiance.width() == my.geometry.padded_width() &&
                 radiance.height() == my.geometry.padded_height() && radiance.planes() == my.bins &&
                 mean_e.width() == my.geometry.width_px && mean_e.height() == my.geometry.height_px);
    auto start = Clock::now();
    Spectrum factor = my.per_radiance;
    for (float& value : factor.bin) value *= static_cast<float>(exposure_s);
    tbb::parallel_for(rows_of(radiance.height()), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) my.collapse_row(radiance, factor, y);
    });
    times_.collapse_ms = ms_since(start);

    start = Clock::now();
    my.convolver.run();
    times_.convolve_ms = ms_since(start);

    start = Clock::now();
    constexpr float kMost_e = 1e9f;
    const auto dark_e = static_cast<float>(std::min(my.camera.dark_current_e_s * exposure_s, 1e9));
    tbb::parallel_for(rows_of(mean_e.height()), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) my.crop_row(y, dark_e, kMost_e, mean_e);
    });
    for (const PointSource& point : points) {
        const double x = static_cast<double>(point.position_px.x);
        const double y = static_cast<double>(point.position_px.y);
        double electrons = 0;
        for (int b = 0; b < my.bins; ++b)
            electrons +=
                static_cast<double>(my.per_irradiance[b]) * static_cast<double>(point.irradiance_w_m2_um[b]);
        electrons *= exposure_s * cos_falloff(my.geometry, x, y, my.camera.cos_power - 3);
        my.point_spread.add(x, y, std::min(electrons, 1e9), mean_e);
    }
    times_.points_ms = ms_since(start);
}

void SensorChain::digitise(const ElectronImage& mean_e, const Exposure& exposure, RandomKey key,
                           DnImage& frame) {
    Implementation& my = *implementation_;
    const auto start = Clock::now();
    DigitiserParameters p;
    p.full_well_e = static_cast<float>(my.camera.full_well_e);
    p.read_noise_e = static_cast<float>(my.camera.read_noise_e);
    p.gain_dn_e = static_cast<float>(my.camera.system_gain_dn_e(exposure.gain_db));
    p.offset_dn = static_cast<float>(my.camera.offset_dn);
    p.most_dn = static_cast<float>((1 << my.camera.bits) - 1);
    tbb::parallel_for(rows_of(frame.height()), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y)
            digitise_row(mean_e.row(y), p, key, static_cast<std::uint32_t>(y * frame.width()), frame.row(y));
    });
    times_.digitise_ms = ms_since(start);
}

double SensorChain::mtf(double u, double v) const {
    const double fill = implementation_->camera.fill_factor;
    return implementation_->optics.at(std::hypot(u, v)) * pixel_aperture_mtf(u, fill) *
           pixel_aperture_mtf(v, fill);
}

double SensorChain::fft_pair_ms() {
    const auto start = Clock::now();
    implementation_->convolver.run();
    return ms_since(start);
}

}  // namespace hilcam
