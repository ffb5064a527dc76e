#include "render/earth/cloud_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/earth/adding_doubling.h"
#include "render/earth/phase_function.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr float kPiOfClouds = static_cast<float>(kPi);
// Droplets as in ISCCP (Rossow & Schiffer, Bull. Am. Meteorol. Soc. 80, 2261, 1999; cited from memory). A
// variance of 0.1 changes the light at 8 degrees of phase by 1 to 2 %.
constexpr double kRadius_um = 10, kVariance = 0.15;
constexpr int kStreams = 16;
constexpr int kThinnestCloud = -7, kThickest = 9;  // powers of two of the scaled thickness

// The position of a value among `count` equal steps of [0, 1].
struct GridPlace {
    int low;
    float share;
    GridPlace(float x, int count) {
        const float at = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(count - 1);
        low = std::min(static_cast<int>(at), count - 2);
        share = at - static_cast<float>(low);
    }
};

float phase_cosine_azimuth(float mu0, float mu, float cos_phase) {
    const float sines = std::sqrt(std::max(1e-12f, (1 - mu0 * mu0) * (1 - mu * mu)));
    // Azimuth between the directions of the light: 0 means forward.
    return std::clamp((mu0 * mu - cos_phase) / sines, -1.0f, 1.0f);
}

}  // namespace

// Squares make the grid denser at grazing angles.
float CloudTable::cosine_at(int i) {
    const float x = static_cast<float>(i) / (kCosines - 1);
    return std::max(0.002f, x * x);
}

CloudTable::CloudTable(const SpectralGrid& grid) {
    std::vector<PhaseFunction> phases(static_cast<std::size_t>(grid.size()),
                                      PhaseFunction::henyey_greenstein(0.85));
    tbb::parallel_for(0, grid.size(), [&](int b) {
        const double um = grid.center_um(b);
        phases[static_cast<std::size_t>(b)] =
            PhaseFunction::droplets(um, grid.width_um(b), water_index(um), kRadius_um, kVariance);
    });
    phase_.resize(PhaseFunction::kAngles);
    for (int i = 0; i < PhaseFunction::kAngles; ++i)
        for (int b = 0; b < grid.size(); ++b)
            phase_[static_cast<std::size_t>(i)][b] =
                phases[static_cast<std::size_t>(b)].at(static_cast<float>(PhaseFunction::angle_rad(i)));

    const std::vector<double> moments =
        phases[static_cast<std::size_t>(grid.size() / 2)].moments(2 * kStreams + 1);
    std::vector<double> cosines;
    cosines.reserve(kCosines);
    for (int i = 0; i < kCosines; ++i) cosines.push_back(static_cast<double>(cosine_at(i)));
    const ScatteringLayers made = scattering_layers(moments, kStreams, cosines, kThinnestCloud, kThickest);
    left_ = static_cast<float>(1 - made.forward_share);

    // From the layers' thicknesses to equal steps of c.
    const auto c_of = [&](double scaled) {
        const double tau = scaled / (1 - made.forward_share);
        return static_cast<double>(kB) * tau / (1 + static_cast<double>(kB) * tau);
    };
    multiple_.resize(static_cast<std::size_t>(kAzimuths * kCosines * kCosines * kThick));
    transmitted_.resize(static_cast<std::size_t>(kCosines * kThick));
    spherical_.resize(kThick);
    for (int k = 0; k < kThick; ++k) {
        const double c = static_cast<double>(k) / (kThick - 1);
        std::size_t above = 0;
        while (above < made.layers.size() && c_of(made.layers[above].thickness) < c) ++above;
        const bool beyond = above == made.layers.size();
        const double high = beyond ? 1 : c_of(made.layers[above].thickness);
        const double low = above == 0 ? 0 : c_of(made.layers[above - 1].thickness);
        const double share = high > low ? (c - low) / (high - low) : 0;
        // Zero before the thinnest layer; constant beyond the thickest.
        const auto mixed = [&](const auto& value, double nothing) {
            const double a = above == 0 ? nothing : value(made.layers[above - 1]);
            const double b = beyond ? value(made.layers.back()) : value(made.layers[above]);
            return static_cast<float>(a + share * (b - a));
        };
        spherical_[static_cast<std::size_t>(k)] =
            mixed([](const ScatteringLayer& l) { return l.spherical_albedo; }, 0);
        for (int i = 0; i < kCosines; ++i) {
            const auto at = static_cast<std::size_t>(i);
            transmitted_[at * kThick + static_cast<std::size_t>(k)] =
                mixed([&](const ScatteringLayer& l) { return l.transmitted[at]; }, 1);
        }
        for (int a = 0; a < kAzimuths; ++a) {
            const double phi = kPi * a / (kAzimuths - 1);
            std::vector<double> turns;
            turns.reserve(2 * kStreams);
            for (int m = 0; m < 2 * kStreams; ++m) turns.push_back(m == 0 ? 1 : 2 * std::cos(m * phi));
            for (int s = 0; s < kCosines; ++s)
                for (int v = 0; v < kCosines; ++v) {
                    const double mu0 = cosines[static_cast<std::size_t>(s)],
                                 mu = cosines[static_cast<std::size_t>(v)];
                    const double turned =
                        -mu0 * mu + std::sqrt((1 - mu0 * mu0) * (1 - mu * mu)) * std::cos(phi);
                    const double once = phase_of_moments(made.scaled_moments, turned) / (4 * (mu0 + mu));
                    const auto place = static_cast<std::size_t>(v * kCosines + s);
                    const auto more_than_once = [&](const ScatteringLayer& l) {
                        double sum = 0;
                        for (std::size_t m = 0; m < turns.size(); ++m)
                            sum += turns[m] * l.reflection[m][place];
                        return sum + once * std::expm1(-l.thickness * (1 / mu0 + 1 / mu));
                    };
                    multiple_[static_cast<std::size_t>(((a * kCosines + s) * kCosines + v) * kThick + k)] =
                        mixed(more_than_once, 0);
                }
        }
    }
}

