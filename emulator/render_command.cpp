#include "emulator/render_command.h"

#include "emulator/emulator.h"
#include "emulator/exposure_renderer.h"
#include "emulator/scene_loader.h"
#include "emulator/shutter_timing.h"
#include "io/image_file.h"
#include "sensor/chain.h"

namespace hilcam {

void render_to_file(const ScenarioConfig& scenario, RenderStage stage, double time_offset_s,
                    const std::filesystem::path& out) {
    const bool exr = out.extension() == ".exr";
    if (exr == (stage == RenderStage::kFrame))
        throw InputError(out.string() +
                         ": accepted: .exr for radiance and electrons, .png, .tiff or .raw for a frame");
    const SpectralGrid grid(scenario.spectrum_edges_um);
    const ImageGeometry geometry = geometry_of(scenario.camera, static_cast<int>(scenario.quality.guard_px),
                                               static_cast<int>(scenario.quality.oversampling));
    const std::unique_ptr<Renderer> renderer = load_renderer(scenario, grid, geometry);

    const TimeTai start = parse_utc(scenario.time_utc);
    const TimeTai time = start + static_cast<std::int64_t>(time_offset_s * 1e9);
    renderer->require_air(snapshot_at(scenario, start, time));

    WorldState world(initial_motions(scenario, start), scenario.origin, joints_of(scenario));
    ExposureRenderer exposures(*renderer, scenario, grid, world.placed_objects());
    const RandomKey key{static_cast<std::uint64_t>(scenario.seed), 1};
    RadianceImage radiance = exposures.make_image();
    std::vector<PointSource> points;
    points.reserve(exposures.most_points());
    // The first frame that the camera would take.
    const CameraModel& camera = scenario.camera;
    Exposure exposure{ShutterTiming(camera).exposure_s(camera.exposure_s), camera.gain_db, {}, {}};
    if (!camera.sequence.empty())
        exposure = {camera.sequence[0].exposure_s, camera.sequence[0].gain_db, {}, {}};
    exposures.render(world, time, key, radiance, points, exposure);
    if (stage == RenderStage::kRadiance) return write_radiance_exr(out, radiance, grid);

    SensorChain chain(scenario.camera, grid, sampling_of(scenario.quality),
                      load_detector_pictures(scenario.camera));
    const auto [array_width, array_height] = array_size(scenario.camera);
    ElectronImage electrons(array_width, array_height);
    chain.expose(radiance, points, exposure, electrons);
    if (stage == RenderStage::kElectrons) return write_electrons_exr(out, electrons);
    const auto [width, height] = frame_size(scenario.camera);
    DnImage frame(width, height);
    chain.digitise(electrons, exposure, key, frame);
    if (out.extension() == ".raw") return write_raw(out, frame, camera.pixel_layout());
    write_frame(out, frame);
}

}  // namespace hilcam
