#include "io/meshes/kind_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace hilcam {
namespace {

constexpr int kBands = 4;  // bands of roughness
// A small picture is enlarged to at least this width, because smooth borders run between its texels.
constexpr int kFineEnough = 512;
constexpr int kLargest = 2048;

BytePlane halved(const BytePlane& p) {
    BytePlane out{std::max(1, p.width / 2), std::max(1, p.height / 2), {}};
    out.values.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            // An odd last row or column is merged with its neighbour.
            const int x0 = x * p.width / out.width, x1 = (x + 1) * p.width / out.width;
            const int y0 = y * p.height / out.height, y1 = (y + 1) * p.height / out.height;
            int sum = 0;
            for (int row = y0; row < y1; ++row)
                for (int column = x0; column < x1; ++column) sum += p.at(column, row);
            const int count = (x1 - x0) * (y1 - y0);
            out.at(x, y) = static_cast<std::uint8_t>((sum + count / 2) / count);
        }
    return out;
}

// A channel, sampled at the places of another size.
class PictureChannel {
  public:
    PictureChannel(const BytePlane& plane, std::array<TextureWrap, 2> wrap, bool smooth, int width,
                   int height)
        : plane_(plane), wrap_(wrap), smooth_(smooth) {
        while (plane_.width > width || plane_.height > height) {
            if (plane_.width == 1 && plane_.height == 1) break;
            plane_ = halved(plane_);
        }
        scale_x_ = static_cast<float>(plane_.width) / static_cast<float>(width);
        scale_y_ = static_cast<float>(plane_.height) / static_cast<float>(height);
        is_same_ = plane_.width == width && plane_.height == height;
    }

    bool empty() const { return plane_.empty(); }
    // Returns the value at the centre of a place of the other size.
    float at(int column, int row) const {
        if (is_same_) return plane_.at(column, row);
        const float x = (static_cast<float>(column) + 0.5f) * scale_x_,
                    y = (static_cast<float>(row) + 0.5f) * scale_y_;
        if (!smooth_) return value(static_cast<int>(x), static_cast<int>(y));
        const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
        const float fx = x - 0.5f - left, fy = y - 0.5f - top;
        const int i = static_cast<int>(left), k = static_cast<int>(top);
        return (1 - fy) * ((1 - fx) * value(i, k) + fx * value(i + 1, k)) +
               fy * ((1 - fx) * value(i, k + 1) + fx * value(i + 1, k + 1));
    }

  private:
    BytePlane plane_;
    std::array<TextureWrap, 2> wrap_;
    bool smooth_, is_same_ = false;
    float scale_x_ = 1, scale_y_ = 1;

    float value(int x, int y) const {
        return plane_.at(wrapped(x, plane_.width, wrap_[0]), wrapped(y, plane_.height, wrap_[1]));
    }
};

LookKind look_of(const KindSource& s, float metallic, float roughness) {
    return {std::clamp(s.metallic_factor * metallic / 255, 0.0f, 1.0f),
            std::clamp(s.roughness_factor * roughness / 255, 0.0f, 1.0f)};
}

bool is_metal(const LookKind& k) { return k.metallic >= 0.5f; }

std::size_t nearest(std::span<const LookKind> kinds, const LookKind& look) {
    std::size_t best = 0;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const float away = std::abs(kinds[i].roughness - look.roughness) +
                           (is_metal(kinds[i]) == is_metal(look) ? 0.0f : 10.0f);
        if (away < least) least = away, best = i;
    }
    return best;
}

// Maps each pair of rounded values to its kind.
class KindTable {
  public:
    KindTable(const KindSource& source, std::span<const LookKind> kinds) {
        for (int metallic = 0; metallic < 256; ++metallic)
            for (int roughness = 0; roughness < 256; ++roughness) {
                const LookKind look =
                    look_of(source, static_cast<float>(metallic), static_cast<float>(roughness));
                kinds_.push_back(static_cast<std::uint8_t>(1 + (kinds.empty() ? 0 : nearest(kinds, look))));
            }
    }
    std::uint8_t at(float metallic, float roughness) const {
        return kinds_[256 * static_cast<std::size_t>(metallic + 0.5f) +
                      static_cast<std::size_t>(roughness + 0.5f)];
    }

