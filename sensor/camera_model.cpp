#include "sensor/camera_model.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "sensor/optics.h"

namespace hilcam {

Fields fields(FieldZone& z) {
    return {
        required(number("field_fraction", z.field_fraction, 1, {0, 1},
                        "image height of the zone over the image height of the corner")),
        number("defocus_um", z.defocus_m, 1e-6, {-10000, 10000},
               "defocus of the zone, added to the camera's"),
        number("wavefront_rms_nm", z.wavefront_rms_m, 1e-9, {0, 1e5},
               "wavefront error of the zone; replaces the camera's"),
    };
}

Fields fields(MeasuredMtf& m) {
    return {table("mtf", m.mtf, {"cycles_mm", "modulation"}, {0, 1e5}, {0, 1},
                  "MTF of the lens, from frequency 0 on")};
}

Fields fields(SettingsStep& s) {
    return {
        required(
            number("exposure_ms", s.exposure_s, 1e-3, {1e-3, 1e6}, "exposure time of this step's frame")),
        number("gain_db", s.gain_db, 1, {-60, 60}, "gain of this step's frame"),
    };
}

namespace {

Fields optics_fields(CameraModel& c) {
    return {
        required(number("focal_length_mm", c.focal_length_m, 1e-3, {0.1, 100000}, "focal length")),
        choice("projection", c.projection, {"rectilinear", "fisheye"}, "projection of the lens"),
        numbers("distortion", c.distortion, 1, {-100, 100}, {1, 5},
                "distortion coefficients k1, k2, p1, p2, k3 (Brown, as OpenCV); fisheye: k1 to k4"),
        numbers(
            "distortion_x_mm", c.distortion_x_mm, 1, {-1000, 1000}, {1, LensPolynomial::kMaxTerms},
            "horizontal distortion beyond `distortion`, to the right [mm], as a polynomial of the ideal "
            "image point x, y from the principal point [mm]: terms 1, x, y, x^2, x y, y^2, x^3, ... to y^5"),
        numbers("distortion_y_mm", c.distortion_y_mm, 1, {-1000, 1000}, {1, LensPolynomial::kMaxTerms},
                "vertical distortion beyond `distortion`, downward [mm], with the same terms"),
        numbers("principal_point_px", c.principal_point_px, 1, {-16384, 32768}, {2, 2},
                "point where the boresight meets the sensor; default: the sensor's centre"),
        required(number("f_number", c.f_number, 1, {0.5, 100}, "focal length over aperture diameter")),
        optional(number("t_number", c.t_number, 1, {0.5, 1000},
                        "T-number: f-number over the root of the transmission; replaces transmission"),
                 c.has_t_number),
        optional(
            curve("transmission", c.transmission, {0, 1},
                  "transmission of all lens elements and filters together; number or [[um, value], ...]"),
            c.has_transmission),
        number("central_obscuration_ratio", c.central_obscuration_ratio, 1, {0, 0.95},
               "diameter of the central obscuration over the aperture diameter"),
        number("defocus_um", c.defocus_m, 1e-6, {-10000, 10000},
               "axial displacement of the detector from best focus"),
        number("wavefront_rms_nm", c.wavefront_rms_m, 1e-9, {0, 1e5},
               "rms wavefront error of the lens as built (Shannon)"),
        numbers("zernike_nm", c.zernike_m, 1e-9, {-1e5, 1e5}, {1, 34},
                "rms coefficients of the wavefront's Zernike terms, from Noll's 4 on"),
        section("measured_mtf", c.measured_mtf,
                "measured MTF of the lens; replaces the MTF computed from diffraction and aberrations"),
        sections("field_zones", c.field_zones,
                 "lens properties at several image heights, interpolated between them"),
        number("cos_power", c.cos_power, 1, {0, 8}, "n: irradiance falls as cos^n of the field angle"),
        table("vignetting", c.vignetting, {"field_fraction", "transmission"}, {0, 1}, {0, 1},
              "transmission by image height, in addition to cos^n"),
        section("spider", c.spider, "vanes that hold the central obscuration"),
        section("stray_light", c.stray_light, "glare and ghost of the lens"),
        section("outside_light", c.outside_light,
                "glare and ghosts of the Sun and bodies outside the picture; left out: neither"),
        section("jitter", c.jitter, "jitter of the line of sight"),
    };
}

Fields detector_fields(CameraModel& c) {
    return {
        required(curve("quantum_efficiency", c.quantum_efficiency, {0, 1},
                       "electrons per photon; number or curve")),
        number("fill_factor", c.fill_factor, 1, {0.01, 1}, "light-sensitive share of a pixel's area"),
        numbers("pixel_aperture_um", c.pixel_aperture_m, 1e-6, {0.05, 100}, {2, 2},
                "width and height of a pixel's light-sensitive area; default: a square of fill_factor"),
        number("diffusion_um", c.diffusion_m, 1e-6, {0, 100}, "standard deviation of charge diffusion"),
        number("crosstalk_fraction", c.crosstalk_fraction, 1, {0, 0.2},
               "share of a pixel's charge that moves to each of its four neighbours"),
        section("color_filter", c.color_filter,
                "colour filter array: a mapping, one of the shipped RGGB, GRBG, GBRG and BGGR (generic "
                "filters), or mono (no filters)"),
        required(number("full_well_e", c.full_well_e, 1, {10, 1e8}, "full well (saturation capacity)")),
        numbers("nonlinearity", c.nonlinearity, 1, {-0.5, 0.5}, {1, 2},
                "coefficients a2, a3 of the read-out charge q (1 + a2 x + a3 x^2), with x = q / full well"),
        number("dark_current_e_s", c.dark_current_e_s, 1, {0, 1e8}, "mean dark current at dark_reference_c"),
        number("dark_reference_c", c.dark_reference_c, 1, {-200, 150},
               "temperature at which dark_current_e_s applies"),
        number("dark_doubling_k", c.dark_doubling_k, 1, {1, 50},
               "temperature rise that doubles the dark current"),
        number("temperature_c", c.temperature_c, 1, {-200, 150}, "temperature of the detector"),
        number("prnu_fraction", c.prnu_fraction, 1, {0, 0.5},
               "standard deviation of the gain from pixel to pixel"),
        number("dsnu_e", c.dsnu_e, 1, {0, 1e5}, "standard deviation of the offset from pixel to pixel"),
        section("fixed_pattern", c.fixed_pattern, "further pixel, row and column non-uniformity"),
        section("defects", c.defects, "defective pixels"),
        section("ccd", c.ccd, "charge transfer and blooming of a CCD"),
        section("cosmic_rays", c.cosmic_rays, "charged particles that strike the detector"),
        section("shutter", c.shutter, "shutter and exposure times of the rows"),
        number("read_noise_e", c.read_noise_e, 1, {0, 1e5}, "standard deviation of the temporal read noise"),
        number("reset_noise_e", c.reset_noise_e, 1, {0, 1e5},
               "kTC noise of sensors without correlated double sampling"),
        number("row_noise_e", c.row_noise_e, 1, {0, 1e5}, "row noise, drawn once per row and frame"),
        number("flicker_noise_e", c.flicker_noise_e, 1, {0, 1e5}, "1/f noise along the read-out"),
    };
}

Fields electronics_fields(CameraModel& c) {
    return {
        section("filters", c.filters, "analogue filters along the rows, applied after the noise"),
        optional(number("gain_dn_e", c.gain_dn_e, 1, {1e-6, 1e4}, "DN per electron at 0 dB"),
                 c.has_gain_dn_e),
        optional(
            number("gain_e_dn", c.gain_e_dn, 1, {1e-4, 1e6}, "electrons per DN at 0 dB; replaces gain_dn_e"),
            c.has_gain_e_dn),
        number("offset_dn", c.offset_dn, 1, {0, 65535}, "black level"),
        required(integer("bits", c.bits, {8, 16}, "bits of the ADC")),
        integer("sum_bits", c.sum_bits, {0, 16},
                "number of bits at which a sum of binned values saturates (binning: sum); 0: bits"),
        integer("container_bits", c.container_bits, {8, 16}, "bits per pixel in memory: 8 or 16"),
        choice("packing", c.packing, {"none", "pfnc", "gige"},
               "packing of pixels in memory. none: container_bits per pixel; pfnc: bit stream (Mono12p); "
               "gige: two pixels in three bytes"),
        section("converter", c.converter, "ADC errors, and companding"),
        numbers("window_px", c.window_px, 1, {0, 16384}, {4, 4},
                "left, top, width and height of the read-out window; default: the whole sensor"),
        integer("black_rows", c.black_rows, {0, 1024},
                "number of optically black rows above the picture, published with it"),
        integer("black_columns", c.black_columns, {0, 1024},
                "number of optically black columns left of the picture, published with it"),
        integer("binning_x", c.binning_x, {1, 16}, "number of columns binned into one"),
        integer("binning_y", c.binning_y, {1, 16}, "number of rows binned into one"),
        choice("binning", c.binning, {"charge", "sum", "mean"},
               "method of binning: sum of charge, or sum or mean of the DN"),
        number("exposure_ms", c.exposure_s, 1e-3, {1e-3, 1e7}, "exposure time at power-up"),
        number("gain_db", c.gain_db, 1, {-60, 60}, "gain at power-up, in addition to gain_dn_e"),
        number("frame_rate_hz", c.frame_rate_hz, 1, {1e-4, 10000}, "frame rate at power-up"),
        numbers("exposure_range_ms", c.exposure_range_s, 1e-3, {1e-3, 1e7}, {2, 2},
                "shortest and longest exposure time"),
        numbers("gain_range_db", c.gain_range_db, 1, {-60, 60}, {2, 2}, "lowest and highest gain"),
        numbers("frame_rate_range_hz", c.frame_rate_range_hz, 1, {1e-4, 10000}, {2, 2},
                "lowest and highest frame rate. A triggered frame leaves the camera, and the next trigger is "
                "accepted, at least one period of the highest rate after its exposure starts"),
        section("auto_exposure", c.auto_exposure, "auto-exposure of the camera"),
        sections("sequence", c.sequence, "settings of successive frames, repeated in a cycle"),
    };
}

}  // namespace

Fields fields(CameraModel& c) {
    Fields list = {
        text("name", c.name, "model name that clients see"),
        text("source", c.source, "source of the data"),
        required(integer("width_px", c.width_px, {1, 16384}, "number of columns")),
        required(integer("height_px", c.height_px, {1, 16384},
                         "number of rows; line_scan: number of lines in a frame")),
        required(number("pitch_um", c.pitch_m, 1e-6, {0.5, 100}, "distance between pixel centres")),
    };
    for (Fields part : {optics_fields(c), detector_fields(c), electronics_fields(c)})
        std::move(part.begin(), part.end(), std::back_inserter(list));
    return list;
}

// --- checks

namespace {

// unit: the keys' unit, in units of the values.
void check_range(double value, const std::vector<double>& range, const std::string& key,
                 const std::string& range_key, double unit = 1) {
    if (range[0] > range[1])
        throw KeyError(range_key, "found a lower limit above the upper; accepted: [lower, upper]");
    if (value < range[0] || value > range[1])
        throw KeyError(key, "lies outside " + range_key + " at power-up: found " + plain(value / unit) +
                                "; accepted: a value inside [" + plain(range[0] / unit) + ", " +
                                plain(range[1] / unit) + "], or another " + range_key);
}

void check_settings(const CameraModel& c) {
    constexpr double kMillisecond_s = 1e-3;
    if (c.shutter.kind != ShutterKind::kLineScan)
        check_range(c.exposure_s, c.exposure_range_s, "exposure_ms", "exposure_range_ms", kMillisecond_s);
    check_range(c.gain_db, c.gain_range_db, "gain_db", "gain_range_db");
    check_range(c.frame_rate_hz, c.frame_rate_range_hz, "frame_rate_hz", "frame_rate_range_hz");
    for (std::size_t i = 0; i < c.sequence.size(); ++i) {
        const std::string step = "sequence." + std::to_string(i) + ".";
        check_range(c.sequence[i].exposure_s, c.exposure_range_s, step + "exposure_ms", "exposure_range_ms",
                    kMillisecond_s);
        check_range(c.sequence[i].gain_db, c.gain_range_db, step + "gain_db", "gain_range_db");
    }
    if (c.auto_exposure.on && !c.sequence.empty())
        throw InputError("auto_exposure.on and sequence: a camera has one or the other; found both");
    if (c.shutter.kind == ShutterKind::kLineScan && (c.auto_exposure.on || !c.sequence.empty()))
        throw InputError(
            "shutter.kind line_scan: its exposure is tdi_stages x line_time_us; found auto_exposure or "
            "sequence");
}

// Checks that the lens does not fold over: directions to every corner of the field must map back to it.
void check_lens(const CameraModel& c) {
    if (c.projection == Projection::kFisheye && c.distortion.size() > 4)
        throw InputError("distortion: found 5 coefficients; accepted with projection fisheye: k1 to k4");
    if (c.projection == Projection::kFisheye && !(c.distortion_x_mm.empty() && c.distortion_y_mm.empty()))
        throw InputError(
            "distortion_x_mm, distortion_y_mm: found with projection fisheye; accepted: rectilinear");
    const ImageGeometry geometry = geometry_of(c, 0);
    for (const double x : {0.0, 0.5 * geometry.width_px, 1.0 * geometry.width_px})
        for (const double y : {0.0, 0.5 * geometry.height_px, 1.0 * geometry.height_px}) {
            const Vec2d back = geometry.project_px(geometry.direction_camera(x, y));
            if (!(std::abs(back.x - x) + std::abs(back.y - y) < 1e-6))
                throw InputError(
                    "distortion: the lens folds over inside the field, or sees 90 degrees off its axis; "
                    "accepted: coefficients that keep it monotonic to the corners");
        }
    if (c.has_t_number && c.has_transmission)
        throw InputError("t_number and transmission say the same; accepted: one of them");
    if (c.has_t_number && c.t_number < c.f_number)
        throw InputError("t_number " + plain(c.t_number) + " is below f_number " + plain(c.f_number) +
                         ": the lens would make light");
    if (!c.measured_mtf.mtf.empty()) {
        if (c.measured_mtf.mtf.x.front() != 0 || std::abs(c.measured_mtf.mtf.y.front() - 1) > 1e-6)
            throw InputError("measured_mtf.mtf begins at [" + plain(c.measured_mtf.mtf.x.front()) + ", " +
                             plain(c.measured_mtf.mtf.y.front()) + "]; accepted: [0, 1]");
        if (!c.field_zones.empty() || !c.zernike_m.empty() || c.wavefront_rms_m > 0 || c.defocus_m != 0)
            throw InputError(
                "measured_mtf stands in place of defocus_um, wavefront_rms_nm, zernike_nm and field_zones; "
                "found both");
    }
    for (std::size_t i = 1; i < c.field_zones.size(); ++i)
        if (c.field_zones[i].field_fraction <= c.field_zones[i - 1].field_fraction)
            throw KeyError("field_zones", "found field_fraction " + plain(c.field_zones[i].field_fraction) +
                                              " after " + plain(c.field_zones[i - 1].field_fraction) +
                                              "; accepted: values that rise from zone to zone");
}

void check_detector(const CameraModel& c) {
    check_spider(c.spider, spider_pupil(c));
    if (c.pixel_aperture_m.size() == 2)
        for (const double side : c.pixel_aperture_m)
            if (side > c.pitch_m)
                throw refused_key("pixel_aperture_um", plain(side * 1e6),
                                  "no more than pitch_um " + plain(c.pitch_m * 1e6));
    // The read charge must rise with the charge up to the full well.
    const double a2 = c.nonlinearity.empty() ? 0 : c.nonlinearity[0];
    const double a3 = c.nonlinearity.size() > 1 ? c.nonlinearity[1] : 0;
    for (int i = 0; i <= 100; ++i) {
        const double x = i / 100.0;
        if (1 + 2 * a2 * x + 3 * a3 * x * x <= 0)
            throw KeyError("nonlinearity",
                           "found a response that falls while the charge rises, at " + plain(x) +
                               " of the full well; accepted: coefficients with which it rises all the way");
    }
    if (c.shutter.kind != ShutterKind::kLineScan &&
        (c.shutter.tdi_stages > 1 || c.shutter.tdi_mismatch_fraction != 0))
        throw InputError("shutter.tdi_stages and tdi_mismatch_fraction need shutter.kind line_scan");
    if (c.shutter.kind == ShutterKind::kLineScan && (c.ccd.blooming || c.ccd.parallel_inefficiency > 0))
        throw InputError(
            "ccd.blooming and ccd.parallel_inefficiency need a sensor whose rows are neighbours; found "
            "shutter.kind line_scan");
    for (const auto* columns : {&c.defects.dead_columns, &c.defects.hot_columns})
        for (const double column : *columns)
            if (column >= static_cast<double>(c.width_px) || column != std::floor(column))
                throw InputError("defects: column " + plain(column) + "; accepted: whole, below width_px " +
                                 std::to_string(c.width_px));
}

void check_electronics(const CameraModel& c) {
    if (c.has_gain_dn_e == c.has_gain_e_dn && !(c.gain_dn_e > 0 && !c.has_gain_e_dn))
        throw InputError(std::string("a camera has either gain_dn_e or gain_e_dn; found ") +
                         (c.has_gain_dn_e ? "both" : "neither"));
    if (c.container_bits != 8 && c.container_bits != 16)
        throw refused_key("container_bits", std::to_string(c.container_bits), "8 or 16");
    if (c.frame_bits() > c.container_bits)
        throw InputError("bits " + std::to_string(c.frame_bits()) + " do not fit into container_bits " +
                         std::to_string(c.container_bits) + "; accepted: no more bits than that");
    if (c.packing == Packing::kGige && c.frame_bits() != 10 && c.frame_bits() != 12)
        throw InputError("packing gige with " + std::to_string(c.frame_bits()) + " bits; accepted: 10 or 12");
    const double max_dn = std::exp2(static_cast<double>(c.bits)) - 1;
    if (c.offset_dn >= max_dn)
        throw KeyError("offset_dn", plain(c.offset_dn) + " leaves nothing of the ADC's " +
                                        std::to_string(c.bits) + " bits; accepted: below " + plain(max_dn));
    if (c.sum_bits != 0 && c.binning != BinningKind::kSum)
        throw KeyError("sum_bits", "has no effect without binning: sum; accepted: both or neither");
    if (c.sum_bits != 0 && c.sum_bits < c.bits)
        throw refused_key("sum_bits", std::to_string(c.sum_bits),
                          "no less than bits " + std::to_string(c.bits));
    if (c.converter.companding != Companding::kNone && c.bits == 8)
        throw InputError("converter.companding to 8 bits; found bits 8");
}

void check_rectangles(const CameraModel& c) {
    for (const double number : c.window_px)
        if (number != std::floor(number)) throw refused_key("window_px", plain(number), "whole pixels");
    const PixelRectangle w = window_of(c);
    if (w.width < 1 || w.height < 1 || w.left + w.width > c.width_px || w.top + w.height > c.height_px)
        throw KeyError("window_px", "reaches outside the sensor of " + std::to_string(c.width_px) + " x " +
                                        std::to_string(c.height_px) + ": found left " +
                                        std::to_string(w.left) + ", top " + std::to_string(w.top) + ", " +
                                        std::to_string(w.width) + " x " + std::to_string(w.height));
    const auto [width, height] = array_size(c);
    if (width < c.binning_x || height < c.binning_y)
        throw InputError("binning_x, binning_y: found " + std::to_string(c.binning_x) + " and " +
                         std::to_string(c.binning_y) +
                         "; accepted: no more than the columns and rows read out, " + std::to_string(width) +
                         " x " + std::to_string(height));
}

}  // namespace

void validate(const CameraModel& c) {
    check_rectangles(c);
    check_settings(c);
    check_lens(c);
    check_detector(c);
    check_electronics(c);
}

// --- derived figures

double CameraModel::system_gain_dn_e(double at_gain_db) const {
    const double at_0_db = has_gain_e_dn ? 1 / gain_e_dn : gain_dn_e;
    return at_0_db * std::pow(10.0, at_gain_db / 20);
}

double CameraModel::read_e(double charge_e) const {
    const double a2 = nonlinearity.empty() ? 0 : nonlinearity[0];
    const double a3 = nonlinearity.size() < 2 ? 0 : nonlinearity[1];
    const double q = std::min(charge_e, full_well_e), x = q / full_well_e;
    return q * (1 + x * (a2 + x * a3));
}

double CameraModel::charge_of_read_e(double read) const {
    if (const double well_e = read_e(full_well_e); read >= well_e) return full_well_e + (read - well_e);
    // The read charge rises with the charge (validate()).
    double min_e = 0, max_e = full_well_e;
    for (int step = 0; step < 60; ++step) {
        const double middle_e = 0.5 * (min_e + max_e);
        (read_e(middle_e) < read ? min_e : max_e) = middle_e;
    }
    return max_e;
}

double CameraModel::dark_current_now_e_s() const {
    return dark_current_e_s * std::exp2((temperature_c - dark_reference_c) / dark_doubling_k);
}

double CameraModel::dark_noise_e() const {
    return std::sqrt(read_noise_e * read_noise_e + reset_noise_e * reset_noise_e + row_noise_e * row_noise_e +
                     flicker_noise_e * flicker_noise_e);
}

double CameraModel::pixel_aperture_x_m() const {
    return pixel_aperture_m.size() == 2 ? pixel_aperture_m[0] : pitch_m * std::sqrt(fill_factor);
}
double CameraModel::pixel_aperture_y_m() const {
    return pixel_aperture_m.size() == 2 ? pixel_aperture_m[1] : pitch_m * std::sqrt(fill_factor);
}

PixelRectangle window_of(const CameraModel& c) {
    if (c.window_px.size() != 4) return {0, 0, static_cast<int>(c.width_px), static_cast<int>(c.height_px)};
    const auto at = [&](std::size_t i) { return static_cast<int>(c.window_px[i]); };
    return {at(0), at(1), at(2), at(3)};
}

std::array<int, 2> array_size(const CameraModel& c) {
    const PixelRectangle w = window_of(c);
    return {w.width + static_cast<int>(c.black_columns), w.height + static_cast<int>(c.black_rows)};
}

std::array<int, 2> frame_size(const CameraModel& c, std::int64_t binning_x, std::int64_t binning_y) {
    const auto [width, height] = array_size(c);
    return {width / static_cast<int>(binning_x > 0 ? binning_x : c.binning_x),
            height / static_cast<int>(binning_y > 0 ? binning_y : c.binning_y)};
}

std::array<std::int64_t, 2> binning_of(const CameraModel& c, const Exposure& e) {
    return {e.binning_x > 0 ? e.binning_x : c.binning_x, e.binning_y > 0 ? e.binning_y : c.binning_y};
}

ImageGeometry geometry_of(const CameraModel& c, int guard_px, int oversampling) {
    const auto coefficient = [&](std::size_t i) { return i < c.distortion.size() ? c.distortion[i] : 0.0; };
    const PixelRectangle w = window_of(c);
    ImageGeometry g;
    g.width_px = w.width * oversampling;
    g.height_px = w.height * oversampling;
    g.guard_px = guard_px * oversampling;
    g.focal_length_px = c.focal_length_m / c.pitch_m * oversampling;
    if (c.projection == Projection::kFisheye) {
        g.distortion.projection = Projection::kFisheye;
        g.distortion.k1 = coefficient(0), g.distortion.k2 = coefficient(1);
        g.distortion.k3 = coefficient(2), g.distortion.k4 = coefficient(3);
    } else {
        g.distortion.k1 = coefficient(0), g.distortion.k2 = coefficient(1);
        g.distortion.p1 = coefficient(2), g.distortion.p2 = coefficient(3);
        g.distortion.k3 = coefficient(4);
        g.distortion.polynomial =
            lens_polynomial(c.distortion_x_mm, c.distortion_y_mm, c.focal_length_m * 1e3);
    }
    const bool given = c.principal_point_px.size() == 2;
    const Vec2d principal =
        given ? Vec2d{c.principal_point_px[0], c.principal_point_px[1]}
              : Vec2d{0.5 * static_cast<double>(c.width_px), 0.5 * static_cast<double>(c.height_px)};
    g.principal_offset_px = {(principal.x - w.left - 0.5 * w.width) * oversampling,
                             (principal.y - w.top - 0.5 * w.height) * oversampling};
    return g;
}

}  // namespace hilcam
