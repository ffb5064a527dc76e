#pragma once
// `hilcam characterise`: measures the emulated camera as a laboratory would, from its own frames through the
// whole chain (camera_bench.h), after EMVA 1288 (sensor/measure/emva1288.h) and ISO 12233
// (sensor/measure/slanted_edge.h), and sets the figures beside those of the data sheet. The result depends on
// the camera file alone.

#include <string>
#include <vector>

#include "emulator/characterise/characterise_mtf.h"
#include "emulator/characterise/characterise_setup.h"
#include "sensor/measure/emva1288.h"

namespace hilcam {

struct LightLevel {
    double exposure_s = 0, filter = 0;
    LightPoint point;
};

struct Characterisation {
    LabSetup setup;
    std::size_t pixels = 0, defects = 0;  // looked at; left out as defects
    std::uint64_t frames = 0;

    // With light.
    std::vector<LightLevel> light;
    Measured standard_gain_dn_e, gain_dn_e;  // EMVA's one slope; of small signals
    Measured quantum_efficiency;
    Measured saturation_capacity_e;  // at the greatest temporal variance
    Measured full_well_e;            // of strongly over-exposed frames
    Linearity linearity, configured_linearity;
    double shot_bandwidth = 1;  // of white noise, by charge transfer and filters
    Nonuniformity prnu_fraction;

    // In the dark.
    std::vector<DarkPoint> dark;
    Measured dark_gain_dn_e;  // at the gain of these frames
    DarkCurrent dark_current;
    Measured dark_noise_e;
    double read_bandwidth = 1;  // by filters
    Nonuniformity dsnu_e;

    MtfCurve horizontal, vertical;
};

Characterisation characterise(const CameraModel& camera, const DetectorPictures& pictures);

}  // namespace hilcam
