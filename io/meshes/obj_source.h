#pragma once
// OBJ files in the words that assimp reads: what it drops without a word, takes for something else or stumbles over is
// written as it has it (Wavefront, "Object Files (.obj)", Advanced Visualizer Manual, appendix B1).
//
//   in the file                               what assimp makes of it
//   a byte-order mark, blanks before a line   the line is dropped, and all indices behind are off by one
//   v .5 1 2; v x y z r g b a                 the vertex is dropped
//   vt u                                      the file is refused
//   f 01 02 03                                other corners
//   lines that end with a carriage return     one line
//   mtllib a.mtl b.mtl                        a file of that name
//
// What can be neither is refused with its line.

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
    std::string text;                    // without the lines `mtllib`
    std::vector<std::string> libraries;  // the files that these lines name
};
// Throws InputError with name:line.
ObjSource plain_obj(std::string_view text, const std::string& name);

// The materials that an OBJ names, one library after another.
struct ObjLibraries {
    std::string text;
    std::map<std::string, std::filesystem::path, std::less<>>
        folder_of_material;  // textures lie beside their library
    std::vector<std::string> missing;
};
// Reads them in a child (confined.h). Where none of those that are named is there, one of the mesh's own name stands for them. Throws InputError for a
// library that is not readable, and for too many materials in all of them and `obj` together.
ObjLibraries read_obj_libraries(const ObjSource& obj, NamedFiles& files);

}  // namespace hilcam
