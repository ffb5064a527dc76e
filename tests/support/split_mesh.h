#pragma once
// Each triangle of a mesh in four, by the middles of its edges; no corner is shared between the triangles that were.

#include <array>
#include <cstdint>

#include "render/mesh.h"
