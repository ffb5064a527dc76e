#include "sensor/focal_plane.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/clones.h"
#include "sensor/convolution/bright_pixels.h"
#include "sensor/convolution/subpixel_light_adder.h"
#include "sensor/mtf.h"
#include "sensor/point_light.h"
#include "sensor/stray/far_wings.h"
#include "sensor/stray/outside_light.h"

namespace hilcam {
namespace {

tbb::blocked_range<int> image_rows(int height) { return {0, height, 16}; }

constexpr float kMaxCharge_e = 1e9f;   // largest mean charge of a pixel
constexpr float kMaxBefore_e = 1e12f;  // largest charge of a radiance pixel

// Factors on planes of the image, beginning at one of them.
struct Weights {
    Spectrum factor;
    int first, count;
};
HILCAM_CLONES void weigh(const RadianceImage& radiance, const Weights& weights, int y, std::size_t begin,
                         std::size_t end, const float* illumination, float* out) {
    const float* first = radiance.row(y, weights.first).data();
    for (std::size_t x = begin; x < end; ++x) out[x] = weights.factor[0] * first[x];
    for (int b = 1; b < weights.count; ++b) {
        const float* in = radiance.row(y, weights.first + b).data();
        const float f = weights.factor[b];
        for (std::size_t x = begin; x < end; ++x) out[x] += f * in[x];
    }
    for (std::size_t x = begin; x < end; ++x) {
        const float value = out[x] * illumination[x];
        out[x] = value < kMaxBefore_e ? value : kMaxBefore_e;
    }
}

HILCAM_CLONES float greatest(const float* in, std::size_t count) {
    float most = 0;
    for (std::size_t x = 0; x < count; ++x) most = in[x] > most ? in[x] : most;
    return most;
}

HILCAM_CLONES void cut_off(const float* in, std::size_t count, float* out) {
    for (std::size_t x = 0; x < count; ++x) {
        const float value = in[x] > 0 ? in[x] : 0.0f;
        out[x] = value < kMaxCharge_e ? value : kMaxCharge_e;
    }
}

}  // namespace

struct FocalPlane::Implementation {
    DetectorView view;
    int bins;
    std::vector<LightChannel> channels;
    std::vector<FarWings> wings;        // far wings of bright light, by channel
    std::vector<OutsideLight> outside;  // by channel; empty: the camera has none
    PointLight points;
    std::vector<float> illumination;               // over the radiance image
    std::vector<std::vector<float>> zone_weights;  // over the FFT's image, by zone; empty with one zone
    std::vector<double> cell_sums;                 // sums of a ghost's cells
    std::vector<float> row_peaks;                  // brightest pixel of each row of a channel
    SubpixelLightAdder subpixel_adder{illumination, zone_weights};
    BrightPixels bright{{view.image.padded_width(), view.image.padded_height(), view.sampling.guard_px,
                         view.sampling.oversampling},
                        view.camera.full_well_e,
                        static_cast<int>(channels.size()),
                        illumination};
    bool dark = false;  // the radiance image contains no light

    static std::vector<LightChannel> make_channels(const DetectorView& view, const SpectralGrid& grid) {
        std::vector<LightChannel> out;
        const ColorFilterArrayConfig& array = view.camera.color_filter;
        if (array.pattern.empty())
            out.emplace_back(view, grid, nullptr);
        else
            for (const ColorFilterConfig& filter : array.filters)
                out.emplace_back(view, grid, &filter.transmission);
        return out;
    }

    static std::vector<FarWings> make_wings(const DetectorView& view,
                                            const std::vector<LightChannel>& channels) {
        std::vector<FarWings> out;
        out.reserve(channels.size());
        for (const LightChannel& channel : channels)
            out.emplace_back(channel.mtfs.front().wing_slope_px(), view.camera.stray_light, view.detector);
        return out;
    }

