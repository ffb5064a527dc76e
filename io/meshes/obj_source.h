#pragma once
// Rewrites OBJ files for assimp: what assimp drops silently, misreads or fails on is written as assimp
// accepts it (Wavefront, "Object Files (.obj)", Advanced Visualizer Manual, appendix B1).
//
//  in the file                              what assimp makes of it
//  byte-order mark, blanks before a line    drops the line; all later indices are off by one
//  v .5 1 2; v x y z r g b a                drops the vertex
//  vt u                                     refuses the file
//  f 01 02 03                               other corners
//  lines that end with a carriage return    one line
//  mtllib a.mtl b.mtl                       one file with that whole name
//
// What cannot be rewritten is refused with its line.

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/meshes/named_files.h"

namespace hilcam {

struct ObjSource {
    std::string text;                    // without the `mtllib` lines
    std::vector<std::string> libraries;  // the files that these lines name
};
// Throws InputError with name:line.
ObjSource plain_obj(std::string_view text, const std::string& name);

// The materials that an OBJ names, library after library.
struct ObjLibraries {
    std::string text;
    // Textures are searched in the folder of their library.
    std::map<std::string, std::filesystem::path, std::less<>> folder_of_material;
    std::vector<std::string> missing;
};
// Reads the libraries; runs in a child (confined.h). When none of the named ones exists, a library with the
// mesh's own name takes their place. Throws InputError for an unreadable library, and for too many materials
// in all of them and `obj`.
ObjLibraries read_obj_libraries(const ObjSource& obj, NamedFiles& files);

}  // namespace hilcam
