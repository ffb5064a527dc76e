#include "render/earth/land.h"

namespace hilcam {

LandBands::LandBands(const SpectralGrid& grid)
    : band_{grid.average({{0.48, 0.50}, {1, 0}, {}}),
            grid.average({{0.48, 0.50, 0.57, 0.59}, {0, 1, 1, 0}, {}}),
            grid.average({{0.57, 0.59, 0.68, 0.74}, {0, 1, 1, 0}, {}}),
            grid.average({{0.68, 0.74}, {0, 1}, {}})} {}

}  // namespace hilcam
