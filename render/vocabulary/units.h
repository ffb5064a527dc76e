#pragma once
// Constants of nature and unit factors, each with its source.

namespace hilcam {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr float kPiF = static_cast<float>(kPi);
inline constexpr double kTurn_rad = 2 * kPi;
inline constexpr double kDegree_rad = kPi / 180.0;
inline constexpr double kArcsecond_rad = kPi / 648000.0;

// SI defining constants, exact (BIPM, The International System of Units, 9th ed., 2019).
inline constexpr double kSpeedOfLight_m_s = 299792458.0;
inline constexpr double kPlanck_j_s = 6.62607015e-34;
inline constexpr double kBoltzmann_j_k = 1.380649e-23;
// Stefan-Boltzmann constant, 2 pi^5 k^4 / (15 h^3 c^2): CODATA 2018.
inline constexpr double kStefanBoltzmann_w_m2_k4 = 5.670374419e-8;

// IAU 2012 Resolution B2, exact.
inline constexpr double kAstronomicalUnit_m = 149597870700.0;
// IAU 2015 Resolution B3, nominal values.
inline constexpr double kSunRadius_m = 6.957e8;
inline constexpr double kTotalSolarIrradiance_w_m2 = 1361.0;
inline constexpr double kSunEffectiveTemperature_k = 5772.0;

// WGS 84 ellipsoid (NGA.STND.0036, 2014).
inline constexpr double kEarthEquatorialRadius_m = 6378137.0;
inline constexpr double kEarthFlattening = 1.0 / 298.257223563;

// Energy of one photon [J] at a wavelength [um].
inline constexpr double photon_energy_j(double wavelength_um) {
    return kPlanck_j_s * kSpeedOfLight_m_s / (wavelength_um * 1e-6);
}

inline constexpr double square(double x) { return x * x; }

}  // namespace hilcam
