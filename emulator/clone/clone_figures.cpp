#include "emulator/clone/clone_figures.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// The spread of the dark currents over their mean.
std::optional<Measured> dark_spread(const CloneMeasurement& m) {
    if (!m.dark_spread_e_s || !m.dark_current_e_s ||
        m.dark_current_e_s->value < 5 * m.dark_current_e_s->uncertainty)
        return std::nullopt;
    const Measured& spread = m.dark_spread_e_s->pixel;
    const Measured& mean = *m.dark_current_e_s;
    const double ratio = spread.value / mean.value;
    return Measured{ratio,
                    std::hypot(spread.uncertainty / mean.value, ratio * mean.uncertainty / mean.value)};
}

std::optional<Measured> scaled(const std::optional<Measured>& m, double factor) {
    return m ? std::optional<Measured>({m->value * factor, m->uncertainty * factor}) : std::nullopt;
}

// The figures of the lens and of lag, which other series than darks and flats show.
std::vector<CloneFigure> optics_figures(const CloneOptics& o, const CameraModel& like) {
    const auto of_lens = [&](Measured LensCalibration::*part) {
        return o.lens ? std::optional<Measured>((*o.lens).*part) : std::nullopt;
    };
    const auto term = [&](std::optional<Measured> LensCalibration::*part) {
        return o.lens ? (*o.lens).*part : std::nullopt;
    };
    const char* no_board = "no chessboard";
    const char* no_term = o.lens ? "the boards do not show it: 0" : no_board;
    const auto coefficient = [&](std::size_t i) {
        return like.distortion.size() > i ? like.distortion[i] : 0;
    };
    const bool given = like.principal_point_px.size() == 2;
    const auto axis = [&](std::size_t i, std::int64_t size_px) {
        return given ? like.principal_point_px[i] : 0.5 * static_cast<double>(size_px);
    };
    const auto blur = [&](BlurKind kind, double unit_m) {
        const bool seen = o.blur && o.blur->kind == kind && !o.blur->zones.empty();
        return seen ? scaled(o.blur->zones.front().blur_m, 1 / unit_m) : std::nullopt;
    };
    const char* other_blur = "an error of the other kind describes the edges";
    const auto why_no_blur = [&](BlurKind kind) {
        return !o.blur ? "no edge" : o.blur->kind == kind ? "" : other_blur;
    };
    return {
        {"focal_length_mm", "Focal length", "mm",
         scaled(of_lens(&LensCalibration::focal_length_px), like.pitch_m * 1e3), like.focal_length_m * 1e3,
         no_board},
        {"principal_point_x_px", "Principal point x", "px", of_lens(&LensCalibration::principal_x_px),
         axis(0, like.width_px), no_board},
        {"principal_point_y_px", "Principal point y", "px", of_lens(&LensCalibration::principal_y_px),
         axis(1, like.height_px), no_board},
        {"distortion_k1", "Distortion k1", "", term(&LensCalibration::k1), coefficient(0), no_term},
        {"distortion_k2", "Distortion k2", "", term(&LensCalibration::k2), coefficient(1), no_term},
        {"distortion_p1", "Distortion p1", "", term(&LensCalibration::p1), coefficient(2), no_term},
        {"distortion_p2", "Distortion p2", "", term(&LensCalibration::p2), coefficient(3), no_term},
        {"distortion_k3", "Distortion k3", "", term(&LensCalibration::k3), coefficient(4), no_term},
        {"wavefront_rms_nm", "Wavefront error, innermost", "nm", blur(BlurKind::kWavefront, 1e-9),
         like.wavefront_rms_m * 1e9, why_no_blur(BlurKind::kWavefront)},
        {"defocus_um", "Defocus, innermost", "um", blur(BlurKind::kDefocus, 1e-6), like.defocus_m * 1e6,
         why_no_blur(BlurKind::kDefocus)},
        {"lag_fraction", "Lag in the next frame", "",
         o.lag ? std::optional<Measured>(o.lag->left.front()) : std::nullopt, 0, "no series of lag"},
    };
}

const char* why_no_bend(const CloneMeasurement& m) {
    return m.light_known ? "fewer than six levels below saturation" : "the light of the levels is not stated";
}

}  // namespace

std::vector<CloneFigure> clone_figures(const CloneMeasurement& m, const CameraModel& like) {
    const auto bend = [&](Measured Bend::*part) {
        return m.nonlinearity ? std::optional<Measured>((*m.nonlinearity).*part) : std::nullopt;
    };
    const auto coefficient = [&](std::size_t i) {
        return like.nonlinearity.size() > i ? like.nonlinearity[i] : 0;
    };
    const FixedPatternConfig& f = like.fixed_pattern;
    const double gain_at_0_db = std::pow(10, -m.gain_db / 20);
    const Measured gain{m.gain_dn_e.value * gain_at_0_db, m.gain_dn_e.uncertainty * gain_at_0_db};
    std::vector<CloneFigure> out = {
        {"gain_dn_e", "System gain K", "DN/e-", gain, like.system_gain_dn_e(0), ""},
        {"offset_dn", "Black level", "DN", m.offset_dn, like.offset_dn, ""},
        {"read_noise_e", "Read noise of a pixel", "e-", m.read_noise_e,
         std::sqrt(std::max(0.0, std::pow(like.dark_noise_e(), 2) - std::pow(like.row_noise_e, 2))), ""},
        {"row_noise_e", "Noise common to a row", "e-", m.row_noise_e, like.row_noise_e, ""},
        {"column_noise_e", "Noise common to a column", "e-", m.column_noise_e, 0, ""},
        {"dark_current_e_s", fmt::format("Dark current at {:g} C", m.temperature_c), "e-/s",
         m.dark_current_e_s, like.dark_current_e_s, "darks of one exposure"},
        {"dark_doubling_k", "Doubling temperature", "K", m.dark_doubling_k, like.dark_doubling_k,
         "fewer than two temperatures with a dark current that is seen"},
        {"full_well_e", "Full well", "e-", m.full_well_e, like.full_well_e,
         m.full_well_at_least_e > 0
             ? fmt::format("no flat beyond it; at least {:.4g} e-", m.full_well_at_least_e)
             : "no flat beyond it"},
        {"nonlinearity_a2", "Bend a2", "", bend(&Bend::a2), coefficient(0), why_no_bend(m)},
        {"nonlinearity_a3", "Bend a3", "", bend(&Bend::a3), coefficient(1), why_no_bend(m)},
        {"prnu_fraction", "PRNU of pixels", "", m.prnu_fraction.pixel, like.prnu_fraction, ""},
        {"column_gain_fraction", "PRNU of columns", "", m.prnu_fraction.column, f.column_gain_fraction, ""},
        {"dsnu_e", "DSNU of pixels", "e-", m.dsnu_e.pixel, like.dsnu_e, ""},
        {"row_e", "DSNU of rows", "e-", m.dsnu_e.row, f.row_e, ""},
        {"column_e", "DSNU of columns", "e-", m.dsnu_e.column, f.column_e, ""},
        {"dark_current_fraction", "Spread of dark currents", "", dark_spread(m), f.dark_current_fraction,
         "the dark current is not seen"},
    };
    const std::vector<CloneFigure> optics = optics_figures(m.optics, like);
    out.insert(out.end(), optics.begin(), optics.end());
    return out;
}

const CloneFigure& figure_of(const std::vector<CloneFigure>& figures, const char* key) {
    const auto found =
        std::find_if(figures.begin(), figures.end(), [&](const CloneFigure& f) { return f.key == key; });
    HILCAM_CHECK(found != figures.end());
    return *found;
}

}  // namespace hilcam