    static std::vector<OutsideLight> make_outside(const DetectorView& view, const SpectralGrid& grid,
                                                  const std::vector<LightChannel>& channels,
                                                  const std::vector<FarWings>& wings) {
        std::vector<OutsideLight> out;
        if (!view.camera.outside_light) return out;
        for (std::size_t c = 0; c < channels.size(); ++c)
            out.emplace_back(*view.camera.outside_light, outside_lens(view.camera), view.detector,
                             channels[c].per_irradiance, grid.size(), wings[c]);
        return out;
    }

    Implementation(const CameraModel& c, const SpectralGrid& grid, const SensorSampling& s)
        : view(c, s),
          bins(grid.size()),
          channels(make_channels(view, grid)),
          wings(make_wings(view, channels)),
          outside(make_outside(view, grid, channels, wings)),
          points(view, channels, wings, bins) {
        const ImageGeometry& image = view.image;
        for (int y = 0; y < image.padded_height(); ++y)
            for (int x = 0; x < image.padded_width(); ++x)
                illumination.push_back(
                    static_cast<float>(view.light_at(view.detector_px(x), view.detector_px(y))));
        const std::size_t zones = channels.front().mtfs.size();
        zone_weights.resize(zones > 1 ? zones : 0);
        for (std::size_t z = 0; z < zone_weights.size(); ++z)
            for (int y = 0; y < channels.front().convolver->height(); ++y)
                for (int x = 0; x < channels.front().convolver->width(); ++x)
                    zone_weights[z].push_back(static_cast<float>(
                        zone_weight(c.field_zones, z,
                                    view.lens.field_fraction(view.detector_px(x), view.detector_px(y)))));
        row_peaks.resize(static_cast<std::size_t>(image.padded_height()));
    }

    RayGrid rays_of(const Exposure& exposure) const {
        return exposure.ray_grid.value_or(view.sampling.samples_per_axis);
    }
    // Returns null when the frame has no record of where light falls within its pixels.
    const SubpixelLight* moments_of(const RadianceImage& radiance, const Exposure& exposure) const {
        const SubpixelLight* const moments = radiance.moments();
        return is_halved(rays_of(exposure)) && moments && moments->used() ? moments : nullptr;
    }

    // --- radiance to electrons

    void collapse(LightChannel& channel, const RadianceImage& radiance, const Exposure& exposure) {
        const double exposure_s = exposure.exposure_s;
        const bool weighed = !radiance.responses().empty();
        const int first = weighed ? static_cast<int>(&channel - channels.data()) : 0,
                  planes = weighed ? 1 : bins;
        Spectrum factor = weighed ? Spectrum{{1}} : channel.per_radiance;
        for (float& value : factor.bin) value *= static_cast<float>(exposure_s);
        tbb::parallel_for(image_rows(radiance.height()), [&](const tbb::blocked_range<int>& range) {
            for (int y = range.begin(); y < range.end(); ++y)
                collapse_row(channel, radiance, {factor, first, planes}, y);
        });
        if (channel.ghost) collect_ghost(channel);
        take_out_bright(channel, radiance, exposure);
        close_border(channel);
        if (zone_weights.empty()) return;
        tbb::parallel_for(image_rows(channel.convolver->height()), [&](const tbb::blocked_range<int>& range) {
            for (int y = range.begin(); y < range.end(); ++y) split_by_zone(channel, y);
        });
    }
    void collapse_row(LightChannel& channel, const RadianceImage& radiance, const Weights& weights, int y) {
        const int width = view.image.padded_width();
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        float* out = channel.convolver->row(y).data();
        float most = 0;
        for (int x = 0; x < width; x += RadianceImage::kBlock_px) {
            const int end = std::min(x + RadianceImage::kBlock_px, width);
            if (radiance.dark(x, y)) {
                std::fill(out + x, out + end, 0.0f);
                continue;
            }
            weigh(radiance, weights, y, static_cast<std::size_t>(x), static_cast<std::size_t>(end),
                  illumination.data() + row, out);
            most = std::max(most, greatest(out + x, static_cast<std::size_t>(end - x)));
        }
        row_peaks[static_cast<std::size_t>(y)] = most;
    }
    void take_out_bright(LightChannel& channel, const RadianceImage& radiance, const Exposure& exposure) {
        const auto number = static_cast<std::size_t>(&channel - channels.data());
        const std::size_t before = bright.all().size();
        channel.max_e = bright.take_out({*channel.convolver, row_peaks, static_cast<int>(number),
                                         moments_of(radiance, exposure), exposure.exposure_s});
        for (const BrightPixel& pixel : bright.all().subspan(before))
            wings[number].collect(pixel.position_px.x, pixel.position_px.y, pixel.electrons);
    }
    // Fills the columns and rows that the FFT's size adds beyond the picture with a ramp from its last pixels
    // to its first, which follow cyclically. A step there would ring into the picture.
    void close_border(LightChannel& channel) const {
        Convolver& light = *channel.convolver;
        const auto width = static_cast<std::size_t>(view.image.padded_width());
        const int height = view.image.padded_height();
        for (int y = 0; y < height; ++y) {
            const std::span<float> row = light.row(y);
            for (std::size_t x = width; x < row.size(); ++x) {
                const float u =
                    static_cast<float>(x - width + 1) / static_cast<float>(row.size() - width + 1);
                row[x] = (1 - u) * row[width - 1] + u * row[0];
            }
        }
        for (int y = height; y < light.height(); ++y) {
            const float u =
                static_cast<float>(y - height + 1) / static_cast<float>(light.height() - height + 1);
            const std::span<const float> last = light.row(height - 1), first = light.row(0);
            const std::span<float> row = light.row(y);
            for (std::size_t x = 0; x < row.size(); ++x) row[x] = (1 - u) * last[x] + u * first[x];
        }
    }
    // Computes the first layer last, because it holds the input of the others.
    void split_by_zone(LightChannel& channel, int y) {
        const auto width = static_cast<std::size_t>(channel.convolver->width());
        const float* all = channel.convolver->row(y).data();
        for (std::size_t z = zone_weights.size(); z-- > 0;) {
            const float* weight = zone_weights[z].data() + static_cast<std::size_t>(y) * width;
            float* part = channel.convolver->row(y, static_cast<int>(z)).data();
            for (std::size_t x = 0; x < width; ++x) part[x] = all[x] * weight[x];
        }
    }

