#include "io/files/cache_file.h"

#include <unistd.h>

#include <cstring>
#include <string>

#include "render/vocabulary/fnv.h"

namespace hilcam {

CacheReader::CacheReader(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) return;
    in_.open(file, std::ios::binary);
    left_ = size;
    good_ = static_cast<bool>(in_);
}

void write_cache_file(const std::filesystem::path& file, const std::function<void(CacheWriter&)>& write) {
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    const std::filesystem::path beside = file.string() + "." + std::to_string(::getpid());
    CacheWriter out(beside);
    write(out);
    if (out.good())
        std::filesystem::rename(beside, file, ignored);
    else
        std::filesystem::remove(beside, ignored);
}

std::uint64_t hash_of(std::uint64_t hash, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    Fnv1a out(hash);
    for (std::size_t i = 0; i < size; i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
        out.take(word);
    }
    out.take(size);
    return out.value();
}

std::uint64_t hash_of(const Mesh& mesh) {
    std::uint64_t hash = Fnv1a().value();
    const auto add = [&](const auto& values) {
        hash = hash_of(hash, values.data(), values.size() * sizeof(values[0]));
    };
    add(mesh.vertices_m);
    add(mesh.normals);
    add(mesh.uvs);
    add(mesh.triangles);
    add(mesh.surface_of_triangle);
    return hash;
}

}  // namespace hilcam
