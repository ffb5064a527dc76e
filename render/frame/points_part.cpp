#include "render/frame/points_part.h"

#include <cmath>

namespace hilcam {
namespace {

// Solid angle of a pixel: its area on the plane z = 1, seen from the origin.
double solid_angle_sr(const ImageGeometry& geometry, double x_px, double y_px) {
    const Vec3d dir = geometry.direction_camera(x_px, y_px);
    const Vec3d right =
        geometry.direction_camera(x_px + 0.5, y_px) - geometry.direction_camera(x_px - 0.5, y_px);
    const Vec3d down =
        geometry.direction_camera(x_px, y_px + 0.5) - geometry.direction_camera(x_px, y_px - 0.5);
    const double distance = length(dir);
    return length(cross(right, down)) / (distance * distance * distance);
}

}  // namespace

void add_points_part(const ImageGeometry& geometry, std::span<const PointSource> points, LightParts& parts,
                     PixelRecord* record) {
    RadianceImage& image = parts.of(LightPart::kPoints);
    for (const PointSource& point : points) {
        const int x = static_cast<int>(std::floor(point.position_px.x)) + geometry.guard_px,
                  y = static_cast<int>(std::floor(point.position_px.y)) + geometry.guard_px;
        if (x < 0 || y < 0 || x >= image.width() || y >= image.height()) continue;
        const double per_sr = 1 / solid_angle_sr(geometry, static_cast<double>(point.position_px.x),
                                                 static_cast<double>(point.position_px.y));
        const Spectrum radiance = static_cast<float>(per_sr) * point.irradiance_w_m2_um;
        for (int plane = 0; plane < image.planes(); ++plane)
            image.row(y, plane)[static_cast<std::size_t>(x)] +=
                image.responses().empty()
                    ? radiance[plane]
                    : sum_of_products(image.responses()[static_cast<std::size_t>(plane)], radiance);
        if (!record || !record->holds(x, y)) continue;
        PixelRecord::Entry entry;
        entry.part = LightPart::kPoints, entry.light = radiance;
        if (point.object < PointSource::kFirstBody) entry.object = point.object;
        record->add(entry);
    }
}

}  // namespace hilcam
