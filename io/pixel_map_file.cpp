#include "io/pixel_map_file.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "render/check.h"

namespace hilcam {

PixelMap read_pixel_map(const std::filesystem::path& file, bool any_sign) {
    cv::Mat picture;
    try {
        picture = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
    }
    if (picture.empty())
        throw InputError(file.string() + ": is missing or does not decode; accepted: TIFF, PNG");
    if (picture.channels() != 1)
        throw InputError(file.string() + ": has " + std::to_string(picture.channels()) +
                         " channels; accepted: one");
    cv::Mat numbers;
    picture.convertTo(numbers, CV_32F);
    PixelMap map(numbers.cols, numbers.rows);
    for (int y = 0; y < numbers.rows; ++y) {
        std::copy_n(numbers.ptr<float>(y), numbers.cols, map.row(y).begin());
        for (std::size_t x = 0; x < map.row(y).size(); ++x) {
            const float value = map.row(y)[x];
            if (std::isfinite(value) && (any_sign || value >= 0)) continue;
            throw InputError(file.string() + ": pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                             ") is " + std::to_string(value) + "; accepted: finite" +
                             (any_sign ? "" : ", not negative"));
        }
    }
    return map;
}

DetectorPictures load_detector_pictures(const CameraModel& camera) {
    const FixedPatternConfig& config = camera.fixed_pattern;
    DetectorPictures out;
    if (!config.prnu_map.empty()) out.prnu = read_pixel_map(config.prnu_map, false);
    if (!config.offset_map.empty()) out.offset_e = read_pixel_map(config.offset_map, true);
    if (!config.dark_map.empty()) out.dark_e_s = read_pixel_map(config.dark_map, false);
    return out;
}

}  // namespace hilcam
