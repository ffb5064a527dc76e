#include "sensor/chain.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/stopwatch.h"
#include "sensor/array_places.h"
#include "sensor/focal_plane.h"
#include "sensor/noise.h"
#include "sensor/read_out.h"

namespace hilcam {
namespace {

tbb::blocked_range<int> rows_of(int height) { return {0, height, 16}; }

// Computes the mean charge of a row: light times each pixel's gain, plus its dark current.
HILCAM_CLONES void to_charge(float* light, std::size_t count, const float* gain, const float* dark_e_s,
                             float uniform_dark_e, float exposure_s) {
    constexpr float kMax_e = 1e9f;
    if (gain)
        for (std::size_t x = 0; x < count; ++x) light[x] *= gain[x];
    for (std::size_t x = 0; x < count; ++x) {
        const float all = light[x] + (dark_e_s ? dark_e_s[x] * exposure_s : uniform_dark_e);
        light[x] = all > 0 ? (all < kMax_e ? all : kMax_e) : 0.0f;
    }
}

}  // namespace

struct SensorChain::Implementation {
    CameraModel camera;
    FocalPlane focal_plane;
    FixedPattern pattern;
    ArrayPlaces places;
    ReadOut read_out;
    std::optional<ChargeTransfer> transfer;
    bool charge_moves;       // true: beyond its pixel, so that rows cannot be read one by one
    ElectronImage charge_e;  // used when charge moves
    int array_width, array_height;
    std::vector<double> column_sums;  // for frame transfer
    struct Scratch {
        std::vector<float> charge, deviates, binned;
        std::vector<std::uint16_t> dn;
        std::vector<std::uint32_t> sums;
    };
    std::vector<Scratch> scratch;  // by thread

    Implementation(const CameraModel& c, const SpectralGrid& grid, const SensorSampling& sampling,
                   const DetectorPictures& pictures)
        : camera(c),
          focal_plane(c, grid, sampling),
          pattern(draw_fixed_pattern(c, pictures)),
          places(c),
          read_out(c),
          charge_moves(c.ccd.blooming || c.ccd.parallel_inefficiency > 0 || c.ccd.serial_inefficiency > 0 ||
                       c.cosmic_rays.rate_cm2_s > 0),
          array_width(array_size(c)[0]),
          array_height(array_size(c)[1]) {
        if (charge_moves) charge_e = ElectronImage(array_width, array_height);
        if (c.ccd.parallel_inefficiency > 0 || c.ccd.serial_inefficiency > 0)
            transfer.emplace(c.ccd, array_width, array_height, window_of(c).left, window_of(c).top);
        if (c.shutter.kind == ShutterKind::kFrameTransfer)
            column_sums.resize(static_cast<std::size_t>(array_width));
        scratch.resize(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
        for (Scratch& s : scratch) {
            const auto width = static_cast<std::size_t>(array_width);
            s.charge.resize(width), s.deviates.resize(width), s.binned.resize(width);
            s.dn.resize(width), s.sums.resize(width);
        }
    }
    Scratch& mine() {
        return scratch[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())];
    }

    // --- mean charge

    // Frame transfer: while rows are shifted under the light, each charge packet passes the places of all
    // other pixels in its column, those on one side on its way in before the exposure, the others on its way
    // out. Each place contributes with its own gain.
    void smear(ElectronImage& light_e, double exposure_s) {
        const double share = camera.shutter.line_time_s / exposure_s;
        std::fill(column_sums.begin(), column_sums.end(), 0.0);
        for (int y = 0; y < array_height; ++y)
            for (std::size_t x = 0; x < column_sums.size(); ++x) {
                float& pixel = light_e.row(y)[x];
                if (pattern.gain.width() > 0) pixel *= pattern.gain.row(y)[x];
                column_sums[x] += static_cast<double>(pixel);
            }
        for (int y = 0; y < array_height; ++y)
            for (std::size_t x = 0; x < column_sums.size(); ++x) {
                float& pixel = light_e.row(y)[x];
                pixel += static_cast<float>(share * (column_sums[x] - static_cast<double>(pixel)));
            }
    }
    void charge_row(int y, ElectronImage& light_e, double exposure_s) const {
        const auto row_of = [&](const PixelMap& map) {
            return map.width() > 0 ? map.row(y).data() : nullptr;
        };
        const bool gains_are_in = camera.shutter.kind == ShutterKind::kFrameTransfer;
        to_charge(light_e.row(y).data(), static_cast<std::size_t>(array_width),
                  gains_are_in ? nullptr : row_of(pattern.gain), row_of(pattern.dark_e_s),
                  static_cast<float>(pattern.uniform_dark_e_s * exposure_s), static_cast<float>(exposure_s));
    }

