#include "io/meshes/mesh_source.h"

#include <filesystem>
#include <utility>

#include "io/meshes/mesh_import.h"
#include "io/meshes/ply_source.h"
#include "io/meshes/stl_source.h"
#include "io/system/input_file.h"

namespace hilcam {

MeshSource mesh_source_of(NamedFiles& files, const std::string& kind) {
    const std::filesystem::path& file = files.mesh();
    const std::string name = file.string();
    MeshSource source{(file.parent_path() / file.stem()).string() + kind, read_input_file(file, mesh_kind())};
    if (kind == ".obj") {
        ObjSource obj = plain_obj(source.bytes, name);
        source.libraries = read_obj_libraries(obj, files);
        source.libraries.text = take_map_options(source.libraries.text, source.maps);
        source.bytes = std::move(obj.text);
        if (!source.libraries.text.empty())
            source.bytes.insert(0, std::string("mtllib ") + kMeshMaterials + "\n");
    }
    if (kind == ".ply") source.bytes = plain_ply(source.bytes, name);
    source.whole_colors = kind == ".ply" && has_whole_colors(source.bytes);
    if (kind == ".stl") source.bytes = plain_stl(source.bytes, name, source.remarks);
    source.is_flat = kind == ".stl";
    return source;
}

}  // namespace hilcam
