#include "sensor/convolution/subpixel_light_adder.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

constexpr int kAddedBlock_px = MomentKernels::kBlock_px, kReach_px = MomentKernels::kMaxReach_px;
static_assert(kAddedBlock_px == RadianceImage::kBlock_px);

// --- operations on rows of pixels

HILCAM_CLONES void add_scaled(float factor, const float* in, std::size_t count, float* sum) {
    for (std::size_t x = 0; x < count; ++x) sum[x] += factor * in[x];
}
HILCAM_CLONES void multiply(const float* a, const float* b, std::size_t count, float* product) {
    for (std::size_t x = 0; x < count; ++x) product[x] = a[x] * b[x];
}

// Input for computing charge from rates. A pixel that was cut has only the charge that was left. zone: null
// with one zone.
struct ChargeRow {
    const float *rate_e_s, *lens, *zone;
    float exposure_s, max_e;
};
HILCAM_CLONES void to_charge(const ChargeRow& of, std::size_t count, float* factor, float* charge_e) {
    const float exposure_s = of.exposure_s, max_e = of.max_e;
    for (std::size_t x = 0; x < count; ++x) {
        const float all_e = exposure_s * of.lens[x] * of.rate_e_s[x];
        factor[x] = all_e > max_e ? max_e / all_e : 1.0f;
    }
    if (of.zone)
        for (std::size_t x = 0; x < count; ++x) factor[x] *= of.zone[x];
    for (std::size_t x = 0; x < count; ++x) {
        factor[x] = factor[x] * exposure_s * of.lens[x];
        charge_e[x] = factor[x] * of.rate_e_s[x];
    }
}

// Light two pixels and one pixel before a place, and one and two after it.
struct Neighbors {
    const float *second_before, *before, *behind, *second_behind;
};
HILCAM_CLONES void find_smooth(const Neighbors& light, std::size_t count, float* difference) {
    for (std::size_t x = 0; x < count; ++x)
        difference[x] = smooth_difference(light.second_before[x], light.before[x], light.behind[x],
                                          light.second_behind[x]);
}
// Subtracts the smooth difference in pixels that are not known to be smooth. Returns false when nothing
// remains in any of these.
HILCAM_CLONES bool take(const float* smooth, const std::uint8_t* sharp, std::size_t count,
                        float* difference) {
    std::uint32_t left = 0;
    for (std::size_t x = 0; x < count; ++x) {
        const float rest = difference[x] - smooth[x];
        difference[x] = sharp[x] ? rest : difference[x];
        left |= sharp[x] && rest != 0 ? 1u : 0u;
    }
    return left != 0;
}

}  // namespace

// True when there are differences in the block that contains the pixel, which may be outside the picture.
bool SubpixelLightAdder::Source::knows(int x, int y) const {
    return x >= 0 && y >= 0 && x < light.width() && y < light.height() && !light.unknown(x, y) &&
           !radiance.dark(x, y);
}
// Returns charge rates of pixels from (x, y) on [e-/s], in `room` if they have to be computed.
const float* SubpixelLightAdder::Source::rates_e_s(int x, int y, std::size_t count, float* room) const {
    const auto from = [&](int plane) { return radiance.row(y, plane).data() + x; };
    if (!response) return from(number);
    std::fill_n(room, count, 0.0f);
    for (int b = 0; b < radiance.planes(); ++b) add_scaled((*response)[b], from(b), count, room);
    return room;
}

void SubpixelLightAdder::add(const RadianceImage& radiance, const Channel& channel, const FrameBlur& blur,
                             double exposure_s, Convolver& image) const {
    const int width = radiance.width(), height = radiance.height();
    const auto stride = static_cast<std::size_t>(image.row(1).data() - image.row(0).data());
    for (std::size_t zone = 0; zone < channel.kernels.size(); ++zone) {
        MomentKernels& kernels = channel.kernels[zone];
        if (!kernels.prepare(blur)) continue;
        const Source source{radiance,
                            *radiance.moments(),
                            channel.number,
                            radiance.responses().empty() ? &channel.response : nullptr,
                            static_cast<float>(exposure_s),
                            channel.max_e,
                            zone_weights_.empty() ? nullptr : zone_weights_[zone].data(),
                            static_cast<std::size_t>(image.width())};
        const int across = (width + kAddedBlock_px - 1) / kAddedBlock_px,
                  down = (height + kAddedBlock_px - 1) / kAddedBlock_px;
        tbb::parallel_for(
            tbb::blocked_range2d<int>(0, down, 0, across), [&](const tbb::blocked_range2d<int>& range) {
                Scratch scratch;
                for (int j = range.rows().begin(); j < range.rows().end(); ++j)
                    for (int i = range.cols().begin(); i < range.cols().end(); ++i) {
                        const int x = i * kAddedBlock_px, y = j * kAddedBlock_px;
                        if (!gather(source, x, y, scratch)) continue;
                        kernels.add(scratch.parts, std::min(kAddedBlock_px, width - x),
                                    std::min(kAddedBlock_px, height - y), image.row(y).data() + x, stride);
                    }
            });
    }
}

// Collects the differences in a block and around it that are known not to be smooth. Returns false when there
// are none.
bool SubpixelLightAdder::gather(const Source& source, int x_px, int y_px, Scratch& scratch) const {
    const auto known = [&](int y) {
        bool any = false;
        for (int x = x_px - kAddedBlock_px; x <= x_px + kAddedBlock_px; x += kAddedBlock_px)
            any = any || source.knows(x, y);
        return any;
    };
    if (!known(y_px - kAddedBlock_px) && !known(y_px) && !known(y_px + kAddedBlock_px)) return false;
    for (int row = 0; row < static_cast<int>(kArea_px); ++row) copy_row(source, x_px, y_px, row, scratch);
    find_sharp(scratch);
    return take_smooth(scratch);
}

