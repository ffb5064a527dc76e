#include "emulator/tradeoff/structural_similarity.h"

#include <opencv2/imgproc.hpp>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr int kWindow_px = 11;

cv::Mat as_doubles(const ElectronImage& image) {
    // OpenCV takes no pointer to const; it is only read.
    const cv::Mat view(image.height(), image.width(), CV_32F, const_cast<float*>(image.data()));
    cv::Mat out;
    view.convertTo(out, CV_64F);
    return out;
}

// The window's weighted mean about every place where it fits.
cv::Mat windowed(const cv::Mat& image) {
    constexpr double kSigma_px = 1.5;
    cv::Mat all;
    cv::GaussianBlur(image, all, {kWindow_px, kWindow_px}, kSigma_px);
    constexpr int kEdge = kWindow_px / 2;
    return all(cv::Rect(kEdge, kEdge, image.cols - 2 * kEdge, image.rows - 2 * kEdge)).clone();
}

}  // namespace

std::optional<double> structural_similarity(const ElectronImage& a, const ElectronImage& b, double range_e) {
    HILCAM_CHECK(a.width() == b.width() && a.height() == b.height());
    if (a.width() < kWindow_px || a.height() < kWindow_px) return std::nullopt;
    const double c1 = 1e-4 * range_e * range_e, c2 = 9e-4 * range_e * range_e;
    const cv::Mat x = as_doubles(a), y = as_doubles(b);
    const cv::Mat mean_x = windowed(x), mean_y = windowed(y);
    const cv::Mat xx = mean_x.mul(mean_x), yy = mean_y.mul(mean_y), xy = mean_x.mul(mean_y);
    const cv::Mat variances = windowed(x.mul(x)) - xx + windowed(y.mul(y)) - yy;
    const cv::Mat covariance = windowed(x.mul(y)) - xy;
    const cv::Mat above = (2 * xy + c1).mul(2 * covariance + c2);
    const cv::Mat below = (xx + yy + c1).mul(variances + c2);
    return cv::mean(above / below)[0];
}

}  // namespace hilcam