  private:
    std::vector<std::uint8_t> kinds_;
};

// A missing channel is 255 everywhere.
float at(const PictureChannel& channel, int x, int y) { return channel.empty() ? 255.0f : channel.at(x, y); }

}  // namespace

int wrapped(std::int64_t texel, int size, TextureWrap wrap) {
    const std::int64_t n = size;
    switch (wrap) {
        case TextureWrap::kClamp:
            return static_cast<int>(std::clamp<std::int64_t>(texel, 0, n - 1));
        case TextureWrap::kMirror: {
            const std::int64_t there = (texel % (2 * n) + 2 * n) % (2 * n);
            return static_cast<int>(there < n ? there : 2 * n - 1 - there);
        }
        case TextureWrap::kRepeat:
            break;
    }
    return static_cast<int>((texel % n + n) % n);
}

std::uint8_t KindPicture::at(std::int64_t x, std::int64_t y) const {
    return kinds[static_cast<std::size_t>(wrapped(y, height, wrap[1])) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(wrapped(x, width, wrap[0]))];
}

std::vector<LookKind> kinds_of(const KindSource& s) {
    if (s.metallic.empty() || s.metallic.values.size() != s.roughness.values.size()) return {};
    struct Sum {
        double metallic = 0, roughness = 0;
        std::uint64_t count = 0;
    };
    std::array<Sum, 2 * kBands> sums{};
    for (std::size_t i = 0; i < s.metallic.values.size(); ++i) {
        const LookKind look = look_of(s, s.metallic.values[i], s.roughness.values[i]);
        const int band = std::min(kBands - 1, static_cast<int>(look.roughness * kBands));
        Sum& sum = sums[static_cast<std::size_t>(band + (is_metal(look) ? kBands : 0))];
        sum.metallic += static_cast<double>(look.metallic),
            sum.roughness += static_cast<double>(look.roughness);
        ++sum.count;
    }
    std::sort(sums.begin(), sums.end(), [](const Sum& a, const Sum& b) { return a.count > b.count; });
    std::vector<LookKind> out;
    for (const Sum& sum : sums)
        if (sum.count > 0)
            out.push_back({static_cast<float>(sum.metallic / static_cast<double>(sum.count)),
                           static_cast<float>(sum.roughness / static_cast<double>(sum.count))});
    return out;
}

KindPicture kind_picture(const KindSource& s, const std::vector<LookKind>& kinds, int halvings) {
    KindPicture out;
    out.width = std::max({1, s.alpha.width, s.metallic.width});
    out.height = std::max({1, s.alpha.height, s.metallic.height});
    if (s.smooth)
        for (int k = 0; k < 2 && 2 * std::max(out.width, out.height) <= kFineEnough; ++k)
            out.width *= 2, out.height *= 2;
    const auto halve = [&out] {
        out.width = std::max(1, out.width / 2), out.height = std::max(1, out.height / 2);
    };
    while (std::max(out.width, out.height) > kLargest) halve();
    for (int k = 0; k < halvings; ++k) halve();
    out.wrap = s.wrap;
    const PictureChannel alpha(s.alpha, s.wrap, s.smooth, out.width, out.height),
        metallic(s.metallic, s.wrap, s.smooth, out.width, out.height),
        roughness(s.roughness, s.wrap, s.smooth, out.width, out.height);
    const KindTable table(s, kinds);
    out.kinds.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            if (at(alpha, x, y) < s.cutoff) {
                out.kinds.push_back(0);
                continue;
            }
            out.kinds.push_back(table.at(at(metallic, x, y), at(roughness, x, y)));
        }
    return out;
}

}  // namespace hilcam
