// Any text is a scenario or refused in one line.

#include <string>

#include "emulator/scenario/app_config.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    ScenarioConfig scenario;
    try {
        read_config_text({reinterpret_cast<const char*>(data), size}, "fuzz.yaml", "/nowhere",
                         section_of(scenario));
    } catch (const InputError& error) {
        const std::string message = error.what();
        HILCAM_CHECK(!message.empty() && message.find('\n') == std::string::npos);
    }
    return 0;
}
