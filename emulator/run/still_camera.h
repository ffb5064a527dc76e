#pragma once
// A scenario's camera at one instant: the frame that it would take then, as often as asked, stage by stage.
// For pictures and for measurements; the loop has its own (frame_loop.h).

#include <memory>
#include <optional>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/scenario/scene_loader.h"
#include "sensor/chain.h"

namespace hilcam {

class StillCamera {
  public:
    // Pictures hold radiance bin by bin, or what the detector's channels make of it, as frames of a run do: only then are
    // charges those of a run to the last bit.
    enum class Light { kCharge, kRadiance };
    // Loads all that the scenario names. Throws InputError, DeviceError. Owner thread, as all here.
    explicit StillCamera(const ScenarioConfig& scenario, double time_offset_s = 0,
                         Light light = Light::kCharge);

    // Makes the body that the camera rides on stand there from now on, at rest against the object that is
    // nearest; everything else is where it was. Throws InputError where the atmosphere does not cover what is
    // seen from there.
    void look_from(const Pose& body);

    // Goes over to another scenario that has the same scene and the same camera, but for its settings: other
    // poses, motions, exposure, gain and seed, and another time where nothing that was loaded depends on it.
    // Its pictures are those of a camera that is made for it. Throws InputError.
    void take(const ScenarioConfig& scenario, double time_offset_s = 0);
    // Tells what the frame would show, pointing jitter apart, without a picture. truth: made for this renderer,
    // its raster set.
    void report(FrameTruth& truth);
    // Returns the velocity of an object in the world, from 0.
    Vec3d velocity_m_s(std::size_t object);

    // These functions are called in this order; each gives what it fills, valid until the next call. The key
    // chooses the light paths, and the noise.
    const RadianceImage& render(RandomKey key, FrameTruth* truth = nullptr);
    const ElectronImage& expose();
    // The same of the picture that was rendered, moved to the right by whole columns of the radiance image: what a lens
    // that is shifted by so much would show, but for the columns that come in from the guard band's edge. Light from beside
    // the picture stays. Not for pictures with differences within their pixels (RadianceImage::moments).
    const ElectronImage& expose_moved(int columns);
    const DnImage& digitise(RandomKey key);
    // Returns the part that no light makes: dark current [e-].
    ElectronImage dark();

    // The picture that render() fills, before it is first called: its size and planes.
    const RadianceImage& radiance() const { return radiance_; }
    const ScenarioConfig& scenario() const { return scenario_; }
    const SpectralGrid& grid() const { return grid_; }
    const Exposure& exposure() const { return exposure_; }
    TimeTai time() const { return time_; }
    // Returns where the camera was in the last rendering, pointing jitter in it.
    const Pose& shown_camera() const { return exposures_->middle_world().camera; }
    // Returns where everything is at mid-exposure, pointing jitter apart.
    const WorldSnapshot& world() const { return snapshot_; }
    Renderer& renderer() { return *renderer_; }
    const std::vector<LoadedObject>& objects() const { return objects_; }
    const Renderer& renderer() const { return *renderer_; }

  private:
    // Made at the first use: a radiance image needs none.
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
