#pragma once
// An atmosphere for tests that shares nothing with the program's own: tables as the U.S. Standard Atmosphere 1976 prints them instead of
// its layers' formulas, another author's cross sections of air, and light by sums and chance that know no transfer tables. One
// wavelength.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "render/vocabulary/units.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class ReferenceAir {
  public:
    struct Haze {
        double optical_depth = 0, scale_height_m = 1500, asymmetry = 0, single_albedo = 0;
    };
    static constexpr double kTop_m = 100e3;

    // haze: at this wavelength. ozone_m2: cross section of ozone there.
    ReferenceAir(double wavelength_um, Haze haze, double ozone_du, double ozone_m2)
        : haze_(haze), molecule_m2_(molecule_m2(wavelength_um)), ozone_m2_(ozone_m2) {
        double column = 0;
        for (double h = 50; h < kTop_m; h += 100) column += 100 * ozone_profile(h);
        // One Dobson unit: 2.687e20 molecules over a square metre.
        ozone_scale_ = ozone_du * 2.687e20 / column;
    }

    double molecules(double h) const { return molecule_m2_ * kSeaLevel_m3 * density(h); }  // [1/m]
    double haze_extinction(double h) const {
        return haze_.optical_depth / haze_.scale_height_m * std::exp(-h / haze_.scale_height_m);
    }
    double haze_scattering(double h) const { return haze_.single_albedo * haze_extinction(h); }
    double extinction(double h) const {
        return molecules(h) + haze_extinction(h) + ozone_scale_ * ozone_m2_ * ozone_profile(h);
    }
    // Scattering times phase function [1/(m sr)], and without the phase function.
    double scattered(double h, double cosine) const {
        return molecules(h) * 3 / (16 * kPi) * (1 + cosine * cosine) +
               haze_scattering(h) * haze_phase(cosine);
    }
    double scattering(double h) const { return molecules(h) + haze_scattering(h); }

    // Density over that at sea level: table I, straight in the logarithm between its heights.
    static double density(double h) {
        struct Row {
            double km, kg_m3;
        };
        static constexpr std::array<Row, 45> kTable = {
            {{0, 1.2250},     {1, 1.1117},     {2, 1.0066},     {3, 0.90925},    {4, 0.81935},
             {5, 0.73643},    {6, 0.66011},    {7, 0.59002},    {8, 0.52579},    {9, 0.46706},
             {10, 0.41351},   {11, 0.36480},   {12, 0.31194},   {13, 0.26660},   {14, 0.22786},
             {15, 0.19476},   {16, 0.16647},   {17, 0.14230},   {18, 0.12165},   {19, 0.10400},
             {20, 0.088910},  {22, 0.064510},  {24, 0.046938},  {26, 0.034257},  {28, 0.025076},
             {30, 0.018410},  {32, 0.013555},  {34, 9.8874e-3}, {36, 7.2579e-3}, {38, 5.3666e-3},
             {40, 3.9957e-3}, {42, 2.9948e-3}, {44, 2.2589e-3}, {46, 1.7142e-3}, {48, 1.3167e-3},
             {50, 1.0269e-3}, {55, 5.6810e-4}, {60, 3.0968e-4}, {65, 1.6321e-4}, {70, 8.2829e-5},
             {75, 3.9921e-5}, {80, 1.8458e-5}, {86, 6.958e-6},  {90, 3.416e-6},  {100, 5.604e-7}}};
        const double km = std::clamp(h * 1e-3, 0.0, 100.0);
        std::size_t i = 0;
        while (i + 2 < kTable.size() && km > kTable[i + 1].km) ++i;
        const double share = (km - kTable[i].km) / (kTable[i + 1].km - kTable[i].km);
        return kTable[i].kg_m3 * std::pow(kTable[i + 1].kg_m3 / kTable[i].kg_m3, share) / kTable[0].kg_m3;
    }

  private:
    static constexpr double kSeaLevel_m3 = 2.5469e25;  // table I

    Haze haze_;
    double molecule_m2_, ozone_m2_, ozone_scale_ = 0;

    // Bucholtz, Applied Optics 34, 2765 (1995), table 3.
    static double molecule_m2(double um) {
        return um <= 0.5 ? 1e-4 * 3.01577e-28 * std::pow(um, -(3.55212 + 1.35579 * um + 0.11563 / um))
                         : 1e-4 * 4.01061e-28 * std::pow(um, -(3.99668 + 1.10298e-3 * um + 2.71393e-2 / um));
    }
    // The standard's mid-latitude model, every 4 km [10^18 m^-3]; an exponential from 60 km on.
    static double ozone_profile(double h) {
        static constexpr std::array<double, 16> kEvery4km = {0.68,  0.58,   0.65,   2.02,   2.95,  4.77,
                                                             4.54,  3.24,   2.03,   1.22,   0.607, 0.274,
                                                             0.103, 0.0384, 0.0161, 0.00733};
        const double at = h / 4000;
        const auto i = static_cast<std::size_t>(at);
        if (i + 1 >= kEvery4km.size()) return 0.00733 * std::exp(-(h - 60e3) / 4500);
        return kEvery4km[i] + (at - static_cast<double>(i)) * (kEvery4km[i + 1] - kEvery4km[i]);
    }
    // Cornette & Shanks, Applied Optics 31, 3152 (1992), eq. 17.
    double haze_phase(double c) const {
        const double g = haze_.asymmetry, g2 = g * g;
        return 3 / (8 * kPi) * (1 - g2) * (1 + c * c) / ((2 + g2) * std::pow(1 + g2 - 2 * g * c, 1.5));
    }
};

