#pragma once
// Makes frames of a scenario's first instant and discards them, to measure what frames cost on this machine.

#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/scenario/app_config.h"
#include "sensor/chain.h"

namespace hilcam {

// A frame with more primary rays takes a minute or more, so none is made just to be measured.
inline constexpr double kMaxTrialRays = 32e6;
// Returns how many rays a frame of that quality starts at the camera when it has no visibility buffer.
double primary_rays(const ScenarioConfig& scenario, const RenderQuality& quality);

// Cost of one frame.
struct TrialCost {
    double render_ms = 0;  // from the world to the radiance image, on all threads
    double sensor_ms = 0;  // from the radiance image to DN
    double core_ms = 0;    // processor time of both, over all threads of the program
};

class TrialFrames {
  public:
    struct Parts {
        ExposureRenderer& exposures;
        SensorChain& chain;
        WorldState& world;
        const ScenarioConfig& scenario;  // scenario as the camera has it
        std::uint64_t seed;
    };
    // All parts must outlive this object. No loop may run meanwhile. Owner thread.
    explicit TrialFrames(const Parts& parts);

    // Makes a frame at the present level of the exposures. Owner thread.
    TrialCost take();

  private:
    Parts parts_;
    TimeTai start_;
    RadianceImage radiance_;
    std::vector<PointSource> points_;
    std::vector<SideLight> beside_;
    ElectronImage electrons_;
    DnImage frame_;
    Exposure exposure_;
    std::uint64_t taken_ = 0;
};

}  // namespace hilcam
