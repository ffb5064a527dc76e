#pragma once
// Maps pixels to directions and back: a pinhole with the lens's distortion.
//
// Camera axes: +x right, +y down, +z along the boresight, which meets the image at its middle (width/2,
// height/2) plus principal_offset_px. The centre of pixel (0, 0) is at (0.5, 0.5) px. The guard band
// continues the image on all four sides, so there is a pixel (-1, 0): light from just outside the frame can
// spread in.
//
// Rectilinear lenses have distortion after Brown, Photogrammetric Engineering 32 (1966), in OpenCV's form.
// With x, y = X/Z, Y/Z and r^2 = x^2 + y^2
//     x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
//     y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p2 x y + p1 (r^2 + 2 y^2)
// A polynomial of x and y can be added for what these terms cannot express (lens_polynomial.h). Fisheye
// lenses have OpenCV's model: with theta = atan r
//     x' = x / r theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8), and the same for y'

#include <cmath>

#include "render/vocabulary/lens_polynomial.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

enum class Projection { kRectilinear, kFisheye };

struct LensDistortion {
    double k1 = 0, k2 = 0, k3 = 0, p1 = 0, p2 = 0;
    double k4 = 0;  // fourth coefficient of a fisheye
    Projection projection = Projection::kRectilinear;
    LensPolynomial polynomial{};  // added by a rectilinear lens

    bool none() const { return projection == Projection::kRectilinear && !brown() && polynomial.none(); }
    bool brown() const { return k1 != 0 || k2 != 0 || k3 != 0 || p1 != 0 || p2 != 0; }
    Vec2d distorted(Vec2d p) const {
        if (projection == Projection::kFisheye) return fisheye(p);
        const double r2 = p.x * p.x + p.y * p.y;
        const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
        const Vec2d moved{p.x * radial + 2 * p1 * p.x * p.y + p2 * (r2 + 2 * p.x * p.x),
                          p.y * radial + p1 * (r2 + 2 * p.y * p.y) + 2 * p2 * p.x * p.y};
        if (polynomial.none()) return moved;
        const Vec2d by = polynomial.shift(p).by;
        return {moved.x + by.x, moved.y + by.y};
    }
    // Inverts the distortion by Newton's method with its Jacobian. Converges to 1e-12 within 12 steps where
    // the lens does not fold over.
    Vec2d undistorted(Vec2d q) const {
        if (projection == Projection::kFisheye) return from_fisheye(q);
        Vec2d p = q;
        for (int step = 0; step < 12; ++step) {
            const Vec2d at = distorted(p);
            const Vec2d error{at.x - q.x, at.y - q.y};
            if (std::abs(error.x) + std::abs(error.y) < 1e-14) break;
            const double r2 = p.x * p.x + p.y * p.y;
            const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
            const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // d radial / d(r^2) * 2
            double xx = radial + p.x * p.x * slope + 2 * p1 * p.y + 6 * p2 * p.x;
            double yy = radial + p.y * p.y * slope + 6 * p1 * p.y + 2 * p2 * p.x;
            double xy = p.x * p.y * slope + 2 * p1 * p.x + 2 * p2 * p.y;  // growth of x along y
            double yx = xy;
            if (!polynomial.none()) {
                const LensPolynomial::Shift s = polynomial.shift(p);
                xx += s.along_x.x, xy += s.along_y.x, yx += s.along_x.y, yy += s.along_y.y;
            }
            const double determinant = xx * yy - xy * yx;
            if (!(std::abs(determinant) > 1e-12)) break;
            p.x -= (yy * error.x - xy * error.y) / determinant;
            p.y -= (xx * error.y - yx * error.x) / determinant;
        }
        return p;
    }

  private:
    double fisheye_radius(double theta) const {
        const double t2 = theta * theta;
        return theta * (1 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4))));
    }
    Vec2d fisheye(Vec2d p) const {
        const double r = std::sqrt(p.x * p.x + p.y * p.y);
        if (r < 1e-12) return p;
        const double scale = fisheye_radius(std::atan(r)) / r;
        return {p.x * scale, p.y * scale};
    }
    // The plane z = 1 cannot show directions at 90 degrees or more; they become 89.99 degrees.
    Vec2d from_fisheye(Vec2d q) const {
        const double radius = std::sqrt(q.x * q.x + q.y * q.y);
        if (radius < 1e-12) return q;
        double theta = radius;
        for (int step = 0; step < 12; ++step) {
            const double t2 = theta * theta;
            const double slope = 1 + t2 * (3 * k1 + t2 * (5 * k2 + t2 * (7 * k3 + t2 * 9 * k4)));
            if (!(std::abs(slope) > 1e-12)) break;
            theta -= (fisheye_radius(theta) - radius) / slope;
        }
        constexpr double kMax_rad = 1.5706217938697063;
        const double scale = std::tan(theta < kMax_rad ? theta : kMax_rad) / radius;
        return {q.x * scale, q.y * scale};
    }
};

struct ImageGeometry {
    int width_px = 0;
    int height_px = 0;
    int guard_px = 0;            // on each side
    double focal_length_px = 0;  // focal length / pixel pitch
    LensDistortion distortion;
    Vec2d principal_offset_px{};  // from the image's middle to the place where the boresight meets it

    Vec2d center_px() const {
        return {0.5 * width_px + principal_offset_px.x, 0.5 * height_px + principal_offset_px.y};
    }
    int padded_width() const { return width_px + 2 * guard_px; }
    int padded_height() const { return height_px + 2 * guard_px; }
    // Returns the direction of a place [px of the sensor frame], not normalised: z is 1, so that
    // interpolation and projection use the same plane.
    Vec3d direction_camera(double x_px, double y_px) const {
        const Vec2d center = center_px();
        Vec2d p{(x_px - center.x) / focal_length_px, (y_px - center.y) / focal_length_px};
        if (!distortion.none()) p = distortion.undistorted(p);
        return {p.x, p.y, 1.0};
    }
    // Returns where a direction with z > 0 meets the image [px of the sensor frame].
    Vec2d project_px(Vec3d direction_camera) const {
        Vec2d p{direction_camera.x / direction_camera.z, direction_camera.y / direction_camera.z};
        if (!distortion.none()) p = distortion.distorted(p);
        const Vec2d center = center_px();
        return {center.x + focal_length_px * p.x, center.y + focal_length_px * p.y};
    }
    // True when the lens really shows the direction (z > 0) at the place that project_px() gives. Far outside
    // the field a distortion polynomial folds over and may even return a place inside the picture.
    bool shows(Vec3d dir, Vec2d place_px) const {
        if (distortion.none()) return true;
        constexpr double kSame_rad = 1e-6;
        const Vec3d back = normalized(direction_camera(place_px.x, place_px.y));
        return length(cross(normalized(dir), back)) < kSame_rad;
    }
};

// Returns the geometry with `times` as many pixels in each direction.
inline ImageGeometry scaled(const ImageGeometry& geometry, int times) {
    ImageGeometry out = geometry;
    out.width_px *= times, out.height_px *= times, out.guard_px *= times, out.focal_length_px *= times;
    out.principal_offset_px = {times * geometry.principal_offset_px.x,
                               times * geometry.principal_offset_px.y};
    return out;
}

}  // namespace hilcam
