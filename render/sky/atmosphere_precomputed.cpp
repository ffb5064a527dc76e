// `precomputed`: a spherical, layered atmosphere with all orders of scattering.
//
// Tables are made at start-up from atmosphere_physics.h and kept on disk: transmittance to space T(height,
// direction); the light of second and higher orders at a point, treated as isotropic, psi(height, Sun), order
// by order; and the sky's irradiance on the ground. A ray integrates single scattering and psi with steps
// that are denser towards its lowest point.
//
// psi and the sky are stored in the two parts of air_by_place.h: over black ground, and of light from below.
// Light from below is treated as going up and down in place.
//
// tests/closed_form/atmosphere_test.cpp compares it with a Monte Carlo of an independent atmosphere: within 5
// %.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "render/sky/air_by_place.h"
#include "render/sky/air_lift.h"
#include "render/sky/air_refraction.h"
#include "render/sky/air_steps.h"
#include "render/sky/air_transmittance.h"
#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/sky/atmosphere_physics.h"
#include "render/sky/spectrum_table.h"
#include "render/sky/standard_air.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

class PrecomputedAtmosphere final : public AirByPlace, private AirBall {
  public:
    PrecomputedAtmosphere(const AtmosphereConfig& config, const SpectralGrid& grid,
                          const AtmosphereStore* store)
        : air_(config, grid),
          refraction_(air_refractivity(grid) * config.pressure_pa / kStandardPressure_pa,
                      standard_air_density, kGround_m, AirPhysics::kTop_m),
          ground_(AirLift::even(config.ground_albedo), {}),
          multiple_(48, 20),
          sky_(64, 16),
          returned_(2, 2),
          text_("precomputed: standard air of 1976, aerosol " +
                std::to_string(config.aerosol_optical_depth).substr(0, 5) + " at 0.55 um, ozone " +
                std::to_string(static_cast<int>(config.ozone_du)) + " DU, ") {
        const std::vector<double> key = key_of(config, grid);
        if (!store || !find(*store, key)) {
            transmittance_.fill(air_);
            fill_multiple();
            fill_sky();
            if (store) store->keep(key, values());
        }
        put_over(AirLift::even(config.ground_albedo));
    }

    void put_over(AirGround ground) override {
        ground_ = AirLift(std::move(ground), returned_.cells().front());
        multiple_.put_over(ground_), sky_.put_over(ground_);
    }

    double top_m() const override { return AirPhysics::kTop_m; }
    const AirRefraction* refraction() const override { return &refraction_; }
    std::string describe() const override { return text_ + ground_.describe(); }

    bool lifts_by_place() const override { return ground_.varies(); }

