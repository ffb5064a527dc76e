#pragma once
// The nodes of a glTF file's scene: their transforms, and what they show.

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
    std::size_t number = 0;                   // its number in the file
    std::optional<std::uint64_t> mesh, skin;  // the mesh that it shows, and that mesh's skin
    std::vector<float> weights;               // its own, of morph targets; empty: the mesh's
    std::vector<NodeMatrix> places;           // in the file's axes; one, or one per instance
};

// Returns the visible nodes of the scene, parents first. Several roots are put under one node ROOT, which has
// a number that no node of the file has.
std::vector<GltfNode> shown_nodes(GltfDocument& document);
// Returns the transform of each node of the file to the file's axes, by node number.
std::vector<NodeMatrix> places_of_nodes(const GltfDocument& document);

}  // namespace hilcam
