#pragma once
// Provides the transfer tables of a scene's objects (render/probes/transfer_table.h): reads them from the
// cache folder, makes and stores them, or orders them for a run that begins without them.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "render/probes/transfer_table.h"
#include "render/scene/scene.h"

namespace hilcam {

// A table to be made, with everything it depends on.
struct TableOrder {
    std::string name;                  // object's name, for people
    std::vector<std::size_t> objects;  // the object and others like it, which share the table
    Mesh mesh;                         // mesh as its file has it
    float scale = 1;                   // size of the objects relative to the mesh
    std::vector<std::uint8_t> glass;   // by surface of the mesh
    TransferSettings settings;
};

// The way in which a scene gets its tables, and the outcome.
struct LightLoading {
    bool later = false;               // true: missing tables are ordered instead of made
    std::vector<TableOrder> orders;   // orders for those tables
    std::size_t found = 0, made = 0;  // tables found on disk; tables made
    double seconds = 0;               // time for all of it
};

// Gives each object its table if any of the scenario's qualities needs one; objects that are alike share it.
// The scene's meshes have their files' sizes, and `scales` (by object) brings objects and tables to size.
// Throws InputError when memory runs out.
void load_tables(Scene& scene, const std::vector<float>& scales, const ScenarioConfig& scenario,
                 LightLoading& light);
// Makes an ordered table, or finds it in the cache if another camera had the same one made. Throws
// InputError, and what the watcher throws. One thread, on oneTBB.
std::shared_ptr<const TransferTable> make_table(const TableOrder& order, const WorkWatcher& watcher);

}  // namespace hilcam
