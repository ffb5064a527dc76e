#include "sensor/focal_plane.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "render/check.h"
#include "render/clones.h"
#include "render/pose.h"
#include "render/units.h"
#include "sensor/compact_kernel.h"
#include "sensor/mtf.h"
#include "sensor/optics.h"
#include "sensor/psf.h"
#include "sensor/system_mtf.h"

namespace hilcam {
namespace {

const tbb::blocked_range<int> rows_of(int height) { return {0, height, 16}; }

constexpr float kMost_e = 1e9f;         // of a pixel's mean charge
constexpr float kMostBefore_e = 1e12f;  // of a radiance pixel, so that the FFT cannot overflow

HILCAM_CLONES void weigh(const RadianceImage& radiance, const Spectrum& factor, int bins, int y,
                         std::size_t begin, std::size_t end, const float* illumination, float* out) {
    const float* first = radiance.row(y, 0).data();
    for (std::size_t x = begin; x < end; ++x) out[x] = factor[0] * first[x];
    for (int b = 1; b < bins; ++b) {
        const float* in = radiance.row(y, b).data();
        const float f = factor[b];
        for (std::size_t x = begin; x < end; ++x) out[x] += f * in[x];
    }
    for (std::size_t x = begin; x < end; ++x) {
        const float value = out[x] * illumination[x];
        out[x] = value < kMostBefore_e ? value : kMostBefore_e;
    }
}

HILCAM_CLONES void cut_off(const float* in, std::size_t count, float* out) {
    for (std::size_t x = 0; x < count; ++x) {
        const float value = in[x] > 0 ? in[x] : 0.0f;
        out[x] = value < kMost_e ? value : kMost_e;
    }
}

// Which channel each pixel of the array belongs to.
class Mosaic {
  public:
    explicit Mosaic(const CameraModel& c) : left_(window_of(c).left), top_(window_of(c).top) {
        const ColorFilterArrayConfig& array = c.color_filter;
        std::vector<int> row;
        for (const char letter : array.pattern + ' ') {
            if (letter != ' ') {
                for (std::size_t i = 0; i < array.filters.size(); ++i)
                    if (array.filters[i].name[0] == letter) row.push_back(static_cast<int>(i));
            } else if (!row.empty()) {
                rows_.push_back(std::move(row));
                row.clear();
            }
        }
    }
    bool one_color() const { return rows_.empty(); }
    // x, y: of the window.
    int channel(int x, int y) const {
        if (rows_.empty()) return 0;
        // The pattern goes on to the left of and above the window.
        const auto& row = rows_[(static_cast<std::size_t>(y + top_) + 4 * rows_.size()) % rows_.size()];
        return row[(static_cast<std::size_t>(x + left_) + 4 * row.size()) % row.size()];
    }

    // Columns after which a row's pattern comes again.
    int period(int y) const {
        if (rows_.empty()) return 1;
        return static_cast<int>(rows_[static_cast<std::size_t>(y + top_) % rows_.size()].size());
    }

