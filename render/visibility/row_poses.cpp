#include "render/visibility/row_poses.h"

namespace hilcam {
namespace {

std::size_t tile_rows(int height_px) {
    return static_cast<std::size_t>((height_px + kVisibilityTile_px - 1) / kVisibilityTile_px);
}

}  // namespace

RowPoses::RowPoses(int height_px)
    : rows_(tile_rows(height_px) * kVisibilityTile_px), edges_(tile_rows(height_px) + 1) {}

bool RowPoses::place(const RowMotion& motion, const ImageGeometry& buffer, int buffer_px) {
    buffer_px_ = buffer_px;
    const double guard_px = static_cast<double>(buffer.guard_px) / buffer_px;
    // y_px: down the padded picture.
    const auto at = [&](double y_px) {
        const Pose pose = motion.pose_at(y_px - guard_px);
        return At{to_matrix(pose.world_from_body),
                  pose.position_world_m - motion.camera.pose.position_world_m};
    };
    const double height_px = static_cast<double>(buffer.padded_height()) / buffer_px;
    const double half_s = 0.5 * height_px * motion.line_time_s;
    half_turn_rad_ = half_s * length(motion.camera.rate_body_rad_s);
    half_way_m_ = half_s * length(motion.camera.velocity_world_m_s);
    if (!(half_turn_rad_ <= kMaxHalfTurn_rad)) return false;
    const std::size_t rows =
        tile_rows(buffer.padded_height()) * kVisibilityTile_px / static_cast<std::size_t>(buffer_px);
    for (std::size_t row = 0; row < rows; ++row) rows_[row] = at(static_cast<double>(row) + 0.5);
    for (std::size_t edge = 0; edge < edges_.size(); ++edge)
        edges_[edge] = at(static_cast<double>(edge) * kVisibilityTile_px / buffer_px);
    first_ = at(0), last_ = at(height_px);
    return true;
}

}  // namespace hilcam
