#include "io/files/transfer_cache.h"

#include <array>
#include <string>

#include "io/files/cache_file.h"

namespace hilcam {
namespace {

// Raised when TransferTable makes another table of the same mesh.
constexpr std::uint32_t kTableVersion = 14;

struct TableHeader {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'T', 'T'};
    std::uint32_t version = kTableVersion;
    std::uint16_t directions = 0;
    std::uint16_t enclosed = 0;
    std::uint64_t nodes = 0;
    std::uint64_t hash = 0;
    bool operator==(const TableHeader&) const = default;
};

}  // namespace

std::shared_ptr<const TransferTable> cached_transfer(const Mesh& mesh, std::span<const std::uint8_t> glass,
                                                     const TransferSettings& settings,
                                                     const std::filesystem::path& folder) {
    TableHeader expected;
    expected.directions = static_cast<std::uint16_t>(settings.directions);
    expected.enclosed = settings.enclosed;
    expected.nodes = settings.nodes;
    expected.hash = hash_of(hash_of(mesh), glass.data(), glass.size());
    const std::filesystem::path file =
        folder / ("transfer_" + std::to_string(expected.hash) + "_" + std::to_string(settings.directions) +
                  "_" + std::to_string(settings.nodes) + (settings.enclosed ? "_enclosed" : "") + ".bin");
    auto table = std::make_shared<TransferTable>();
    CacheReader in(file);
    TableHeader header;
    in(header);
    if (in.good() && header == expected) {
        TransferTable::list(*table, in);
        if (in.good() && in.at_end() && table->is_whole()) return table;
    }
    table = std::make_shared<TransferTable>(mesh, glass, settings);
    write_cache_file(file, [&](CacheWriter& out) {
        out(expected);
        TransferTable::list(*table, out);
    });
    return table;
}

}  // namespace hilcam
