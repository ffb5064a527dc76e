#pragma once
// Renders the reference picture of what a still camera sees, and measures how far other renderings are from
// it.
//
// The reference is the mean of frames with independent light paths. They form two halves, and half the
// difference of their means is the standard error of the whole mean. Frames are added until that is small, by
// a rule that depends on the pictures alone, so a scenario has the same reference on every machine. The
// standard error does not include what all frames have in common: the grid of rays in a pixel, the number of
// bins, the depth.
//
// The target is the scenario's first object with its parts on joints. Its window is the box of their bounding
// spheres, 8 px wider for the lens's blur. All light in the window counts as the target's.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/run/still_camera.h"
#include "emulator/tradeoff/image_error.h"
#include "emulator/tradeoff/limb_error.h"

namespace hilcam {

// Magnitudes of errors. An empty value means that the picture contains nothing of that kind.
struct PictureErrors {
    NoiseError noise;
    double false_lights = 0;            // number of pixels (image_error.h); over several frames, the mean
    std::optional<double> centroid_px;  // distance between the centroids of the target's light
    std::optional<double> photometric_fraction;  // error as a share of the target's light
    std::optional<double> limb_px;               // over all bodies in view (limb_error.h)
    std::optional<double> similarity;            // over the range up to saturation (structural_similarity.h)
};

struct ReferenceLimits {
    // Sufficient standard error of 99 % of the lit pixels, in their own sensor noise.
    double standard_error_sigma = 0.05;
    int max_frames = 64;  // a power of two, at least 4
};

struct ReferencePicture {
    ElectronImage mean;         // [e-], saturated
    ElectronImage dark;         // picture without light
    NoiseError standard_error;  // |standard error| / sigma over lit pixels, if there are any
    int frames = 0;
    double seconds = 0;  // time to make it
};
// camera: for that scenario, in its present position. Owner thread.
ReferencePicture render_reference(StillCamera& camera, const ScenarioConfig& scenario,
                                  const ReferenceLimits& limits,
                                  const std::function<void(const std::string&)>& log);

class PictureJudge {
  public:
    // camera: for the scenario at any quality, in the position where the reference was made; it provides the
    // places of things.
    PictureJudge(const ScenarioConfig& scenario, const StillCamera& camera, ReferencePicture reference);

    // electrons: from StillCamera::expose() of the same camera.
    PictureErrors errors(const ElectronImage& electrons) const;
    // Return, for each lit pixel (image_error.h), the distance of a picture from the reference, and from
    // another rendering.
    std::vector<double> lit_errors(const ElectronImage& electrons) const;
    std::vector<double> lit_scatter(const ElectronImage& electrons, const ElectronImage& other) const;

    const ReferencePicture& reference() const { return reference_; }
    double saturation_e() const { return saturation_e_; }

  private:
    ElectronImage saturated(const ElectronImage& electrons) const;
    void find_target(const StillCamera& camera, const ScenarioConfig& scenario);
    void find_limbs(const StillCamera& camera, const ScenarioConfig& scenario);

    SensorNoise noise_;
    double saturation_e_;
    Vec2d offset_px_;  // position of the window in the array
    ReferencePicture reference_;
    PixelBox target_;
    std::optional<WindowLight> target_light_;
    std::vector<LimbPlace> limbs_;
};

// Renders the reference of a scenario's first instant and returns its judge. Throws InputError when nothing
// in it is brighter than the sensor's dark noise.
PictureJudge first_instant_judge(const ScenarioConfig& reference, const ReferenceLimits& limits,
                                 const std::function<void(const std::string&)>& log);

}  // namespace hilcam