// Light in it over a ball with ground of one albedo, per unit of solar irradiance; the Sun a point.
class ReferenceLight {
  public:
    ReferenceLight(const ReferenceAir& air, double ground_albedo) : air_(air), albedo_(ground_albedo) {
        for (double h = 0; h < ReferenceAir::kTop_m; h += 100) most_ = std::max(most_, air_.extinction(h));
        most_ *= 1.01;
    }

    // Radiance [sr^-1] of light scattered once, along a ray that misses the ground.
    double once(Vec3d origin, Vec3d dir, Vec3d sun) const {
        double sum = 0;
        walk(origin, dir, [&](Vec3d p, double step_m, double passed) {
            sum += passed * step_m * air_.scattered(height(p), dot(dir, sun)) * to_sun(p, sun);
        });
        return sum;
    }
    // Of all other light there, by so many paths: each begins where the ray is met, by chance.
    double more_than_once(Vec3d origin, Vec3d dir, Vec3d sun, int paths) {
        std::vector<Vec3d> places;
        std::vector<double> sums{0};
        walk(origin, dir, [&](Vec3d p, double step_m, double passed) {
            places.push_back(p);
            sums.push_back(sums.back() + passed * step_m * air_.scattering(height(p)));
        });
        double sum = 0;
        for (int i = 0; i < paths; ++i) {
            const auto found =
                std::upper_bound(sums.begin() + 1, sums.end() - 1, uniform_(engine_) * sums.back());
            const Vec3d at = places[static_cast<std::size_t>(found - sums.begin()) - 1];
            double weight = sums.back();
            const Vec3d next = scatter(at, dir, weight);
            sum += path(at, next, sun, weight);
        }
        return sum / paths;
    }
    // All of it along any ray from space, by null collisions (Woodcock 1965) and the Sun by next event.
    double radiance(Vec3d origin, Vec3d dir, Vec3d sun, int paths) {
        const double entry = to_sphere(origin, dir, kGround_m + ReferenceAir::kTop_m, true);
        if (entry < 0) return 0;
        double sum = 0;
        for (int i = 0; i < paths; ++i) sum += path(origin + (entry + 1e-3) * dir, dir, sun, 1);
        return sum / paths;
    }

  private:
    static constexpr double kGround_m = kEarthEquatorialRadius_m;
    ReferenceAir air_;
    double albedo_, most_ = 0;
    std::mt19937_64 engine_{4};
    std::uniform_real_distribution<double> uniform_{0, 1};

