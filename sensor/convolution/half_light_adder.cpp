#include "sensor/convolution/half_light_adder.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace hilcam {
namespace {

constexpr int kBlock_px = HalfKernels::kBlock_px, kReach_px = HalfKernels::kMaxReach_px;
static_assert(kBlock_px == RadianceImage::kBlock_px);

}  // namespace

float HalfLightAdder::Source::rate_e_s(int x, int y) const {
    const auto at = static_cast<std::size_t>(x);
    if (!response) return radiance.row(y, number)[at];
    float sum = 0;
    for (int b = 0; b < radiance.planes(); ++b) sum += (*response)[b] * radiance.row(y, b)[at];
    return sum;
}

void HalfLightAdder::add(const RadianceImage& radiance, const Channel& channel, const FrameBlur& blur,
                         double exposure_s, Convolver& image) const {
    const int width = radiance.width(), height = radiance.height();
    const auto stride = static_cast<std::size_t>(image.row(1).data() - image.row(0).data());
    for (std::size_t zone = 0; zone < channel.kernels.size(); ++zone) {
        HalfKernels& kernels = channel.kernels[zone];
        if (!kernels.prepare(blur)) continue;
        const Source source{radiance,
                            *radiance.halves(),
                            channel.number,
                            radiance.responses().empty() ? &channel.response : nullptr,
                            static_cast<float>(exposure_s),
                            channel.most_e,
                            zone_weights_.empty() ? nullptr : zone_weights_[zone].data(),
                            static_cast<std::size_t>(image.width())};
        const int across = (width + kBlock_px - 1) / kBlock_px, down = (height + kBlock_px - 1) / kBlock_px;
        tbb::parallel_for(
            tbb::blocked_range2d<int>(0, down, 0, across), [&](const tbb::blocked_range2d<int>& range) {
                Scratch scratch;
                for (int j = range.rows().begin(); j < range.rows().end(); ++j)
                    for (int i = range.cols().begin(); i < range.cols().end(); ++i) {
                        const int x = i * kBlock_px, y = j * kBlock_px;
                        if (!gather(source, x, y, scratch)) continue;
                        kernels.add(scratch.parts, std::min(kBlock_px, width - x),
                                    std::min(kBlock_px, height - y), image.row(y).data() + x, stride);
                    }
            });
    }
}

// Collects the differences of a block, and about it, that are known not to be smooth. False: there are none.
bool HalfLightAdder::gather(const Source& source, int x_px, int y_px, Scratch& scratch) const {
    const auto inside = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < source.light.width() && y < source.light.height();
    };
    const auto each_about = [&](auto&& use) {
        for (int y = y_px - kBlock_px; y <= y_px + kBlock_px; y += kBlock_px)
            for (int x = x_px - kBlock_px; x <= x_px + kBlock_px; x += kBlock_px)
                if (inside(x, y)) use(x, y);
    };
    bool any = false;
    each_about([&](int x, int y) { any = any || !source.light.unknown(x, y); });
    if (!any) return false;
    for (auto& row : scratch.charge_e) row.fill(0);
    for (auto& row : scratch.kinds) row.fill(HalfKind::kSmooth);
    for (auto& part : scratch.parts) part.fill(0);
    each_about([&](int x, int y) { copy_block(source, x, y, x_px, y_px, scratch); });
    find_near(scratch);
    return take_smooth(scratch);
}

