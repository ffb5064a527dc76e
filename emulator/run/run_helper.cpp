#include "emulator/run/run_helper.h"

#include "io/system/program_files.h"
#include "io/system/run_program.h"
#include "render/vocabulary/check.h"

namespace hilcam {

int run_helper(const std::string& name, const std::vector<std::string>& arguments,
               const std::string& without) {
    const auto program = helper_program(name);
    if (!std::filesystem::exists(program))
        throw DeviceError(program.string() + " is missing: " + without + "; build it (target " + name + ")");
    const std::optional<int> status = run_program(program, arguments);
    if (!status) throw DeviceError(program.string() + " cannot be started: " + without);
    return *status;
}

}  // namespace hilcam
