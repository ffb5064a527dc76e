#pragma once
// The part of the Earth's rotation that theory cannot predict: UT1 and the pole, as the IERS measures them
// (Bulletin A).

namespace hilcam {

struct EarthOrientation {
    double ut1_minus_utc_s = 0;             // leap seconds keep it below 0.9 s, which is 420 m at the equator
    double pole_x_rad = 0, pole_y_rad = 0;  // celestial intermediate pole in ITRF: some 10 m

    friend bool operator==(const EarthOrientation&, const EarthOrientation&) = default;
};

}  // namespace hilcam
