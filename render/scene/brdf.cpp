#include "render/scene/brdf.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/clones.h"
#include "render/vocabulary/lane_sum.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Spectrum brdf_value(const Scatterer& at, Cosines c) {
    if (!(c.no > 0 && c.ni > 0)) return {};
    return std::visit([&](const auto& model) { return model.value(at, c); }, at.material->brdf);
}

namespace {

// weight times below_facets(), and times D V of a lobe. count: a multiple of BrdfSum::kEach.
HILCAM_CLONES void reflect_below(const BrdfSum::Lanes& weight, const BrdfSum::Lanes& no,
                                 const BrdfSum::Lanes& ni, const LobeAlbedo& e, std::size_t count,
                                 BrdfSum::Lanes& out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = weight[i] * below_facets(e, no[i], ni[i]);
}
HILCAM_CLONES void reflect_lobe(const BrdfSum::Lanes& weight, const BrdfSum::Lanes& no,
                                const BrdfSum::Lanes& ni, const BrdfSum::Lanes& rougher, float alpha,
                                float over_half, std::size_t count, BrdfSum::Lanes& out) {
    for (std::size_t i = 0; i < count; ++i) {
        const float nh = std::min((no[i] + ni[i]) * over_half, 1.0f);
        // Slopes s of density a^2 / (pi (a^2 + s^2)^2) (GGX's: Heitz, JCGT 3(2), 2014) that are scattered by
        // r: to the first order the density changes by r (4 s^2 - 2 a^2) / (a^2 + s^2)^2 of itself. A lobe
        // whose a^2 grows by 4 r a^2 / (2 a^2 + s^2) does so at its middle and in its tails, which hardly
        // change.
        const float both = alpha * alpha + rougher[i], slope = (1 - nh * nh) / (nh * nh);
        const float wider =
            std::min(std::sqrt(alpha * alpha + rougher[i] * 4 * both / (2 * both + slope)), 1.0f);
        const float lobe = ggx_distribution(wider, nh) * ggx_visibility(wider, no[i], std::max(ni[i], 1e-6f));
        out[i] = weight[i] * lobe;
    }
}

// Null for a model without facets.
const LobeAlbedo* facets_of(const Material& material) {
    return std::visit(
        []<class Model>(const Model& model) -> const LobeAlbedo* {
            if constexpr (Model::kHasFacets)
                return &model.facets;
            else
                return nullptr;
        },
        material.brdf);
}

}  // namespace

BrdfSum::BrdfSum(const Scatterer& at, float io)
    : at_(at),
      io_(io),
      mirrored_(std::visit(
          [&](const auto& model) {
              return model.mirrored(at, half_vector({1, 1, io}).ih);
          },
          at.material->brdf)),
      all_mirrored_(lane_sum(mirrored_.bin)),
      all_base_(lane_sum(at.base.bin)) {}

void BrdfSum::add(const Lanes& weight, const Lanes& no, const Lanes& ni, const Lanes& rougher,
                  std::size_t count) {
    const Material& m = *at_.material;
    if (std::holds_alternative<brdf::Lambert>(m.brdf)) {
        below_ += lane_sum(weight) / kPiF;
        for (std::size_t i = 0; i < kLanes; ++i) reflected_[i] = all_base_ / kPiF * weight[i];
        return;
    }
    const LobeAlbedo* const facets = facets_of(m);
    if (!facets) {
        for (std::size_t i = 0; i < count; ++i) {
            reflected_[i] = 0;
            if (!(weight[i] > 0)) continue;
            const Spectrum light = weight[i] * brdf_value(at_, {no[i], ni[i], io_});
            other_ += light;
            reflected_[i] = lane_sum(light.bin);
        }
        return;
    }
    Lanes below{}, lobe{};
    const std::size_t filled = (count + kEach - 1) / kEach * kEach;
    reflect_below(weight, no, ni, *facets, filled, below);
    below_ += lane_sum(below);
    if (at_.alpha > 0)
        reflect_lobe(weight, no, ni, rougher, at_.alpha, 1 / std::sqrt(std::max(2 + 2 * io_, 1e-8f)), filled,
                     lobe);
    lobe_ += lane_sum(lobe);
    for (std::size_t i = 0; i < kLanes; ++i) reflected_[i] = all_base_ * below[i] + all_mirrored_ * lobe[i];
}

namespace {

// top: the model's chance of a highlight.
template <class Model>
float density_of(const Model& model, const Scatterer& at, Cosines c, float top) {
    const float diffuse = (1 - top) * c.ni / kPiF;
    return top > 0 ? diffuse + top * model.highlight_density(at, c) : diffuse;
}

}  // namespace

float brdf_density(const Scatterer& at, Cosines c) {
    if (!(c.no > 0 && c.ni > 0) || !at.has_lobes()) return 0;
    return std::visit(
        [&](const auto& model) { return density_of(model, at, c, model.highlight_chance(at, c.no)); },
        at.material->brdf);
}

