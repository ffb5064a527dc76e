#pragma once
// Tables of directions kept on disk beside the levels of detail: making them takes seconds.

#include <memory>
#include <span>

#include "io/cache/cache.h"
#include "render/probes/transfer_table.h"

namespace hilcam {

// A mesh as its file has it, and what a table is made of beside it. A size of the object is no part of it: one table
// serves a mesh in all sizes.
struct TableSource {
    const Mesh& mesh;
    std::span<const std::uint8_t> glass;  // by surface of the mesh
    TransferSettings settings;
    float scale = 1;  // the object is so many times as large as the mesh
};

// Returns the object's table from the cache, made and written there if need be. A file that is damaged, or of
// another mesh or other settings, is made anew; a folder that cannot be written is no failure.
std::shared_ptr<const TransferTable> cached_transfer(const TableSource& source, const Cache& cache,
                                                     const WorkWatcher& watcher = {});
// Returns the table that the cache has, for the object's size; null where it has none.
std::shared_ptr<const TransferTable> find_transfer(const TableSource& source, const Cache& cache);

}  // namespace hilcam