    Sight look(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const override {
        Parts parts = look_in_parts(origin_m, dir, distance_m, sun_dir);
        if (!lifts_by_place()) return parts.over_black;
        const double lowest_m =
            std::clamp(-dot(origin_m, dir), 0.0, std::isfinite(distance_m) ? distance_m : kFar_m);
        parts.over_black.radiance_sr += lift(origin_m + lowest_m * dir) * parts.per_lift_sr;
        return parts.over_black;
    }

    Parts look_in_parts(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const override {
        return parts_along(origin_m, dir, distance_m, sun_dir, lifts_by_place());
    }

    Spectrum lift_at(float u, float v) const override {
        return lifts_by_place() ? ground_.at(u, v) : Spectrum{};
    }

    Spectrum sun_transmittance(Vec3d point_m, Vec3d sun_dir) const override {
        const double r = length(point_m);
        return transmittance_.to_sun(r, dot(point_m, sun_dir) / r);
    }

    Spectrum sky_irradiance(Vec3d point_m, Vec3d sun_dir) const override {
        Sky sky = sky_in_parts(point_m, sun_dir);
        if (lifts_by_place()) sky.over_black += lift(point_m) * sky.per_lift;
        return sky.over_black;
    }

    Sky sky_in_parts(Vec3d point_m, Vec3d sun_dir) const override {
        const double r = length(point_m);
        const double u = sun_coordinate(dot(point_m, sun_dir) / r), v = height_coordinate(r);
        return {sky_.shown(u, v), lifts_by_place() ? sky_.per_lift(u, v) : Spectrum{}};
    }

  private:
    static constexpr double kStandardPressure_pa = 101325;
    AirPhysics air_;
    AirRefraction refraction_;
    AirLift ground_;
    // Over black ground; per unit of lift; and the table that lookups use: the first alone if the lift
    // differs by place, otherwise the total.
    struct Tables {
        SpectrumTable over_black, per_lift, shown;
        Tables(int width, int height)
            : over_black(width, height), per_lift(width, height), shown(width, height) {}
        void put_over(const AirLift& ground) {
            shown = over_black;
            if (ground.varies()) return;
            for (std::size_t i = 0; i < shown.cells().size(); ++i)
                shown.cells()[i] += ground.first() * per_lift.cells()[i];
        }
    };
    AirTransmittance transmittance_;
    Tables multiple_, sky_;
    SpectrumTable returned_;  // S, the same in all cells
    std::string text_;

    static constexpr double kFar_m = 1e12;

    // --- along a ray
    // in_parts: false leaves per_lift_sr out.
    Parts parts_along(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir, bool in_parts) const {
        Parts out;
        out.over_black.transmittance.bin.fill(1);
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
        integrate(origin_m, dir, from_m, end_m, sun_dir, in_parts, out);
        return out;
    }

    void integrate(Vec3d origin_m, Vec3d dir, double from_m, double end_m, Vec3d sun_dir, bool in_parts,
                   Parts& out) const {
        constexpr int kSteps = 14;
        const auto cos_theta = static_cast<float>(dot(dir, sun_dir));
        const float rayleigh_phase = air_.rayleigh_phase(cos_theta),
                    aerosol_phase = air_.aerosol_phase(cos_theta);
        Spectrum& passed = out.over_black.transmittance;
        for_each_air_step(-dot(origin_m, dir), from_m, end_m, kSteps, [&](AirStep step) {
            const Vec3d p = origin_m + step.distance_m * dir;
            const double r = length(p), mu_s = dot(p, sun_dir) / r;
            const AirAt here = air_.at(r - kGround_m);
            const double u = sun_coordinate(mu_s), v = height_coordinate(r);
            const Spectrum scattering = here.rayleigh + here.aerosol;
            Spectrum source = (rayleigh_phase * here.rayleigh + aerosol_phase * here.aerosol) *
                              transmittance_.to_sun(r, mu_s);
            source += scattering * multiple_.shown(u, v);
            const AirPiece piece(here.extinction, step.length_m);
            const Spectrum seen_m = passed * piece.length_m;
            out.over_black.radiance_sr += seen_m * source;
            if (in_parts) out.per_lift_sr += seen_m * (scattering * multiple_.per_lift(u, v));
            passed = passed * piece.passed;
        });
    }

    // Sunlight scattered once [sr^-1 m^-1]; and the same plus everything scattered more often over black
    // ground.
    Spectrum source_of_sun(double radius, double mu_s, float cosine, const AirAt& here) const {
        return (air_.rayleigh_phase(cosine) * here.rayleigh + air_.aerosol_phase(cosine) * here.aerosol) *
               transmittance_.to_sun(radius, mu_s);
    }
    Spectrum source_over_black(double radius, double mu_s, float cosine, const AirAt& here) const {
        return source_of_sun(radius, mu_s, cosine, here) +
               (here.rayleigh + here.aerosol) *
                   multiple_.over_black(sun_coordinate(mu_s), height_coordinate(radius));
    }

    // Light of one or several orders: its mean over all directions at a point, and its irradiance on the
    // ground.
    struct Orders {
        SpectrumTable mean, ground;  // ground: height 2, both equal
    };
    // Fills the two parts of psi, order by order.
    void fill_multiple() {
        const Orders black = all_orders(
            next_order([&](double radius, double mu_s, float cosine,
                           const AirAt& here) { return source_of_sun(radius, mu_s, cosine, here); },
                       [](double) { return Spectrum{}; }));
        const auto coming_down = [&](double mu_s) {
            return static_cast<float>(std::max(0.0, mu_s)) * transmittance_.to_sun(kGround_m, mu_s) +
                   black.ground(sun_coordinate(mu_s), 0);
        };
        const Orders lifted = all_orders(
            next_order([](double, double, float, const AirAt&) { return Spectrum{}; },
                       [&](double mu_s) { return static_cast<float>(1 / kPi) * coming_down(mu_s); }));
        multiple_.over_black = black.mean, multiple_.per_lift = lifted.mean;
        const Spectrum down = coming_down(1), again = lifted.ground(1, 0);
        for (Spectrum& cell : returned_.cells())
            for (int b = 0; b < kMaxBins; ++b) cell[b] = down[b] > 0 ? again[b] / down[b] : 0;
    }

    // Returns the first order and all that it produces over black ground, until an order adds less than a
    // thousandth.
    Orders all_orders(Orders last) const {
        constexpr int kMaxOrders = 30;
        Orders total = last;
        for (int order = 2; order <= kMaxOrders; ++order) {
            last = next_order(
                [&](double radius, double mu_s, float, const AirAt& here) {
                    return (here.rayleigh + here.aerosol) *
                           last.mean(sun_coordinate(mu_s), height_coordinate(radius));
                },
                [](double) { return Spectrum{}; });
            float most = 0;
            for (std::size_t i = 0; i < total.mean.cells().size(); ++i) {
                Spectrum& sum = total.mean.cells()[i];
                const Spectrum& more = last.mean.cells()[i];
                sum += more;
                for (int b = 0; b < kMaxBins; ++b)
                    if (sum[b] > 0) most = std::max(most, more[b] / sum[b]);
            }
            for (std::size_t i = 0; i < total.ground.cells().size(); ++i)
                total.ground.cells()[i] += last.ground.cells()[i];
            if (most < 1e-3f) break;
        }
        return total;
    }

    // A ray from inside the air to its end, the same for all of one height and inclination.
    struct Way {
        struct Piece {
            double distance_m, radius_m;
            AirAt air;
            Spectrum seen_m;  // length, dimmed by everything in front of it
        };
        std::vector<Piece> pieces;
        Spectrum passed;
        double end_m;
        bool meets_ground;
    };
    Way way_of(double r, double mu, int steps) const {
        Way out;
        out.meets_ground = meets_ground(r, mu);
        out.end_m = out.meets_ground ? to_ground(r, mu) : to_sphere_far(r, mu, kTop_m);
        out.passed.bin.fill(1);
        for_each_air_step(-r * mu, 0, out.end_m, steps, [&](AirStep step) {
            const double d = step.distance_m, radius = std::sqrt(r * r + d * d + 2 * r * mu * d);
            const AirAt here = air_.at(radius - kGround_m);
            const AirPiece piece(here.extinction, step.length_m);
            out.pieces.push_back({d, radius, here, out.passed * piece.length_m});
            out.passed = out.passed * piece.passed;
        });
        return out;
    }

    // Returns the light that arrives from sources in the air, source(radius, Sun's cosine, cosine between ray
    // and Sun, air) [sr^-1 m^-1], and on the ground, ground_sr(Sun's cosine) [sr^-1].
    template <class Source, class Ground>
    Orders next_order(const Source& source, const Ground& ground_sr) const {
        constexpr int kRings = 12, kSpokes = 6, kSteps = 10;
        const int suns = multiple_.over_black.width(), heights = multiple_.over_black.height();
        Orders out{SpectrumTable(suns, heights), SpectrumTable(suns, 2)};
        tbb::parallel_for(0, heights + 1, [&](int y) {
            // One more row: the ground itself, for irradiance.
            const bool on_ground = y == heights;
            const double r = on_ground
                                 ? kGround_m
                                 : std::min(height_at(static_cast<double>(y) / (heights - 1)), kTop_m - 1);
            const auto share = static_cast<float>((on_ground ? kPi : 1) / (kRings * kSpokes));
            for (int i = 0; i < kRings; ++i) {
                const double u = (i + 0.5) / kRings, mu = on_ground ? std::sqrt(1 - u) : 1 - 2 * u;
                const Way way = way_of(r, mu, kSteps);
                for (int x = 0; x < suns; ++x)
                    for (int j = 0; j < kSpokes; ++j) {
                        const double mu_s = sun_at(static_cast<double>(x) / (suns - 1)),
                                     phi = kPi * (j + 0.5) / kSpokes;
                        const Spectrum light =
                            arriving(way, r, mu_s, cosine_to_sun(mu, mu_s, phi), source, ground_sr);
                        if (!on_ground)
                            out.mean.at(x, y) += share * light;
                        else
                            out.ground.at(x, 0) += share * light;
                    }
            }
        });
        for (int x = 0; x < suns; ++x) out.ground.at(x, 1) = out.ground.at(x, 0);
        return out;
    }

    static double cosine_to_sun(double mu, double mu_s, double phi) {
        return mu * mu_s + std::sqrt(std::max(0.0, (1 - mu * mu) * (1 - mu_s * mu_s))) * std::cos(phi);
    }

    // r, mu_s: at the start of the ray.
    template <class Source, class Ground>
    static Spectrum arriving(const Way& way, double r, double mu_s, double cosine, const Source& source,
                             const Ground& ground_sr) {
        Spectrum light;
        for (const Way::Piece& piece : way.pieces)
            light +=
                piece.seen_m * source(piece.radius_m, (r * mu_s + piece.distance_m * cosine) / piece.radius_m,
                                      static_cast<float>(cosine), piece.air);
        if (way.meets_ground) light += way.passed * ground_sr((r * mu_s + way.end_m * cosine) / kGround_m);
        return light;
    }

    // Fills the sky's light on the ground, and on horizontal surfaces at other heights, in its two parts.
    void fill_sky() {
        constexpr int kRings = 16, kSpokes = 16, kSteps = 14;
        const int suns = sky_.over_black.width(), heights = sky_.over_black.height();
        constexpr auto kShare = static_cast<float>(kPi / (kRings * kSpokes));
        const auto no_ground = [](double) { return Spectrum{}; };
        tbb::parallel_for(0, heights, [&](int y) {
            const double r = std::min(height_at(static_cast<double>(y) / (heights - 1)), kTop_m - 1);
            for (int i = 0; i < kRings; ++i) {
                // Equal shares of the cosine-weighted hemisphere.
                const double mu = std::sqrt(1 - (i + 0.5) / kRings);
                const Way way = way_of(r, mu, kSteps);
                for (int x = 0; x < suns; ++x)
                    for (int j = 0; j < kSpokes; ++j) {
                        const double mu_s = sun_at(static_cast<double>(x) / (suns - 1)),
                                     cosine = cosine_to_sun(mu, mu_s, kPi * (j + 0.5) / kSpokes);
                        const auto black = [&](double radius, double sun, float c, const AirAt& here) {
                            return source_over_black(radius, sun, c, here);
                        };
                        const auto lifted = [&](double radius, double sun, float, const AirAt& here) {
                            return (here.rayleigh + here.aerosol) *
                                   multiple_.per_lift(sun_coordinate(sun), height_coordinate(radius));
                        };
                        sky_.over_black.at(x, y) += kShare * arriving(way, r, mu_s, cosine, black, no_ground);
                        sky_.per_lift.at(x, y) += kShare * arriving(way, r, mu_s, cosine, lifted, no_ground);
                    }
            }
        });
    }

    // --- on disk
    static constexpr std::uint32_t kFileVersion = 3;

    static std::vector<double> key_of(const AtmosphereConfig& c, const SpectralGrid& grid) {
        std::vector<double> key = {static_cast<double>(kFileVersion), c.pressure_pa,
                                   c.aerosol_optical_depth,           c.angstrom_exponent,
                                   c.aerosol_scale_height_m,          c.aerosol_asymmetry,
                                   c.aerosol_single_albedo,           c.ozone_du};
        key.insert(key.end(), grid.edges_um().begin(), grid.edges_um().end());
        return key;
    }
    // None of them depends on the ground.
    std::array<SpectrumTable*, 6> tables() {
        return {&transmittance_.table(), &multiple_.over_black, &multiple_.per_lift,
                &sky_.over_black,        &sky_.per_lift,        &returned_};
    }

    std::vector<float> values() {
        std::vector<float> out;
        for (SpectrumTable* table : tables())
            for (const Spectrum& cell : table->cells())
                out.insert(out.end(), cell.bin.begin(), cell.bin.end());
        return out;
    }
    // Returns false if the store has none, or if its values are not light.
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