  private:
    int left_, top_;
    std::vector<std::vector<int>> rows_;
};

// The lens at each zone, at least one.
std::vector<LensState> lens_states(const CameraModel& c) {
    if (c.field_zones.empty()) return {{c.defocus_m, c.wavefront_rms_m}};
    std::vector<LensState> out;
    for (const FieldZone& zone : c.field_zones)
        out.push_back({c.defocus_m + zone.defocus_m, zone.wavefront_rms_m});
    return out;
}

// From 0 to 1 without a kink, which would show as a ring in an even picture.
double smooth_step(double t) { return t * t * (3 - 2 * t); }

// Share of each zone in the image at a field height: smooth between zones, constant outside them.
double zone_weight(const std::vector<FieldZone>& zones, std::size_t i, double field_fraction) {
    if (zones.size() < 2) return 1;
    const auto at = [&](std::size_t k) { return zones[k].field_fraction; };
    if (i > 0 && field_fraction < at(i))
        return smooth_step(std::clamp((field_fraction - at(i - 1)) / (at(i) - at(i - 1)), 0.0, 1.0));
    if (i + 1 < zones.size() && field_fraction > at(i))
        return smooth_step(std::clamp((at(i + 1) - field_fraction) / (at(i + 1) - at(i)), 0.0, 1.0));
    return 1;
}

// One filter's image.
struct Channel {
    Spectrum per_radiance;        // e- s^-1 per W m^-2 sr^-1 um^-1
    Spectrum per_irradiance;      // e- s^-1 per W m^-2 um^-1
    std::vector<SystemMtf> mtfs;  // by zone
    std::vector<PointSpread> spreads;
    std::optional<Convolver> convolver;
    std::optional<CompactKernel> kernel;  // does the same, faster
    std::optional<Ghost> ghost;
};

}  // namespace

struct FocalPlane::Implementation {
    CameraModel camera;
    SensorSampling sampling;
    ImageGeometry detector;  // its pixels
    ImageGeometry image;     // the radiance image's
    int bins;
    RelativeIllumination lens;
    Mosaic mosaic;
    std::vector<Channel> channels;
    std::vector<float> illumination;               // over the radiance image
    std::vector<std::vector<float>> zone_weights;  // the same, by zone; empty with one zone
    std::vector<double> cell_sums;                 // of a ghost
    bool dark = false;                             // nothing in the radiance image

    Implementation(const CameraModel& c, const SpectralGrid& grid, const SensorSampling& s)
        : camera(c),
          sampling(s),
          detector(geometry_of(c, s.guard_px)),
          image(geometry_of(c, s.guard_px, s.oversampling)),
          bins(grid.size()),
          lens(c, detector),
          mosaic(c) {
        if (c.color_filter.pattern.empty()) {
            add_channel(grid, nullptr);
        } else {
            for (const ColorFilterConfig& filter : c.color_filter.filters)
                add_channel(grid, &filter.transmission);
        }
        glare_e.resize(channels.size());
        const std::size_t zones = channels.front().mtfs.size();
        zone_weights.resize(zones > 1 ? zones : 0);
        for (int y = 0; y < image.padded_height(); ++y)
            for (int x = 0; x < image.padded_width(); ++x) {
                const double dx = detector_px(x), dy = detector_px(y);
                illumination.push_back(static_cast<float>(lens.at(dx, dy)));
                for (std::size_t z = 0; z < zone_weights.size(); ++z)
                    zone_weights[z].push_back(
                        static_cast<float>(zone_weight(c.field_zones, z, lens.field_fraction(dx, dy))));
            }
    }
    // Middle of a radiance pixel [px of the detector's frame].
    double detector_px(int padded) const {
        return (padded + 0.5) / sampling.oversampling - sampling.guard_px;
    }

    void add_channel(const SpectralGrid& grid, const Curve* filter) {
        Channel& channel = channels.emplace_back();
        channel.per_radiance = electrons_per_s_per_radiance(camera, grid, filter);
        channel.per_irradiance = electrons_per_s_per_irradiance(camera, grid, filter);
        for (const LensState& state : lens_states(camera)) {
            channel.mtfs.emplace_back(camera, OpticsOtf(camera, grid, channel.per_radiance, state));
            const SystemMtf& mtf = channel.mtfs.back();
            channel.spreads.emplace_back([&](double u, double v) { return mtf.of_point(u, v); },
                                         camera.fill_factor);
        }
        std::vector<Transfer> transfers;
        for (const SystemMtf& mtf : channel.mtfs)
            transfers.push_back([&](double u, double v) { return image_transfer(mtf, u, v); });
        channel.convolver.emplace(image.padded_width(), image.padded_height(), transfers);
        // Its border of nothing must lie in the guard band.
        if (transfers.size() == 1 && image.guard_px >= CompactKernel::kMostRadius)
            channel.kernel =
                CompactKernel::find(transfers.front(), image.padded_width(), image.padded_height());
        if (camera.stray_light.ghost_fraction > 0) channel.ghost.emplace(camera.stray_light, detector);
    }
    // MTF_sys at the radiance image's frequencies. Its rays have averaged over its pixels already. With an
    // even number of them to a detector pixel, that pixel's centre lies on their corner: half a pixel back.
    std::complex<double> image_transfer(const SystemMtf& mtf, double u, double v) const {
        const int n = sampling.samples_per_axis, m = sampling.oversampling;
        const std::complex<double> shift = m % 2 ? 1.0 : std::polar(1.0, -kPi * (u + v));
        return mtf.at(u * m, v * m) * shift / (ray_grid_mtf(u, n) * ray_grid_mtf(v, n));
    }

