// hilcam-calibrate-lens: finds the corners of chessboards and calibrates a lens with OpenCV's calib3d, for
// `hilcam clone`, which starts it (emulator/clone/lens_calibration.h). Not useful by itself.
//
//     hilcam-calibrate-lens WIDTH HEIGHT COLUMNS ROWS ANSWER PICTURE...
//
// PICTURE: WIDTH x HEIGHT bytes. ANSWER: JSON; {"refused": N, "why": TEXT} when picture N shows no board.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace {

using Corners = std::vector<cv::Point2f>;

struct Refused {
    std::size_t picture;
    std::string why;
};

struct Request {
    cv::Size picture, board;
    std::string answer;
    std::vector<std::string> files;
};

cv::Mat read_picture(const std::string& file, cv::Size size) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.size() != static_cast<std::size_t>(size.area())) throw std::runtime_error(file + " is cut off");
    cv::Mat out(size, CV_8U);
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(out.data));
    return out;
}

// Returns the width of the change between two squares [px], from a tenth to nine tenths.
double blur_px(const cv::Mat& picture, cv::Size board, const Corners& corners) {
    return cv::estimateChessboardSharpness(picture, board, corners)[0];
}

double shortest_side_px(const Corners& corners) {
    double out = 1e9;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const cv::Point2f d = corners[i] - corners[i - 1];
        out = std::min(out, std::hypot(static_cast<double>(d.x), static_cast<double>(d.y)));
    }
    return out;
}

Corners find_corners(const Request& r, std::size_t i) {
    const cv::Mat picture = read_picture(r.files[i], r.picture);
    Corners out;
    if (!cv::findChessboardCornersSB(
            picture, r.board, out,
            cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY))
        throw Refused{i, "no such board"};
    constexpr double kMostBlur_px = 6;
    const double blur = blur_px(picture, r.board, out);
    if (blur > kMostBlur_px) {
        char text[80];
        std::snprintf(text, sizeof text, "squares whose borders are %.1f px wide", blur);
        throw Refused{i, text};
    }
    // Where gradients on both sides of a corner agree: several times as exact as what found it.
    const int reach = std::clamp(static_cast<int>(0.3 * shortest_side_px(out)), 2, 11);
    cv::cornerSubPix(picture, out, {reach, reach}, {-1, -1},
                     cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4));
    return out;
}

struct Calibration {
    double residual_px = 0;
    double f = 0, f_error = 0;
    std::array<double, 2> center{}, center_error{};
    std::array<double, 5> k{}, k_error{};  // k1 k2 p1 p2 k3
};

Calibration calibrate(const std::vector<Corners>& boards, const Request& r, int flags) {
    std::vector<cv::Point3f> plane;
    for (int y = 0; y < r.board.height; ++y)
        for (int x = 0; x < r.board.width; ++x)
            plane.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.f);
    const std::vector<std::vector<cv::Point3f>> planes(boards.size(), plane);
    cv::Mat camera = cv::Mat::eye(3, 3, CV_64F), terms = cv::Mat::zeros(1, 5, CV_64F), inside, outside, views;
    std::vector<cv::Mat> turns, places;
    Calibration out;
    // Square pixels: one focal length.
    out.residual_px =
        cv::calibrateCamera(planes, boards, r.picture, camera, terms, turns, places, inside, outside, views,
                            flags | cv::CALIB_FIX_ASPECT_RATIO,
                            cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-12));
    const auto error = [&](int i) { return inside.at<double>(i); };
    out.f = camera.at<double>(1, 1), out.f_error = std::max(error(0), error(1));
    for (int i = 0; i < 2; ++i) {
        out.center[static_cast<std::size_t>(i)] = camera.at<double>(i, 2);
        out.center_error[static_cast<std::size_t>(i)] = error(2 + i);
    }
    for (int i = 0; i < 5; ++i) {
        out.k[static_cast<std::size_t>(i)] = terms.at<double>(i);
        out.k_error[static_cast<std::size_t>(i)] = error(4 + i);
    }
    return out;
}

// Leaves out k3 unless the boards show it well: it turns a lens inside out beyond the last corner. Leaving out
// others would move k1 and the principal point, with which they go together, by more than the rest's errors.
Calibration calibrate_with_seen_terms(const std::vector<Corners>& boards, const Request& r) {
    const Calibration all = calibrate(boards, r, 0);
    constexpr std::size_t kK3 = 4;
    if (std::abs(all.k[kK3]) > 3 * all.k_error[kK3]) return all;
    Calibration out = calibrate(boards, r, cv::CALIB_FIX_K3);
    out.k_error[kK3] = 0;
    return out;
}

nlohmann::json answer(const Request& r) {
    std::vector<Corners> boards;
    for (std::size_t i = 0; i < r.files.size(); ++i) boards.push_back(find_corners(r, i));
    const Calibration c = calibrate_with_seen_terms(boards, r);
    double reach = 0;
    for (const Corners& board : boards)
        for (const cv::Point2f& p : board)
            reach = std::max(reach, std::hypot(static_cast<double>(p.x) - c.center[0],
                                               static_cast<double>(p.y) - c.center[1]));
    return {{"residual_px", c.residual_px},   {"f", c.f}, {"f_error", c.f_error}, {"center", c.center},
            {"center_error", c.center_error}, {"k", c.k}, {"k_error", c.k_error}, {"reach_px", reach}};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 7) {
        std::cerr << "hilcam-calibrate-lens: it is started by hilcam clone, which calibrates lenses by it\n";
        return 2;
    }
    const Request r{{std::atoi(argv[1]), std::atoi(argv[2])},
                    {std::atoi(argv[3]), std::atoi(argv[4])},
                    argv[5],
                    {argv + 6, argv + argc}};
    try {
        nlohmann::json out;
        try {
            out = answer(r);
        } catch (const Refused& refused) {
            out = {{"refused", refused.picture}, {"why", refused.why}};
        }
        std::ofstream file(r.answer);
        file << out;
        file.close();
        return file ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "hilcam-calibrate-lens: " << error.what() << "\n";
        return 1;
    }
}
