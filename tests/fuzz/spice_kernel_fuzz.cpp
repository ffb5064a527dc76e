// Any bytes are a binary SPICE kernel whose segments can be asked all over their spans, or refused in one line.

#include <cstring>
#include <string>

#include "io/spice/body_orientation.h"
#include "io/spice/ck_segment.h"
#include "io/spice/spk_segment.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

void ask(const DafFile& file, const DafArray& array) {
    const double start = array.doubles[0], stop = array.doubles[1];
    for (const double t : {start, start + (stop - start) / 3, stop, stop + 1e3}) {
        if (file.kind() == "SPK")
            (void)load_spk_segment(file, array)->at(t);
        else if (file.kind() == "CK")
            (void)load_ck_segment(file, array)->at(t, 0.1);
        else
            (void)load_binary_orientation(file, array)->at(t);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto check = [](const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    };
    try {
        const DafFile file(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
        for (const DafArray& array : file.arrays()) try {
                ask(file, array);
            } catch (const InputError& error) {
                check(error);
            }
    } catch (const InputError& error) {
        check(error);
    }
    return 0;
}