    void collapse_row(Channel& channel, const RadianceImage& radiance, const Spectrum& factor, int y) {
        const int width = image.padded_width();
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        float* out = channel.convolver->row(y).data();
        for (int x = 0; x < width; x += RadianceImage::kBlock_px) {
            const int end = std::min(x + RadianceImage::kBlock_px, width);
            if (radiance.dark(x, y))
                std::fill(out + x, out + end, 0.0f);
            else
                weigh(radiance, factor, bins, y, static_cast<std::size_t>(x), static_cast<std::size_t>(end),
                      illumination.data() + row, out);
        }
        // The first layer last: it holds what the others take their parts of.
        for (std::size_t z = zone_weights.size(); z-- > 0;) {
            const float* weight = zone_weights[z].data() + row;
            float* part = channel.convolver->row(y, static_cast<int>(z)).data();
            for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) part[x] = out[x] * weight[x];
        }
    }

    // Before convolution; the light of a cell of the ghost's size goes together.
    void collect_ghost(Channel& channel) {
        const int side = Ghost::kCell_px * sampling.oversampling;
        const int across = (image.padded_width() + side - 1) / side;
        const int down = (image.padded_height() + side - 1) / side;
        cell_sums.resize(static_cast<std::size_t>(across * down));
        tbb::parallel_for(tbb::blocked_range<int>(0, down, 4), [&](const tbb::blocked_range<int>& range) {
            for (int j = range.begin(); j < range.end(); ++j)
                sum_cells(*channel.convolver, j * side, side,
                          std::span(cell_sums).subspan(static_cast<std::size_t>(j * across),
                                                       static_cast<std::size_t>(across)));
        });
        channel.ghost->clear();
        const double part = 1.0 / (sampling.oversampling * sampling.oversampling);
        for (int j = 0; j < down; ++j)
            for (int i = 0; i < across; ++i) {
                const double sum = cell_sums[static_cast<std::size_t>(j * across + i)];
                if (sum > 0)
                    channel.ghost->collect((i + 0.5) * Ghost::kCell_px - sampling.guard_px,
                                           (j + 0.5) * Ghost::kCell_px - sampling.guard_px, part * sum);
            }
    }
    void sum_cells(const Convolver& light, int top, int side, std::span<double> sums) const {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (int layer = 0; layer < light.layers(); ++layer)
            for (int y = top; y < std::min(top + side, light.height()); ++y) {
                const std::span<const float> row = light.row(y, layer);
                for (std::size_t i = 0; i < sums.size(); ++i) {
                    const auto first = row.begin() + static_cast<std::ptrdiff_t>(i) * side;
                    const auto last = first + std::min<std::ptrdiff_t>(side, row.end() - first);
                    sums[i] += static_cast<double>(std::accumulate(first, last, 0.0f));
                }
            }
    }

    // --- sampling at the pixels
    // ---------------------------------------------------------------------------------------