void CloudTable::place(float mu0, float mu, float cos_phase, EarthAspect& out) const {
    const float s = std::clamp(mu0, 0.002f, 1.0f), v = std::clamp(mu, 0.002f, 1.0f);
    const float azimuth = std::acos(phase_cosine_azimuth(s, v, cos_phase));
    const GridPlace a(azimuth / kPiOfClouds, kAzimuths), x(std::sqrt(s), kCosines), y(std::sqrt(v), kCosines);
    std::array<float, kThick> many{};
    for (int i = 0; i < 8; ++i) {
        const int da = i >> 2, dx = i >> 1 & 1, dy = i & 1;
        const float weight =
            (da ? a.share : 1 - a.share) * (dx ? x.share : 1 - x.share) * (dy ? y.share : 1 - y.share);
        const float* row =
            multiple_.data() + (((a.low + da) * kCosines + x.low + dx) * kCosines + y.low + dy) * kThick;
        for (std::size_t k = 0; k < kThick; ++k) many[k] += weight * row[k];
    }
    // Single scattering: the exact phase function, for the rest of the layer.
    const float place = PhaseFunction::place(std::acos(std::clamp(-cos_phase, -1.0f, 1.0f)));
    const auto low = static_cast<std::size_t>(std::min(static_cast<int>(place), PhaseFunction::kAngles - 2));
    const float share = place - static_cast<float>(low), scale = 1 / (4 * (s + v) * left_);
    out.once = (scale * (1 - share)) * phase_[low] + (scale * share) * phase_[low + 1];
    const float slant = 1 / s + 1 / v, down = 1 / std::max(0.02f, mu0);
    for (std::size_t k = 0; k < EarthAspect::kSteps; ++k) {
        const float c = static_cast<float>(k * k) / ((EarthAspect::kSteps - 1) * (EarthAspect::kSteps - 1));
        const GridPlace t(c, kThick);
        const auto i = static_cast<std::size_t>(t.low);
        out.many[k] = many[i] + t.share * (many[i + 1] - many[i]);
        out.share[k] = -std::expm1(-scaled_thickness(c) * slant);
        out.seen[k] = transmitted(c, v);
        out.lit[k] = transmitted(c, std::max(mu0, 0.0f));
        out.beam[k] = std::exp(-scaled_thickness(c) * down);
    }
}

Spectrum CloudTable::reflected(const EarthAspect& aspect, float c) {
    const GridPlace at(std::sqrt(c), EarthAspect::kSteps);
    const auto i = static_cast<std::size_t>(at.low);
    const float many = aspect.many[i] + at.share * (aspect.many[i + 1] - aspect.many[i]);
    const float share = aspect.share[i] + at.share * (aspect.share[i + 1] - aspect.share[i]);
    Spectrum out;
    for (int b = 0; b < kMaxBins; ++b) out[b] = std::max(0.0f, share * aspect.once[b] + many);
    return out;
}

float CloudTable::transmitted(float c, float mu) const {
    const GridPlace y(std::sqrt(std::clamp(mu, 0.0f, 1.0f)), kCosines), t(c, kThick);
    const float* low = transmitted_.data() + y.low * kThick + t.low;
    const float a = low[0] + t.share * (low[1] - low[0]);
    const float b = low[kThick] + t.share * (low[kThick + 1] - low[kThick]);
    return a + y.share * (b - a);
}

float CloudTable::spherical_albedo(float c) const {
    const GridPlace t(c, kThick);
    const float* low = spherical_.data() + t.low;
    return low[0] + t.share * (low[1] - low[0]);
}

}  // namespace hilcam