    // --- noise and read-out

    // Black columns have their own random keys, so a row is drawn in two pieces.
    void draw_row(int y, std::span<const float> mean_e, RandomKey key, std::span<float> charge,
                  std::span<float> deviates) const {
        const auto black = static_cast<std::size_t>(places.black_columns());
        const auto piece = [&](std::size_t first, std::size_t count) {
            if (count == 0) return;
            const auto part = [&](auto span) { return span.empty() ? span : span.subspan(first, count); };
            draw_pixels(part(mean_e), key,
                        sensor_pixel(places.column(static_cast<int>(first)), places.row(y)), part(charge),
                        part(deviates));
        };
        piece(0, black);
        piece(black, static_cast<std::size_t>(array_width) - black);
    }
    void move_charge(const ElectronImage& mean_e, const Exposure& exposure, RandomKey key) {
        tbb::parallel_for(rows_of(array_height), [&](const tbb::blocked_range<int>& range) {
            for (int y = range.begin(); y < range.end(); ++y)
                draw_row(y, mean_e.row(y), key, charge_e.row(y), {});
        });
        if (camera.cosmic_rays.rate_cm2_s > 0)
            add_tracks(camera.cosmic_rays, camera.pitch_m, exposure.exposure_s, key, charge_e);
        const auto full_well_e = static_cast<float>(camera.full_well_e);
        if (camera.ccd.blooming)
            bloom(charge_e, full_well_e);
        else
            for (float& q : charge_e.all()) q = std::min(q, full_well_e);
        if (transfer) transfer->apply(charge_e);
    }
    // Computes a row of the array: its charge, and deviates for its noise.
    void fill_row(int y, const ElectronImage& mean_e, RandomKey key, Scratch& s) const {
        if (charge_moves) {
            std::copy(charge_e.row(y).begin(), charge_e.row(y).end(), s.charge.begin());
            draw_row(y, {}, key, {}, s.deviates);
        } else {
            draw_row(y, mean_e.row(y), key, s.charge, s.deviates);
        }
    }
    std::span<const TelegraphPixel> telegraph_of(int y) const {
        const auto [from, to] =
            std::equal_range(pattern.telegraph.begin(), pattern.telegraph.end(), TelegraphPixel{0, y, 0},
                             [](const TelegraphPixel& a, const TelegraphPixel& b) { return a.y < b.y; });
        return {from, to};
    }
    // The parameters that turn a frame's charge into numbers.
    struct Reading {
        double gain_dn_e, black_level_dn;
        int binning_x, binning_y;
    };
    void read_array_row(int y, const Reading& r, RandomKey key, Scratch& s,
                        std::span<std::uint16_t> dn) const {
        const std::span<const float> offset =
            pattern.offset_e.width() > 0 ? pattern.offset_e.row(y) : std::span<const float>{};
        read_out.read({y, places.row(y), s.charge, s.deviates, offset, r.gain_dn_e, r.black_level_dn},
                      telegraph_of(y), key, dn);
    }

