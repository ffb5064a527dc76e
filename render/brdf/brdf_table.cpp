#include "render/brdf/brdf_table.h"

#include <algorithm>
#include <cmath>

#include "render/brdf/microfacet.h"
#include "render/vocabulary/check.h"

namespace hilcam {

BrdfTable::BrdfTable(Layout layout, std::array<std::vector<float>, 3> axes_rad, std::vector<Spectrum> values)
    : layout_(layout), axes_rad_(std::move(axes_rad)), values_(std::move(values)) {
    HILCAM_CHECK(values_.size() == axes_rad_[0].size() * axes_rad_[1].size() * axes_rad_[2].size());
    fit_lobe();
}

Spectrum BrdfTable::interpolate(std::array<float, 3> at_rad) const {
    std::array<std::size_t, 3> low{}, high{};
    std::array<float, 3> share{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<float>& axis = axes_rad_[k];
        const auto above = std::upper_bound(axis.begin(), axis.end(), at_rad[k]);
        high[k] = static_cast<std::size_t>(std::min(above, axis.end() - 1) - axis.begin());
        low[k] = above == axis.begin() ? 0 : static_cast<std::size_t>(above - axis.begin()) - 1;
        const float step = axis[high[k]] - axis[low[k]];
        share[k] = step > 0 ? (at_rad[k] - axis[low[k]]) / step : 0.0f;
    }
    Spectrum out;
    for (unsigned corner = 0; corner < 8; ++corner) {
        float weight = 1;
        std::size_t index = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const bool upper = (corner >> k & 1u) != 0;
            weight *= upper ? share[k] : 1 - share[k];
            index = index * axes_rad_[k].size() + (upper ? high[k] : low[k]);
        }
        if (weight > 0) out += weight * values_[index];
    }
    return out;
}

Spectrum BrdfTable::value(float no, float ni, float io) const {
    const auto angle = [](float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); };
    if (layout_ == Layout::kAngles) {
        const float sines = std::sqrt(std::max(0.0f, 1 - no * no)) * std::sqrt(std::max(0.0f, 1 - ni * ni));
        const float phi = sines > 1e-6f ? angle((io - no * ni) / sines) : 0.0f;
        return interpolate({angle(ni), phi, angle(no)});
    }
    // Half vector: theta_h to the normal, theta_d between it and the light, phi_d the light's azimuth about
    // it.
    const float half_length = std::sqrt(std::max(2 + 2 * io, 1e-8f));
    const float nh = std::clamp((no + ni) / half_length, 0.0f, 1.0f), ih = std::min(0.5f * half_length, 1.0f);
    const float sines = std::sqrt(std::max(0.0f, 1 - nh * nh)) * std::sqrt(std::max(0.0f, 1 - ih * ih));
    // n is a part along h plus a tangential part; the light's azimuth around h is measured from the direction
    // away from n.
    const float cos_phi = sines > 1e-6f ? (nh * ih - ni) / sines : 0.0f;
    return interpolate({std::sqrt(angle(nh)), angle(ih), angle(cos_phi)});
}

// Fits a GGX lobe around the mirror direction: as wide as the table's highlight at 30 degrees, with the
// highlight's share of the light as its share of the samples.
void BrdfTable::fit_lobe() {
    constexpr float kCosine = 0.8660254f, kSine = 0.5f;
    const auto at =
        [&](float theta_o) {  // in the plane of incidence, beyond the mirror direction if positive
            const float c = std::cos(theta_o), io = kCosine * c - kSine * std::sin(theta_o);
            return c > 0 ? max_component(value(c, kCosine, io)) : 0.0f;
        };
    const float peak = at(0.5235988f);
    const float floor = at(-1.0f);  // far from the highlight, on the light's side
    if (!(peak > 1.5f * floor)) {
        lobe_share_ = 0.2f, lobe_alpha_ = 0.7f;
        return;
    }
    float width = 0.01f;  // where the highlight has fallen to half
    while (width < 1 && at(0.5235988f + width) > 0.5f * (peak + floor)) width *= 1.15f;
    // GGX falls to half where tan^2 theta_h = 0.414 alpha^2; the facet turns half as far as the light.
    lobe_alpha_ = std::clamp(std::tan(0.5f * width) / 0.644f, 0.02f, 0.8f);
    const float highlight = (peak - floor) * kPiF * width * width, diffuse = kPiF * floor;
    lobe_share_ = std::clamp(highlight / (highlight + diffuse), 0.2f, 0.8f);
}

}  // namespace hilcam
