#include "emulator/recording/program_version.h"

namespace hilcam {

constinit const std::string_view kProgramVersion = "hilcam " HILCAM_VERSION;

}  // namespace hilcam
