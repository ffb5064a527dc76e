#pragma once
// A scenario's camera at one instant: makes the frame that it would take then, any number of times, stage by
// stage. For pictures and measurements; runs use frame_loop.h.

#include <memory>
#include <optional>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/scenario/scene_loader.h"
#include "sensor/chain.h"

namespace hilcam {

class StillCamera {
  public:
    // kRadiance: pictures hold radiance for each bin. kCharge: they hold what the detector's channels make of
    // it, as frames of a run do; only then are charges bit for bit those of a run.
    enum class Light { kCharge, kRadiance };
    // Loads everything that the scenario names. Throws InputError, DeviceError. Owner thread, like all
    // functions here.
    explicit StillCamera(const ScenarioConfig& scenario, double time_offset_s = 0,
                         Light light = Light::kCharge);

    // Moves the body that carries the camera to a new pose, at rest relative to the nearest object. Nothing
    // else moves. Throws InputError where the atmosphere does not cover what is visible from there.
    void look_from(const Pose& body);

    // Switches to another scenario with the same scene and camera, but other settings: poses, motions,
    // exposure, gain, seed, and the time if nothing loaded depends on it. Pictures are those of a camera made
    // for that scenario. Throws InputError.
    void take(const ScenarioConfig& scenario, double time_offset_s = 0);
    // Reports what the frame would show, without pointing jitter and without rendering. truth: made for this
    // renderer, its raster set.
    void report(FrameTruth& truth);
    // Returns the velocity of an object in the world. object: from 0.
    Vec3d velocity_m_s(std::size_t object);

    // Call the functions below in this order. Each returns an image that stays valid until its next call. The
    // key selects the light paths, and the noise.
    const RadianceImage& render(RandomKey key, FrameTruth* truth = nullptr);
    const ElectronImage& expose();
    // Exposes the rendered picture shifted to the right by whole columns of the radiance image, as a shifted
    // lens would show it, except for the columns that enter from the guard band's edge. Light from outside
    // the picture is not shifted. Not for pictures with moments within their pixels (RadianceImage::moments).
    const ElectronImage& expose_moved(int columns);
    const DnImage& digitise(RandomKey key);
    // Returns the charge without light: dark current [e-].
    ElectronImage dark();

    // Returns the picture that render() fills. Before the first call, only its size and planes are valid.
    const RadianceImage& radiance() const { return radiance_; }
    const ScenarioConfig& scenario() const { return scenario_; }
    const SpectralGrid& grid() const { return grid_; }
    const Exposure& exposure() const { return exposure_; }
    TimeTai time() const { return time_; }
    // Returns the camera's pose in the last rendering, including pointing jitter.
    const Pose& shown_camera() const { return exposures_->middle_world().camera; }
    // Returns the world at mid-exposure, without pointing jitter.
    const WorldSnapshot& world() const { return snapshot_; }
    Renderer& renderer() { return *renderer_; }
    const std::vector<LoadedObject>& objects() const { return objects_; }
    const Renderer& renderer() const { return *renderer_; }

  private:
    // Makes the chain on first use; a radiance image needs none.
    SensorChain& chain();

    ScenarioConfig scenario_;
    Light light_;
    SpectralGrid grid_;
    std::vector<LoadedObject> objects_;
    std::unique_ptr<Renderer> renderer_;
    TimeTai time_;
    WorldSnapshot snapshot_;
    std::optional<WorldState> world_;
    std::optional<ExposureRenderer> exposures_;
    RadianceImage radiance_, moved_;
    std::vector<PointSource> points_, moved_points_;
    std::vector<SideLight> beside_;
    Exposure exposure_;
    std::optional<SensorChain> chain_;
    ElectronImage electrons_;
    DnImage frame_;
};

}  // namespace hilcam
