#include "io/meshes/ply_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <vector>

#include "io/files/text_lines.h"
#include "io/meshes/mesh_precheck.h"
#include "io/system/text_mark.h"

namespace hilcam {
namespace {

enum class PlyForm { kText, kLittle, kBig };

struct PlyType {
    std::size_t bytes = 0;
    bool is_signed = false, is_float = false;
};
struct PlyProperty {
    bool is_list = false, holds_indices = false;
    PlyType count, value;
};
struct PlyElement {
    std::string name, header;  // its lines in the header
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};
struct PlyHeader {
    std::string begin;  // the lines before the first element
    PlyForm form = PlyForm::kText;
    std::vector<PlyElement> elements;
    std::size_t data_at = 0;
};

std::optional<PlyType> ply_type_of(std::string_view word) {
    struct Known {
        std::string_view name, newer;
        PlyType type;
    };
    static constexpr std::array<Known, 8> kPlyTypes = {{{"char", "int8", {1, true, false}},
                                                        {"uchar", "uint8", {1, false, false}},
                                                        {"short", "int16", {2, true, false}},
                                                        {"ushort", "uint16", {2, false, false}},
                                                        {"int", "int32", {4, true, false}},
                                                        {"uint", "uint32", {4, false, false}},
                                                        {"float", "float32", {4, true, true}},
                                                        {"double", "float64", {8, true, true}}}};
    for (const Known& known : kPlyTypes)
        if (word == known.name || word == known.newer) return known.type;
    return {};
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> out;
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        out.push_back(line.substr(at, end - at));
        at = end;
    }
    return out;
}

class PlyHeaderReader {
  public:
    PlyHeaderReader(std::string_view ply, const std::string& name) : ply_(ply), lines_(ply, name) {}

    PlyHeader read() {
        require_end();
        for (std::string_view line; lines_.next(line);)
            if (add(line)) {
                // The data begin after this line, whatever ends it.
                out_.data_at = static_cast<std::size_t>(line.data() - ply_.data()) + line.size();
                if (ply_.substr(out_.data_at).starts_with('\r')) ++out_.data_at;
                if (ply_.substr(out_.data_at).starts_with('\n')) ++out_.data_at;
                break;
            }
        return std::move(out_);
    }

  private:
    static constexpr int kMaxLines = 1000;  // no header has more

    std::string_view ply_;
    TextLines lines_;
    PlyHeader out_;
    std::set<std::string, std::less<>> seen_;

    // A file may end within its header.
    void require_end() const {
        TextLines lines(ply_, lines_.name());
        for (std::string_view line; lines.number() < kMaxLines && lines.next(line);)
            if (line.starts_with("end_header")) return;
        throw InputError(lines_.name() + ": does not parse: its PLY header has no end_header");
    }

    // True for the header's last line.
    bool add(std::string_view line) {
        const auto words = words_of(line);
        if (words.empty() || words[0] == "obj_info") return false;
        // A comment may name a texture (VCGlib).
        if (words[0] == "comment" && (words.size() < 3 || words[1] != "TextureFile")) return false;
        if (words[0].starts_with("end_header")) return true;
        if (words[0] == "element") return add_element(words), false;
        if (words[0] == "property" && !out_.elements.empty()) return add_property(line, words), false;
        if (words[0] == "format" && words.size() > 1)
            out_.form = words[1] == "binary_little_endian" ? PlyForm::kLittle
                        : words[1] == "binary_big_endian"  ? PlyForm::kBig
                                                           : PlyForm::kText;
        out_.begin.append(trimmed(line)) += '\n';
        return false;
    }
    void add_element(const std::vector<std::string_view>& words) {
        const auto count = words.size() == 3 ? parsed_as<std::uint64_t>(words[2]) : std::nullopt;
        if (!count) lines_.fail("accepted: element NAME COUNT");
        if (!seen_.emplace(words[1]).second) lines_.refuse(words[1], "each element once");
        PlyElement& element = out_.elements.emplace_back();
        element.name = words[1], element.count = *count;
        element.header = "element " + element.name + " " + std::to_string(*count) + "\n";
    }
    void add_property(std::string_view line, const std::vector<std::string_view>& words) {
        PlyProperty property;
        property.is_list = words.size() == 5 && words[1] == "list";
        const auto type = [&](std::string_view word) {
            const auto known = ply_type_of(word);
            if (!known) lines_.refuse(word, "a type of a property, such as float, uchar or int32");
            return *known;
        };
        if (!property.is_list && words.size() != 3)
            lines_.fail("accepted: property TYPE NAME, or property list TYPE TYPE NAME");
        if (property.is_list) property.count = type(words[2]);
        property.value = type(words[property.is_list ? 3 : 1]);
        property.holds_indices = property.is_list && words.back().starts_with("vertex_ind");
        out_.elements.back().properties.push_back(property);
        out_.elements.back().header.append(trimmed(line)) += '\n';
    }
};

// Reads the numbers of the data in order.
class PlyData {
  public:
    PlyData(std::string_view ply, const PlyHeader& header, const std::string& name)
        : ply_(ply), form_(header.form), at_(header.data_at), name_(name) {}