// Copies the part of the block at (from_x, from_y) that lies about the one at (x_px, y_px).
void HalfLightAdder::copy_block(const Source& source, int from_x, int from_y, int x_px, int y_px,
                                Scratch& scratch) const {
    if (source.radiance.dark(from_x, from_y)) return;
    const int width = source.light.width();
    const bool known = !source.light.unknown(from_x, from_y);
    const int x0 = std::max(from_x, x_px - kRim_px), y0 = std::max(from_y, y_px - kRim_px);
    const int x1 = std::min({from_x + kBlock_px, x_px + kBlock_px + kRim_px, width});
    const int y1 = std::min({from_y + kBlock_px, y_px + kBlock_px + kRim_px, source.light.height()});
    for (int y = y0; y < y1; ++y) {
        const float* lens =
            illumination_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        const float* zone =
            source.zone ? source.zone + static_cast<std::size_t>(y) * source.zone_width : nullptr;
        const auto row = static_cast<std::size_t>(y - y_px + kRim_px);
        // What makes charge of a rate: of a pixel that was cut, of as much of it as was left.
        std::array<float, kArea_px> factor;
        float* const charge_e = scratch.charge_e[row].data();
        for (int x = x0; x < x1; ++x) {
            const auto at = static_cast<std::size_t>(x - x_px + kRim_px);
            const float rate_e_s = source.rate_e_s(x, y), all_e = source.exposure_s * lens[x] * rate_e_s;
            const float left = all_e > source.most_e ? source.most_e / all_e : 1.0f;
            factor[at] = left * (zone ? zone[x] : 1.0f) * source.exposure_s * lens[x];
            charge_e[at] = factor[at] * rate_e_s;
        }
        if (!known) continue;
        std::copy_n(source.light.kinds(y).data() + x0, x1 - x0,
                    scratch.kinds[row].data() + x0 + kRim_px - x_px);
        const int in_y = y - y_px + kReach_px, first = std::max(x0, x_px - kReach_px),
                  last = std::min(x1, x_px + kBlock_px + kReach_px);
        if (in_y < 0 || in_y >= HalfKernels::kSide_px) continue;
        for (std::size_t part = 0; part < HalfKernels::kParts; ++part) {
            const float* in = source.light.row(y, static_cast<int>(part), source.number).data();
            float* to = scratch.parts[part].data() + in_y * HalfKernels::kSide_px + kReach_px - x_px;
            for (int x = first; x < last; ++x)
                to[x] = factor[static_cast<std::size_t>(x - x_px + kRim_px)] * in[x];
        }
    }
}

void HalfLightAdder::find_near(Scratch& scratch) {
    std::array<std::array<std::uint8_t, kArea_px>, kArea_px> along;
    for (std::size_t y = 0; y < kArea_px; ++y) {
        std::array<std::uint8_t, kArea_px> object;
        for (std::size_t x = 0; x < kArea_px; ++x)
            object[x] = scratch.kinds[y][x] == HalfKind::kObject ? 1 : 0;
        for (std::size_t x = 2; x + 2 < kArea_px; ++x)
            along[y][x] = object[x - 2] | object[x - 1] | object[x] | object[x + 1] | object[x + 2];
    }
    for (std::size_t y = 2; y + 2 < kArea_px; ++y)
        for (std::size_t x = 2; x + 2 < kArea_px; ++x)
            scratch.near[y][x] =
                along[y - 2][x] | along[y - 1][x] | along[y][x] | along[y + 1][x] | along[y + 2][x];
}

// Takes what the picture as a whole has been given already from the differences. False: nothing is left.
bool HalfLightAdder::take_smooth(Scratch& scratch) {
    const Area& e = scratch.charge_e;
    for (std::size_t y = 2; y + 2 < kArea_px; ++y)
        for (std::size_t x = 0; x < kArea_px; ++x)
            scratch.down_e[y][x] = smooth_difference(e[y - 2][x], e[y - 1][x], e[y + 1][x], e[y + 2][x]);
    bool any = false;
    for (std::size_t j = 0; j < HalfKernels::kSide_px; ++j)
        for (std::size_t i = 0; i < HalfKernels::kSide_px; ++i) {
            const std::size_t y = j + 2, x = i + 2, at = j * HalfKernels::kSide_px + i;
            if (!scratch.near[y][x] && scratch.kinds[y][x] == HalfKind::kSmooth) continue;
            const std::array<float, kArea_px>& down_e = scratch.down_e[y];
            const float smooth[] = {
                smooth_difference(e[y][x - 2], e[y][x - 1], e[y][x + 1], e[y][x + 2]), down_e[x],
                smooth_difference(down_e[x - 2], down_e[x - 1], down_e[x + 1], down_e[x + 2])};
            for (std::size_t part = 0; part < HalfKernels::kParts; ++part) {
                scratch.parts[part][at] -= smooth[part];
                any = any || scratch.parts[part][at] != 0;
            }
        }
    return any;
}

}  // namespace hilcam
