#include "io/images/view_picture.h"

#include <algorithm>
#include <cmath>

#include "io/system/wire_format.h"
#include "render/sky/sun.h"
#include "sensor/optics.h"

namespace hilcam {
namespace {

constexpr double kGamma = 2.2;
constexpr double kLit = 1.0 / 64, kMinSpan = 1.0 / 16, kWhiteShare = 0.995;

double linear_dn(std::size_t dn, const DnScale& scale) {
    if (!scale.square_root) return static_cast<double>(dn);
    const double root = static_cast<double>(dn) / 255;
    return root * root * scale.max_dn;
}

using CodeTable = std::vector<std::uint8_t>;

// Returns the code of each possible DN, amplified.
CodeTable code_table(const DnScale& scale, const ViewLevels& levels, double gain) {
    CodeTable table(65536);
    for (std::size_t dn = 0; dn < table.size(); ++dn) {
        const double light =
            gain * (linear_dn(dn, scale) - levels.black_dn) / (levels.white_dn - levels.black_dn);
        table[dn] =
            static_cast<std::uint8_t>(std::lround(255 * std::pow(std::clamp(light, 0.0, 1.0), 1 / kGamma)));
    }
    return table;
}

// Returns the electrons that pixels behind this filter collect from a white surface in sunlight.
double sunlit_electrons(const PictureRun& run, const ColorFilterConfig& filter) {
    const Spectrum response = electrons_per_s_per_irradiance(run.model, run.grid, &filter.transmission);
    const Spectrum sun = solar_irradiance_1au_w_m2_um(run.grid);
    double sum = 0;
    for (int b = 0; b < run.grid.size(); ++b)
        sum += static_cast<double>(response[b]) * static_cast<double>(sun[b]);
    return sum;
}

std::array<double, 3> balance_of(const PictureRun& run) {
    std::array<double, 3> collected = {0, 0, 0};
    const std::string letters = "RGB";
    for (const ColorFilterConfig& filter : run.model.color_filter.filters)
        if (const std::size_t i = letters.find(filter.name); i != std::string::npos)
            collected[i] = sunlit_electrons(run, filter);
    const double most = *std::max_element(collected.begin(), collected.end());
    std::array<double, 3> balance = {1, 1, 1};
    for (std::size_t i = 0; i < 3; ++i)
        if (collected[i] > 0) balance[i] = most / collected[i];
    return balance;
}

}  // namespace

PictureView::PictureView(const PictureRun& run) : model_(run.model), pattern_(bayer_pattern_of(run.model)) {
    if (!pattern_.empty()) balance_ = balance_of(run);
}

ViewLevels PictureView::levels_of(const DnImage& frame, const DnScale& scale) const {
    std::vector<std::uint32_t> counts(65536);
    for (const std::uint16_t dn : frame.plane(0)) ++counts[dn];
    const double full_span = std::max(1.0, scale.full_dn - scale.black_dn);
    std::uint64_t lit = 0;
    const auto is_lit = [&](std::size_t dn) {
        return linear_dn(dn, scale) > scale.black_dn + kLit * full_span;
    };
    for (std::size_t dn = 0; dn < counts.size(); ++dn)
        if (is_lit(dn)) lit += counts[dn];
    const auto rank = static_cast<std::uint64_t>(std::ceil(kWhiteShare * static_cast<double>(lit)));
    double white_dn = scale.black_dn;
    std::uint64_t below = 0;
    for (std::size_t dn = 0; dn < counts.size() && below < rank; ++dn) {
        if (!is_lit(dn)) continue;
        below += counts[dn];
        white_dn = linear_dn(dn, scale);
    }
    return {scale.black_dn,
            std::clamp(white_dn, scale.black_dn + kMinSpan * full_span, scale.black_dn + full_span)};
}

// Uses 4096 steps from black to saturation, because balanced colours are not integers; values above
// saturation count as saturated.
ViewLevels PictureView::levels_of_colors(const DnScale& scale) const {
    constexpr std::size_t kSteps = 4096;
    const double full_span = std::max(1.0, scale.full_dn - scale.black_dn);
    std::array<std::uint64_t, kSteps + 1> counts{};
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = c; i < colors_.size(); i += 3) {
            const double share = balance_[c] * (linear_dn(colors_[i], scale) - scale.black_dn) / full_span;
            if (share > kLit) ++counts[static_cast<std::size_t>(std::min(1.0, share) * kSteps)];
        }
    std::uint64_t lit = 0, below = 0;
    for (const std::uint64_t count : counts) lit += count;
    const auto rank = static_cast<std::uint64_t>(std::ceil(kWhiteShare * static_cast<double>(lit)));
    std::size_t step = 0;
    while (step < kSteps && below < rank) below += counts[step++];
    const double white = std::clamp(static_cast<double>(step) / kSteps, kMinSpan, 1.0);
    return {scale.black_dn, scale.black_dn + white * full_span};
}

PictureSamples PictureView::make(const DnImage& frame, const FrameRecord& record) {
    const Exposure exposure{record.exposure_s,
                            record.gain_db,
                            record.black_level_dn,
                            record.binning_x,
                            record.binning_y,
                            {},
                            {},
                            {}};
    const DnScale scale = dn_scale_of(model_, exposure);
    // A mirrored or binned frame has no mosaic with that pattern.
    const bool color = !pattern_.empty() && record.binning_x == 1 && record.binning_y == 1 &&
                       !record.reverse_x && !record.reverse_y;
    if (!color) {
        levels_ = levels_of(frame, scale);
        const CodeTable codes = code_table(scale, levels_, 1);
        samples_.resize(frame.pixels());
        std::transform(frame.plane(0).begin(), frame.plane(0).end(), samples_.begin(),
                       [&](std::uint16_t dn) { return codes[dn]; });
        return {samples_, frame.width(), frame.height(), SampleKind::kGray8};
    }
    colors_.resize(3 * frame.pixels());
    row_.resize(3 * static_cast<std::size_t>(frame.width()) + 8);
    interpolate_colors(frame, pattern_, row_, colors_);
    levels_ = levels_of_colors(scale);
    samples_.resize(colors_.size());
    for (std::size_t c = 0; c < 3; ++c) {
        const CodeTable codes = code_table(scale, levels_, balance_[c]);
        for (std::size_t i = c; i < colors_.size(); i += 3) samples_[i] = codes[colors_[i]];
    }
    return {samples_, frame.width(), frame.height(), SampleKind::kRgb8};
}

std::string PictureView::png(const DnImage& frame, const FrameRecord& record, PictureNotes notes) {
    const PictureSamples samples = make(frame, record);
    notes.push_back({"view_black_dn", "", levels_.black_dn, "DN that is shown as black"});
    notes.push_back({"view_white_dn", "", levels_.white_dn, "DN that is shown as white"});
    return encode_png(samples, {png_texts(notes), kGamma});
}

}  // namespace hilcam