    static double height(Vec3d p) { return length(p) - kGround_m; }
    static double to_sphere(Vec3d o, Vec3d d, double radius, bool nearer) {
        const double b = dot(o, d), q = b * b - dot(o, o) + radius * radius;
        if (q < 0) return -1;
        return nearer ? -b - std::sqrt(q) : -b + std::sqrt(q);
    }
    // Calls tell(point, step, transmittance to the viewer) at even steps from where the ray enters the air to where it leaves.
    template <class Tell>
    void walk(Vec3d origin, Vec3d dir, const Tell& tell) const {
        constexpr int kSteps = 1000;
        const double top = kGround_m + ReferenceAir::kTop_m, from = to_sphere(origin, dir, top, true),
                     step_m = (to_sphere(origin, dir, top, false) - from) / kSteps;
        double depth = 0;
        for (int i = 0; i < kSteps; ++i) {
            const Vec3d p = origin + (from + (i + 0.5) * step_m) * dir;
            const double here = air_.extinction(height(p)) * step_m;
            tell(p, step_m, std::exp(-depth - 0.5 * here));
            depth += here;
        }
    }
    double to_sun(Vec3d p, Vec3d sun) const {
        if (to_sphere(p, sun, kGround_m * (1 - 1e-12), true) > 0) return 0;
        const double end = to_sphere(p, sun, kGround_m + ReferenceAir::kTop_m, false);
        double depth = 0;
        constexpr int kSteps = 60;
        for (int i = 0; i < kSteps; ++i) {
            // Crowded where the ray is lowest.
            const double a = std::pow(static_cast<double>(i) / kSteps, 3),
                         b = std::pow(static_cast<double>(i + 1) / kSteps, 3);
            depth += end * (b - a) * air_.extinction(height(p + end * 0.5 * (a + b) * sun));
        }
        return std::exp(-depth);
    }
    static Vec3d turned(Vec3d d, double cosine, double phi) {
        const Vec3d a = normalized(std::abs(d.x) < 0.7 ? cross(d, Vec3d{1, 0, 0}) : cross(d, Vec3d{0, 1, 0})),
                    b = cross(d, a);
        const double s = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        return normalized(cosine * d + s * std::cos(phi) * a + s * std::sin(phi) * b);
    }
    // Returns a uniform direction; the weight takes its phase function.
    Vec3d scatter(Vec3d p, Vec3d d, double& weight) {
        const double cosine = 2 * uniform_(engine_) - 1, h = height(p);
        weight *= 4 * kPi * air_.scattered(h, cosine) / air_.scattering(h);
        return turned(d, cosine, 2 * kPi * uniform_(engine_));
    }
    double path(Vec3d p, Vec3d d, Vec3d sun, double weight) {
        double light = 0;
        for (int order = 0; order < 60; ++order) {
            const double ground = to_sphere(p, d, kGround_m, true),
                         out = to_sphere(p, d, kGround_m + ReferenceAir::kTop_m, false);
            double at = 0;
            bool met = false;
            while (!met) {
                at -= std::log(1 - uniform_(engine_)) / most_;
                if (at > (ground > 0 ? ground : out)) break;
                met = uniform_(engine_) * most_ < air_.extinction(height(p + at * d));
            }
            if (met) {
                p = p + at * d;
                const double h = height(p);
                weight *= air_.scattering(h) / air_.extinction(h);
                light += weight * air_.scattered(h, dot(d, sun)) / air_.scattering(h) * to_sun(p, sun);
                d = scatter(p, d, weight);
            } else if (ground > 0 && albedo_ > 0) {
                const Vec3d n = normalized(p + ground * d);
                p = (kGround_m + 0.01) * n;
                weight *= albedo_;
                if (dot(n, sun) > 0) light += weight * dot(n, sun) / kPi * to_sun(p, sun);
                d = turned(n, std::sqrt(uniform_(engine_)), 2 * kPi * uniform_(engine_));
            } else {
                break;
            }
            if (weight < 0.02) {
                if (uniform_(engine_) > weight / 0.02) break;
                weight = 0.02;
            }
        }
        return light;
    }
};

}  // namespace hilcam
