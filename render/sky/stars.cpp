#include "render/sky/stars.h"

#include <erfa.h>
#include <erfam.h>

#include <algorithm>
#include <cmath>

#include "render/sky/star_spectra.h"
#include "render/vocabulary/units.h"

namespace hilcam {

std::vector<Star> stars_at(const StarCatalogue& catalogue, TimeTai time, double faintest_magnitude,
                           const SpectralGrid& grid) {
    const JulianDate now = julian_tt(time);
    const StarSpectra spectra(grid);
    std::vector<Star> stars;
    for (std::size_t row = 0; row < catalogue.stars.size(); ++row) {
        const CatalogueStar& star = catalogue.stars[row];
        if (star.magnitude_v > faintest_magnitude) continue;
        // Julian epoch to Julian date: J2000.0 is JD 2451545.0 TT, a Julian year has 365.25 days.
        const double epoch_days = (star.epoch_year - 2000.0) * 365.25;
        // ERFA needs dRA/dt itself; near the poles the cosine is limited, so that it stays finite.
        const double ra_rate = star.pm_ra_cosdec_rad_yr / std::max(1e-9, std::cos(star.declination_rad));
        double ra, dec, pm_ra, pm_dec, parallax, velocity;
        eraPmsafe(star.right_ascension_rad, star.declination_rad, ra_rate, star.pm_dec_rad_yr,
                  star.parallax_rad / kArcsecond_rad, 0, ERFA_DJ00, epoch_days, now.day, now.fraction, &ra,
                  &dec, &pm_ra, &pm_dec, &parallax, &velocity);
        const double sin_ra = std::sin(ra), cos_ra = std::cos(ra), sin_dec = std::sin(dec),
                     cos_dec = std::cos(dec);
        Star out;
        out.world_dir = {cos_dec * cos_ra, cos_dec * sin_ra, sin_dec};
        const Vec3d east{-sin_ra, cos_ra, 0}, north{-sin_dec * cos_ra, -sin_dec * sin_ra, cos_dec};
        out.motion_rad_yr = to_float((pm_ra * cos_dec) * east + pm_dec * north);
        out.parallax_rad = static_cast<float>(star.parallax_rad);
        out.irradiance_w_m2_um =
            spectra.irradiance_w_m2_um(star.magnitude_v, {star.color_b_v, star.color_v_i});
        out.magnitude_v = static_cast<float>(star.magnitude_v);
        out.row = static_cast<std::uint32_t>(row);
        out.hip = static_cast<std::uint32_t>(star.hip);
        out.hd = static_cast<std::uint32_t>(star.hd);
        stars.push_back(out);
    }
    return stars;
}

StarObserver::StarObserver(double years, Vec3d position_m, Vec3d velocity_m_s)
    : years_(years),
      position_au_(position_m / kAstronomicalUnit_m),
      beta_(velocity_m_s / kSpeedOfLight_m_s),
      inverse_lorentz_(std::sqrt(1 - dot(beta_, beta_))) {}

}  // namespace hilcam