    void read_frame_row(int y, const ElectronImage& mean_e, const Exposure& exposure, RandomKey key,
                        DnImage& frame) {
        Scratch& s = mine();
        const auto [binning_x, binning_y] = binning_of(camera, exposure);
        const Reading reading{camera.system_gain_dn_e(exposure.gain_db),
                              exposure.black_level_dn.value_or(camera.offset_dn), static_cast<int>(binning_x),
                              static_cast<int>(binning_y)};
        if (binning_x == 1 && binning_y == 1) {
            fill_row(y, mean_e, key, s);
            read_array_row(y, reading, key, s, frame.row(y));
        } else if (camera.binning == BinningKind::kCharge) {
            read_charge_binned(y, mean_e, reading, key, s, frame.row(y));
        } else {
            read_digitally_binned(y, mean_e, reading, key, s, frame.row(y));
        }
        read_out.compand(frame.row(y));
    }
    // Reads charge that is binned on the chip: with the noise of one reading, and the first pixel's offset
    // and telegraph noise for all of them.
    void read_charge_binned(int y, const ElectronImage& mean_e, const Reading& r, RandomKey key, Scratch& s,
                            std::span<std::uint16_t> dn) const {
        const int bx = r.binning_x, by = r.binning_y;
        const std::span<float> binned = std::span(s.binned).first(dn.size());
        std::fill(binned.begin(), binned.end(), 0.0f);
        for (int j = 0; j < by; ++j) {
            fill_row(y * by + j, mean_e, key, s);
            for (std::size_t x = 0; x < dn.size(); ++x)
                for (int i = 0; i < bx; ++i)
                    binned[x] +=
                        std::min(s.charge[x * static_cast<std::size_t>(bx) + static_cast<std::size_t>(i)],
                                 static_cast<float>(camera.full_well_e));
        }
        const std::span<float> deviates = std::span(s.deviates).first(dn.size());
        const std::uint32_t row = places.row(y * by);
        draw_pixels({}, key, sensor_pixel(0, row), {}, deviates);
        std::span<float> offset;
        if (pattern.offset_e.width() > 0) {
            offset = std::span(s.charge).first(dn.size());
            for (std::size_t x = 0; x < dn.size(); ++x)
                offset[x] = pattern.offset_e.row(y * by)[x * static_cast<std::size_t>(bx)];
        }
        read_out.read({y, row, binned, deviates, offset, r.gain_dn_e, r.black_level_dn, bx * by, bx},
                      telegraph_of(y * by), key, dn);
    }
    void read_digitally_binned(int y, const ElectronImage& mean_e, const Reading& r, RandomKey key,
                               Scratch& s, std::span<std::uint16_t> dn) const {
        const auto bx = static_cast<std::size_t>(r.binning_x);
        const int by = r.binning_y;
        std::fill_n(s.sums.begin(), dn.size(), 0u);
        for (int j = 0; j < by; ++j) {
            fill_row(y * by + j, mean_e, key, s);
            read_array_row(y * by + j, r, key, s, s.dn);
            for (std::size_t x = 0; x < dn.size(); ++x)
                for (std::size_t i = 0; i < bx; ++i) s.sums[x] += s.dn[x * bx + i];
        }
        const auto count = static_cast<std::uint32_t>(bx) * static_cast<std::uint32_t>(by);
        for (std::size_t x = 0; x < dn.size(); ++x)
            dn[x] = static_cast<std::uint16_t>(camera.binning == BinningKind::kMean
                                                   ? (s.sums[x] + count / 2) / count
                                                   : std::min(s.sums[x], read_out.max_sum_dn()));
    }
};

SensorChain::SensorChain(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
                         const DetectorPictures& pictures)
    : implementation_(std::make_unique<Implementation>(camera, grid, sampling, pictures)) {}
SensorChain::~SensorChain() = default;

void SensorChain::expose(const RadianceImage& radiance, std::span<const PointSource> points,
                         const Exposure& exposure, ElectronImage& mean_e, std::span<const SideLight> beside) {
    Implementation& my = *implementation_;
    const Stopwatch collapse;
    my.focal_plane.collapse(radiance, exposure);
    times_.collapse_ms = collapse.ms();

    const Stopwatch convolve;
    my.focal_plane.convolve(radiance, exposure);
    times_.convolve_ms = convolve.ms();

    const Stopwatch gather;
    my.focal_plane.gather(points, beside, exposure, mean_e);
    if (my.camera.shutter.kind == ShutterKind::kFrameTransfer) my.smear(mean_e, exposure.exposure_s);
    tbb::parallel_for(rows_of(mean_e.height()), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) my.charge_row(y, mean_e, exposure.exposure_s);
    });
    times_.points_ms = gather.ms();
}

void SensorChain::digitise(const ElectronImage& mean_e, const Exposure& exposure, RandomKey key,
                           DnImage& frame) {
    Implementation& my = *implementation_;
    const auto [width, height] = frame_size(my.camera, exposure.binning_x, exposure.binning_y);
    HILCAM_CHECK(mean_e.width() == my.array_width && mean_e.height() == my.array_height &&
                 frame.width() == width && frame.height() == height);
    const Stopwatch digitise;
    if (my.charge_moves) my.move_charge(mean_e, exposure, key);
    tbb::parallel_for(rows_of(frame.height()), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) my.read_frame_row(y, mean_e, exposure, key, frame);
    });
    times_.digitise_ms = digitise.ms();
}

double SensorChain::mtf(double u, double v) const {
    return implementation_->focal_plane.mtf(u, v) * implementation_->read_out.filter().mtf(u);
}

int SensorChain::kernel_radius() const { return implementation_->focal_plane.kernel_radius(); }

double SensorChain::fft_pair_ms() {
    const Stopwatch watch;
    implementation_->focal_plane.run_fft_pair();
    return watch.ms();
}

}  // namespace hilcam
