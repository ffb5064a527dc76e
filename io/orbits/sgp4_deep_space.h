#pragma once
// The deep-space part of SGP4, for periods of 225 minutes and longer: Sun, Moon, and the resonances of
// one-day and half-day orbits with the Earth's tesseral harmonics. Sources as in sgp4.h; constants are from
// Spacetrack Report No. 3, section DEEP, which gives them no other names.

#include <array>

#include "io/orbits/sgp4.h"

namespace hilcam {

// Rates from the Earth's gravity alone [rad/min].
struct DeepSpaceRates {
    double mean_motion, mean_anomaly, perigee, node;
};

class DeepSpace {
  public:
    DeepSpace(const Sgp4Elements& epoch, const DeepSpaceRates& rates);

    // Adds the secular rates from Sun and Moon and the resonance to those from the Earth's zonal harmonics.
    // t: minutes from epoch. A pure function: the resonance is integrated from epoch at each call, in steps
    // of 720 minutes. Loop.
    void add_secular(double t, MeanElements& m) const;
    // Adds terms with periods of half a month and half a year (Lyddane's form at inclinations below 0.2 rad).
    // Loop.
    void add_periodics(double t, MeanElements& m) const;

  private:
    // The periodic terms of one perturbing body, with the theory's names.
    struct Periodics {
        double anomaly_at_epoch, mean_motion, eccentricity;  // elements of the body
        double e2, e3, i2, i3, l2, l3, l4, g2, g3, g4, h2, h3;
    };
    struct Change {
        double e = 0, i = 0, l = 0, g = 0, h = 0;  // terms of e, i, M, perigee, node (the last times sin i)
    };
    // amplitude * sin(perigee_times * perigee + times * lambda - phase), a term in the rate of the mean
    // motion.
    struct ResonanceTerm {
        double amplitude = 0;
        int perigee_times = 0, times = 0;
        double phase_rad = 0;
    };
    enum class Resonance { kNone, kDay, kHalfDay };

    Sgp4Elements epoch_;
    DeepSpaceRates rates_;
    double sidereal_at_epoch_rad_;
    std::array<Periodics, 2> bodies_{};  // Sun, Moon
    Change secular_;                     // per minute; h: of the node itself
    Resonance resonance_ = Resonance::kNone;
    std::array<ResonanceTerm, 10> terms_{};
    std::size_t term_count_ = 0;
    double lambda_at_epoch_ = 0, lambda_rate_ = 0;

    struct Body;
    struct Geometry;
    void add_body(const Body& body, Periodics& periodics);
    void set_day_resonance(double theta);
    void set_half_day_resonance(double theta);
    static void change_of(const Periodics& body, double t, Change& change);
    // Integrates the resonance's longitude and mean motion to t.
    void integrate(double t, double& lambda, double& n) const;
};

}  // namespace hilcam
