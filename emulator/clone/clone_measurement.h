#pragma once
// Measures one particular camera from its frames: the figures of its camera file with their uncertainties,
// maps of its pixels, and its defects.
//
// Gain, response, dark current and spreads come from the estimators of `hilcam characterise`
// (sensor/measure/emva1288.h), which get their light from the lamp; here only the ratio of the light from
// flat to flat is known, from exposure times or the manifest. So the quantum efficiency is not measured. What
// shows the lens is measured by itself (clone_optics.h). The illumination's own shading looks like the
// sensor's: a smooth surface is divided out of the flats.
//
// Figures hold for the temperature of the flats, or that with the most series of darks. The noise of the
// darks is freed of rounding exactly (sensor/measure/quantiser.h).

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/clone/clone_optics.h"
#include "emulator/clone/frame_set.h"
#include "sensor/camera_model.h"
#include "sensor/measure/emva1288.h"
#include "sensor/measure/pixel_maps.h"

namespace hilcam {

struct MeasuredLevel {
    std::size_t series = 0;
    LightPoint point;     // photons: relative light
    double charge_e = 0;  // mean charge of the light
    bool saturated = false;
};
struct MeasuredDark {
    std::size_t series = 0;
    double temperature_c = 0;
    DarkPoint point;
};
struct DarkAtTemperature {
    double temperature_c = 0;
    Measured dark_current_e_s;
};

// A map over the sensor, with the spread of its pixels that count.
struct PixelValues {
    std::vector<double> value;
    MapSpread spread;
};

struct CloneMeasurement {
    int width = 0, height = 0, bits = 0;
    double temperature_c = 0;
    bool temperature_told = false;  // the frames' names or manifest state it
    double gain_db = 0;
    bool light_known = false;  // ratios of the light from flat to flat
    PixelSelection good;       // pixels without defects

    std::vector<MeasuredLevel> light;  // rising signal
    std::vector<MeasuredDark> dark;    // rising exposure
    Measured gain_dn_e, standard_gain_dn_e;
    std::optional<Bend> nonlinearity;
    std::optional<Linearity> linearity;
    std::optional<Measured> full_well_e;
    double full_well_at_least_e = 0;  // charge of the brightest flat that does not saturate
    double saturation_dn = 0;

    Measured offset_dn, read_noise_e, row_noise_e, column_noise_e;
    std::optional<Measured> dark_current_e_s;
    std::optional<Measured> dark_doubling_k;
    std::vector<DarkAtTemperature> dark_currents;
    Nonuniformity dsnu_e, prnu_fraction;
    std::optional<Nonuniformity> dark_spread_e_s;

    PixelValues offset_e, dark_e_s, gain;  // dark_e_s: empty when there is one exposure; gain: mean 1
    std::vector<ListedDefect> defects;
    double hot_limit_e_s = 0;  // excess of dark current from which a pixel is listed as hot
    Measured blinking_frames;  // mean number of frames between two draws of a blinking pixel's state; 0: none
    CloneOptics optics;        // filled by measure_optics()
    std::vector<std::string> remarks;  // limits of these figures that a reader must know
};

// like: a camera of the same type, for its size, colour filters and temperature. progress: called now and
// then with the share of the work that is done. Throws InputError, one line, for frames that do not fit
// together or from which this cannot be measured.
CloneMeasurement measure_clone(const FrameSet& frames, const CameraModel& like,
                               const std::function<void(double)>& progress);

}  // namespace hilcam
