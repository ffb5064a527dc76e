#include "sensor/half_light_adder.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace hilcam {
namespace {

constexpr int kBlock_px = HalfKernels::kBlock_px, kReach_px = HalfKernels::kMaxReach_px;
static_assert(kBlock_px == RadianceImage::kBlock_px);

}  // namespace

void HalfLightAdder::add(const HalfLight& light, int number, const FrameBlur& blur, double exposure_s,
                         float most_e, LightChannel& channel) const {
    const int width = light.width(), height = light.height();
    Convolver& image = *channel.convolver;
    const auto stride = static_cast<std::size_t>(image.row(1).data() - image.row(0).data());
    for (std::size_t zone = 0; zone < channel.halves.size(); ++zone) {
        HalfKernels& kernels = channel.halves[zone];
        if (!kernels.prepare(blur)) continue;
        const Source source{light,
                            number,
                            static_cast<float>(exposure_s),
                            most_e,
                            zone_weights_.empty() ? nullptr : zone_weights_[zone].data(),
                            static_cast<std::size_t>(image.width())};
        const int across = (width + kBlock_px - 1) / kBlock_px, down = (height + kBlock_px - 1) / kBlock_px;
        tbb::parallel_for(
            tbb::blocked_range2d<int>(0, down, 0, across), [&](const tbb::blocked_range2d<int>& range) {
                HalfKernels::Differences differences;
                for (int j = range.rows().begin(); j < range.rows().end(); ++j)
                    for (int i = range.cols().begin(); i < range.cols().end(); ++i) {
                        const int x = i * kBlock_px, y = j * kBlock_px;
                        if (!gather(source, x, y, differences)) continue;
                        kernels.add(differences, std::min(kBlock_px, width - x),
                                    std::min(kBlock_px, height - y), image.row(y).data() + x, stride);
                    }
            });
    }
}

// Collects the differences of a block, and of those about it as far as kernels reach. False: all are even.
bool HalfLightAdder::gather(const Source& source, int x_px, int y_px, HalfKernels::Differences& out) const {
    bool any = false;
    for (int y = y_px - kBlock_px; y <= y_px + kBlock_px; y += kBlock_px)
        for (int x = x_px - kBlock_px; x <= x_px + kBlock_px; x += kBlock_px) {
            if (x < 0 || y < 0 || x >= source.light.width() || y >= source.light.height() ||
                source.light.even(x, y))
                continue;
            if (!any)
                for (auto& plane : out) plane.fill(0);
            any = true;
            copy_block(source, x, y, x_px, y_px, out);
        }
    return any;
}

// What of the block at (from_x, from_y) lies about the one at (x_px, y_px).
void HalfLightAdder::copy_block(const Source& source, int from_x, int from_y, int x_px, int y_px,
                                HalfKernels::Differences& out) const {
    const int width = source.light.width();
    const int x0 = std::max(from_x, x_px - kReach_px), y0 = std::max(from_y, y_px - kReach_px);
    const int x1 = std::min({from_x + kBlock_px, x_px + kBlock_px + kReach_px, width});
    const int y1 = std::min({from_y + kBlock_px, y_px + kBlock_px + kReach_px, source.light.height()});
    for (int d = 0; d < HalfLight::kDifferences; ++d)
        for (int y = y0; y < y1; ++y) {
            const float* in = source.light.row(y, d, source.number).data();
            const float* lens =
                illumination_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
            const float* zone =
                source.zone ? source.zone + static_cast<std::size_t>(y) * source.zone_width : nullptr;
            float* to = out[static_cast<std::size_t>(d)].data() +
                        (y - y_px + kReach_px) * HalfKernels::kSide_px + kReach_px - x_px;
            for (int x = x0; x < x1; ++x) {
                const float e =
                    std::clamp(source.exposure_s * lens[x] * in[x], -source.most_e, source.most_e);
                to[x] = zone ? zone[x] * e : e;
            }
        }
}

}  // namespace hilcam
