#include "emulator/clone/clone_optics.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/clone/clone_measurement.h"
#include "emulator/clone/edge_pieces.h"
#include "emulator/clone/series_stack.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kMostSaturated = 1e-3;  // share of numbers at the converter's end

class OpticsLaboratory {
  public:
    OpticsLaboratory(const FrameSet& frames, const CameraModel& like, const CloneMeasurement& clone)
        : frames_(frames),
          like_(like),
          clone_(clone),
          camera_(like),
          planes_(color_planes(like, frames.width, frames.height)) {
        if (clone.full_well_e || clone.full_well_at_least_e > camera_.full_well_e)
            camera_.full_well_e = clone.full_well_e ? clone.full_well_e->value : clone.full_well_at_least_e;
        if (clone.nonlinearity)
            camera_.nonlinearity = {clone.nonlinearity->a2.value, clone.nonlinearity->a3.value};
    }

    CloneOptics measure() {
        CloneOptics out;
        for (const FrameSeries& s : frames_.others) {
            if (s.kind == SeriesKind::kLag) {
                if (out.lag) refuse_second(s);
                out.lag = image_lag(means(s), s.name);
            } else if (s.kind == SeriesKind::kChessboard) {
                if (out.lens) refuse_second(s);
                out.lens = calibrate_lens(frames_, s, like_, [this](const FrameSeries& of, std::size_t i) {
                    return even_board(one_frame(of, i));
                });
            }
        }
        std::vector<PlacedPiece> pieces;
        for (const FrameSeries& s : frames_.others)
            if (s.kind == SeriesKind::kEdge)
                for (EdgePiece& piece : measure_edge(s))
                    pieces.push_back({field_fraction(piece.place_px, out.lens), std::move(piece)});
        if (!pieces.empty()) {
            if (out.lens)  // the aperture is the same, so diffraction depends on the f-number alone
                camera_.focal_length_m = out.lens->focal_length_px.value * camera_.pitch_m;
            out.blur = fit_lens_blur(camera_, pieces);
        }
        return out;
    }

  private:
    [[noreturn]] static void refuse_second(const FrameSeries& s) {
        throw InputError(s.name +
                         ": found a second series of this kind; accepted: one, of one board with one number "
                         "of corners, and one of lag");
    }
    void refuse_saturated(const FrameSeries& s, const DnImage& frame) const {
        const int end = (1 << frames_.bits) - 1;
        const auto at_end =
            std::count_if(frame.all().begin(), frame.all().end(), [&](auto dn) { return dn >= end; });
        const double share = static_cast<double>(at_end) / static_cast<double>(frame.pixels());
        if (share > kMostSaturated)
            throw InputError(
                fmt::format("{}: found {:.1f} % of the numbers at the converter's end; accepted: a "
                            "shorter exposure, without saturated pixels",
                            s.name, 100 * share));
    }
    DnImage one_frame(const FrameSeries& s, std::size_t i) const {
        DnImage frame(frames_.width, frames_.height);
        s.read(i, frame);
        return frame;
    }
    // Returns the charge of a pixel, without its own offset and gain.
    double charge_e(double dn, std::size_t pixel) const {
        const double read_e =
            (dn - clone_.offset_dn.value) / clone_.gain_dn_e.value - clone_.offset_e.value[pixel];
        const double e = read_e > 0 ? camera_.charge_of_read_e(read_e) : read_e;
        return e / clone_.gain.value[pixel];
    }

    // --- lag

    std::vector<double> means(const FrameSeries& s) const {
        std::vector<double> out;
        for (std::size_t i = 0; i < s.frames; ++i) {
            const DnImage frame = one_frame(s, i);
            refuse_saturated(s, frame);
            double sum = 0;
            for (std::size_t p = 0; p < frame.pixels(); ++p)
                if (clone_.good.use[p]) sum += frame.all()[p];
            const double dn = sum / static_cast<double>(clone_.good.count());
            const double read_e = (dn - clone_.offset_dn.value) / clone_.gain_dn_e.value;
            out.push_back(read_e > 0 ? camera_.charge_of_read_e(read_e) : read_e);
        }
        return out;
    }

    // --- chessboard

    // Each colour plane becomes as bright as the others, and defects take their neighbour's number.
    std::vector<double> even_board(const DnImage& frame) const {
        std::vector<double> out(frame.all().begin(), frame.all().end());
        for (double& value : out) value -= clone_.offset_dn.value;
        for (const PixelSelection& plane : planes_) {
            double sum = 0;
            for (std::size_t p = 0; p < out.size(); ++p)
                if (plane.use[p]) sum += out[p] / static_cast<double>(plane.count());
            for (std::size_t p = 0; p < out.size() && sum > 0; ++p)
                if (plane.use[p]) out[p] /= sum;
        }
        for (std::size_t p = 1; p < out.size(); ++p)
            if (!clone_.good.use[p]) out[p] = out[p - 1];
        return out;
    }

    // --- edges

    std::vector<EdgePiece> measure_edge(const FrameSeries& s) const {
        std::vector<double> mean(static_cast<std::size_t>(frames_.width) *
                                 static_cast<std::size_t>(frames_.height));
        for (std::size_t i = 0; i < s.frames; ++i) {
            const DnImage frame = one_frame(s, i);
            refuse_saturated(s, frame);
            for (std::size_t p = 0; p < mean.size(); ++p)
                mean[p] += frame.all()[p] / static_cast<double>(s.frames);
        }
        const PixelSelection use = largest_plane(clone_.good, like_);
        double most = 0;
        for (std::size_t p = 0; p < mean.size(); ++p) {
            mean[p] = use.use[p] ? charge_e(mean[p], p) : 0;
            most = std::max(most, mean[p]);
        }
        const double noise_e =
            std::sqrt((most + square(clone_.read_noise_e.value)) / static_cast<double>(s.frames));
        return measure_edge_pieces({frames_.width, frames_.height, mean, use.use, noise_e}, s.name);
    }
    // Image height over that of the sensor's farthest corner, as the camera's field_zones count.
    double field_fraction(Vec2d place, const std::optional<LensCalibration>& lens) const {
        Vec2d center{0.5 * frames_.width, 0.5 * frames_.height};
        if (like_.principal_point_px.size() == 2)
            center = {like_.principal_point_px[0], like_.principal_point_px[1]};
        if (lens) center = {lens->principal_x_px.value, lens->principal_y_px.value};
        double corner = 0;
        for (const double x : {0.0, 1.0 * frames_.width})
            for (const double y : {0.0, 1.0 * frames_.height})
                corner = std::max(corner, std::hypot(x - center.x, y - center.y));
        return std::min(1.0, std::hypot(place.x - center.x, place.y - center.y) / corner);
    }

    const FrameSet& frames_;
    const CameraModel& like_;
    const CloneMeasurement& clone_;
    CameraModel camera_;  // the sheet, with the measured response
    std::vector<PixelSelection> planes_;
};

}  // namespace

CloneOptics measure_optics(const FrameSet& frames, const CameraModel& like, const CloneMeasurement& clone) {
    return OpticsLaboratory(frames, like, clone).measure();
}

}  // namespace hilcam
