#pragma once
// Keeps transfer tables on disk beside the levels of detail, because making them takes seconds.

#include <memory>
#include <span>

#include "io/cache/cache.h"
#include "render/probes/transfer_table.h"

namespace hilcam {

// A mesh as in its file, with everything else that its table depends on. One table serves all sizes of an
// object, so the scale is not part of the key.
struct TableSource {
    const Mesh& mesh;
    std::span<const std::uint8_t> glass;  // by surface of the mesh
    TransferSettings settings;
    float scale = 1;  // size of the object relative to the mesh
};

// Returns the object's table from the cache; makes and keeps it when it is missing, damaged, or for another
// mesh or other settings. A folder that cannot be written is no error.
std::shared_ptr<const TransferTable> cached_transfer(const TableSource& source, const Cache& cache,
                                                     const WorkWatcher& watcher = {});
// Returns the cached table, scaled to the object's size; null when there is none.
std::shared_ptr<const TransferTable> find_transfer(const TableSource& source, const Cache& cache);

}  // namespace hilcam
