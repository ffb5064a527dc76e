#include "render/color_bands.h"

#include <cmath>

namespace hilcam {
namespace {

std::array<float, 256> make_srgb_table() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < 256; ++i) {
        const double v = static_cast<double>(i) / 255.0;
        table[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return table;
}
const std::array<float, 256> kSrgbTable = make_srgb_table();

}  // namespace

float linear_from_srgb(std::uint8_t code) { return kSrgbTable[code]; }

ColorBands::ColorBands(const SpectralGrid& grid)
    : bins_(grid.size()),
      // 20 nm ramps, so that a bin edge near a band edge does not switch.
      red_(grid.average({{0.57, 0.59}, {0, 1}, {}})),
      green_(grid.average({{0.48, 0.50, 0.57, 0.59}, {0, 1, 1, 0}, {}})),
      blue_(grid.average({{0.48, 0.50}, {1, 0}, {}})) {}

Spectrum ColorBands::spectrum(Vec3f rgb) const {
    Spectrum out;
    for (int b = 0; b < bins_; ++b) out[b] = red_[b] * rgb.x + green_[b] * rgb.y + blue_[b] * rgb.z;
    return out;
}

Vec3f sample(const Texture& texture, float u, float v) {
    const float x = (u - std::floor(u)) * static_cast<float>(texture.width) - 0.5f;
    const float y = (v - std::floor(v)) * static_cast<float>(texture.height) - 0.5f;
    const float fx = x - std::floor(x);
    const float fy = y - std::floor(y);
    const auto wrap = [](float value, int size) {
        const int i = static_cast<int>(value);
        return i < 0 ? i + size : (i >= size ? i - size : i);
    };
    const int x0 = wrap(std::floor(x), texture.width), x1 = wrap(std::floor(x) + 1, texture.width);
    const int y0 = wrap(std::floor(y), texture.height), y1 = wrap(std::floor(y) + 1, texture.height);
    const auto texel = [&](int column, int row) {
        const auto& t =
            texture.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) +
                           static_cast<std::size_t>(column)];
        return Vec3f{linear_from_srgb(t[0]), linear_from_srgb(t[1]), linear_from_srgb(t[2])};
    };
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x1, y0)) +
           fy * ((1 - fx) * texel(x0, y1) + fx * texel(x1, y1));
}

}  // namespace hilcam
