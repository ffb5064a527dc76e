// Any manifest of a folder of frames is read or refused in one line; so is any file name, and any raw file.

#include <string>
#include <string_view>

#include "emulator/clone/frame_names.h"
#include "emulator/clone/raw_frame.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

template <class Work>
void accepted_or_refused(const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        const std::string_view message = error.what();
        HILCAM_CHECK(!message.empty() && message.find('\n') == std::string_view::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    FramesConfig config;
    accepted_or_refused([&] { read_config_text(text, "fuzz.yaml", "/nowhere", section_of(config)); });
    accepted_or_refused([&] {
        if (const auto settings = settings_in_name(text))
            HILCAM_CHECK(settings->exposure_s >= 0 && settings->light > 0);
    });
    accepted_or_refused([&] {
        DnImage frame(4, 3);
        decode_raw(text, config, "fuzz.raw", frame);
    });
    return 0;
}
