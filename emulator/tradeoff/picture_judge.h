#pragma once
// The reference picture of what a still camera sees, and how far other renderings of it are from that.
//
// The reference is a mean of frames with light paths of their own. They come in two halves; the standard
// error of the mean of both is half their difference. Frames are added until that is small, by a rule that
// looks at the pictures only: the same scenario has the same reference on any machine. What all its frames
// have in common (the grid of rays in a pixel, the number of bins, the depth) is not in that standard error.
//
// The target is the scenario's first object with its joints' parts. Its window is the box of the spheres that
// hold them, 8 px wider for the lens's blur; its light is all that there is in the window.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/run/still_camera.h"
#include "emulator/tradeoff/image_error.h"
#include "emulator/tradeoff/limb_error.h"

namespace hilcam {

// None: there is no such thing in the picture. All are magnitudes.
struct PictureErrors {
    NoiseError noise;
    double false_lights = 0;                     // pixels (image_error.h); of several frames, the mean
    std::optional<double> centroid_px;           // way of the centre of the target's light
    std::optional<double> photometric_fraction;  // of the target's light
    std::optional<double> limb_px;               // limb_error.h, of all bodies in view
    std::optional<double> similarity;            // structural_similarity.h, over the saturation's range
};

struct ReferenceLimits {
    double standard_error_sigma = 0.05;  // of 99 % of the lit pixels, in their own sensor noise: enough
    int max_frames = 64;                 // a power of two, 4 at least
};

struct ReferencePicture {
    ElectronImage mean;         // [e-], saturated
    ElectronImage dark;         // what it has without light
    NoiseError standard_error;  // |standard error| / sigma over lit pixels; those may be none
    int frames = 0;
    double seconds = 0;  // that it took
};
// `camera`: of the scenario, as it stands. Owner thread.
ReferencePicture render_reference(StillCamera& camera, const ScenarioConfig& scenario,
                                  const ReferenceLimits& limits,
                                  const std::function<void(const std::string&)>& log);

class PictureJudge {
  public:
    // `camera`: of the scenario, whatever its quality, standing where the reference's stood; asked where
    // things are.
    PictureJudge(const ScenarioConfig& scenario, const StillCamera& camera, ReferencePicture reference);

    // `electrons`: as StillCamera::expose() gives them, of the same camera.
    PictureErrors errors(const ElectronImage& electrons) const;
    // By lit pixel (image_error.h): how far a picture is from the reference, and from another rendering.
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
    Vec2d offset_px_;  // of the window in the array
    ReferencePicture reference_;
    PixelBox target_;
    std::optional<WindowLight> target_light_;
    std::vector<LimbPlace> limbs_;
};

// The judge of a scenario's first instant; renders the reference. InputError when nothing in it is brighter
// than the sensor's noise in the dark.
PictureJudge first_instant_judge(const ScenarioConfig& reference, const ReferenceLimits& limits,
                                 const std::function<void(const std::string&)>& log);

}  // namespace hilcam
