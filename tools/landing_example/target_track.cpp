#include "tools/landing_example/target_track.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace flight {
namespace {

cv::Mat as_floats(const cv::Mat& frame) {
    cv::Mat out;
    frame.convertTo(out, CV_32F);
    return out;
}

// A square about a place, which may lie between pixels; what is beside the picture is the edge's.
cv::Mat square_about(const cv::Mat& image, const cv::Vec2d& at_px, int half_px, double scale) {
    const double size = 2 * half_px + 1;
    const cv::Matx23d to_source(scale, 0, at_px[0] - scale * half_px, 0, scale, at_px[1] - scale * half_px);
    cv::Mat out;
    cv::warpAffine(image, out, to_source, cv::Size(static_cast<int>(size), static_cast<int>(size)),
                   cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
    return out;
}

// The top of a parabola through three neighbours, from the middle one.
double top_of(double before, double middle, double after) {
    const double curve = before - 2 * middle + after;
    return curve < 0 ? 0.5 * (before - after) / curve : 0;
}

}  // namespace

void TargetTrack::begin(const cv::Mat& frame, const cv::Vec2d& at_px, double height_m) {
    patch_ = as_floats(frame), within_px_ = at_px, height_m_ = height_m;
}

std::optional<cv::Vec2d> TargetTrack::follow(const cv::Mat& frame, const cv::Vec2d& expected_px,
                                             double height_m) {
    // The picture before, as large as things are in this one.
    const cv::Mat patch = square_about(patch_, within_px_, kHalf_px, height_m / height_m_);
    const cv::Mat now = as_floats(frame);
    const cv::Mat field = square_about(now, expected_px, kHalf_px + kSearch_px, 1);
    cv::Mat score;
    cv::matchTemplate(field, patch, score, cv::TM_CCOEFF_NORMED);
    cv::Point best;
    cv::minMaxLoc(score, nullptr, &likeness_, nullptr, &best);
    if (!(likeness_ > kMinLikeness)) return {};
    cv::Vec2d off_px(best.x - kSearch_px, best.y - kSearch_px);
    if (best.x > 0 && best.x + 1 < score.cols && best.y > 0 && best.y + 1 < score.rows) {
        const auto at = [&](int x, int y) {
            return static_cast<double>(score.at<float>(best.y + y, best.x + x));
        };
        off_px += cv::Vec2d(top_of(at(-1, 0), at(0, 0), at(1, 0)), top_of(at(0, -1), at(0, 0), at(0, 1)));
    }
    const cv::Vec2d found_px = expected_px + off_px;
    patch_ = now, within_px_ = found_px, height_m_ = height_m;
    return found_px;
}

}  // namespace flight
