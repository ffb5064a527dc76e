#pragma once
// Pictures that say what a surface consists of: whether anything is there (an alpha mask), and whether it is
// metal or paint and how rough (a metallic-roughness texture). They are quantised into kinds; each kind
// becomes a surface of its own (surface_cutter.h).

#include <array>
#include <cstdint>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// One channel of a picture, rows from the top.
struct BytePlane {
    int width = 0, height = 0;
    std::vector<std::uint8_t> values;

    bool empty() const { return values.empty(); }
    std::uint8_t& at(int x, int y) { return values[index(x, y)]; }
    std::uint8_t at(int x, int y) const { return values[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

// Returns the index of a texel in the picture, wrapped when it is beyond the edge.
int wrapped(std::int64_t texel, int size, TextureWrap wrap);

// The channels, which all cover the same part of the surface. An empty one is constant.
struct KindSource {
    BytePlane alpha;  // material is there where it is `cutoff` or more, 0..255
    float cutoff = 127.5f;
    BytePlane metallic, roughness;  // 0..255 for shares of 0 to 1
    float metallic_factor = 1, roughness_factor = 1;
    std::array<TextureWrap, 2> wrap{};
    bool smooth = true;  // interpolated between texels; false: each texel is a square
};

// The look of a kind. Kind 0 is empty space; it may not occur.
struct LookKind {
    float metallic = 0, roughness = 1;
};
struct KindPicture {
    int width = 0, height = 0;
    std::array<TextureWrap, 2> wrap{};
    std::vector<std::uint8_t> kinds;  // rows from the top

    std::uint8_t at(std::int64_t x, std::int64_t y) const;
};

// Returns the looks of the kinds from 1 on, by covered area, largest first: metal and paint, each in up to
// four bands of roughness with the band's mean. Empty without channels of metal and roughness.
std::vector<LookKind> kinds_of(const KindSource& source);
// Returns the kind of each texel. A look that is not in `kinds` becomes the nearest; with no kinds, all
// material is kind 1. halvings: how often width and height are halved from full size.
KindPicture kind_picture(const KindSource& source, const std::vector<LookKind>& kinds, int halvings);

}  // namespace hilcam
