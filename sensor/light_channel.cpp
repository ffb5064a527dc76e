#include "sensor/light_channel.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/mtf.h"
#include "sensor/stray/point_halos.h"

namespace hilcam {
namespace {

std::vector<LensState> lens_states(const CameraModel& c) {
    if (c.field_zones.empty()) return {{c.defocus_m, c.wavefront_rms_m}};
    std::vector<LensState> out;
    for (const FieldZone& zone : c.field_zones)
        out.push_back({c.defocus_m + zone.defocus_m, zone.wavefront_rms_m});
    return out;
}

// The share of a separately drawn halo that a point's table contains: its own, and that folded in from the
// fields around. The latter is smooth, so it is computed 2 px apart. Fields outside 25 x 25 count as a
// uniform plane beyond the radius of a circle with that square's area.
class HaloInTable {
  public:
    explicit HaloInTable(const PointHalos& halos) : halos_(halos) {
        constexpr int kCopies = 12;
        constexpr double kAcross_px = PointSpread::kField_px;
        const double beyond =
            halos.share_beyond((2 * kCopies + 1) * kAcross_px / std::sqrt(kPi)) / (kAcross_px * kAcross_px);
        for (int y = 0; y < kNodes; ++y)
            for (int x = 0; x < kNodes; ++x) {
                double sum = beyond;
                for (int j = -kCopies; j <= kCopies; ++j)
                    for (int i = -kCopies; i <= kCopies; ++i)
                        if (i != 0 || j != 0)
                            sum += halos.share(
                                std::hypot(x * kStep_px - i * kAcross_px, y * kStep_px - j * kAcross_px));
                folded_.push_back(sum);
            }
    }
    double at(double x_px, double y_px) const {
        const double x = std::abs(x_px) / kStep_px, y = std::abs(y_px) / kStep_px;
        const int i = std::min(static_cast<int>(x), kNodes - 2),
                  j = std::min(static_cast<int>(y), kNodes - 2);
        const double u = x - i, v = y - j;
        const double* top = folded_.data() + j * kNodes + i;
        const double* bottom = top + kNodes;
        return halos_.share(std::hypot(x_px, y_px)) + (1 - v) * ((1 - u) * top[0] + u * top[1]) +
               v * ((1 - u) * bottom[0] + u * bottom[1]);
    }

  private:
    static constexpr int kStep_px = 2, kNodes = PointSpread::kField_px / (2 * kStep_px) + 1;
    const PointHalos& halos_;
    std::vector<double> folded_;
};

double smooth_step(double t) { return t * t * (3 - 2 * t); }

// Returns MTF_sys for light within pixels, up to 1 cycle per pixel. Rays have already averaged over halves.
Transfer transfer_of_halves(const SystemMtf& mtf, RayGrid rays) {
    return [&mtf, rays](double u, double v) {
        return mtf.at(u, v) / (half_rays_mtf(u, rays) * half_rays_mtf(v, rays));
    };
}

// Returns MTF_sys at the radiance image's frequencies. Rays have already averaged over its pixels. With an
// even number of these across a detector pixel, the detector pixel's centre is on their corner, half a pixel
// back.
std::complex<double> image_transfer(const SystemMtf& mtf, int oversampling, RayGrid rays, double u,
                                    double v) {
    if (is_halved(rays)) return smooth_transfer(transfer_of_halves(mtf, rays), u, v);
    const int m = oversampling;
    const std::complex<double> shift = m % 2 ? 1.0 : std::polar(1.0, -kPi * (u + v));
    return mtf.at(u * m, v * m) * shift / (ray_grid_mtf(u, rays) * ray_grid_mtf(v, rays));
}

}  // namespace

DetectorView::DetectorView(const CameraModel& c, const SensorSampling& s)
    : camera(c),
      sampling(s),
      detector(geometry_of(c, s.guard_px)),
      image(geometry_of(c, s.guard_px, s.oversampling)),
      lens(c, detector),
      mosaic(c) {}

LightChannel::LightChannel(const DetectorView& view, const SpectralGrid& grid, const Curve* filter)
    : per_radiance(electrons_per_s_per_radiance(view.camera, grid, filter)),
      per_irradiance(electrons_per_s_per_irradiance(view.camera, grid, filter)) {
    for (const LensState& state : lens_states(view.camera))
        mtfs.emplace_back(view.camera, OpticsOtf(view.camera, grid, per_radiance, state),
                          SpiderSpikes(view.camera.spider, spider_pupil(view.camera), grid, per_radiance));
    const SensorSampling& sampling = view.sampling;
    const auto transfer_of = [&](const SystemMtf& mtf, RayGrid rays) -> Transfer {
        return [&mtf, rays, m = sampling.oversampling](double u, double v) {
            return image_transfer(mtf, m, rays, u, v);
        };
    };
    std::vector<Transfer> transfers;
    for (const SystemMtf& mtf : mtfs) {
        spreads.emplace_back([&](double u, double v) { return mtf.of_point(u, v); }, view.camera.fill_factor);
        transfers.push_back(transfer_of(mtf, sampling.samples_per_axis));
    }
    if (view.camera.stray_light.has_halo()) {
        const PointHalos halos(view.camera.stray_light, view.detector);
        const HaloInTable in_table(halos);
        for (const PointSpread& spread : spreads)
            cores.push_back(spread.less([&](double x, double y) { return in_table.at(x, y); }));
    }
    // Light that runs beyond the right and lower edges remains invisible.
    const int width = fft_size(view.image.padded_width()), height = fft_size(view.image.padded_height());
    convolver.emplace(width, height, transfers);
    // The kernel's surroundings count as zero, so they must be in the guard band.
    if (transfers.size() == 1 && view.image.guard_px >= CompactKernel::kMaxRadius && !sampling.always_fft) {
        std::vector<RayGrid> grids = sampling.other_grids;
        grids.push_back(sampling.samples_per_axis);
        for (const RayGrid rays : grids)
            if (auto kernel = CompactKernel::find(transfer_of(mtfs.front(), rays), width, height))
                kernels.push_back({rays, std::move(*kernel)});
    }
    if (is_halved(sampling.samples_per_axis))
        for (const SystemMtf& mtf : mtfs)
            moments.emplace_back(transfer_of_halves(mtf, sampling.samples_per_axis));
    if (view.camera.stray_light.ghost_fraction > 0) ghost.emplace(view.camera.stray_light, view.detector);
}

CompactKernel* LightChannel::kernel_of(RayGrid rays) {
    for (GridKernel& k : kernels)
        if (k.rays == rays) return &k.kernel;
    return nullptr;
}

double LightChannel::electrons_of(const Spectrum& irradiance_w_m2_um, int bins, double exposure_s) const {
    double sum = 0;
    for (int b = 0; b < bins; ++b)
        sum += static_cast<double>(per_irradiance[b]) * static_cast<double>(irradiance_w_m2_um[b]);
    return sum * exposure_s;
}

double zone_weight(const std::vector<FieldZone>& zones, std::size_t i, double field_fraction) {
    if (zones.size() < 2) return 1;
    const auto at = [&](std::size_t k) { return zones[k].field_fraction; };
    if (i > 0 && field_fraction < at(i))
        return smooth_step(std::clamp((field_fraction - at(i - 1)) / (at(i) - at(i - 1)), 0.0, 1.0));
    if (i + 1 < zones.size() && field_fraction > at(i))
        return smooth_step(std::clamp((at(i + 1) - field_fraction) / (at(i + 1) - at(i)), 0.0, 1.0));
    return 1;
}

}  // namespace hilcam
