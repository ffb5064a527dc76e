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
    return {
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
}

const CloneFigure& figure_of(const std::vector<CloneFigure>& figures, const char* key) {
    const auto found =
        std::find_if(figures.begin(), figures.end(), [&](const CloneFigure& f) { return f.key == key; });
    HILCAM_CHECK(found != figures.end());
    return *found;
}

}  // namespace hilcam
