#include "emulator/characterise/characterise_mtf.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/measure/slanted_edge.h"

namespace hilcam {
namespace {

// Size across and along the edge. In 256 rows, an edge at 5 degrees passes 22 pixels of the grid.
constexpr int kAcross_px = 144, kAlong_px = 256;
constexpr double kTilt_rad = 5 * kDegree_rad;
constexpr double kBrightAlbedo = 0.8, kDarkAlbedo = 0.2;
constexpr double kBright_fraction = 0.8;  // brightness of the bright plate as a share of saturation
// Eight radiance pixels across a detector pixel, so that frequencies above the detector's Nyquist are not
// aliased before the MTF acts on them; and two rays, so that the steps of an edge on their grid stay below
// 0.001.
constexpr SensorSampling kFineSampling{16, 8, 2};
// Noise of a calibrated pixel relative to the edge's step. The MTF at Nyquist is a mean over some ten
// thousand pixels and has about the same error.
constexpr double kPixelNoise = 7e-4;
constexpr int kMinFrames = 16, kMaxFrames = 2048;

LabSetup windowed(LabSetup s, EdgeDirection direction) {
    const PixelRectangle w = window_of(s.camera);
    const bool rows = direction == EdgeDirection::kAlongRows;
    require_lines(s.camera, kAlong_px);
    const int top = s.camera.shutter.kind == ShutterKind::kLineScan ? 0 : w.top;
    const int room =
        s.camera.shutter.kind == ShutterKind::kLineScan ? static_cast<int>(s.camera.height_px) : w.height;
    const int width = std::min(rows ? kAcross_px : kAlong_px, w.width);
    const int height = std::min(rows ? kAlong_px : kAcross_px, room);
    s.camera.window_px = {w.left + std::floor(0.5 * (w.width - width)),
                          top + std::floor(0.5 * (room - height)), 1.0 * width, 1.0 * height};
    return s;
}

struct Picture {
    std::vector<double> mean_dn;
    double variance_dn2 = 0;  // temporal, of a mean pixel in one frame
};

Picture take(CameraBench& bench, const Exposure& exposure, double filter, const PixelSelection& selection,
             int frames) {
    bench.expose(exposure, filter);
    FrameStack stack(selection);
    for (int i = 0; i < frames; ++i) stack.add(bench.frame());
    const std::vector<double> variance = stack.temporal_variance_dn2();
    double sum = 0;
    for (std::size_t i = 0; i < variance.size(); ++i) sum += selection.use[i] ? variance[i] : 0;
    return {stack.mean_dn(), sum / static_cast<double>(selection.count())};
}

// Photons of each pixel, without the light that arrives while rows of a frame-transfer CCD pass. That light
// is the same for every exposure, so the difference of two exposures removes it.
struct LightPicture {
    std::vector<double> photons;
    double variance = 0;  // variance of a pixel's mean
};

LightPicture light_of(CameraBench& bench, const LabSetup& s, const ResponseCurve& response, double filter,
                      const PixelSelection& selection, int frames) {
    const bool smears = s.camera.shutter.kind == ShutterKind::kFrameTransfer;
    const auto at = [&](double exposure_s) {
        const Exposure exposure{exposure_s, s.gain_db, {}, {}};
        const Picture light = take(bench, exposure, filter, selection, frames);
        const Picture dark = take(bench, exposure, 0, selection, frames);
        LightPicture out;
        for (std::size_t i = 0; i < light.mean_dn.size(); ++i)
            out.photons.push_back(response.photons(light.mean_dn[i] - dark.mean_dn[i]));
        const double slope = response.responsivity_dn_photon().value;
        out.variance = (light.variance_dn2 + dark.variance_dn2) / frames / (slope * slope);
        return out;
    };
    LightPicture out = at(s.exposure_s);
    if (!smears) return out;
    const LightPicture brief = at(s.shortest_s);
    for (std::size_t i = 0; i < out.photons.size(); ++i) out.photons[i] -= brief.photons[i];
    out.variance += brief.variance;
    return out;
}

// Imperfect charge transfer along a direction, on average over the picture: exp(-n c (1 - cos 2 pi f)) after
// n transfers (Janesick, Scientific Charge-Coupled Devices, SPIE, 2001, ch. 5).
double transfer_mtf(const CameraModel& c, double u, double v) {
    const auto [width, height] = array_size(c);
    const PixelRectangle window = window_of(c);
    const auto along = [](double inefficiency, double transfers, double f) {
        return std::exp(-inefficiency * transfers * (1 - std::cos(2 * kPi * f)));
    };
    return along(c.ccd.serial_inefficiency, window.left + 0.5 * width, u) *
           along(c.ccd.parallel_inefficiency, window.top + 0.5 * height, v);
}

}  // namespace

std::size_t MtfCurve::nyquist() const {
    const auto at =
        std::find_if(frequency_cy_px.begin(), frequency_cy_px.end(), [](double f) { return f > 0.5 - 1e-9; });
    return static_cast<std::size_t>(at - frequency_cy_px.begin());
}

MtfCurve measure_mtf(const LabSetup& setup, const ResponseCurve& response, EdgeDirection direction,
                     const DetectorPictures& pictures, const std::function<void(double)>& told) {
    const LabSetup s = windowed(setup, direction);
    PixelSelection selection = lab_selection(s);
    CameraBench bench(s.camera, s.grid, kFineSampling, s.lamp_w_m2_um, pictures);
    const double tilt_rad = direction == EdgeDirection::kAlongRows ? kTilt_rad : kTilt_rad - kPi / 2;
    const double filter = kBright_fraction / kOverexposure / kBrightAlbedo;

    // The shot noise of the bright plate, relative to the step, determines the number of frames.
    const double bright_e = kBright_fraction * configured_saturation_e(s.camera, s.gain_db);
    const double step_e = bright_e * (1 - kDarkAlbedo / kBrightAlbedo);
    const double noise = std::hypot(std::sqrt(2.5 * bright_e), 3 * s.camera.dark_noise_e()) / step_e;
    const int frames = static_cast<int>(
        std::clamp(std::ceil(std::pow(noise / kPixelNoise, 2)), 1.0 * kMinFrames, 1.0 * kMaxFrames));

    int pictures_taken = 0;
    const auto picture_of = [&](double left, double right) {
        bench.show({left, right, tilt_rad});
        LightPicture picture = light_of(bench, s, response, filter, selection, frames);
        told(++pictures_taken / 3.0);
        return picture;
    };
    const LightPicture bright = picture_of(kBrightAlbedo, kBrightAlbedo);
    const LightPicture dark = picture_of(kDarkAlbedo, kDarkAlbedo);
    const LightPicture edge = picture_of(kBrightAlbedo, kDarkAlbedo);

    std::vector<double> value(edge.photons.size()), step(value.size());
    double mean_step = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        step[i] = bright.photons[i] - dark.photons[i];
        if (selection.use[i]) mean_step += step[i] / static_cast<double>(selection.count());
    }
    exclude_outliers(step, 8, selection);
    for (std::size_t i = 0; i < value.size(); ++i)
        value[i] = selection.use[i] ? (edge.photons[i] - dark.photons[i]) / step[i] : 0;

