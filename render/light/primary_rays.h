#pragma once
// The camera's rays through a tile, in packets of 4 x 4 pixels: objects become vertices, the rest sees the
// background.

#include <span>

#include "render/light/tile.h"

namespace hilcam {

// Writes at most vertices.size() vertices (PathModel::kMaxSamples are enough) and adds the background to the
// tile's pixels. Returns how many. Loop, any thread.
std::size_t trace_primary_rays(Tile& tile, std::span<Vertex> vertices);
// Adds the background alone. uncovered: how many of a pixel's kVisibilitySamples see no object, row by row.
// Loop, any thread.
void add_backdrop(Tile& tile, const std::uint8_t* uncovered);
// Adds the air between the camera and a vertex that it sees along dir, and dims the vertex by it.
void add_air_before(Tile& tile, Vec3d dir, Vertex& vertex);

}  // namespace hilcam
