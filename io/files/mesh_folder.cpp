#include "io/files/mesh_folder.h"

#include "render/vocabulary/check.h"

namespace hilcam {

std::vector<std::filesystem::path> mesh_folders(const std::filesystem::path& file) {
    std::error_code error;
    std::vector<std::filesystem::path> out{
        std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path(), error)};
    const std::filesystem::path real = std::filesystem::canonical(file, error).parent_path();
    if (!error && real != out.front()) out.push_back(real);
    return out;
}

const InputKind& mesh_kind() {
    static const InputKind kind{std::uintmax_t{4} << 30, "a mesh file, or what one names beside it"};
    return kind;
}

void require_in_folders(const std::filesystem::path& mesh, const std::filesystem::path& file,
                        const std::string& what) {
    std::error_code error;
    const std::filesystem::path real = std::filesystem::weakly_canonical(file, error);
    for (const std::filesystem::path& folder : mesh_folders(mesh)) {
        const std::filesystem::path inside = real.lexically_relative(folder);
        if (!inside.empty() && *inside.begin() != "..") return;
    }
    throw InputError(what + " lies outside the mesh's folder, at " + real.string() +
                     "; accepted: files in that folder or below it");
}

}  // namespace hilcam
