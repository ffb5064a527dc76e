#include "emulator/run/render_command.h"

#include <optional>

#include "emulator/run/still_camera.h"
#include "emulator/run/truth_source.h"
#include "io/pictures/image_file.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

// The first frame that the camera would take.
FrameRecord record_of(const ScenarioConfig& s, const Exposure& exposure) {
    FrameRecord record;
    record.id = 1;
    record.exposure_s = exposure.exposure_s;
    record.gain_db = exposure.gain_db;
    record.bits = s.camera.frame_bits();
    record.binning_x = s.camera.binning_x, record.binning_y = s.camera.binning_y;
    return record;
}

// Where the frame, neither binned nor mirrored, lies in the radiance image [px of that].
PixelRectangle frame_in_radiance(const CameraModel& camera, const ImageGeometry& image, int oversampling) {
    const auto [width, height] = array_size(camera);
    return {image.guard_px - static_cast<int>(camera.black_columns) * oversampling,
            image.guard_px - static_cast<int>(camera.black_rows) * oversampling, width * oversampling,
            height * oversampling};
}

FrameTruth empty_truth(const ScenarioConfig& s, const Renderer& renderer) {
    TruthWishes wishes = truth_wishes(s);
    if (!s.outputs.has_truth)
        wishes.object = wishes.range = wishes.depth = wishes.normal = wishes.position = true;
    FrameTruth truth = make_truth(s, renderer, wishes);
    truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling),
                             {s.camera.binning_x, s.camera.binning_y});
    return truth;
}

void write_truth(const std::filesystem::path& folder, const ScenarioConfig& s, const SpectralGrid& grid,
                 const FrameTruth& truth, FrameRecord record) {
    record.exposure_mid = truth.time;
    const TruthDocument document(truth_source(s, grid, 1));
    TruthFiles(folder).write(truth, record.id, document.line(truth, record), document.legend(truth));
}

}  // namespace

void render_to_file(const ScenarioConfig& scenario, RenderStage stage, double time_offset_s,
                    const std::filesystem::path& out, const std::filesystem::path& truth_folder) {
    const bool exr = out.extension() == ".exr";
    if (exr == (stage == RenderStage::kFrame))
        throw InputError(out.string() +
                         ": accepted: .exr for radiance and electrons, .png, .tiff or .raw for a frame");
    StillCamera camera(scenario, time_offset_s);
    const RandomKey key{static_cast<std::uint64_t>(scenario.seed), 1};
    std::optional<FrameTruth> truth;
    if (!truth_folder.empty()) truth = empty_truth(scenario, camera.renderer());
    const RadianceImage& radiance = camera.render(key, truth ? &*truth : nullptr);
    if (truth)
        write_truth(truth_folder, scenario, camera.grid(), *truth, record_of(scenario, camera.exposure()));
    if (stage == RenderStage::kRadiance)
        return write_radiance_exr(out, radiance, camera.grid(),
                                  frame_in_radiance(scenario.camera, camera.renderer().geometry(),
                                                    static_cast<int>(scenario.quality.oversampling)));
    const ElectronImage& electrons = camera.expose();
    if (stage == RenderStage::kElectrons) return write_electrons_exr(out, electrons);
    const DnImage& frame = camera.digitise(key);
    if (out.extension() == ".raw") return write_raw(out, frame, scenario.camera.pixel_layout());
    write_frame(out, frame);
}

}  // namespace hilcam