    int image_index(int px) const {
        const int m = sampling.oversampling;
        return (px + sampling.guard_px) * m + m / 2;
    }
    void sample_row(int y, float* out) const {
        const int width = detector.width_px;
        if (dark) {
            std::fill_n(out, width, 0.0f);
        } else if (mosaic.one_color() && sampling.oversampling == 1) {
            const float* in = channels.front().convolver->row(image_index(y)).data() + sampling.guard_px;
            cut_off(in, static_cast<std::size_t>(width), out);
        } else {
            mix_row(y, out);
            cut_off(out, static_cast<std::size_t>(width), out);
        }
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (!channels[c].ghost) continue;
            for (int x = 0; x < width; ++x)
                if (mosaic.channel(x, y) == static_cast<int>(c)) out[x] += channels[c].ghost->at(x, y);
        }
    }
    // Of each pixel its own channel; under a mosaic, charge that crosses over comes from neighbours of other
    // colours. At the window's edge a pixel is its own neighbour.
    void mix_row(int y, float* out) const {
        const int m = sampling.oversampling, width = detector.width_px;
        const auto c = mosaic.one_color() ? 0.0f : static_cast<float>(camera.crosstalk_fraction);
        const int period = mosaic.period(y);
        const auto light = [&](int x, int row) {
            const Channel& channel = channels[static_cast<std::size_t>(mosaic.channel(x, row))];
            return channel.convolver->row(image_index(row)).data() + image_index(0);
        };
        const int above = std::max(y - 1, 0), below = std::min(y + 1, detector.height_px - 1);
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

    // --- points
    // ------------------------------------------------------------------------------------------------------

    double electrons_of(const Channel& channel, const PointSource& point, double exposure_s) const {
        double sum = 0;
        for (int b = 0; b < bins; ++b)
            sum += static_cast<double>(channel.per_irradiance[b]) *
                   static_cast<double>(point.irradiance_w_m2_um[b]);
        return sum * exposure_s;
    }

    // A point may move through the exposure: it is drawn as many points, a quarter of a pixel apart.
    // drift_px: its own way, over that of the sky.
    template <class Draw>
    void along_trail(Vec2d middle_px, Vec2d drift_px, const Exposure& exposure, const Draw& draw) const {
        const Vec3d turn_rad = -exposure.exposure_s * exposure.camera_rate_rad_s;
        const bool turns = turn_rad.x != 0 || turn_rad.y != 0 || turn_rad.z != 0;
        if (!turns && drift_px.x == 0 && drift_px.y == 0) return draw(middle_px, 1.0);
        const Vec3d dir = detector.direction_camera(middle_px.x, middle_px.y);
        const auto at = [&](double time) {
            Vec2d px = middle_px;
            if (turns) {
                const Vec3d moved = to_matrix(from_rotation_vector(time * turn_rad)) * dir;
                px = moved.z > 0 ? detector.project_px(moved) : Vec2d{-1e9, -1e9};
            }
            return Vec2d{px.x + time * drift_px.x, px.y + time * drift_px.y};
        };
        const Vec2d from = at(-0.5), to = at(0.5);
        const double length_px = std::hypot(to.x - from.x, to.y - from.y);
        const double parts = std::clamp(std::ceil(length_px * 4), 1.0, 4096.0);
        for (double i = 0.5; i < parts; i += 1) draw(at(i / parts - 0.5), 1 / parts);
    }

    void add_point(const PointSource& point, const Exposure& exposure, ElectronImage& light_e) {
        const double m = sampling.oversampling;
        const Vec2d middle_px{static_cast<double>(point.position_px.x) / m,
                              static_cast<double>(point.position_px.y) / m};
        const double way = exposure.exposure_s / m;
        const Vec2d drift_px{way * static_cast<double>(point.drift_px_s.x),
                             way * static_cast<double>(point.drift_px_s.y)};
        if (!std::isfinite(middle_px.x) || !std::isfinite(middle_px.y)) return;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const double all = std::min(electrons_of(channels[c], point, exposure.exposure_s), 1e9);
            if (!(all > 0)) continue;
            along_trail(middle_px, drift_px, exposure, [&](Vec2d at_px, double part) {
                if (std::abs(at_px.x) > 1e6 || std::abs(at_px.y) > 1e6) return;
                const double electrons = all * part * lens.of_point(at_px.x, at_px.y);
                scatter(at_px, [&](Vec2d px, double share) {
                    draw_point(static_cast<int>(c), px, electrons * share, light_e);
                });
            });
        }
    }
    // The exposure's own jitter: points half a standard deviation apart, out to three, by the normal density.
    template <class Draw>
    void scatter(Vec2d at_px, const Draw& draw) const {
        if (jitter_px <= 0) return draw(at_px, 1.0);
        constexpr int kReach = 6;
        std::array<double, 2 * kReach + 1> weights;
        double sum = 0;
        for (int i = -kReach; i <= kReach; ++i)
            sum += weights[static_cast<std::size_t>(i + kReach)] = std::exp(-0.125 * i * i);
        for (int j = -kReach; j <= kReach; ++j)
            for (int i = -kReach; i <= kReach; ++i)
                draw({at_px.x + 0.5 * i * jitter_px, at_px.y + 0.5 * j * jitter_px},
                     weights[static_cast<std::size_t>(i + kReach)] *
                         weights[static_cast<std::size_t>(j + kReach)] / (sum * sum));
    }
    void draw_point(int c, Vec2d at_px, double electrons, ElectronImage& light_e) {
        Channel& channel = channels[static_cast<std::size_t>(c)];
        const StrayLightConfig& stray = camera.stray_light;
        if (stray.glare_radius_px <= 0) {
            glare_e[static_cast<std::size_t>(c)] +=
                electrons * camera.fill_factor * stray.veiling_glare_fraction;
            electrons *= 1 - stray.veiling_glare_fraction;
        }
        const double field = lens.field_fraction(at_px.x, at_px.y);
        for (std::size_t z = 0; z < channel.spreads.size(); ++z) {
            const double weight = zone_weight(camera.field_zones, z, field);
            if (weight > 0)
                add_patch(channel.spreads[z].at(at_px.x, at_px.y, electrons * weight), c, light_e);
        }
    }
    void add_patch(const PointPatch& patch, int c, ElectronImage& light_e) const {
        const auto left = static_cast<int>(camera.black_columns), top = static_cast<int>(camera.black_rows);
        const auto crosstalk = static_cast<float>(mosaic.one_color() ? 0 : camera.crosstalk_fraction);
        const auto add = [&](int x, int y, float electrons) {
            if (x < 0 || y < 0 || x >= detector.width_px || y >= detector.height_px) return;
            light_e.row(y + top)[static_cast<std::size_t>(x + left)] += electrons;
        };
        for (int j = std::max(0, -patch.top - 1);
             j < std::min(patch.size, detector.height_px + 1 - patch.top); ++j) {
            const int y = patch.top + j;
            const float* in = patch.electrons + j * patch.size;
            for (int i = std::max(0, -patch.left - 1);
                 i < std::min(patch.size, detector.width_px + 1 - patch.left); ++i) {
                const int x = patch.left + i;
                if (mosaic.channel(x, y) != c) continue;
                add(x, y, (1 - 4 * crosstalk) * in[i]);
                if (crosstalk == 0) continue;
                add(x - 1, y, crosstalk * in[i]), add(x + 1, y, crosstalk * in[i]);
                add(x, y - 1, crosstalk * in[i]), add(x, y + 1, crosstalk * in[i]);
            }
        }
    }

    // What the points' light adds far from them.
    void collect_ghosts(std::span<const PointSource> points, const Exposure& exposure) {
        for (Channel& channel : channels) {
            for (const PointSource& point : points) {
                const double m = sampling.oversampling;
                const double x = static_cast<double>(point.position_px.x) / m;
                const double y = static_cast<double>(point.position_px.y) / m;
                channel.ghost->collect(x, y,
                                       camera.fill_factor * lens.of_point(x, y) *
                                           electrons_of(channel, point, exposure.exposure_s));
            }
            channel.ghost->spread();
        }
    }
    void add_glare(ElectronImage& light_e) const {
        const double pixels = static_cast<double>(detector.padded_width()) * detector.padded_height();
        for (int y = 0; y < detector.height_px; ++y)
            for (int x = 0; x < detector.width_px; ++x)
                light_e.row(y + static_cast<int>(camera.black_rows))[static_cast<std::size_t>(
                    x + static_cast<int>(camera.black_columns))] +=
                    static_cast<float>(glare_e[static_cast<std::size_t>(mosaic.channel(x, y))] / pixels);
    }

    std::vector<double> glare_e;  // of all points, spread evenly; by channel
    double jitter_px = 0;         // of this exposure, what its density leaves within it
};

