#pragma once
// The Earth is turned, beyond what theory knows, by UT1 and the pole, as the IERS measures them (Bulletin A).

namespace hilcam {

struct EarthOrientation {
    double ut1_minus_utc_s = 0;             // kept below 0.9 s by leap seconds: 420 m at the equator
    double pole_x_rad = 0, pole_y_rad = 0;  // place of the celestial intermediate pole in ITRF: some 10 m

    friend bool operator==(const EarthOrientation&, const EarthOrientation&) = default;
};

}  // namespace hilcam
