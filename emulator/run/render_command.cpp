#include "emulator/run/render_command.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "emulator/progress/progress.h"
#include "emulator/recording/run_seed.h"
#include "emulator/run/picture_fault.h"
#include "emulator/run/picture_run.h"
#include "emulator/run/still_camera.h"
#include "emulator/run/truth_source.h"
#include "emulator/scenario/apart_refusal.h"
#include "io/images/image_file.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

// Returns the record of the first frame that the camera would take.
FrameRecord record_of(const ScenarioConfig& s, const StillCamera& camera) {
    const Exposure& exposure = camera.exposure();
    FrameRecord record;
    record.id = 1;
    record.exposure_mid = camera.time();
    record.camera = camera.shown_camera();
    record.black_level_dn = exposure.black_level_dn.value_or(s.camera.offset_dn);
    record.exposure_s = exposure.exposure_s;
    record.gain_db = exposure.gain_db;
    record.bits = s.camera.frame_bits();
    return record;
}

// Returns the layout of a stage's picture: light and charge are shown before binning.
FrameLayout layout_of(const CameraModel& camera, PictureStage stage) {
    if (stage != PictureStage::kFrame) return {};
    return {camera.binning_x, camera.binning_y};
}

// Returns the area of the frame, neither binned nor mirrored, in the radiance image [px of that].
PixelRectangle frame_in_radiance(const CameraModel& camera, const ImageGeometry& image, int oversampling) {
    const auto [width, height] = array_size(camera);
    return {image.guard_px - static_cast<int>(camera.black_columns) * oversampling,
            image.guard_px - static_cast<int>(camera.black_rows) * oversampling, width * oversampling,
            height * oversampling};
}

FrameTruth empty_truth(const ScenarioConfig& s, const Renderer& renderer, const FrameLayout& layout) {
    TruthRequest request = truth_request(s);
    if (!s.outputs.find<TruthConfig>())
        request.object = request.range = request.depth = request.normal = request.position = true;
    FrameTruth truth = make_truth(s, renderer, request);
    truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling), layout);
    return truth;
}

void write_truth(const PictureTruthFiles& files, const TruthSource& source, const FrameTruth& truth,
                 const FrameRecord& record) {
    const TruthDocument document(source);
    write_picture_truth(files, document.header() + '\n' + document.line(truth, record) + '\n', truth,
                        document.legend(truth));
}

// Refuses to overwrite a frame of a run, or the labels of another picture. A picture may be rendered again.
void require_unused(const RenderFiles& files) {
    if (files.overwrite) return;
    std::error_code error;
    const auto refuse = [](const std::filesystem::path& file, const char* what) {
        throw InputError(file.string() + ": is " + what + "; accepted: another name, or --overwrite");
    };
    const RunFolder run = run_folder(FilesConfig{});
    for (const std::filesystem::path& file : {files.out, files.view})
        if (run.is_own(file.filename().string()) && std::filesystem::exists(file, error))
            refuse(file, "a frame of a run");
    if (files.truth.empty()) return;
    const PictureTruthFiles truth = picture_truth_files(files.truth, files.out);
    for (const std::filesystem::path& file : {truth.lines, truth.layers, truth.mask})
        if (std::filesystem::exists(file, error))
            refuse(file, "the truth of a picture that is there already");
}

// Refuses options that write files beside a picture when there is no picture.
void require_no_file(const RenderFiles& files) {
    const auto refuse = [](const std::string& option) {
        throw InputError(option + ": goes with a picture, and there is none; accepted: --out FILE beside it");
    };
    if (files.parts) refuse("--parts");
    if (!files.view.empty()) refuse("--view " + files.view.string());
    if (!files.truth.empty()) refuse("--truth " + files.truth.string());
}

// Refuses impossible file names before rendering takes minutes.
void check_names(PictureStage stage, const RenderFiles& files) {
    const auto is_one_of = [&](std::initializer_list<const char*> endings) {
        return std::any_of(endings.begin(), endings.end(),
                           [&](const char* ending) { return files.out.extension() == ending; });
    };
    const bool fits = stage == PictureStage::kRadiance ? is_one_of({".exr"})
                      : stage == PictureStage::kElectrons
                          ? is_one_of({".exr", ".fits", ".fit"})
                          : is_one_of({".png", ".tiff", ".tif", ".fits", ".fit", ".raw"});
    if (files.parts && stage != PictureStage::kRadiance)
        throw InputError("--parts: they are parts of the light at the lens; accepted with --stage radiance");
    if (files.out.empty() && files.pixel) return require_no_file(files);
    if (!fits)
        throw InputError(files.out.string() +
                         ": accepted: .exr for radiance, .exr or .fits for electrons, .png, .tiff, .fits or "
                         ".raw for a frame");
    if (files.view.empty()) return;
    if (stage != PictureStage::kFrame)
        throw InputError("--view " + files.view.string() + ": shows a frame; accepted with --stage frame");
    if (files.view.extension() != ".png")
        throw InputError("--view " + files.view.string() + ": accepted: .png");
    if (files.view.lexically_normal() == files.out.lexically_normal())
        throw InputError("--view " + files.view.string() + ": is the file of --out; accepted: another one");
}

