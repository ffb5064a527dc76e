#include "render/scene/color_bands.h"

#include <algorithm>
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
      blue_(grid.average({{0.48, 0.50}, {1, 0}, {}})) {
    for (int b = grid.solar_bins(); b < bins_; ++b) red_[b] = 0, thermal_[b] = 1;
}

Spectrum ColorBands::spectrum(Vec3f rgb) const {
    Spectrum out;
    for (int b = 0; b < bins_; ++b)
        out[b] = red_[b] * rgb.x + green_[b] * rgb.y + blue_[b] * rgb.z + thermal_[b];
    return out;
}

namespace {

// The two texels around a place along one side of a picture, and the weight of the second.
struct TexelPair {
    int first, second;
    float share;
};

TexelPair texels_about(float at, int size, TextureWrap wrap) {
    if (wrap == TextureWrap::kRepeat) {
        const float x = (at - std::floor(at)) * static_cast<float>(size) - 0.5f;
        const auto wrapped = [size](float value) {
            const int i = static_cast<int>(value);
            return i < 0 ? i + size : (i >= size ? i - size : i);
        };
        return {wrapped(std::floor(x)), wrapped(std::floor(x) + 1), x - std::floor(x)};
    }
    // There and back is one period of a mirrored picture.
    const float there =
        wrap == TextureWrap::kClamp ? std::clamp(at, 0.0f, 1.0f) : at - 2 * std::floor(at / 2);
    const float x = (there > 1 ? 2 - there : there) * static_cast<float>(size) - 0.5f;
    const auto within = [size](float value) { return std::clamp(static_cast<int>(value), 0, size - 1); };
    return {within(std::floor(x)), within(std::floor(x) + 1), x - std::floor(x)};
}

Vec3f bilinear(const Texture& texture, float u, float v) {
    const auto [x0, x1, fx] = texels_about(u, texture.width, texture.wrap[0]);
    const auto [y0, y1, fy] = texels_about(v, texture.height, texture.wrap[1]);
    const auto texel = [&](int column, int row) {
        const auto& t =
            texture.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) +
                           static_cast<std::size_t>(column)];
        return Vec3f{linear_from_srgb(t[0]), linear_from_srgb(t[1]), linear_from_srgb(t[2])};
    };
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x1, y0)) +
           fy * ((1 - fx) * texel(x0, y1) + fx * texel(x1, y1));
}

std::uint8_t srgb_from_linear(float value) {
    // The table is increasing: the code nearest to the value.
    const auto above = std::lower_bound(kSrgbTable.begin(), kSrgbTable.end(), value);
    if (above == kSrgbTable.begin()) return 0;
    if (above == kSrgbTable.end()) return 255;
    const auto code = above - kSrgbTable.begin();
    return static_cast<std::uint8_t>(*above - value < value - *(above - 1) ? code : code - 1);
}

// Half as large, at least one texel; an odd last row or column joins its neighbour.
Texture halved(const Texture& t) {
    Texture out;
    out.wrap = t.wrap;
    out.width = std::max(1, t.width / 2), out.height = std::max(1, t.height / 2);
    out.texels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    const auto range = [](int i, int from, int to) {
        return std::array<int, 2>{i * from / to, (i + 1) * from / to};
    };
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const auto rows = range(y, t.height, out.height), columns = range(x, t.width, out.width);
            std::array<float, 3> sum{};
            for (int row = rows[0]; row < rows[1]; ++row)
                for (int column = columns[0]; column < columns[1]; ++column)
                    for (std::size_t c = 0; c < 3; ++c)
                        sum[c] += linear_from_srgb(
                            t.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(t.width) +
                                     static_cast<std::size_t>(column)][c]);
            const auto count = static_cast<float>((rows[1] - rows[0]) * (columns[1] - columns[0]));
            auto& texel = out.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                     static_cast<std::size_t>(x)];
            for (std::size_t c = 0; c < 3; ++c) texel[c] = srgb_from_linear(sum[c] / count);
        }
    return out;
}

}  // namespace

MipTexture::MipTexture(Texture texture) {
    if (texture.texels.empty()) return;
    levels_.push_back(std::move(texture));
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

Vec3f MipTexture::sample(float u, float v, float footprint) const {
    const float level =
        footprint > 0 ? std::log2(std::max(1.0f, footprint * static_cast<float>(width()))) : 0.0f;
    const auto last = static_cast<float>(levels_.size() - 1);
    const float at = std::min(level, last);
    const auto low = static_cast<std::size_t>(at);
    // The finer level alone for half of the way: it is sharper, and needs one lookup instead of two.
    const float share = std::max(0.0f, 2 * (at - static_cast<float>(low)) - 1);
    const Vec3f fine = bilinear(levels_[low], u, v);
    return share > 0 ? (1 - share) * fine + share * bilinear(levels_[low + 1], u, v) : fine;
}

Vec3f MipTexture::mean(const std::function<double(double)>& row_weight) const {
    const Texture& t = levels_.front();
    Vec3d sum;
    double weights = 0;
    for (int y = 0; y < t.height; ++y) {
        const double weight = row_weight((y + 0.5) / t.height);
        for (int x = 0; x < t.width; ++x) {
            const auto& c = t.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(t.width) +
                                     static_cast<std::size_t>(x)];
            sum = sum + weight * to_double(Vec3f{linear_from_srgb(c[0]), linear_from_srgb(c[1]),
                                                 linear_from_srgb(c[2])});
            weights += weight;
        }
    }
    return to_float(sum / weights);
}

}  // namespace hilcam
