#include "emulator/run/picture_run.h"

#include "emulator/recording/program_version.h"

namespace hilcam {

PictureRun picture_run_of(const ScenarioConfig& s, std::size_t number) {
    return {std::string(kProgramVersion),     s.name, static_cast<std::int64_t>(number), s.seed, s.camera,
            SpectralGrid(s.spectrum_edges_um)};
}

}  // namespace hilcam
