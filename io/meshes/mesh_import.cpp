#include "io/meshes/mesh_import.h"

#include "io/meshes/gltf_import.h"
#include "io/meshes/mesh_scene.h"
#include "io/meshes/mesh_source.h"
#include "io/meshes/scene_mesh.h"

namespace hilcam {
namespace {

bool is_gltf(const std::string& kind) { return kind == ".glb" || kind == ".gltf"; }

}  // namespace

const InputKind& mesh_kind() {
    static const InputKind kind{std::uintmax_t{4} << 30, "a mesh file, or what one names beside it"};
    return kind;
}

MeshContents import_mesh_contents(NamedFiles& files, const std::string& kind) {
    if (is_gltf(kind)) return gltf_contents(files, kind);
    const MeshSource source = mesh_source_of(files, kind);
    const MeshScene read(source, files);
    MeshContents out = contents_of_scene(read.scene(), source, files);
    out.missing_materials = source.libraries.missing;
    out.remarks = source.remarks;
    out.remarks.insert(out.remarks.end(), files.remarks().begin(), files.remarks().end());
    return out;
}

std::vector<Mesh> import_mesh_parts(NamedFiles& files, const std::string& kind,
                                    std::span<const std::string> nodes) {
    if (is_gltf(kind)) return gltf_parts(files, kind, nodes);
    const MeshSource source = mesh_source_of(files, kind);
    const MeshScene read(source, files);
    std::vector<Mesh> meshes;
    for (int part = -1; part < static_cast<int>(nodes.size()); ++part)
        meshes.push_back(part_of_scene(read.scene(), source, files, nodes, part));
    return meshes;
}

}  // namespace hilcam