BrdfSample brdf_exact(const Scatterer& at, Vec3f normal, Vec3f view_dir, int part) {
    BrdfSample out;
    const float no = std::clamp(dot(normal, view_dir), 1e-4f, 1.0f);
    if (part == 0 && at.has_exact()) {
        out.dir = normalized(reflect(view_dir, normal));
        out.weight = brdf_mirrored(at, no);
        out.exact = out.valid = true;
    }
    if (part == 1 && at.is_glass()) {
        out.dir = -view_dir;
        out.weight = sheet_transmittance(at, no);
        out.exact = out.valid = out.transmits = true;
    }
    return out;
}

namespace {

BrdfSample sample_sheet(const Scatterer& at, Vec3f normal, Vec3f view_dir, float u) {
    const float no = std::max(dot(normal, view_dir), 1e-4f);
    const float chance = std::visit(
        [&](const auto& model) {
            const float back = largest(model.mirrored(at, no)), through = largest(model.passed(at, no));
            return back / (back + through);
        },
        at.material->brdf);
    const int part = u < chance ? 0 : 1;
    BrdfSample out = brdf_exact(at, normal, view_dir, part);
    out.weight = (1 / (part == 0 ? chance : 1 - chance)) * out.weight;
    return out;
}

}  // namespace

BrdfSample brdf_sample(const Scatterer& at, Vec3f normal, Vec3f view_dir, std::array<float, 3> u) {
    if (at.is_glass()) return sample_sheet(at, normal, view_dir, u[1]);
    const float no = std::max(dot(normal, view_dir), 1e-4f);
    return std::visit(
        [&](const auto& model) {
            const float top = model.highlight_chance(at, no);
            const bool highlight = u[0] < top;
            BrdfSample out;
            if (highlight && at.has_exact()) {
                out = brdf_exact(at, normal, view_dir, 0);
                out.weight = (1 / top) * out.weight;
                return out;
            }
            const Frame local(normal);
            if (highlight) {
                out.dir = model.sample_highlight(at, local, view_dir, u[1], u[2]);
            } else {
                out.dir = local.to_world(sample_cosine(u[1], u[2]));
                out.diffuse = true;
            }
            const Cosines c{no, dot(normal, out.dir), dot(view_dir, out.dir)};
            if (c.ni > 0 && at.has_lobes()) out.density = density_of(model, at, c, top);
            out.valid = out.density > 0;
            if (out.valid) out.weight = (c.ni / out.density) * brdf_value(at, c);
            return out;
        },
        at.material->brdf);
}

Spectrum sheet_transmittance(const Scatterer& at, float cosine) {
    const float c = std::clamp(cosine, 1e-4f, 1.0f);
    return std::visit([&](const auto& model) { return model.passed(at, c); }, at.material->brdf);
}

float brdf_albedo(const Scatterer& at, float no, int bins) {
    return std::visit([&](const auto& model) { return model.albedo(at, no, bins); }, at.material->brdf);
}

Spectrum brdf_mirrored(const Scatterer& at, float cosine) {
    return std::visit([&](const auto& model) { return model.mirrored(at, cosine); }, at.material->brdf);
}

float brdf_lobe_share(const Scatterer& at, float no) {
    return std::visit([&](const auto& model) { return model.lobe_share(no); }, at.material->brdf);
}

float brdf_below_facets(const Material& material, float no) {
    const LobeAlbedo* const facets = facets_of(material);
    return facets ? 1 - (*facets)(no) : 1.0f;
}

namespace {

// The share of sunlight from 45 degrees that comes back in all directions: the midpoint rule over the
// hemisphere, for models without narrow lobes.
double hemispherical_reflectance(const Scatterer& at, const SpectralGrid& grid) {
    constexpr int kCosines = 32, kAzimuths = 64;
    constexpr float in = 0.70710678f;
    double sum = 0;
    for (int i = 0; i < kCosines; ++i)
        for (int j = 0; j < kAzimuths; ++j) {
            const float out = (static_cast<float>(i) + 0.5f) / kCosines;
            const float azimuth_rad = 2 * kPiF * (static_cast<float>(j) + 0.5f) / kAzimuths;
            const float between =
                in * out + std::sqrt((1 - in * in) * (1 - out * out)) * std::cos(azimuth_rad);
            sum += static_cast<double>(mean(brdf_value(at, {in, out, between}), grid.size()) * out);
        }
    return sum * 2 * kPi / (kCosines * kAzimuths);
}

}  // namespace

// The albedo that brdf_albedo() has for a path's sake is far above what these models reflect.
double reflectance_of(const Material& material, const SpectralGrid& grid) {
    const Scatterer at{&material, material.ggx_alpha, material.base, material.highlight};
    constexpr float kCosine = 0.7f;
    return std::min(1.0, material.traits().albedo_is_bound
                             ? hemispherical_reflectance(at, grid)
                             : static_cast<double>(brdf_albedo(at, kCosine, grid.size())));
}

}  // namespace hilcam