FocalPlane::FocalPlane(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling)
    : implementation_(std::make_unique<Implementation>(camera, grid, sampling)) {}
FocalPlane::~FocalPlane() = default;

void FocalPlane::collapse(const RadianceImage& radiance, const Exposure& exposure) {
    Implementation& my = *implementation_;
    my.jitter_px =
        std::sqrt(jitter_blur_rad2(my.camera.jitter, exposure.exposure_s)) * my.detector.focal_length_px;
    // A hundredth of a pixel is not seen.
    if (my.jitter_px < 0.01) my.jitter_px = 0;
    HILCAM_CHECK(radiance.width() == my.image.padded_width() &&
                 radiance.height() == my.image.padded_height() && radiance.planes() == my.bins);
    my.dark = true;
    constexpr int kBlock_px = RadianceImage::kBlock_px;
    for (int y = 0; y < radiance.height() && my.dark; y += kBlock_px)
        for (int x = 0; x < radiance.width(); x += kBlock_px) my.dark = my.dark && radiance.dark(x, y);
    for (Channel& channel : my.channels) {
        if (!my.dark) {
            Spectrum factor = channel.per_radiance;
            for (float& value : factor.bin) value *= static_cast<float>(exposure.exposure_s);
            tbb::parallel_for(rows_of(radiance.height()), [&](const tbb::blocked_range<int>& range) {
                for (int y = range.begin(); y < range.end(); ++y)
                    my.collapse_row(channel, radiance, factor, y);
            });
            if (channel.ghost) my.collect_ghost(channel);
        } else if (channel.ghost) {
            channel.ghost->clear();
        }
    }
}