    std::size_t at() const { return at_; }

    // Returns an integer.
    std::int64_t whole(const PlyType& type) {
        if (form_ == PlyForm::kText) {
            const std::string_view word = next_word();
            const auto value = parsed_as<std::int64_t>(word);
            if (!value) fail("found " + in_quotes(word) + "; accepted: a whole number");
            return *value;
        }
        std::uint64_t bits = 0;
        const std::string_view bytes = take(type.bytes);
        for (std::size_t i = 0; i < type.bytes; ++i)
            bits =
                bits << 8 | static_cast<std::uint8_t>(bytes[form_ == PlyForm::kBig ? i : type.bytes - 1 - i]);
        const std::size_t unused = 64 - 8 * type.bytes;
        if (type.is_float || type.bytes == 0) fail("a list has floating-point numbers for indices");
        return type.is_signed ? static_cast<std::int64_t>(bits << unused) >> unused
                              : static_cast<std::int64_t>(bits);
    }
    std::uint64_t count(const PlyType& type) {
        const std::int64_t value = whole(type);
        // Each takes at least a byte, or a digit and a blank.
        if (value < 0 || static_cast<std::uint64_t>(value) > ply_.size() - at_)
            fail("a list of " + std::to_string(value) + " numbers does not fit into the file");
        return static_cast<std::uint64_t>(value);
    }
    void skip(const PlyElement& element) {
        const auto is_list = [](const PlyProperty& property) { return property.is_list; };
        if (form_ != PlyForm::kText &&
            std::none_of(element.properties.begin(), element.properties.end(), is_list)) {
            std::uint64_t bytes = 0;
            for (const PlyProperty& property : element.properties) bytes += property.value.bytes;
            if (bytes > 0 && element.count > (ply_.size() - at_) / bytes) fail("the file ends too early");
            at_ += bytes * element.count;
            return;
        }
        if (element.properties.empty()) return;
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties) skip(property);
    }
    void skip(const PlyProperty& property) {
        for (std::uint64_t left = property.is_list ? count(property.count) : 1; left > 0; --left)
            form_ == PlyForm::kText ? next_word() : take(property.value.bytes);
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(name_ + ": does not parse: at byte " + std::to_string(at_) + ": " + what);
    }

  private:
    std::string_view ply_;
    PlyForm form_;
    std::size_t at_;
    const std::string& name_;

    std::string_view take(std::size_t bytes) {
        if (bytes > ply_.size() - at_) fail("the file ends too early");
        at_ += bytes;
        return ply_.substr(at_ - bytes, bytes);
    }
    std::string_view next_word() {
        at_ = std::min(ply_.find_first_not_of(" \t\r\n", at_), ply_.size());
        const std::size_t end = std::min(ply_.find_first_of(" \t\r\n", at_), ply_.size());
        if (end == at_) fail("the file ends too early");
        return take(end - at_);
    }
};

using PlyTriangle = std::array<std::int64_t, 3>;

// Splits a strip: each index makes a triangle with the two before it, every other one reversed; -1 starts a
// new strip.
void add_strip(PlyData& data, const PlyProperty& property, std::vector<PlyTriangle>& out) {
    std::array<std::int64_t, 2> before{-1, -1};
    bool turned = false;
    for (std::uint64_t left = data.count(property.count); left > 0; --left) {
        const std::int64_t index = data.whole(property.value);
        if (index < -1 || index > std::int64_t{1} << 31)
            data.fail("found the index " + std::to_string(index));
        if (index >= 0 && before[0] >= 0) {
            const PlyTriangle t =
                turned ? PlyTriangle{before[1], before[0], index} : PlyTriangle{before[0], before[1], index};
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) out.push_back(t);
            if (out.size() > kMaxTriangles) data.fail("has more than 100000000 triangles");
            turned = !turned;
        }
        before = index < 0 ? std::array<std::int64_t, 2>{-1, -1} : std::array{before[1], index};
        if (index < 0) turned = false;
    }
}