    // Close to either side, the error of that side's plate is the same as that of the edge picture.
    const double pixel_noise =
        std::sqrt(edge.variance + std::max(bright.variance, dark.variance)) / mean_step;
    // The distance to either side that every row of the picture reaches.
    const bool along_rows = direction == EdgeDirection::kAlongRows;
    const double across = along_rows ? selection.width : selection.height;
    const double along = along_rows ? selection.height : selection.width;
    const double reach_px = std::min(32.0, 0.5 * (across - along * std::tan(kTilt_rad)) - 1);
    const EdgeMtf mtf =
        slanted_edge_mtf({selection.width, selection.height, value, selection.use, pixel_noise},
                         {.step = 1, .half_width_px = reach_px});
    MtfCurve out{mtf.normal_rad, mtf.frequency_cy_px, {}, mtf.mtf, mtf.uncertainty};
    // At zero frequency the calibration makes this 1; the step near the edge belongs to higher frequencies.
    out.measured.front() = 1, out.uncertainty.front() = 0;
    for (const double f : mtf.frequency_cy_px) {
        const double u = std::abs(f * std::cos(mtf.normal_rad)), v = std::abs(f * std::sin(mtf.normal_rad));
        out.configured.push_back(bench.chain().mtf(u, v) * transfer_mtf(s.camera, u, v));
    }
    return out;
}

}  // namespace hilcam
