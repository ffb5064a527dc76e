#include "emulator/clone/lens_calibration.h"

#include <spdlog/fmt/fmt.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "emulator/run/run_helper.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kFewestBoards = 5;
constexpr double kWorstFocal = 0.02, kWorstResidual_px = 1;

class WorkFolder {
  public:
    WorkFolder() {
        std::string name = (fs::temp_directory_path() / "hilcam-boards-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw DeviceError(name + ": cannot be made: " + std::strerror(errno));
        path_ = name;
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder() {
        std::error_code error;
        fs::remove_all(path_, error);
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

// Writes the numbers as bytes; the brightest half percent becomes white.
void write_picture(const fs::path& file, const std::vector<double>& values) {
    std::vector<double> sorted = values;
    const auto at = [&](double share) {
        const auto place =
            sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
        std::nth_element(sorted.begin(), place, sorted.end());
        return *place;
    };
    const double black = at(0.005), white = at(0.995);
    std::string bytes;
    bytes.reserve(values.size());
    for (const double value : values)
        bytes.push_back(static_cast<char>(static_cast<unsigned char>(
            std::lround(255 * std::clamp((value - black) / std::max(white - black, 1e-9), 0.0, 1.0)))));
    std::ofstream out(file, std::ios::binary);
    out << bytes;
    out.close();
    if (!out) throw DeviceError(file.string() + ": cannot be written");
}

json run_calibration(const FrameSet& frames, const FrameSeries& series, const LinearFrame& linear) {
    const WorkFolder folder;
    const fs::path answer = folder.path() / "answer.json";
    std::vector<std::string> arguments = {std::to_string(frames.width), std::to_string(frames.height),
                                          std::to_string(series.corner_columns),
                                          std::to_string(series.corner_rows), answer.string()};
    for (std::size_t i = 0; i < series.frames; ++i) {
        const fs::path file = folder.path() / fmt::format("{}.gray", i);
        write_picture(file, linear(series, i));
        arguments.push_back(file.string());
    }
    if (run_helper("hilcam-calibrate-lens", arguments, "no lens is calibrated") != 0)
        throw DeviceError("hilcam-calibrate-lens failed (see above): no lens is calibrated");
    std::ifstream in(answer);
    return json::parse(in);
}

void refuse_frame(const FrameSeries& s, const json& out) {
    if (!out.contains("refused")) return;
    const std::string why = out.at("why").get<std::string>();
    throw InputError(
        fmt::format("{}: found {}; accepted: the whole of a chessboard with {} x {} inner corners and "
                    "a white border around it, in focus",
                    s.files.at(out.at("refused").get<std::size_t>()), why, s.corner_columns, s.corner_rows));
}

}  // namespace

LensCalibration calibrate_lens(const FrameSet& frames, const FrameSeries& series, const CameraModel& like,
                               const LinearFrame& linear) {
    if (like.projection != Projection::kRectilinear)
        throw InputError(series.name +
                         ": found projection fisheye in the camera of --like; accepted: chessboards for "
                         "rectilinear lenses");
    if (series.frames < kFewestBoards)
        throw InputError(
            fmt::format("{}: found {} pictures; accepted: at least {} poses of the board, 15 are usual",
                        series.name, series.frames, kFewestBoards));
    const json out = run_calibration(frames, series, linear);
    refuse_frame(series, out);
    LensCalibration c;
    c.boards = series.frames;
    c.residual_px = out.at("residual_px").get<double>();
    if (!(c.residual_px < kWorstResidual_px))
        throw InputError(
            fmt::format("{}: found corners that are {:.2g} px from those of a plane board; accepted: "
                        "below {:g} px, a stiff board and one lens setting for all pictures",
                        series.name, c.residual_px, kWorstResidual_px));
    c.focal_length_px = {out.at("f").get<double>(), out.at("f_error").get<double>()};
    if (!(c.focal_length_px.uncertainty < kWorstFocal * c.focal_length_px.value))
        throw InputError(fmt::format(
            "{}: found a focal length of {:.0f} +- {:.0f} px; accepted: poses that show it "
            "within {:g} %: turn the board by 20 to 45 degrees in several directions",
            series.name, c.focal_length_px.value, c.focal_length_px.uncertainty, 100 * kWorstFocal));
    const auto center = out.at("center").get<std::array<double, 2>>(),
               center_error = out.at("center_error").get<std::array<double, 2>>();
    // OpenCV has the centre of the first pixel at 0.
    c.principal_x_px = {center[0] + 0.5, center_error[0]},
    c.principal_y_px = {center[1] + 0.5, center_error[1]};
    const auto k = out.at("k").get<std::array<double, 5>>(),
               error = out.at("k_error").get<std::array<double, 5>>();
    const std::array<std::optional<Measured>*, 5> terms = {&c.k1, &c.k2, &c.p1, &c.p2, &c.k3};
    for (std::size_t i = 0; i < terms.size(); ++i)
        if (error[i] > 0) *terms[i] = Measured{k[i], error[i]};
    const double corner = std::hypot(0.5 * frames.width, 0.5 * frames.height);
    c.field_fraction = out.at("reach_px").get<double>() / corner;
    return c;
}

}  // namespace hilcam