// Refuses pictures that cannot be split into parts. A described pixel must be shaded itself, not interpolated
// from its neighbours.
void require_parts(const ScenarioConfig& s, bool pixel) {
    if (const std::string why = apart_refusal(s); !why.empty())
        throw InputError("--parts and --pixel: " + why);
    if (pixel && s.quality.render.sees_ground() && s.quality.render.ground_step_px > 1)
        throw InputError(
            "--pixel: three of four pixels of the ground are interpolated; found quality.ground_step_px: 2; "
            "accepted: --set quality.ground_step_px=1");
}

// The requested parts of a picture's light, and the record of a pixel.
struct AskedLight {
    std::optional<PartsBuffer> buffer;
    std::optional<PixelRecord> record;

    AskedLight(const RenderFiles& files, StillCamera& camera) {
        if (!files.parts && !files.pixel) return;
        require_parts(camera.scenario(), files.pixel.has_value());
        buffer.emplace(camera.renderer().make_parts_buffer(camera.radiance()));
        if (files.pixel) record.emplace().box = radiance_pixels(camera, *files.pixel);
        camera.renderer().keep_parts(&*buffer, record ? &*record : nullptr);
    }
};

}  // namespace

void render_to_files(const ScenarioConfig& bench, PictureStage stage, double time_offset_s,
                     const RenderFiles& files, std::size_t number,
                     const std::function<void(StillCamera&)>& on_loaded) {
    const ScenarioConfig scenario = scenario_of_camera(bench, number - 1);
    check_names(stage, files);
    require_unused(files);
    StillCamera camera(
        scenario, time_offset_s,
        stage == PictureStage::kRadiance ? StillCamera::Light::kRadiance : StillCamera::Light::kCharge);
    if (on_loaded) on_loaded(camera);
    PictureWriter writer(picture_run_of(scenario, number));
    const FrameLayout layout = layout_of(scenario.camera, stage);
    const RandomKey key{seed_of_camera(scenario, number - 1), 1};
    std::optional<FrameTruth> truth;
    if (!files.truth.empty()) truth = empty_truth(scenario, camera.renderer(), layout);
    const Renderer& renderer = camera.renderer();
    std::optional<Progress> progress(std::in_place, "rendering", 1.0,
                                     [&] { return renderer.share_traced(); });
    const AskedLight asked(files, camera);
    const RadianceImage& radiance = camera.render(key, truth ? &*truth : nullptr);
    progress.emplace("sensor and files");
    if (const std::string fault = picture_fault(renderer); !fault.empty()) spdlog::error("{}", fault);
    FrameRecord record = record_of(scenario, camera);
    record.binning_x = layout.binning_x, record.binning_y = layout.binning_y;
    if (truth)
        write_truth(picture_truth_files(files.truth, files.out),
                    truth_source(scenario, camera.grid(), number, drawn_run_id()), *truth, record);
    if (asked.record) std::fputs(pixel_report(camera, *files.pixel, *asked.record).c_str(), stdout);
    if (files.out.empty()) return;
    const auto oversampling = static_cast<int>(scenario.quality.oversampling);
    if (stage == PictureStage::kRadiance) {
        const PixelRectangle frame = frame_in_radiance(scenario.camera, renderer.geometry(), oversampling);
        if (files.parts)
            return writer.write_radiance(files.out, asked.buffer->parts.sum(), frame, oversampling, record,
                                         &asked.buffer->parts);
        return writer.write_radiance(files.out, radiance, frame, oversampling, record);
    }
    const ElectronImage& electrons = camera.expose();
    if (stage == PictureStage::kElectrons) return writer.write_electrons(files.out, electrons, record);
    const DnImage& frame = camera.digitise(key);
    writer.write_frame(files.out, frame, record);
    if (!files.view.empty()) writer.write_view(files.view, frame, record);
}

}  // namespace hilcam
