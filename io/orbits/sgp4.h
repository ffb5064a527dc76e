#pragma once
// SGP4: where a satellite is that is given by a two-line element set.
//
// Hoots & Roehrich, Spacetrack Report No. 3, 1980, with the corrections of Vallado, Crawford, Hujsak & Kelso,
// "Revisiting Spacetrack Report #3", AIAA 2006-6753 ("improved" mode: GMST of 1982, no fixed node wrap); the
// equations are named as in Hoots, Schumacher & Glover, "History of analytical orbit modeling in the U.S.
// Space Surveillance System", J. Guidance 27(2), 2004, appendix B. Gravity: WGS 72, which element sets are
// made with. Orbits of 225 minutes and longer get the Sun, the Moon and resonances (sgp4_deep_space.h).
// Good to a kilometre or so at epoch, to a few more each day.
//
// Units inside are those of the theory: Earth radii (er), minutes, radians. Axes: TEME, true equator and mean
// equinox of date (render/sky/earth_frames.h).

#include <memory>

#include "render/sky/bodies.h"

namespace hilcam {

// Mean elements as an element set has them (Kozai's mean motion), at its epoch.
struct Sgp4Elements {
    double epoch_days_1950 = 0;  // UTC days since 1949-12-31T00:00, the theory's count
    double inclination_rad = 0;
    double node_rad = 0;
    double eccentricity = 0;
    double perigee_rad = 0;
    double mean_anomaly_rad = 0;
    double mean_motion_rad_min = 0;
    double bstar_per_er = 0;  // drag
};

enum class Sgp4Status {
    kOk,
    kEccentricity,  // grew out of [-0.001, 1)
    kMeanMotion,    // mean motion is zero or negative
    kPerturbed,     // eccentricity with the Sun's and Moon's periodics out of [0, 1]
    kSemiLatus,     // below 0
    kDecayed,       // below the Earth's surface; the state is told all the same
};

class DeepSpace;
// Elements while they are being updated.
struct MeanElements {
    double eccentricity, inclination_rad, node_rad, perigee_rad, mean_anomaly_rad, mean_motion_rad_min;
};

class Sgp4 {
  public:
    // Throws InputError for elements that are no orbit (mean motion not above 0, eccentricity not in [0, 1)).
    explicit Sgp4(const Sgp4Elements& elements);
    ~Sgp4();
    Sgp4(Sgp4&&) noexcept;
    Sgp4& operator=(Sgp4&&) noexcept;

    // Position and velocity, TEME. Minutes from epoch, either way. A pure function; loop. `out` is left alone
    // unless kOk or kDecayed.
    Sgp4Status at(double minutes, StateVector& teme) const;
    bool deep_space() const { return deep_ != nullptr; }

  private:
    Sgp4Elements epoch_;
    // Brouwer's mean motion and semi-major axis.
    double n0_rad_min_, a0_er_;
    // Drag and secular rates, by the theory's names.
    bool simple_drag_;
    double eta_ = 0, c1_ = 0, c4_ = 0, c5_ = 0, d2_ = 0, d3_ = 0, d4_ = 0;
    double t2_ = 0, t3_ = 0, t4_ = 0, t5_ = 0;
    double mean_anomaly_rate_ = 0, perigee_rate_ = 0, node_rate_ = 0, node_drag_ = 0;
    double perigee_drag_ = 0, anomaly_drag_ = 0, cubed_at_epoch_ = 0, sin_anomaly_at_epoch_ = 0;
    std::unique_ptr<DeepSpace> deep_;

    void set_mean_motion();
    void set_drag();
    void set_rates();
    void set_higher_drag(double xi_per_er, double s_er);
    Sgp4Status secular(double t, MeanElements& m, double& a_er) const;
    Sgp4Status state_of(const MeanElements& m, double a_er, StateVector& teme) const;
};

// The theory's gravity: WGS 72 as in AIAA 2006-6753, table 1.
namespace wgs72 {
inline constexpr double kMu_km3_s2 = 398600.8;
inline constexpr double kEarthRadius_km = 6378.135;
inline constexpr double kJ2 = 0.001082616, kJ3 = -0.00000253881, kJ4 = -0.00000165597;
// sqrt(mu), er^1.5/min.
double root_mu();
}  // namespace wgs72

}  // namespace hilcam
