#pragma once
// The transfer tables of a scene's objects (render/probes/transfer_table.h): read from the cache folder,
// made and written there, or ordered, for who begins without them.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "render/probes/transfer_table.h"
#include "render/scene/scene.h"

namespace hilcam {

// A table that is to be made: all that it depends on.
struct TableOrder {
    std::string name;                  // name of the object, for people
    std::vector<std::size_t> objects;  // objects of the scene that have it: one and those that are like it
    Mesh mesh;                         // mesh as its file has it
    float scale = 1;                   // the objects are so many times as large
    std::vector<std::uint8_t> glass;   // by surface of the mesh
    TransferSettings settings;
};

// The way in which a scene is to get its tables, and the outcome.
struct LightLoading {
    bool later = false;               // tables that are not on disk are ordered instead of made
    std::vector<TableOrder> orders;   // orders for those tables
    std::size_t found = 0, made = 0;  // tables on disk; tables that were made
    double seconds = 0;               // that this took
};

// Gives each object its table, where the scenario's qualities ask for any; objects that are like another have
// that one's. The scene's meshes are as large as their files have them; scales: by object, brings them to size, as it
// does their tables. Throws InputError when memory runs out.
void load_tables(Scene& scene, const std::vector<float>& scales, const ScenarioConfig& scenario,
                 LightLoading& light);
// Makes what was ordered, or finds it where another camera had the same one made. Throws InputError, and what
// the watcher throws. One thread, on oneTBB.
std::shared_ptr<const TransferTable> make_table(const TableOrder& order, const WorkWatcher& watcher);

}  // namespace hilcam