    // Collects light before convolution, combined in cells of the ghost.
    void collect_ghost(LightChannel& channel) {
        const int side = Ghost::kCell_px * view.sampling.oversampling;
        const int across = (view.image.padded_width() + side - 1) / side;
        const int down = (view.image.padded_height() + side - 1) / side;
        cell_sums.resize(static_cast<std::size_t>(across * down));
        tbb::parallel_for(tbb::blocked_range<int>(0, down, 4), [&](const tbb::blocked_range<int>& range) {
            for (int j = range.begin(); j < range.end(); ++j)
                sum_cells(*channel.convolver, j * side, side,
                          std::span(cell_sums).subspan(static_cast<std::size_t>(j * across),
                                                       static_cast<std::size_t>(across)));
        });
        const double part = 1.0 / (view.sampling.oversampling * view.sampling.oversampling);
        for (int j = 0; j < down; ++j)
            for (int i = 0; i < across; ++i) {
                const double sum = cell_sums[static_cast<std::size_t>(j * across + i)];
                if (sum > 0)
                    channel.ghost->collect((i + 0.5) * Ghost::kCell_px - view.sampling.guard_px,
                                           (j + 0.5) * Ghost::kCell_px - view.sampling.guard_px, part * sum);
            }
    }
    static void sum_cells(const Convolver& light, int top, int side, std::span<double> sums) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (int y = top; y < std::min(top + side, light.height()); ++y) {
            const std::span<const float> row = light.row(y);
            for (std::size_t i = 0; i < sums.size(); ++i) {
                const auto first = row.begin() + static_cast<std::ptrdiff_t>(i) * side;
                const auto last = first + std::min<std::ptrdiff_t>(side, row.end() - first);
                sums[i] += static_cast<double>(std::accumulate(first, last, 0.0f));
            }
        }
    }
    // Collects the light that points add far from themselves.
    void collect_ghosts(std::span<const PointSource> sources, double exposure_s) {
        const double m = view.sampling.oversampling;
        for (LightChannel& channel : channels) {
            for (const PointSource& point : sources) {
                const double x = static_cast<double>(point.position_px.x) / m;
                const double y = static_cast<double>(point.position_px.y) / m;
                channel.ghost->collect(x, y,
                                       view.camera.fill_factor * view.light_of_point(x, y) *
                                           channel.electrons_of(point.irradiance_w_m2_um, bins, exposure_s));
            }
            channel.ghost->spread();
        }
    }