// Copies a row of the block at (x_px, y_px) and its surroundings.
void SubpixelLightAdder::copy_row(const Source& source, int x_px, int y_px, int row, Scratch& scratch) const {
    const int width = source.light.width(), y = y_px - kRim_px + row, left = x_px - kRim_px;
    const int part_row = row - (kRim_px - kReach_px);
    const bool in_parts = part_row >= 0 && part_row < MomentKernels::kSide_px;
    const auto part_at = [&](std::size_t part) {
        return scratch.parts[part].data() + part_row * MomentKernels::kSide_px;
    };
    std::array<float, kArea_px>& charge_e = scratch.charge_e[static_cast<std::size_t>(row)];
    std::array<SubpixelKind, kArea_px>& kinds = scratch.kinds[static_cast<std::size_t>(row)];
    charge_e.fill(0), kinds.fill(SubpixelKind::kSmooth);
    if (in_parts)
        for (std::size_t part = 0; part < MomentKernels::kParts; ++part)
            std::fill_n(part_at(part), MomentKernels::kSide_px, 0.0f);
    if (y < 0 || y >= source.light.height()) return;
    const int x0 = std::max(left, 0), x1 = std::min(left + static_cast<int>(kArea_px), width);
    const float* lens =
        illumination_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x0;
    const float* zone =
        source.zone ? source.zone + static_cast<std::size_t>(y) * source.zone_width + x0 : nullptr;
    std::array<float, kArea_px> factor, rates_e_s;
    const auto count = static_cast<std::size_t>(x1 - x0);
    to_charge({source.rates_e_s(x0, y, count, rates_e_s.data()), lens, zone, source.exposure_s, source.max_e},
              count, factor.data() + (x0 - left), charge_e.data() + (x0 - left));
    for (int block = x_px - kAddedBlock_px; block <= x_px + kAddedBlock_px; block += kAddedBlock_px) {
        if (!source.knows(block, y)) continue;
        const auto within = [&](int reach_px) {
            return std::array{std::max({block, x_px - reach_px, x0}),
                              std::min({block + kAddedBlock_px, x_px + kAddedBlock_px + reach_px, x1})};
        };
        const auto [begin, end] = within(kRim_px);
        std::copy(source.light.kinds(y).data() + begin, source.light.kinds(y).data() + end,
                  kinds.data() + (begin - left));
        const auto [first, last] = within(kReach_px);
        if (!in_parts || first >= last) continue;
        for (std::size_t part = 0; part < MomentKernels::kParts; ++part)
            multiply(factor.data() + (first - left),
                     source.light.row(y, static_cast<int>(part), source.number).data() + first,
                     static_cast<std::size_t>(last - first), part_at(part) + (first - x_px + kReach_px));
    }
}

// Finds the pixels with light that is not smooth: known differences, or an object at most two pixels away.
void SubpixelLightAdder::find_sharp(Scratch& scratch) {
    std::array<std::array<std::uint8_t, kArea_px>, kArea_px> along;
    for (std::size_t y = 0; y < kArea_px; ++y) {
        std::array<std::uint8_t, kArea_px> object;
        for (std::size_t x = 0; x < kArea_px; ++x)
            object[x] = scratch.kinds[y][x] == SubpixelKind::kObject ? 1 : 0;
        for (std::size_t x = 2; x + 2 < kArea_px; ++x)
            along[y][x] = object[x - 2] | object[x - 1] | object[x] | object[x + 1] | object[x + 2];
    }
    for (std::size_t y = 2; y + 2 < kArea_px; ++y)
        for (std::size_t x = 2; x + 2 < kArea_px; ++x)
            scratch.sharp[y][x] = along[y - 2][x] | along[y - 1][x] | along[y][x] | along[y + 1][x] |
                                  along[y + 2][x] | (scratch.kinds[y][x] != SubpixelKind::kSmooth ? 1 : 0);
}

// Subtracts from the differences what the whole picture has already received. Returns false when nothing
// remains.
bool SubpixelLightAdder::take_smooth(Scratch& scratch) {
    constexpr auto kSide_px = static_cast<std::size_t>(MomentKernels::kSide_px);
    const Area& e = scratch.charge_e;
    std::array<float, kArea_px> down_e;
    std::array<float, kSide_px> smooth_e;
    bool any = false;
    for (std::size_t j = 0; j < kSide_px; ++j) {
        const std::size_t y = j + 2;
        find_smooth({e[y - 2].data(), e[y - 1].data(), e[y + 1].data(), e[y + 2].data()}, kArea_px,
                    down_e.data());
        const auto along = [](const std::array<float, kArea_px>& row) {
            return Neighbors{row.data(), row.data() + 1, row.data() + 3, row.data() + 4};
        };
        const auto take_part = [&](std::size_t part, const float* smooth) {
            const bool left = take(smooth, scratch.sharp[y].data() + 2, kSide_px,
                                   scratch.parts[part].data() + j * kSide_px);
            any = any || left;
        };
        find_smooth(along(e[y]), kSide_px, smooth_e.data());
        take_part(0, smooth_e.data());
        take_part(1, down_e.data() + 2);
        find_smooth(along(down_e), kSide_px, smooth_e.data());
        take_part(2, smooth_e.data());
    }
    return any;
}

}  // namespace hilcam
