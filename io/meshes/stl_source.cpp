#include "io/meshes/stl_source.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "io/files/text_lines.h"
#include "io/system/text_mark.h"

namespace hilcam {
namespace {

// A header, the number of triangles, then the triangles; little-endian.
constexpr std::size_t kCountAt = 80, kTrianglesAt = 84, kTriangleBytes = 50;

std::string whole_triangles(std::string_view stl, const std::string& name,
                            std::vector<std::string>& remarks) {
    const auto fail = [&](const std::string& what) { throw InputError(name + ": does not parse: " + what); };
    if (stl.size() < kTrianglesAt)
        fail("found " + std::to_string(stl.size()) +
             " bytes; accepted: a binary STL, whose triangles begin at byte 84, or one in text, which begins "
             "with "
             "'solid'");
    std::uint64_t triangles = 0;
    for (std::size_t i = 4; i-- > 0;)
        triangles = triangles << 8 | static_cast<std::uint8_t>(stl[kCountAt + i]);
    const std::uint64_t bytes = kTrianglesAt + kTriangleBytes * triangles;
    const std::uint64_t room = (stl.size() - kTrianglesAt) / kTriangleBytes;
    if (stl.size() < bytes || (triangles == 0 && room > 0))
        fail("its " + std::to_string(triangles) + " triangles, as a binary STL, take " +
             std::to_string(bytes) + " bytes, and the file has " + std::to_string(stl.size()) +
             ", room for " + std::to_string(room));
    if (stl.size() > bytes)
        remarks.push_back("the file has " + std::to_string(stl.size() - bytes) +
                          " bytes behind the last of its " + std::to_string(triangles) +
                          " triangles; they are left out");
    return std::string(stl.substr(0, bytes));
}

std::string in_small_letters(std::string_view word) {
    std::string out(word);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

// Copies a line with STL's keywords in lower case, and returns its first word.
std::string add_line(std::string_view line, std::string& out) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const std::string word = in_small_letters(line.substr(0, end));
    // The name of a solid keeps its case.
    const bool names = word == "solid" || word == "endsolid";
    out.append(word).append(names ? std::string(line.substr(end)) : in_small_letters(line.substr(end))) +=
        '\n';
    return word;
}

// assimp fails at a solid without a facet.
std::string without_empty_solids(std::string_view stl, const std::string& name) {
    std::string out;
    out.reserve(stl.size() + 1);
    std::size_t solid = 0;  // where the last one begins
    bool any_facet = true;  // true if that one has a facet
    TextLines lines(stl, name);
    for (std::string_view line; lines.next(line);) {
        line = trimmed(line);
        if (line.empty()) continue;
        const std::size_t begin = out.size();
        const std::string word = add_line(line, out);
        if (word == "solid") solid = begin, any_facet = false;
        if (word == "facet") any_facet = true;
        if (word == "endsolid" && !any_facet) out.resize(solid);
    }
    return out;
}

}  // namespace

bool is_stl_text(std::string_view stl) {
    if (stl.starts_with("\xEF\xBB\xBF")) stl.remove_prefix(3);
    const std::string_view begin = stl.substr(0, 500);
    const std::size_t first = std::min(begin.find_first_not_of(" \t\r\n"), begin.size());
    return in_small_letters(begin.substr(first, 5)) == "solid" &&
           std::all_of(begin.begin(), begin.end(), [](char c) { return c > 0; });
}

std::string plain_stl(std::string_view stl, const std::string& name, std::vector<std::string>& remarks) {
    if (!is_stl_text(stl)) return whole_triangles(stl, name, remarks);
    std::string text(without_mark(stl, name));
    // Lines may end with a carriage return only.
    std::replace(text.begin(), text.end(), '\r', '\n');
    return without_empty_solids(text, name);
}

}  // namespace hilcam