    // --- sampling at the pixels

    int image_index(int px) const {
        const int m = view.sampling.oversampling;
        return (px + view.sampling.guard_px) * m + m / 2;
    }
    void sample_row(int y, float* out) const {
        const int width = view.detector.width_px;
        if (dark) {
            std::fill_n(out, width, 0.0f);
        } else if (view.mosaic.one_color() && view.sampling.oversampling == 1) {
            const float* in = channels.front().convolver->row(image_index(y)).data() + view.sampling.guard_px;
            cut_off(in, static_cast<std::size_t>(width), out);
        } else {
            mix_row(y, out);
            cut_off(out, static_cast<std::size_t>(width), out);
        }
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const auto add = [&](const auto& stray) {
                for (int x = 0; x < width; ++x)
                    if (view.mosaic.channel(x, y) == static_cast<int>(c)) out[x] += stray.at(x, y);
            };
            if (channels[c].ghost) add(*channels[c].ghost);
            if (!wings[c].empty()) add(wings[c]);
        }
    }
    // Adds light from outside the picture; each pixel receives that of its own channel.
    void veil_row(int y, std::span<float> row) const {
        if (view.mosaic.one_color()) return outside.front().add_to_row(y, 0, 1, row);
        const auto period = static_cast<std::size_t>(view.mosaic.period(y));
        for (std::size_t phase = 0; phase < std::min(period, row.size()); ++phase)
            outside[static_cast<std::size_t>(view.mosaic.channel(static_cast<int>(phase), y))].add_to_row(
                y, phase, period, row);
    }
    // Takes each pixel from its own channel. Under a colour filter array, crosstalk charge comes from
    // neighbours of other colours. Beyond the window's edge, a pixel is its own neighbour.
    void mix_row(int y, float* out) const {
        const int m = view.sampling.oversampling, width = view.detector.width_px;
        const auto c = view.mosaic.one_color() ? 0.0f : static_cast<float>(view.camera.crosstalk_fraction);
        const int period = view.mosaic.period(y);
        const auto light = [&](int x, int row) {
            const LightChannel& channel = channels[static_cast<std::size_t>(view.mosaic.channel(x, row))];
            return channel.convolver->row(image_index(row)).data() + image_index(0);
        };
        const int above = std::max(y - 1, 0), below = std::min(y + 1, view.detector.height_px - 1);
        for (int phase = 0; phase < std::min(period, width); ++phase) {
            const float* here = light(phase, y);
            if (c == 0) {
                for (int x = phase; x < width; x += period) out[x] = here[x * m];
                continue;
            }
            const float *left = light(phase - 1, y), *right = light(phase + 1, y);
            const float *up = light(phase, above), *down = light(phase, below);
            for (int x = phase; x < width; x += period) {
                const float beside = (x > 0 ? left[(x - 1) * m] : here[x * m]) +
                                     (x + 1 < width ? right[(x + 1) * m] : here[x * m]);
                out[x] = (1 - 4 * c) * here[x * m] + c * (beside + up[x * m] + down[x * m]);
            }
        }
    }
};

FocalPlane::FocalPlane(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling)
    : implementation_(std::make_unique<Implementation>(camera, grid, sampling)) {}
FocalPlane::~FocalPlane() = default;

