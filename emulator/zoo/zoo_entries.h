#pragma once
// Finds the members of a zoo: scenarios and meshes in a folder, each as a scenario that can be loaded.

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/tradeoff/tradeoff_knobs.h"

namespace hilcam {

struct ZooEntry {
    std::string name;  // file name without its extension
    ScenarioSource source;
};

struct ZooEntriesOptions {
    std::int64_t picture_px = 320;       // longer side of the picture; a smaller picture keeps its size
    std::vector<std::string> overrides;  // KEY=VALUE for every scenario, applied last
};

// Finds the *.yaml files and the meshes (*.obj, *.glb, *.gltf, *.stl, *.ply) of a folder in order of names,
// without subfolders. A mesh with the name of a scenario belongs to that scenario. Any other mesh is placed
// in the shipped scenario `mesh_in_orbit`, with materials from surface_words.h. Pictures are made smaller by
// a shorter focal length, so that they show the same. Throws InputError when the folder has no members, or
// one of them cannot be loaded.
std::vector<ZooEntry> zoo_entries(const std::filesystem::path& folder, const ZooEntriesOptions& options);

}  // namespace hilcam
