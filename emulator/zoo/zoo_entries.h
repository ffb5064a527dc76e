#pragma once
// The members of a zoo: scenarios and meshes of a folder, each as a scenario that can be loaded.

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/tradeoff/tradeoff_knobs.h"

namespace hilcam {

struct ZooEntry {
    std::string name;  // name of the file, without its ending
    ScenarioSource source;
};

struct ZooEntriesOptions {
    std::int64_t picture_px = 320;       // the picture's longer side; a smaller picture stays as it is
    std::vector<std::string> overrides;  // KEY=VALUE of every scenario, after all else
};

// Finds the *.yaml and the meshes (*.obj, *.glb, *.gltf, *.stl, *.ply) of a folder by name, not those of folders in it. A mesh beside a
// scenario of the same name is that scenario's; any other
// stands in the shipped scenario `mesh_in_orbit`, its surfaces of the materials of surface_words.h. Pictures are made smaller by a
// shorter focal length, so that they show the same. Throws InputError where the folder has none of them or one of them cannot
// be loaded.
std::vector<ZooEntry> zoo_entries(const std::filesystem::path& folder, const ZooEntriesOptions& options);

}  // namespace hilcam
