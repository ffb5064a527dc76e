#pragma once
// SGP4: the position and velocity of a satellite given by a two-line element set.
//
// Hoots & Roehrich, Spacetrack Report No. 3, 1980, with the corrections of Vallado, Crawford, Hujsak & Kelso,
// "Revisiting Spacetrack Report #3", AIAA 2006-6753 ("improved" mode: GMST of 1982, no fixed node wrap).
// Equations have their names in Hoots, Schumacher & Glover, "History of analytical orbit modeling in the U.S.
// Space Surveillance System", J. Guidance 27(2), 2004, appendix B. Gravity is WGS 72, with which element sets
// are made. Orbits of 225 minutes and longer add the Sun, the Moon and resonances (sgp4_deep_space.h). The
// error is about a kilometre at epoch, and grows by a few each day.
//
// Units inside are the theory's: Earth radii (er), minutes, radians. Axes: TEME, true equator and mean
// equinox of date (render/sky/earth_frames.h).

#include <memory>

#include "render/sky/bodies.h"

namespace hilcam {

// Mean elements at the epoch, as in an element set (Kozai's mean motion).
struct Sgp4Elements {
    double epoch_days_1950 = 0;  // UTC days since 1949-12-31T00:00, as the theory counts
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
    kEccentricity,  // the mean eccentricity has left [-0.001, 1)
    kMeanMotion,    // the mean motion is zero or negative
    kPerturbed,     // the eccentricity with the periodics of Sun and Moon has left [0, 1]
    kSemiLatus,     // the semi-latus rectum is negative
    kDecayed,       // below the Earth's surface; the state is still set
};

class DeepSpace;
// Mean elements at a time, while the theory updates them.
struct MeanElements {
    double eccentricity, inclination_rad, node_rad, perigee_rad, mean_anomaly_rad, mean_motion_rad_min;
};

class Sgp4 {
  public:
    // Throws InputError for elements that are no orbit: mean motion not above 0, eccentricity not in [0, 1).
    explicit Sgp4(const Sgp4Elements& elements);
    ~Sgp4();
    Sgp4(Sgp4&&) noexcept;
    Sgp4& operator=(Sgp4&&) noexcept;

    // Computes position and velocity in TEME [m, m/s] at some minutes from epoch, before or after it. Leaves
    // `teme` alone unless the status is kOk or kDecayed. A pure function. Loop.
    Sgp4Status at(double minutes, StateVector& teme) const;
    bool deep_space() const { return deep_ != nullptr; }

  private:
    Sgp4Elements epoch_;
    // Brouwer's mean motion and semi-major axis.
    double n0_rad_min_, a0_er_;
    // Drag and secular rates, with the theory's names.
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
// Returns sqrt(mu) [er^1.5/min].
double root_mu();
}  // namespace wgs72

}  // namespace hilcam
