#pragma once
// A camera in the terms of its data sheet (EMVA 1288 vocabulary). One YAML file is one camera.
//
// There are three rectangles: the sensor (width_px x height_px); its window, which is exposed and rendered;
// and the read-out array, which is the window with optically black columns at its left and black rows above
// it. After binning, the array is the frame.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image_geometry.h"
#include "sensor/auto_exposure.h"
#include "sensor/ccd.h"
#include "sensor/color_filter.h"
#include "sensor/cosmic_rays.h"
#include "sensor/electronics.h"
#include "sensor/exposure.h"
#include "sensor/fixed_pattern.h"
#include "sensor/motion.h"
#include "sensor/packing.h"
#include "sensor/shutter.h"
#include "sensor/stray/outside_light.h"
#include "sensor/stray/spider.h"
#include "sensor/stray/stray_light.h"

namespace hilcam {

// The lens at one image height. Between zones, the images are blended.
struct FieldZone {
    double field_fraction = 0;  // image height over that of the sensor's corner
    double defocus_m = 0;
    double wavefront_rms_m = 0;
};
Fields fields(FieldZone& zone);

// A measured modulation transfer function of the lens. It replaces diffraction and aberrations.
struct MeasuredMtf {
    Table mtf;  // spatial frequency on the detector [cycles/mm], modulation 0..1
};
Fields fields(MeasuredMtf& mtf);

enum class BinningKind { kCharge, kSum, kMean };

// A step in a sequence of settings.
struct SettingsStep {
    double exposure_s = 1e-3;
    double gain_db = 0;
};
Fields fields(SettingsStep& step);

struct CameraModel {
    std::string name;
    std::string source;  // source of the figures

    // Geometry.
    std::int64_t width_px = 1024;
    std::int64_t height_px = 1024;
    double pitch_m = 5.5e-6;
    double focal_length_m = 0.016;
    std::vector<double> principal_point_px;  // on the sensor; empty: its centre
    Projection projection = Projection::kRectilinear;
    std::vector<double> distortion;       // k1, k2, p1, p2, k3 (or k1..k4 of a fisheye) in OpenCV's order
    std::vector<double> distortion_x_mm;  // terms of a LensPolynomial [mm] in the image plane
    std::vector<double> distortion_y_mm;

    // Optics.
    double f_number = 4;
    double t_number = 0;                        // replaces transmission; 0: not given
    Curve transmission = Curve::constant(0.9);  // glass and all filters together, 0..1
    double central_obscuration_ratio = 0;       // diameter of the obstruction over that of the aperture
    double defocus_m = 0;                       // distance of the image plane from focus
    double wavefront_rms_m = 0;
    std::vector<double> zernike_m;  // rms coefficients, from Noll's fourth on
    MeasuredMtf measured_mtf;
    std::vector<FieldZone> field_zones;
    double cos_power = 4;  // irradiance falls as cos^n of the field angle
    Table vignetting;      // image height fraction, relative illumination in addition to cos^n
    StrayLightConfig stray_light;
    std::optional<OutsideLightConfig> outside_light;
    SpiderConfig spider;

    JitterConfig jitter;
    ShutterConfig shutter;

    // Detector.
    Curve quantum_efficiency =
        Curve::constant(0.5);  // electrons per photon on the light-sensitive area, 0..1
    double fill_factor = 1;    // light-sensitive share of the pixel
    // Width, height; empty: a centred square with the fill factor's area.
    std::vector<double> pixel_aperture_m;
    double diffusion_m = 0;         // standard deviation of charge diffusion before collection
    double crosstalk_fraction = 0;  // share of a pixel's charge that each of its four neighbours receives
    ColorFilterArrayConfig color_filter;
    double full_well_e = 1e4;
    std::vector<double> nonlinearity;  // a2, a3: charge q becomes q (1 + a2 x + a3 x^2), x = q / full well
    double dark_current_e_s = 0;       // mean at dark_reference_c
    double dark_reference_c = 25;
    double dark_doubling_k = 7;
    double temperature_c = 25;
    double prnu_fraction = 0;  // standard deviation over pixels
    double dsnu_e = 0;         // standard deviation over pixels
    FixedPatternConfig fixed_pattern;
    DefectsConfig defects;
    CcdConfig ccd;
    CosmicRayConfig cosmic_rays;

