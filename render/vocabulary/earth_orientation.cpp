#include "render/vocabulary/earth_orientation.h"

namespace hilcam {
namespace {

EarthOrientation in_use;

}  // namespace

void use_earth_orientation(const EarthOrientation& orientation) { in_use = orientation; }
const EarthOrientation& earth_orientation() { return in_use; }

}  // namespace hilcam
