#pragma once
// `hilcam characterise`: measures the emulated camera as a laboratory would, from frames that pass the whole
// chain (camera_bench.h), by EMVA 1288 (sensor/measure/emva1288.h) and ISO 12233
// (sensor/measure/slanted_edge.h). The results stand beside the data sheet's figures and depend only on the
// camera file.

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
    std::size_t pixels = 0, defects = 0;  // measured pixels; pixels excluded as defects
    std::uint64_t frames = 0;

    // Measurements with light.
    std::vector<LightLevel> light;
    Measured standard_gain_dn_e, gain_dn_e;  // EMVA's single slope; slope for small signals
    Measured quantum_efficiency;
    Measured saturation_capacity_e;  // charge at the largest temporal variance
    Measured full_well_e;            // from strongly over-exposed frames
    Linearity linearity, configured_linearity;
    // Noise bandwidth: below 1 where charge transfer and filters narrow white noise.
    double shot_bandwidth = 1;
    Nonuniformity prnu_fraction;

    // Measurements in the dark.
    std::vector<DarkPoint> dark;
    Measured dark_gain_dn_e;  // at the gain of the dark frames
    DarkCurrent dark_current;
    Measured dark_noise_e;
    double read_bandwidth = 1;  // narrowed by filters
    Nonuniformity dsnu_e;

    MtfCurve horizontal, vertical;
};

Characterisation characterise(const CameraModel& camera, const DetectorPictures& pictures);

}  // namespace hilcam