void FocalPlane::collapse(const RadianceImage& radiance, const Exposure& exposure) {
    Implementation& my = *implementation_;
    HILCAM_CHECK(radiance.width() == my.view.image.padded_width() &&
                 radiance.height() == my.view.image.padded_height() &&
                 static_cast<std::size_t>(radiance.planes()) ==
                     (radiance.responses().empty() ? static_cast<std::size_t>(my.bins) : my.channels.size()));
    my.points.begin(exposure);
    my.bright.clear();
    for (FarWings& wings : my.wings) wings.clear();
    my.dark = true;
    constexpr int kBlock_px = RadianceImage::kBlock_px;
    for (int y = 0; y < radiance.height() && my.dark; y += kBlock_px)
        for (int x = 0; x < radiance.width(); x += kBlock_px) my.dark = my.dark && radiance.dark(x, y);
    for (LightChannel& channel : my.channels) {
        if (channel.ghost) channel.ghost->clear();
        if (!my.dark) my.collapse(channel, radiance, exposure);
    }
}

void FocalPlane::convolve(const RadianceImage& radiance, const Exposure& exposure) {
    Implementation& my = *implementation_;
    if (my.dark) return;
    FrameBlur blur;
    const double m = my.view.sampling.oversampling, scale = exposure.exposure_s * m;
    blur.smear_px = {exposure.image_rate_px_s.x * scale, exposure.image_rate_px_s.y * scale};
    blur.sigma_px = {my.points.jitter_px() * m, my.points.jitter_px() * m};
    const bool still = blur.none();
    // The transfer functions are for pictures with the usual grid.
    const RayGrid usual = my.view.sampling.samples_per_axis, rays = my.rays_of(exposure);
    if (rays != usual)
        blur.axis = [usual, rays](double f) { return ray_grid_mtf(f, usual) / ray_grid_mtf(f, rays); };
    for (std::size_t c = 0; c < my.channels.size(); ++c) {
        LightChannel& channel = my.channels[c];
        CompactKernel* kernel = still ? channel.kernel_of(rays) : nullptr;
        if (kernel)
            kernel->run(*channel.convolver);
        else
            channel.convolver->run(blur);
        if (my.moments_of(radiance, exposure))
            my.subpixel_adder.add(radiance,
                                  {static_cast<int>(c), channel.moments, channel.per_radiance, channel.max_e},
                                  blur, exposure.exposure_s, *channel.convolver);
    }
}

void FocalPlane::gather(std::span<const PointSource> sources, std::span<const SideLight> beside,
                        const Exposure& exposure, ElectronImage& light_e) {
    Implementation& my = *implementation_;
    const auto [width, height] = array_size(my.view.camera);
    HILCAM_CHECK(light_e.width() == width && light_e.height() == height);
    if (my.channels.front().ghost) my.collect_ghosts(sources, exposure.exposure_s);
    for (FarWings& wings : my.wings)
        if (!wings.empty()) wings.spread();
    const auto left = static_cast<std::size_t>(my.view.camera.black_columns);
    const int top = static_cast<int>(my.view.camera.black_rows);
    bool veiled = false;
    for (OutsideLight& outside : my.outside) veiled = outside.collect(beside, exposure.exposure_s);
    tbb::parallel_for(image_rows(height), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            std::fill(light_e.row(y).begin(), light_e.row(y).end(), 0.0f);
            if (y >= top) my.sample_row(y - top, light_e.row(y).data() + left);
            if (y >= top && veiled) my.veil_row(y - top, light_e.row(y).subspan(left));
        }
    });
    for (const BrightPixel& pixel : my.bright.all()) my.points.add(pixel, light_e);
    my.points.add(sources, light_e);
    my.points.finish(light_e);
}

double FocalPlane::mtf(double u, double v) const {
    const DetectorView& view = implementation_->view;
    const double light = std::abs(implementation_->channels.front().mtfs.front().at(u, v));
    // With a colour filter array, crosstalk acts after sampling; for a grey picture the effect is the same as
    // without.
    return view.mosaic.one_color() ? light : light * crosstalk_mtf(u, v, view.camera.crosstalk_fraction);
}

int FocalPlane::kernel_radius() const {
    const CompactKernel* kernel =
        implementation_->channels.front().kernel_of(implementation_->view.sampling.samples_per_axis);
    return kernel ? kernel->radius() : 0;
}

void FocalPlane::run_fft_pair() { implementation_->channels.front().convolver->run(); }

}  // namespace hilcam
