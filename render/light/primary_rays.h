#pragma once
// The camera's rays through a tile, in packets of 4 x 4 pixels: objects become vertices, the rest sees the
// background.

#include <span>

#include "render/light/tile.h"

namespace hilcam {

// Writes at most vertices.size() vertices (PathModel::kMostSamples are enough) and adds the background to the
// tile's pixels. Returns how many. Loop, any thread.
std::size_t trace_primary_rays(Tile& tile, std::span<Vertex> vertices);

}  // namespace hilcam