void FocalPlane::convolve(const Exposure& exposure) {
    Implementation& my = *implementation_;
    if (my.dark) return;
    MotionBlur blur;
    const double scale = exposure.exposure_s * my.sampling.oversampling;
    blur.smear_px = {exposure.image_rate_px_s.x * scale, exposure.image_rate_px_s.y * scale};
    blur.sigma_px = {my.jitter_px * my.sampling.oversampling, my.jitter_px * my.sampling.oversampling};
    for (Channel& channel : my.channels) {
        if (channel.kernel && blur.none())
            channel.kernel->run(*channel.convolver);
        else
            channel.convolver->run(blur);
    }
}

void FocalPlane::gather(std::span<const PointSource> points, const Exposure& exposure,
                        ElectronImage& light_e) {
    Implementation& my = *implementation_;
    const auto [width, height] = array_size(my.camera);
    HILCAM_CHECK(light_e.width() == width && light_e.height() == height);
    if (my.channels.front().ghost) my.collect_ghosts(points, exposure);
    const auto left = static_cast<std::size_t>(my.camera.black_columns);
    const int top = static_cast<int>(my.camera.black_rows);
    tbb::parallel_for(rows_of(height), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            std::fill(light_e.row(y).begin(), light_e.row(y).end(), 0.0f);
            if (y >= top) my.sample_row(y - top, light_e.row(y).data() + left);
        }
    });
    std::fill(my.glare_e.begin(), my.glare_e.end(), 0.0);
    for (const PointSource& point : points) my.add_point(point, exposure, light_e);
    if (!points.empty() && my.camera.stray_light.veiling_glare_fraction > 0) my.add_glare(light_e);
}

double FocalPlane::mtf(double u, double v) const {
    return std::abs(implementation_->channels.front().mtfs.front().at(u, v));
}

int FocalPlane::kernel_radius() const {
    const auto& kernel = implementation_->channels.front().kernel;
    return kernel ? kernel->radius() : 0;
}

void FocalPlane::run_fft_pair() { implementation_->channels.front().convolver->run(); }

}  // namespace hilcam
