#include "io/cache/transfer_cache.h"

#include <array>
#include <string>

namespace hilcam {
namespace {

// Raise this when TransferTable makes another table of the same mesh.
constexpr std::uint32_t kTableVersion = 19;

struct TableHeader {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'T', 'T'};
    std::uint32_t version = kTableVersion;
    std::uint16_t directions = 0;
    std::uint16_t enclosed = 0;
    std::uint64_t probes = 0;
    std::uint64_t hash = 0;
    bool operator==(const TableHeader&) const = default;
};

// Probes have colours from textures, so these are part of the key.
std::uint64_t hash_of_looks(std::uint64_t hash, const Mesh& mesh) {
    if (mesh.textures.empty()) return hash;
    for (const MeshSurface& surface : mesh.surfaces)
        hash = hash_of(hash, &surface.base_color_texture, sizeof surface.base_color_texture);
    for (const Texture& texture : mesh.textures) {
        hash = hash_of(hash, &texture.width, sizeof texture.width);
        hash = hash_of(hash, texture.texels.data(), texture.texels.size() * sizeof texture.texels[0]);
        hash = hash_of(hash, texture.wrap.data(), sizeof texture.wrap);
    }
    return hash;
}

// A table's file: its header and its name.
struct TableFile {
    TableHeader header;
    std::string name;

    explicit TableFile(const TableSource& source) {
        const TransferSettings& settings = source.settings;
        header.directions = static_cast<std::uint16_t>(settings.directions);
        header.enclosed = settings.enclosed;
        header.probes = settings.probes;
        header.hash = hash_of_looks(hash_of(hash_of(source.mesh), source.glass.data(), source.glass.size()),
                                    source.mesh);
        name = "transfer_" + std::to_string(header.hash) + "_" + std::to_string(settings.directions) + "_" +
               std::to_string(settings.probes) + (settings.enclosed ? "_enclosed" : "") + ".bin";
    }

    bool read(CacheReader& in, TransferTable& table) const {
        TableHeader found;
        in(found);
        if (!in.good() || found != header) return false;
        TransferTable::list(table, in);
        return in.good() && table.is_whole();
    }
    void write(CacheWriter& out, const TransferTable& table) const {
        out(header);
        TransferTable::list(table, out);
    }
};

}  // namespace

std::shared_ptr<const TransferTable> find_transfer(const TableSource& source, const Cache& cache) {
    const TableFile file(source);
    auto table = std::make_shared<TransferTable>();
    if (!cache.read(file.name, [&](CacheReader& in) { return file.read(in, *table); })) return nullptr;
    table->scale(source.scale);
    return table;
}

std::shared_ptr<const TransferTable> cached_transfer(const TableSource& source, const Cache& cache,
                                                     const WorkWatcher& watcher) {
    if (auto found = find_transfer(source, cache)) return found;
    const TableFile file(source);
    const auto table = std::make_shared<TransferTable>(source.mesh, source.glass, source.settings, watcher);
    cache.write(file.name, [&](CacheWriter& out) { file.write(out, *table); });
    table->scale(source.scale);
    return table;
}

}  // namespace hilcam
