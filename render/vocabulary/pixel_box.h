#pragma once
// A rectangle of pixels.

namespace hilcam {

// x1 and y1 are excluded. Padded pixels: (0, 0) is the corner of the guard band.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    bool empty() const { return x0 >= x1 || y0 >= y1; }
    bool overlaps(const PixelBox& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

}  // namespace hilcam