    // Temporal noise: standard deviations.
    double read_noise_e = 0;
    double reset_noise_e = 0;    // kTC
    double row_noise_e = 0;      // common to a row, new in each frame
    double flicker_noise_e = 0;  // 1/f along the read-out

    // Electronics.
    FilterConfig filters;
    double gain_dn_e = 0;  // DN per electron at 0 dB (EMVA's K)
    double gain_e_dn = 0;  // inverse of gain_dn_e, as some data sheets give it
    double offset_dn = 0;
    std::int64_t bits = 12;            // bits of the converter
    std::int64_t sum_bits = 0;         // for sums of binned numbers; 0: the same as the converter's
    std::int64_t container_bits = 16;  // bits of a pixel in memory
    Packing packing = Packing::kNone;  // packing of pixels in memory
    ConverterConfig converter;

    // Read-out.
    std::vector<double> window_px;  // left, top, width, height; empty: the whole sensor
    std::int64_t black_rows = 0, black_columns = 0;
    std::int64_t binning_x = 1, binning_y = 1;
    BinningKind binning = BinningKind::kCharge;

    // Settings at power-up, and accepted ranges.
    double exposure_s = 1e-3;
    double gain_db = 0;
    double frame_rate_hz = 30;
    std::vector<double> exposure_range_s = {1e-6, 10};
    std::vector<double> gain_range_db = {0, 24};
    std::vector<double> frame_rate_range_hz = {0.01, 200};
    AutoExposureConfig auto_exposure;
    std::vector<SettingsStep> sequence;  // frame k uses step (k - 1) mod n

    bool has_gain_dn_e = false, has_gain_e_dn = false, has_t_number = false, has_transmission = false;

    double aperture_diameter_m() const { return focal_length_m / f_number; }
    // Returns DN per electron at a gain setting.
    double system_gain_dn_e(double at_gain_db) const;
    // Returns the charge that the amplifier reads for an actual charge, limited at the full well [e-].
    double read_e(double charge_e) const;
    // Inverse of read_e(). Beyond the full well's reading, where no charge exists, it continues with slope 1.
    double charge_of_read_e(double read_e) const;
    // Returns the mean dark current at the operating temperature [e-/s], which doubles every dark_doubling_k.
    double dark_current_now_e_s() const;
    // Returns the temporal noise of a dark pixel before the converter, without dark current [e-].
    double dark_noise_e() const;
    // Returns the bits of a published pixel: 8 if companded.
    int frame_bits() const { return converter.companding == Companding::kNone ? number_bits() : 8; }
    // Returns the bits of a number before companding.
    int number_bits() const { return static_cast<int>(sum_bits > bits ? sum_bits : bits); }
    PixelLayout pixel_layout() const { return {packing, frame_bits(), static_cast<int>(container_bits)}; }
    double pixel_aperture_x_m() const;
    double pixel_aperture_y_m() const;
};

Fields fields(CameraModel& camera);
// Throws InputError, naming the keys, for settings that are contradictory or impossible.
void validate(const CameraModel& camera);

// Returns the binning of an exposure, columns and rows.
std::array<std::int64_t, 2> binning_of(const CameraModel& camera, const Exposure& exposure);

struct PixelRectangle {
    int left = 0, top = 0, width = 0, height = 0;
};
// Returns the exposed part of the sensor [px of the sensor].
PixelRectangle window_of(const CameraModel& camera);
// Returns width and height of the read-out array: the window with its black columns and rows.
std::array<int, 2> array_size(const CameraModel& camera);
// Returns width and height of a published frame with the given binning (0: the camera file's).
std::array<int, 2> frame_size(const CameraModel& camera, std::int64_t binning_x = 0,
                              std::int64_t binning_y = 0);

// Returns the geometry of the window with each pixel split into `oversampling` x `oversampling` parts.
// guard_px: in detector pixels.
ImageGeometry geometry_of(const CameraModel& camera, int guard_px, int oversampling = 1);

}  // namespace hilcam
