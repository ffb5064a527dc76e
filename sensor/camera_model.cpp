#include "sensor/camera_model.h"

#include <cmath>

#include "render/check.h"

namespace hilcam {

Fields fields(CameraModel& c) {
    return {
        text("name", c.name, "what clients see as the model"),
        text("source", c.source, "where the figures come from"),
        required(integer("width_px", c.width_px, {1, 16384}, "columns")),
        required(integer("height_px", c.height_px, {1, 16384}, "rows")),
        required(number("pitch_um", c.pitch_m, 1e-6, {0.5, 100}, "distance of pixel centres")),
        required(number("focal_length_mm", c.focal_length_m, 1e-3, {0.1, 100000}, "focal length")),
        numbers("distortion", c.distortion, 1, {-100, 100}, {1, 5},
                "of the lens: k1, k2, p1, p2, k3 (Brown, as OpenCV)"),
        required(number("f_number", c.f_number, 1, {0.5, 100}, "focal length over aperture diameter")),
        curve("transmission", c.transmission, {0, 1},
              "of all glass and filters; number or [[um, value], ...]"),
        number("central_obscuration_ratio", c.central_obscuration_ratio, 1, {0, 0.95},
               "of aperture diameters"),
        number("defocus_um", c.defocus_m, 1e-6, {-10000, 10000}, "shift of the detector from focus"),
        number("cos_power", c.cos_power, 1, {0, 8}, "n: irradiance falls as cos^n of the field angle"),
        required(curve("quantum_efficiency", c.quantum_efficiency, {0, 1},
                       "electrons per photon; number or curve")),
        number("fill_factor", c.fill_factor, 1, {0.01, 1}, "light-sensitive share of a pixel"),
        required(number("full_well_e", c.full_well_e, 1, {10, 1e8}, "saturation capacity")),
        number("dark_current_e_s", c.dark_current_e_s, 1, {0, 1e8}, "at the operating temperature"),
        number("read_noise_e", c.read_noise_e, 1, {0, 1e5}, "temporal, standard deviation"),
        required(number("gain_dn_e", c.gain_dn_e, 1, {1e-6, 1e4}, "DN per electron at 0 dB")),
        number("offset_dn", c.offset_dn, 1, {0, 65535}, "black level"),
        required(integer("bits", c.bits, {8, 16}, "of the ADC")),
        number("exposure_ms", c.exposure_s, 1e-3, {1e-3, 1e6}, "at power-up"),
        number("gain_db", c.gain_db, 1, {-60, 60}, "at power-up, over gain_dn_e"),
        number("frame_rate_hz", c.frame_rate_hz, 1, {1e-3, 10000}, "at power-up"),
        numbers("exposure_range_ms", c.exposure_range_s, 1e-3, {1e-3, 1e6}, {2, 2}, "least and most"),
        numbers("gain_range_db", c.gain_range_db, 1, {-60, 60}, {2, 2}, "least and most"),
        numbers("frame_rate_range_hz", c.frame_rate_range_hz, 1, {1e-3, 10000}, {2, 2}, "least and most"),
    };
}

void validate(const CameraModel& c) {
    const auto inside = [](double value, const std::vector<double>& range, const char* key,
                           const char* range_key) {
        if (range[0] > range[1]) throw InputError(std::string(range_key) + ": the least is above the most");
        if (value < range[0] || value > range[1])
            throw InputError(std::string(key) + " at power-up lies outside " + range_key);
    };
    inside(c.exposure_s, c.exposure_range_s, "exposure_ms", "exposure_range_ms");
    inside(c.gain_db, c.gain_range_db, "gain_db", "gain_range_db");
    inside(c.frame_rate_hz, c.frame_rate_range_hz, "frame_rate_hz", "frame_rate_range_hz");
    // The lens must not fold over: every corner of the field comes back from where it was sent.
    const ImageGeometry geometry = geometry_of(c, 0);
    for (const double x : {0.0, 0.5 * geometry.width_px, 1.0 * geometry.width_px})
        for (const double y : {0.0, 0.5 * geometry.height_px, 1.0 * geometry.height_px}) {
            const Vec2d back = geometry.project_px(geometry.direction_camera(x, y));
            if (!(std::abs(back.x - x) + std::abs(back.y - y) < 1e-6))
                throw InputError(
                    "distortion: the lens folds over inside the field; accepted: coefficients that keep it "
                    "monotonic to the corners");
        }
    const double most_dn = std::exp2(static_cast<double>(c.bits)) - 1;
    if (c.offset_dn >= most_dn)
        throw InputError("offset_dn " + std::to_string(c.offset_dn) + " leaves nothing of the ADC's " +
                         std::to_string(c.bits) + " bits");
}

ImageGeometry geometry_of(const CameraModel& c, int guard_px) {
    const auto coefficient = [&](std::size_t i) { return i < c.distortion.size() ? c.distortion[i] : 0.0; };
    return {static_cast<int>(c.width_px),
            static_cast<int>(c.height_px),
            guard_px,
            c.focal_length_m / c.pitch_m,
            {coefficient(0), coefficient(1), coefficient(4), coefficient(2), coefficient(3)}};
}

}  // namespace hilcam
