#include "io/files/transfer_cache.h"

#include <array>
#include <string>

#include "io/files/cache_file.h"

namespace hilcam {
namespace {

// Raised when TransferTable makes another table of the same mesh.
constexpr std::uint32_t kTableVersion = 19;

struct TableHeader {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'T', 'T'};
    std::uint32_t version = kTableVersion;
    std::uint16_t directions = 0;
    std::uint16_t enclosed = 0;
    std::uint64_t nodes = 0;
    std::uint64_t hash = 0;
    bool operator==(const TableHeader&) const = default;
};

// A table's file: its header, and where it is.
struct TableFile {
    TableHeader header;
    std::filesystem::path path;

    TableFile(const Mesh& mesh, std::span<const std::uint8_t> glass, const TransferSettings& settings,
              const std::filesystem::path& folder) {
        header.directions = static_cast<std::uint16_t>(settings.directions);
        header.enclosed = settings.enclosed;
        header.nodes = settings.nodes;
        header.hash = hash_of(hash_of(mesh), glass.data(), glass.size());
        path =
            folder / ("transfer_" + std::to_string(header.hash) + "_" + std::to_string(settings.directions) +
                      "_" + std::to_string(settings.nodes) + (settings.enclosed ? "_enclosed" : "") + ".bin");
    }

    // Null where it is not there, not whole, or of something else.
    std::shared_ptr<const TransferTable> read() const {
        auto table = std::make_shared<TransferTable>();
        CacheReader in(path);
        TableHeader found;
        in(found);
        if (!in.good() || found != header) return nullptr;
        TransferTable::list(*table, in);
        return in.good() && in.at_end() && table->is_whole() ? table : nullptr;
    }
};

}  // namespace

std::shared_ptr<const TransferTable> find_transfer(const Mesh& mesh, std::span<const std::uint8_t> glass,
                                                   const TransferSettings& settings,
                                                   const std::filesystem::path& folder) {
    return TableFile(mesh, glass, settings, folder).read();
}

std::shared_ptr<const TransferTable> cached_transfer(const Mesh& mesh, std::span<const std::uint8_t> glass,
                                                     const TransferSettings& settings,
                                                     const std::filesystem::path& folder,
                                                     const WorkWatcher& watcher) {
    const TableFile file(mesh, glass, settings, folder);
    if (auto found = file.read()) return found;
    const auto table = std::make_shared<TransferTable>(mesh, glass, settings, watcher);
    write_cache_file(file.path, [&](CacheWriter& out) {
        out(file.header);
        TransferTable::list(*table, out);
    });
    return table;
}

}  // namespace hilcam
