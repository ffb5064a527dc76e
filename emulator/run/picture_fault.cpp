#include "emulator/run/picture_fault.h"

#include "io/maps/map_helper.h"

namespace hilcam {

std::string picture_fault(const Renderer& renderer) {
    const std::string rendering = renderer.fault(), maps = ended_map_readers();
    return rendering + (rendering.empty() || maps.empty() ? "" : "; ") + maps;
}

}  // namespace hilcam
