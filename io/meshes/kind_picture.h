#pragma once
// Pictures that say what a surface is made of, place by place: whether there is anything (an alpha mask), and whether it is metal
// or paint and how rough (a metallic-roughness texture). Made into kinds, of which each is a surface of its own
// (surface_cutter.h).

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

// Returns where a texel beyond a picture's edge is found in it.
int wrapped(std::int64_t texel, int size, TextureWrap wrap);

// The channels, each over one and the same part of the surface; one that is empty says the same everywhere.
struct KindSource {
    BytePlane alpha;  // there is something where it is `cutoff` or more, 0..255
    float cutoff = 127.5f;
    BytePlane metallic, roughness;  // shares, 0..255
    float metallic_factor = 1, roughness_factor = 1;
    std::array<TextureWrap, 2> wrap{};
    bool smooth = true;  // between texels values go over; false: each texel is a square
};

// The kinds that a source has. Kind 0 is where nothing is; it may not occur.
struct LookKind {
    float metallic = 0, roughness = 1;
};
struct KindPicture {
    int width = 0, height = 0;
    std::array<TextureWrap, 2> wrap{};
    std::vector<std::uint8_t> kinds;  // rows from the top

    std::uint8_t at(std::int64_t x, std::int64_t y) const;
};

// Returns the looks of the kinds from 1 on: metal and paint, each in up to four bands of roughness with the mean that occurs in it,
// the one that covers most first. Nothing without channels of metal and roughness.
std::vector<LookKind> kinds_of(const KindSource& source);
// Returns the kinds place by place. halvings: how often the picture is to be half as wide and high as it could be. A look that is
// none of `kinds` is the nearest of them; without any, all there is is kind 1.
KindPicture kind_picture(const KindSource& source, const std::vector<LookKind>& kinds, int halvings);

}  // namespace hilcam
