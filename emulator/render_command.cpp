#include "emulator/render_command.h"

#include "emulator/still_camera.h"
#include "io/image_file.h"

namespace hilcam {

void render_to_file(const ScenarioConfig& scenario, RenderStage stage, double time_offset_s,
                    const std::filesystem::path& out) {
    const bool exr = out.extension() == ".exr";
    if (exr == (stage == RenderStage::kFrame))
        throw InputError(out.string() +
                         ": accepted: .exr for radiance and electrons, .png, .tiff or .raw for a frame");
    StillCamera camera(scenario, time_offset_s);
    const RandomKey key{static_cast<std::uint64_t>(scenario.seed), 1};
    const RadianceImage& radiance = camera.render(key);
    if (stage == RenderStage::kRadiance) return write_radiance_exr(out, radiance, camera.grid());
    const ElectronImage& electrons = camera.expose();
    if (stage == RenderStage::kElectrons) return write_electrons_exr(out, electrons);
    const DnImage& frame = camera.digitise(key);
    if (out.extension() == ".raw") return write_raw(out, frame, scenario.camera.pixel_layout());
    write_frame(out, frame);
}

}  // namespace hilcam
