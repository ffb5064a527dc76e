#include "io/files/obj_maps.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "io/files/text_lines.h"

namespace hilcam {
namespace {

std::vector<std::string> words_of(std::string_view line) {
    std::istringstream in{std::string(line)};
    std::vector<std::string> out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

// Reads as many numbers as follow, three at most, into u and v.
void read_numbers(const std::vector<std::string>& words, std::size_t& at, Vec2f& to) {
    for (int k = 0; k < 3 && at + 1 < words.size(); ++k) {
        std::istringstream in(words[at + 1]);
        in.imbue(std::locale::classic());
        float value = 0;
        if (!(in >> value) || !in.eof() || !std::isfinite(value)) return;
        if (k < 2) (k == 0 ? to.x : to.y) = value;
        ++at;
    }
}

ObjMap map_of(const std::vector<std::string>& words) {
    ObjMap map;
    for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i] == "-s") read_numbers(words, i, map.scale);
        if (words[i] == "-o") read_numbers(words, i, map.offset);
        if (words[i] == "-clamp" && i + 1 < words.size()) map.clamp = words[++i] == "on";
    }
    return map;
}

bool is_plain(const ObjMap& m) {
    return !m.clamp && m.offset.x == 0 && m.offset.y == 0 && m.scale.x == 1 && m.scale.y == 1;
}

}  // namespace

void add_obj_maps(std::string_view mtl, ObjMaps& maps) {
    TextLines lines(mtl, "");
    std::string material;
    for (std::string_view line; lines.next(line);) {
        line = trimmed(line);
        if (line.starts_with("newmtl")) material = trimmed(line.substr(6));
        if (!line.starts_with("map_Kd") && !line.starts_with("map_kd")) continue;
        const ObjMap map = map_of(words_of(line));
        if (!is_plain(map)) maps[material] = map;
    }
}

bool has_whole_colors(std::string_view ply) {
    TextLines lines(ply, "");
    for (std::string_view line; lines.next(line) && !line.starts_with("end_header");) {
        const std::vector<std::string> words = words_of(line);
        if (words.size() == 3 && words[0] == "property" && (words[2] == "red" || words[2] == "diffuse_red"))
            return !words[1].starts_with("float") && words[1] != "double";
    }
    return false;
}

}  // namespace hilcam
