#pragma once
// Tables of directions kept on disk beside the levels of detail: making them takes seconds.

#include <filesystem>
#include <memory>
#include <span>

#include "render/scene/transfer_table.h"

namespace hilcam {

// Returns the mesh's table from `folder`, made and written there if need be. A file that is not whole, or of
// another mesh or other settings, is made anew; a folder that cannot be written is no failure. glass: per
// surface of the mesh.
std::shared_ptr<const TransferTable> cached_transfer(const Mesh& mesh, std::span<const std::uint8_t> glass,
                                                     const TransferSettings& settings,
                                                     const std::filesystem::path& folder,
                                                     const WorkWatcher& watcher = {});
// Returns the table that the folder has; null where it has none.
std::shared_ptr<const TransferTable> find_transfer(const Mesh& mesh, std::span<const std::uint8_t> glass,
                                                   const TransferSettings& settings,
                                                   const std::filesystem::path& folder);

}  // namespace hilcam
