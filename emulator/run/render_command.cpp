#include "emulator/run/render_command.h"

#include <spdlog/spdlog.h>

#include <optional>

#include "emulator/recording/run_seed.h"
#include "emulator/run/still_camera.h"
#include "emulator/run/truth_source.h"
#include "io/files/image_file.h"
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

void write_truth(const PictureTruthFiles& files, const TruthSource& source, const FrameTruth& truth,
                 FrameRecord record) {
    record.exposure_mid = truth.time;
    const TruthDocument document(source);
    write_picture_truth(files, document.header() + '\n' + document.line(truth, record) + '\n', truth,
                        document.legend(truth));
}

// What would be lost: a frame of a run, or the labels of another picture. A picture that is rendered again is
// not.
void require_unused(const RenderFiles& files) {
    if (files.overwrite) return;
    std::error_code error;
    const auto refuse = [](const std::filesystem::path& file, const char* what) {
        throw InputError(file.string() + ": is " + what + "; accepted: another name, or --overwrite");
    };
    const RunFolder run = run_folder(FilesConfig{});
    if (is_of_run(files.out.filename().string(), run) && std::filesystem::exists(files.out, error))
        refuse(files.out, "a frame of a run");
    if (files.truth.empty()) return;
    const PictureTruthFiles truth = picture_truth_files(files.truth, files.out);
    for (const std::filesystem::path& file : {truth.lines, truth.layers})
        if (std::filesystem::exists(file, error))
            refuse(file, "the truth of a picture that is there already");
}

}  // namespace

void render_to_file(const ScenarioConfig& bench, RenderStage stage, double time_offset_s,
                    const RenderFiles& files, std::size_t number) {
    const ScenarioConfig scenario = scenario_of_camera(bench, number - 1);
    const std::filesystem::path& out = files.out;
    const bool exr = out.extension() == ".exr";
    if (exr == (stage == RenderStage::kFrame))
        throw InputError(out.string() +
                         ": accepted: .exr for radiance and electrons, .png, .tiff or .raw for a frame");
    require_unused(files);
    StillCamera camera(scenario, time_offset_s);
    for (const LoadedObject& object : camera.objects())
        if (const std::string warning = warning_of(object); !warning.empty()) spdlog::warn("{}", warning);
    const RandomKey key{seed_of_camera(scenario, number - 1), 1};
    std::optional<FrameTruth> truth;
    if (!files.truth.empty()) truth = empty_truth(scenario, camera.renderer());
    const RadianceImage& radiance = camera.render(key, truth ? &*truth : nullptr);
    if (truth)
        write_truth(picture_truth_files(files.truth, out),
                    truth_source(scenario, camera.grid(), number, drawn_run_id()), *truth,
                    record_of(scenario, camera.exposure()));
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
