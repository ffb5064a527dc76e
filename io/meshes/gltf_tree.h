#pragma once
// The nodes of a glTF file's scene: where they are, and what they show.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/meshes/gltf_document.h"
#include "io/meshes/node_matrix.h"

namespace hilcam {

struct GltfNode {
    std::string name;
    std::uint32_t depth = 0;                  // below the root
    std::size_t number = 0;                   // in the file
    std::optional<std::uint64_t> mesh, skin;  // that it shows
    std::vector<float> weights;               // its own, of morph targets; empty: the mesh's
    std::vector<NodeMatrix> places;           // in the file's axes: one, or one for each instance
};

// Returns the nodes of the scene that are to be seen, parents first. Several roots stand below one node ROOT, whose number is none of the
// file's.
std::vector<GltfNode> shown_nodes(GltfDocument& document);
// Returns where each node of the file is, in the file's axes; by its number.
std::vector<NodeMatrix> places_of_nodes(const GltfDocument& document);

}  // namespace hilcam
