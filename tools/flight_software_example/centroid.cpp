#include "tools/flight_software_example/centroid.h"

#include <opencv2/imgproc.hpp>
#include <vector>

namespace flight {
namespace {

struct Sky {
    double level_dn = 0, noise_dn = 0;
};

// Of the border, without what stands out there: mean and deviation again of what lies within three of them.
Sky measure_sky(const cv::Mat& frame, int border_px) {
    cv::Mat border(frame.size(), CV_8U, cv::Scalar(255));
    border(cv::Rect(border_px, border_px, frame.cols - 2 * border_px, frame.rows - 2 * border_px)) = 0;
    cv::Scalar mean, deviation;
    cv::meanStdDev(frame, mean, deviation, border);
    cv::Mat usual;
    cv::inRange(frame, mean[0] - 3 * deviation[0], mean[0] + 3 * deviation[0], usual);
    cv::meanStdDev(frame, mean, deviation, usual & border);
    return {mean[0], deviation[0]};
}

struct Group {
    double light = 0, x = 0, y = 0;
    int bright = 0;
};

}  // namespace

std::optional<Centroid> find_target(const cv::Mat& frame, const CentroidOptions& o) {
    CV_Assert(frame.type() == CV_16U && std::min(frame.rows, frame.cols) > 2 * o.border_px);
    const Sky sky = measure_sky(frame, o.border_px);
    cv::Mat bright, near, labels;
    cv::compare(frame, sky.level_dn + o.threshold_sigma * sky.noise_dn, bright, cv::CMP_GT);
    const int across = 2 * o.join_px + 1;
    cv::dilate(bright, near, cv::getStructuringElement(cv::MORPH_ELLIPSE, {across, across}));
    std::vector<Group> groups(static_cast<std::size_t>(cv::connectedComponents(near, labels, 8, CV_32S)));
    for (int y = 0; y < frame.rows; ++y)
        for (int x = 0; x < frame.cols; ++x) {
            const int label = labels.at<int>(y, x);
            if (label == 0) continue;  // the sky
            Group& g = groups[static_cast<std::size_t>(label)];
            const double light = frame.at<std::uint16_t>(y, x) - sky.level_dn;
            g.light += light, g.x += light * x, g.y += light * y;
            g.bright += bright.at<std::uint8_t>(y, x) != 0;
        }
    const Group* target = nullptr;
    for (const Group& g : groups)
        if (g.bright >= o.least_px && (!target || g.light > target->light)) target = &g;
    if (!target) return {};
    return Centroid{{target->x / target->light, target->y / target->light}, target->light, target->bright};
}

}  // namespace flight
