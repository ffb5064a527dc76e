// `precomputed`: a spherical, layered atmosphere with all orders of scattering.
//
// Tables made at start-up from atmosphere_physics.h and kept on disk: transmittance to space T(height,
// direction); the light of second and higher orders at a point, taken as coming
// from all sides alike,
// psi(height, Sun), order by order; the sky's irradiance on the ground. A ray adds up single scattering and
// psi along itself with steps that crowd where it is lowest. Against a Monte Carlo of the same air:
// tests/closed_form/atmosphere_test.cpp, within 5 %.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/sky/atmosphere_physics.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kGround_m = kEarthEquatorialRadius_m;
constexpr double kTop_m = kGround_m + AirPhysics::kTop_m;
constexpr double kSunAngularRadius_rad = kSunRadius_m / kAstronomicalUnit_m;

Spectrum exp_of(const Spectrum& minus_depth) {
    Spectrum out;
    for (int b = 0; b < kMaxBins; ++b) out[b] = std::exp(-minus_depth[b]);
    return out;
}

// Distances along a ray from radius r with direction cosine mu.
double to_sphere_far(double r, double mu, double radius) {
    return -r * mu + std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + radius * radius));
}
bool meets_ground(double r, double mu) {
    return mu < 0 && r * r * (mu * mu - 1) + kGround_m * kGround_m >= 0;
}
double to_ground(double r, double mu) {
    return -r * mu - std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + kGround_m * kGround_m));
}

// Bilinear on the unit square.
class SpectrumTable {
  public:
    SpectrumTable(int width, int height)
        : width_(width), height_(height), cells_(static_cast<std::size_t>(width * height)) {}
    int width() const { return width_; }
    int height() const { return height_; }
    Spectrum& at(int x, int y) { return cells_[static_cast<std::size_t>(y * width_ + x)]; }
    Spectrum operator()(double u, double v) const {
        const double x = std::clamp(u, 0.0, 1.0) * (width_ - 1), y = std::clamp(v, 0.0, 1.0) * (height_ - 1);
        const int x0 = std::min(static_cast<int>(x), width_ - 2),
                  y0 = std::min(static_cast<int>(y), height_ - 2);
        const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
        const Spectrum* row = cells_.data() + y0 * width_ + x0;
        Spectrum out = ((1 - fx) * (1 - fy)) * row[0];
        out += (fx * (1 - fy)) * row[1];
        out += ((1 - fx) * fy) * row[width_];
        out += (fx * fy) * row[width_ + 1];
        return out;
    }
    std::vector<Spectrum>& cells() { return cells_; }

  private:
    int width_, height_;
    std::vector<Spectrum> cells_;
};

// One step along a ray: the middle of a piece of it.
struct Step {
    double distance_m, length_m;
};

class PrecomputedAtmosphere final : public Atmosphere {
  public:
    PrecomputedAtmosphere(const AtmosphereConfig& config, const SpectralGrid& grid,
                          const AtmosphereStore* store)
        : air_(config, grid),
          ground_albedo_(static_cast<float>(config.ground_albedo)),
          transmittance_(256, 64),
          multiple_(48, 20),
          sky_(64, 16),
          text_("precomputed: Rayleigh, aerosol " +
                std::to_string(config.aerosol_optical_depth).substr(0, 5) + " at 0.55 um, ozone " +
                std::to_string(static_cast<int>(config.ozone_du)) + " DU") {
        const std::vector<double> key = key_of(config, grid);
        if (store && find(*store, key)) return;
        fill_transmittance();
        fill_multiple();
        fill_sky();
        if (store) store->keep(key, values());
    }

    double top_m() const override { return AirPhysics::kTop_m; }
    std::string describe() const override { return text_; }

