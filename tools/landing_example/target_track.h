#pragma once
// Follows a place of the ground from picture to picture: the patch about it, scaled as the camera comes nearer, is looked for where it
// should be, by normalised correlation. Each picture is compared with the one before, so that the patch stays sharp.

#include <opencv2/core.hpp>
#include <optional>

namespace flight {

class TargetTrack {
  public:
    // frame: one channel of 16 bits; height_m: of the camera over the ground.
    void begin(const cv::Mat& frame, const cv::Vec2d& at_px, double height_m);
    bool begun() const { return !patch_.empty(); }
    // Finds the place in the next picture, near where it is expected. None: it is not to be recognised; the picture before stays.
    std::optional<cv::Vec2d> follow(const cv::Mat& frame, const cv::Vec2d& expected_px, double height_m);
    // The correlation of the last match, 1 at most.
    double likeness() const { return likeness_; }

  private:
    static constexpr int kHalf_px = 32, kSearch_px = 14;
    static constexpr double kMinLikeness = 0.5;
    cv::Mat patch_;        // the picture before
    cv::Vec2d within_px_;  // where the place was in it
    double height_m_ = 0, likeness_ = 0;
};

}  // namespace flight
