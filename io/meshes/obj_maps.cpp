#include "io/meshes/obj_maps.h"

#include <algorithm>
#include <cmath>

#include "io/files/text_lines.h"
#include "io/system/text_number.h"

namespace hilcam {
namespace {

// Removes the next word and the blanks before it from a line, and returns it.
std::string_view take_word(std::string_view& line) {
    line = trimmed(line);
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end);
    return word;
}

// Removes the numbers that come next, at most three, and stores the first two in u and v.
void take_numbers(std::string_view& line, Vec2f& to) {
    for (int k = 0; k < 3; ++k) {
        std::string_view rest = line;
        const auto value = number_of(take_word(rest));
        if (!value || std::abs(*value) > 1e30) return;
        if (k < 2) (k == 0 ? to.x : to.y) = static_cast<float>(*value);
        line = rest;
    }
}

// Removes the options after map_Kd; the file's name remains. A name may begin with a sign, too.
ObjMap take_options(std::string_view& line) {
    ObjMap map;
    for (;;) {
        std::string_view rest = line;
        const std::string_view option = take_word(rest);
        Vec2f unused;
        if (option == "-s") {
            take_numbers(rest, map.scale);
        } else if (option == "-o") {
            take_numbers(rest, map.offset);
        } else if (option == "-t" || option == "-mm" || option == "-boost" || option == "-texres" ||
                   option == "-bm") {
            take_numbers(rest, unused);
        } else if (option == "-clamp") {
            map.clamp = take_word(rest) == "on";
        } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-imfchan" ||
                   option == "-type") {
            take_word(rest);
        } else {
            line = trimmed(line);
            return map;
        }
        line = rest;
    }
}

bool is_plain(const ObjMap& m) {
    return !m.clamp && m.offset.x == 0 && m.offset.y == 0 && m.scale.x == 1 && m.scale.y == 1;
}

}  // namespace

std::string take_map_options(std::string_view mtl, ObjMaps& maps) {
    TextLines lines(mtl, "");
    std::string material, out;
    for (std::string_view line; lines.next(line); out += '\n') {
        std::string_view rest = line;
        const std::string_view word = take_word(rest);
        if (word == "newmtl") material = trimmed(rest);
        if (word != "map_Kd" && word != "map_kd") {
            out += line;
            continue;
        }
        const ObjMap map = take_options(rest);
        if (!is_plain(map)) maps[material] = map;
        out.append("map_Kd ").append(rest);
    }
    return out;
}

bool has_whole_colors(std::string_view ply) {
    TextLines lines(ply, "");
    for (std::string_view line; lines.next(line) && !line.starts_with("end_header");) {
        if (take_word(line) != "property") continue;
        const std::string_view type = take_word(line), name = take_word(line);
        if (name == "red" || name == "diffuse_red") return !type.starts_with("float") && type != "double";
    }
    return false;
}

}  // namespace hilcam
