#include "emulator/run/page_maker.h"

#include "emulator/run/run_helper.h"
#include "render/vocabulary/check.h"

namespace hilcam {

void run_page_maker(const std::string& name, const std::vector<std::string>& arguments) {
    if (run_helper(name, arguments, "no page is made; it needs python3") != 0)
        throw DeviceError(name + " failed (see above): no page is made");
}

}  // namespace hilcam