std::string face_data(const std::vector<PlyTriangle>& faces, PlyForm form) {
    std::string out;
    out.reserve(faces.size() * 16);
    for (const PlyTriangle& face : faces) {
        if (form == PlyForm::kText) {
            out += "3";
            for (const std::int64_t index : face) out.append(" ").append(std::to_string(index));
            out += "\n";
            continue;
        }
        out += '\3';
        for (const std::int64_t index : face)
            for (int i = 0; i < 4; ++i)
                out += static_cast<char>(index >> 8 * (form == PlyForm::kBig ? 3 - i : i));
    }
    return out;
}

// Turns an element of strips into faces, and returns their data.
std::string unrolled(PlyElement& strips, PlyData& data, PlyForm form) {
    std::vector<PlyTriangle> triangles;
    for (std::uint64_t i = 0; i < strips.count; ++i)
        for (const PlyProperty& property : strips.properties)
            property.holds_indices ? add_strip(data, property, triangles) : data.skip(property);
    strips = {
        "face",
        "element face " + std::to_string(triangles.size()) + "\nproperty list uchar int vertex_indices\n",
        triangles.size(),
        {}};
    return face_data(triangles, form);
}

// assimp knows these elements; the data of any other it reads as the next element's.
bool is_known(const PlyElement& element) {
    const std::string& name = element.name;
    return name == "vertex" || name == "face" || name == "edge" || name == "material";
}

// Turns strips into faces and removes elements that assimp does not know, from the header and from the data
// returned.
std::string plain_data(std::string_view ply, PlyHeader& header, const std::string& name) {
    const auto is_strips = [](const PlyElement& e) { return e.name == "tristrips" && e.count > 0; };
    const auto is_faces = [](const PlyElement& e) { return e.name == "face" && e.count > 0; };
    auto& elements = header.elements;
    const auto strips = std::find_if(elements.begin(), elements.end(), is_strips);
    if (strips != elements.end() && std::any_of(elements.begin(), elements.end(), is_faces))
        throw InputError(name +
                         ": does not parse: it has faces and strips of triangles; accepted: one of them");
    // After the last element that is needed, everything may stay.
    while (!elements.empty() && !is_known(elements.back()) && !is_strips(elements.back()))
        elements.pop_back();
    if (std::all_of(elements.begin(), elements.end(), is_known))
        return std::string(ply.substr(header.data_at));
    PlyData data(ply, header, name);
    const std::string_view between = header.form == PlyForm::kText ? "\n" : "";
    std::string out;
    for (PlyElement& element : elements) {
        const std::size_t begin = data.at();
        if (is_strips(element)) {
            out.append(unrolled(element, data, header.form)).append(between);
            continue;
        }
        data.skip(element);
        if (is_known(element)) out.append(ply.substr(begin, data.at() - begin)).append(between);
    }
    std::erase_if(elements, [&](const PlyElement& e) { return !is_known(e); });
    return out;
}

}  // namespace

std::string plain_ply(std::string_view ply, const std::string& name) {
    if (ply.starts_with("\xEF\xBB\xBF")) ply.remove_prefix(3);
    if (!ply.starts_with("ply")) ply = without_mark(ply, name);
    PlyHeader header = PlyHeaderReader(ply, name).read();
    const std::string data = plain_data(ply, header, name);
    std::string out = header.begin;
    // assimp takes all line ends after the header as part of it, so an unused element of one byte is put
    // before the data.
    const bool needs_guard = header.form != PlyForm::kText && data.find_first_of("\r\n") == 0;
    if (needs_guard) out += "element edge 1\nproperty uchar vertex1\n";
    for (const PlyElement& element : header.elements)
        // An empty element may exist beside another of the same name, of which assimp accepts only one.
        if (element.count > 0 && !(needs_guard && element.name == "edge")) out += element.header;
    return out.append(needs_guard ? "end_header\n#" : "end_header\n").append(data);
}

}  // namespace hilcam
