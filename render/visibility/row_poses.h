#pragma once
// The camera's poses for the visibility buffer when rows have different instants: at each row of the picture,
// and at the edges of the buffer's rows of tiles, between which a tile interpolates linearly.
//
// Poses are given as axes and as the displacement from the camera's position at the frame's time. place() is
// for the loop, the rest for any thread.

#include <cstddef>
#include <vector>

#include "render/visibility/visibility_samples.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/row_motion.h"

namespace hilcam {

class RowPoses {
  public:
    struct At {
        Mat3d world_from_camera;
        Vec3d moved_m;
    };

    // Allocates for a buffer with this many rows of pixels.
    explicit RowPoses(int height_px);

    // buffer: its geometry. buffer_px: pixels of the buffer per pixel of the picture. Returns false if the
    // camera turns by more than kMaxHalfTurn_rad from the picture's middle to its upper or lower edge.
    bool place(const RowMotion& motion, const ImageGeometry& buffer, int buffer_px);

    // y_px: row of the buffer.
    const At& of_row(int y_px) const { return rows_[static_cast<std::size_t>(y_px / buffer_px_)]; }
    // Poses at the upper and lower edge of the tiles that start at y_px.
    const At& upper_edge(int y_px) const {
        return edges_[static_cast<std::size_t>(y_px / kVisibilityTile_px)];
    }
    const At& lower_edge(int y_px) const { return (&upper_edge(y_px))[1]; }
    // Poses at the upper and lower edge of the picture.
    const At& first() const { return first_; }
    const At& last() const { return last_; }
    // The camera's rotation and displacement from the picture's middle to its edge.
    double half_turn_rad() const { return half_turn_rad_; }
    double half_way_m() const { return half_way_m_; }

    static constexpr double kMaxHalfTurn_rad = 0.2;

  private:
    int buffer_px_ = 1;
    std::vector<At> rows_, edges_;
    At first_, last_;
    double half_turn_rad_ = 0, half_way_m_ = 0;
};

}  // namespace hilcam