    Sight look(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const override {
        Sight out;
        out.transmittance.bin.fill(1);
        // To the air's edge first.
        double from_m = 0;
        double r = length(origin_m);
        double mu = dot(origin_m, dir) / r;
        if (r > kTop_m) {
            const double inside = r * r * (mu * mu - 1) + kTop_m * kTop_m;
            if (mu >= 0 || inside <= 0) return out;
            from_m = -r * mu - std::sqrt(inside);
        }
        const double end_m =
            std::min(distance_m, meets_ground(r, mu) ? to_ground(r, mu) : to_sphere_far(r, mu, kTop_m));
        if (end_m <= from_m) return out;
        integrate(origin_m, dir, from_m, end_m, sun_dir, out);
        return out;
    }

    Spectrum sun_transmittance(Vec3d point_m, Vec3d sun_dir) const override {
        const double r = length(point_m);
        return to_sun(r, dot(point_m, sun_dir) / r);
    }

    Spectrum sky_irradiance(Vec3d point_m, Vec3d sun_dir) const override {
        const double r = length(point_m);
        return sky_(sun_coordinate(dot(point_m, sun_dir) / r), height_coordinate(r));
    }

  private:
    AirPhysics air_;
    float ground_albedo_;
    SpectrumTable transmittance_, multiple_, sky_;
    std::string text_;

    // --- coordinates of the tables
    // The square root crowds the lowest kilometres.
    static double height_coordinate(double r) {
        return std::sqrt(std::clamp((r - kGround_m) / AirPhysics::kTop_m, 0.0, 1.0));
    }
    static double height_at(double v) { return kGround_m + v * v * AirPhysics::kTop_m; }
    // The Sun's cosine, crowded about the horizon, from 18 degrees (and more) below it to the zenith.
    static double sun_coordinate(double mu_s) {
        const double s = std::clamp(mu_s, -1.0, 1.0);
        return 0.5 + 0.5 * std::copysign(std::sqrt(std::abs(s)), s);
    }
    static double sun_at(double u) { return std::copysign((2 * u - 1) * (2 * u - 1), 2 * u - 1); }
    // Directions that leave to space, by the distance to the top between its least and greatest value
    // (Bruneton & Neyret, EGSR 2008): smooth at the horizon.
    static double direction_coordinate(double r, double mu) {
        const double nearest = kTop_m - r, rho = std::sqrt(std::max(0.0, r * r - kGround_m * kGround_m));
        const double farthest = rho + std::sqrt(kTop_m * kTop_m - kGround_m * kGround_m);
        return farthest > nearest ? (to_sphere_far(r, mu, kTop_m) - nearest) / (farthest - nearest) : 0;
    }
    static double direction_at(double r, double u) {
        const double nearest = kTop_m - r, rho = std::sqrt(std::max(0.0, r * r - kGround_m * kGround_m));
        const double farthest = rho + std::sqrt(kTop_m * kTop_m - kGround_m * kGround_m);
        const double d = nearest + u * (farthest - nearest);
        return d > 0 ? std::clamp((kTop_m * kTop_m - r * r - d * d) / (2 * r * d), -1.0, 1.0) : 1.0;
    }

    Spectrum to_space(double r, double mu) const {
        if (r >= kTop_m) r = kTop_m;
        return transmittance_(direction_coordinate(r, mu), height_coordinate(r));
    }
    // Zero below the horizon, softened by the Sun's disk.
    Spectrum to_sun(double r, double mu_s) const {
        if (r > kTop_m) {
            // From outside: where the ray enters, if it does.
            const double inside = r * r * (mu_s * mu_s - 1) + kTop_m * kTop_m;
            Spectrum clear;
            clear.bin.fill(1);
            if (mu_s >= 0 || inside <= 0) return clear;
            const double d = -r * mu_s - std::sqrt(inside);
            const double mu_entry = std::clamp((r * mu_s + d) / kTop_m, -1.0, 1.0);
            return to_sun(kTop_m, mu_entry);
        }
        const double horizon = std::max(r, kGround_m);
        const double sine_h = kGround_m / horizon;
        const double cos_h = -std::sqrt(std::max(0.0, 1 - sine_h * sine_h));
        // mu - mu_horizon is about sin of the angle above the horizon times sine_h.
        const double above = (mu_s - cos_h) / (std::max(1e-3, sine_h) * kSunAngularRadius_rad);
        if (above <= -1) return {};
        const double x = std::clamp(0.5 * (above + 1), 0.0, 1.0);
        return static_cast<float>(x * x * (3 - 2 * x)) * to_space(horizon, std::max(mu_s, cos_h));
    }

    // --- along a ray
    // Calls step(distance, length) from the beginning to the end; pieces crowd at the lowest point,
    // cubically.
    template <class Action>
    static void for_each_step(double low_m, double from_m, double end_m, int count, const Action& action) {
        // Two points of Gauss and Legendre in each piece, half of it each.
        constexpr double kGauss = 0.57735026918962576;
        const double low = std::clamp(low_m, from_m, end_m);
        const double before = low - from_m, after = end_m - low;
        if (before > 0)
            for (int i = count - 1; i >= 0; --i) {
                const double a = static_cast<double>(i) / count, b = static_cast<double>(i + 1) / count;
                const double near = before * a * a * a, half = 0.5 * (before * b * b * b - near);
                action(Step{low - near - half * (1 + kGauss), half});
                action(Step{low - near - half * (1 - kGauss), half});
            }
        if (after > 0)
            for (int i = 0; i < count; ++i) {
                const double a = static_cast<double>(i) / count, b = static_cast<double>(i + 1) / count;
                const double near = after * a * a * a, half = 0.5 * (after * b * b * b - near);
                action(Step{low + near + half * (1 - kGauss), half});
                action(Step{low + near + half * (1 + kGauss), half});
            }
    }

    // A piece of a ray whose source is even; the extinction inside it is not left out: (1 - e^-x) / x.
    static void add_piece(const Spectrum& source, const Spectrum& extinction, float length_m,
                          Spectrum& transmittance, Spectrum& light) {
        const Spectrum passed = exp_of(length_m * extinction);
        for (int b = 0; b < kMaxBins; ++b) {
            const float x = length_m * extinction[b];
            const float share = x > 1e-4f ? (1 - passed[b]) / x : 1 - 0.5f * x;
            light[b] += transmittance[b] * source[b] * share * length_m;
        }
        transmittance = transmittance * passed;
    }

    void integrate(Vec3d origin_m, Vec3d dir, double from_m, double end_m, Vec3d sun_dir, Sight& out) const {
        constexpr int kSteps = 14;
        const auto cos_theta = static_cast<float>(dot(dir, sun_dir));
        const float rayleigh_phase = air_.rayleigh_phase(cos_theta),
                    aerosol_phase = air_.aerosol_phase(cos_theta);
        for_each_step(-dot(origin_m, dir), from_m, end_m, kSteps, [&](Step step) {
            const Vec3d p = origin_m + step.distance_m * dir;
            const double r = length(p), mu_s = dot(p, sun_dir) / r;
            const AirAt here = air_.at(r - kGround_m);
            Spectrum direct = rayleigh_phase * here.rayleigh;
            direct += aerosol_phase * here.aerosol;
            Spectrum source = direct * to_sun(r, mu_s);
            Spectrum scattering = here.rayleigh;
            scattering += here.aerosol;
            source += scattering * multiple_(sun_coordinate(mu_s), height_coordinate(r));
            add_piece(source, here.extinction, static_cast<float>(step.length_m), out.transmittance,
                      out.radiance_sr);
        });
    }

    // --- the tables
    void fill_transmittance() {
        for (int y = 0; y < transmittance_.height(); ++y)
            for (int x = 0; x < transmittance_.width(); ++x) {
                const double r = height_at(static_cast<double>(y) / (transmittance_.height() - 1));
                const double mu = direction_at(r, static_cast<double>(x) / (transmittance_.width() - 1));
                Spectrum depth;
                for_each_step(-r * mu, 0, to_sphere_far(r, mu, kTop_m), 60, [&](Step step) {
                    const double d = step.distance_m;
                    const double height = std::sqrt(r * r + d * d + 2 * r * mu * d) - kGround_m;
                    depth += static_cast<float>(step.length_m) * air_.at(height).extinction;
                });
                transmittance_.at(x, y) = exp_of(depth);
            }
    }

    // psi, order by order: the mean over all directions of the light that arrives after n scatterings or
    // reflections, then of what that light sends on, until an order adds a thousandth.
    void fill_multiple() {
        constexpr int kMaxOrders = 30;
        Orders last = next_order(nullptr);
        SpectrumTable total = last.mean;
        for (int order = 2; order <= kMaxOrders; ++order) {
            last = next_order(&last);
            float most = 0;
            for (std::size_t i = 0; i < total.cells().size(); ++i) {
                total.cells()[i] += last.mean.cells()[i];
                for (int b = 0; b < kMaxBins; ++b)
                    if (total.cells()[i][b] > 0)
                        most = std::max(most, last.mean.cells()[i][b] / total.cells()[i][b]);
            }
            if (most < 1e-3f) break;
        }
        multiple_ = total;
    }

    // Light of one order: its mean over all directions at a point, and its irradiance on the ground.
    struct Orders {
        SpectrumTable mean, ground;  // ground: height 2, both the same
    };
    Orders next_order(const Orders* previous) const {
        constexpr int kRings = 12, kSpokes = 6;
        Orders out{SpectrumTable(multiple_.width(), multiple_.height()), SpectrumTable(multiple_.width(), 2)};
        tbb::parallel_for(0, multiple_.height() + 1, [&](int y) {
            // One more row: the ground itself, for irradiance.
            const bool on_ground = y == multiple_.height();
            const double r =
                on_ground
                    ? kGround_m
                    : std::min(height_at(static_cast<double>(y) / (multiple_.height() - 1)), kTop_m - 1);
            for (int x = 0; x < multiple_.width(); ++x) {
                const double mu_s = sun_at(static_cast<double>(x) / (multiple_.width() - 1));
                const Vec3d origin{0, 0, r}, sun{std::sqrt(std::max(0.0, 1 - mu_s * mu_s)), 0, mu_s};
                Spectrum sum;
                for (int i = 0; i < kRings; ++i)
                    for (int j = 0; j < kSpokes; ++j) {
                        const double u = (i + 0.5) / kRings, phi = kPi * (j + 0.5) / kSpokes;
                        const double mu = on_ground ? std::sqrt(1 - u) : 1 - 2 * u;
                        const double sine = std::sqrt(1 - mu * mu);
                        sum +=
                            arriving(origin, {sine * std::cos(phi), sine * std::sin(phi), mu}, sun, previous);
                    }
                if (!on_ground)
                    out.mean.at(x, y) = (1.0f / (kRings * kSpokes)) * sum;
                else
                    out.ground.at(x, 0) = out.ground.at(x, 1) =
                        static_cast<float>(kPi / (kRings * kSpokes)) * sum;
            }
        });
        return out;
    }

    // Light that arrives from a direction: scattered or reflected sunlight, or that of the previous order.
    Spectrum arriving(Vec3d origin, Vec3d dir, Vec3d sun, const Orders* previous) const {
        constexpr int kSteps = 10;
        const double r = length(origin), mu = dot(origin, dir) / r;
        const bool ground = meets_ground(r, mu);
        const double end = ground ? to_ground(r, mu) : to_sphere_far(r, mu, kTop_m);
        const auto cosine = static_cast<float>(dot(dir, sun));
        const float rayleigh_phase = air_.rayleigh_phase(cosine), aerosol_phase = air_.aerosol_phase(cosine);
        Spectrum light, passed;
        passed.bin.fill(1);
        for_each_step(-r * mu, 0, end, kSteps, [&](Step step) {
            const Vec3d p = origin + step.distance_m * dir;
            const double radius = length(p), mu_s = dot(p, sun) / radius;
            const AirAt here = air_.at(radius - kGround_m);
            Spectrum source;
            if (previous)
                source = (here.rayleigh + here.aerosol) *
                         previous->mean(sun_coordinate(mu_s), height_coordinate(radius));
            else
                source =
                    (rayleigh_phase * here.rayleigh + aerosol_phase * here.aerosol) * to_sun(radius, mu_s);
            add_piece(source, here.extinction, static_cast<float>(step.length_m), passed, light);
        });
        if (!ground) return light;
        const Vec3d p = origin + end * dir;
        const double mu_s = dot(p, sun) / length(p);
        const float lambert = ground_albedo_ / static_cast<float>(kPi);
        if (previous)
            light += lambert * (passed * previous->ground(sun_coordinate(mu_s), 0));
        else if (mu_s > 0)
            light += (lambert * static_cast<float>(mu_s)) * (passed * to_sun(kGround_m, mu_s));
        return light;
    }

    void fill_sky() {
        constexpr int kRings = 16, kSpokes = 16;
        for (int y = 0; y < sky_.height(); ++y)
            for (int x = 0; x < sky_.width(); ++x) {
                const double r =
                    std::min(height_at(static_cast<double>(y) / (sky_.height() - 1)), kTop_m - 1);
                const double mu_s = sun_at(static_cast<double>(x) / (sky_.width() - 1));
                const Vec3d origin{0, 0, r}, sun{std::sqrt(std::max(0.0, 1 - mu_s * mu_s)), 0, mu_s};
                Spectrum sum;
                for (int i = 0; i < kRings; ++i)
                    for (int j = 0; j < kSpokes; ++j) {
                        // Equal shares of the cosine-weighted half sphere.
                        const double sine = std::sqrt((i + 0.5) / kRings), phi = kPi * (j + 0.5) / kSpokes;
                        const Vec3d dir{sine * std::cos(phi), sine * std::sin(phi),
                                        std::sqrt(1 - sine * sine)};
                        sum += look(origin, dir, std::numeric_limits<double>::infinity(), sun).radiance_sr;
                    }
                sky_.at(x, y) = static_cast<float>(kPi / (kRings * kSpokes)) * sum;
            }
    }

    // --- on disk
    static constexpr std::uint32_t kFileVersion = 2;

    static std::vector<double> key_of(const AtmosphereConfig& c, const SpectralGrid& grid) {
        std::vector<double> key = {static_cast<double>(kFileVersion),
                                   c.pressure_pa,
                                   c.aerosol_optical_depth,
                                   c.angstrom_exponent,
                                   c.aerosol_scale_height_m,
                                   c.aerosol_asymmetry,
                                   c.aerosol_single_albedo,
                                   c.ozone_du,
                                   c.ground_albedo};
        key.insert(key.end(), grid.edges_um().begin(), grid.edges_um().end());
        return key;
    }
    std::array<SpectrumTable*, 3> tables() { return {&transmittance_, &multiple_, &sky_}; }

    std::vector<float> values() {
        std::vector<float> out;
        for (SpectrumTable* table : tables())
            for (const Spectrum& cell : table->cells())
                out.insert(out.end(), cell.bin.begin(), cell.bin.end());
        return out;
    }
    // False where the store has none, or what it has is no light.
    bool find(const AtmosphereStore& store, std::span<const double> key) {
        std::vector<float> kept = values();
        if (!store.find(key, kept) ||
            !std::all_of(kept.begin(), kept.end(), [](float value) { return std::isfinite(value); }))
            return false;
        auto next = kept.begin();
        for (SpectrumTable* table : tables())
            for (Spectrum& cell : table->cells()) {
                std::copy_n(next, cell.bin.size(), cell.bin.begin());
                next += static_cast<std::ptrdiff_t>(cell.bin.size());
            }
        return true;
    }
};

}  // namespace

std::unique_ptr<Atmosphere> make_precomputed_atmosphere(const AtmosphereRequest& request) {
    return std::make_unique<PrecomputedAtmosphere>(request.config, request.grid, request.store);
}

}  // namespace hilcam
