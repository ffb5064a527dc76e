#include "tools/make_spacecraft/patch.h"

#include <algorithm>
#include <cmath>

namespace spacecraft {

std::array<int, 2> pieces_of(const Patch& p, double scale) {
    const double pieces = p.detail * scale;
    return {std::max(p.min_u, static_cast<int>(std::lround(std::sqrt(pieces * p.aspect)))),
            std::max(p.min_v, static_cast<int>(std::lround(std::sqrt(pieces / p.aspect))))};
}

std::size_t triangles_of(const Patch& p, double scale) {
    const auto [u, v] = pieces_of(p, scale);
    return 2 * static_cast<std::size_t>(u) * static_cast<std::size_t>(v);
}

double scale_for(const std::vector<Patch>& patches, std::size_t triangles) {
    const auto total = [&](double scale) {
        std::size_t sum = 0;
        for (const Patch& p : patches) sum += triangles_of(p, scale);
        return sum;
    };
    double low = 0;
    double high = 1;
    while (total(high) < triangles && high < 1e12) high *= 2;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (total(middle) < triangles ? low : high) = middle;
    }
    return high;
}

void append(const Patch& p, double scale, Surface& surface) {
    const auto [nu, nv] = pieces_of(p, scale);
    const auto base = static_cast<std::uint32_t>(surface.positions.size());
    const auto columns = static_cast<std::uint32_t>(nu) + 1;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i)
            surface.positions.push_back(
                hilcam::to_float(p.at(static_cast<double>(i) / nu, static_cast<double>(j) / nv)));
    std::vector<Vec3d> normals(surface.positions.size() - base);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vec3d pa = hilcam::to_double(surface.positions[base + a]);
        const Vec3d n = cross(hilcam::to_double(surface.positions[base + b]) - pa,
                              hilcam::to_double(surface.positions[base + c]) - pa);
        for (const std::uint32_t k : {a, b, c}) normals[k] = normals[k] + n;
        surface.triangles.push_back({base + a, base + b, base + c});
    };
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(nv); ++j)
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(nu); ++i) {
            const std::uint32_t k = j * columns + i;
            add(k, k + 1, k + columns + 1);
            add(k, k + columns + 1, k + columns);
        }
    for (const Vec3d& n : normals) {
        const double size = length(n);
        surface.normals.push_back(size > 0 ? hilcam::to_float(n / size) : Vec3f{0, 0, 1});
    }
}

}  // namespace spacecraft
