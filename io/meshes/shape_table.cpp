#include "io/meshes/shape_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "io/files/text_lines.h"
#include "io/meshes/mesh_precheck.h"
#include "io/system/text_mark.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxTableColumns = 5;

// The words of a line, at most kMaxTableColumns + 1.
struct Words {
    std::array<std::string_view, kMaxTableColumns + 1> word;
    std::size_t count = 0;

    explicit Words(std::string_view line) {
        const auto blank = [](char c) { return c == ' ' || c == '\t' || c == ','; };
        for (std::size_t i = 0; i < line.size() && count < word.size();) {
            if (blank(line[i])) {
                ++i;
                continue;
            }
            std::size_t end = i;
            while (end < line.size() && !blank(line[end])) ++end;
            word[count++] = line.substr(i, end - i);
            i = end;
        }
    }
};

// Returns a number; its exponent may be of Fortran's double precision.
std::optional<double> shape_number(std::string_view text) {
    if (const auto value = number_of(text)) return value;
    std::string plain(text);
    const std::size_t d = plain.find_first_of("dD");
    if (d == std::string::npos) return {};
    plain[d] = 'e';
    return number_of(plain);
}

// Removes what follows DOS's end of text, and zeros that fill up records.
std::string_view text_of_table(std::string_view bytes, const std::string& name) {
    std::string_view text = without_mark(bytes, name);
    text = text.substr(0, text.find('\x1A'));
    while (text.ends_with('\0')) text.remove_suffix(1);
    return text;
}

class ShapeReader {
  public:
    ShapeReader(std::string_view text, const std::string& name) : lines_(text_of_table(text, name), name) {}

    Mesh read(Longitudes longitudes, std::vector<std::string>* remarks) {
        const Words first = next("a line of numbers");
        if (first.count >= 3 && shape_number(first.word[0])) {
            read_radii(first, longitudes, remarks);
        } else {
            mesh_.surfaces.push_back({.name = "shape"});
            read_facets(first);
        }
        if (mesh_.triangles.empty()) lines_.fail("has no facet; accepted: one or more");
        turn_outwards();
        mesh_.surface_of_triangle.assign(mesh_.triangles.size(), 0);
        return std::move(mesh_);
    }

  private:
    TextLines lines_;
    Mesh mesh_;
    bool from_zero_ = false, last_used_ = false;

    static std::string lines_text(const Words& words) {
        std::string out;
        for (std::size_t i = 0; i < words.count; ++i) {
            if (i > 0) out += ' ';
            out += words.word[i];
        }
        return out;
    }
    bool more(Words& words) {
        for (std::string_view line; lines_.next(line);) {
            words = Words(trimmed(line));
            if (words.count > 0 && !words.word[0].starts_with('#')) return true;
        }
        return false;
    }
    Words next(const char* accepted) {
        Words words("");
        if (!more(words)) lines_.fail(std::string("the file ends; accepted: ") + accepted);
        return words;
    }
    double number(std::string_view text) const {
        const auto value = shape_number(text);
        if (!value || std::abs(*value) > 1e9) lines_.refuse(text, "a number below 1e9");
        return *value;
    }
    std::size_t count(std::string_view text, double most) const {
        const double value = number(text);
        if (!(value >= 1 && value <= most) || value != std::floor(value))
            lines_.refuse(text, "a whole number, 1 to " + std::to_string(static_cast<std::uint64_t>(most)));
        return static_cast<std::size_t>(value);
    }
    Vec3f vertex(const Words& words, std::size_t from) {
        if (words.count < from + 3) lines_.refuse(lines_text(words), "three coordinates");
        return to_float(
            {number(words.word[from]), number(words.word[from + 1]), number(words.word[from + 2])});
    }
    void add_vertex(Vec3f v) {
        if (mesh_.vertices_m.size() == kMaxTriangles) lines_.fail("has more than 100000000 vertices");
        mesh_.vertices_m.push_back(v);
    }
    void add_facet(std::size_t a, std::size_t b, std::size_t c) {
        if (a == b || b == c || c == a) return;
        if (mesh_.triangles.size() == kMaxTriangles) lines_.fail("has more than 100000000 facets");
        mesh_.triangles.push_back(
            {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
    }
    // Corners count from 1, or from 0 if one is 0 (settle_corners); four corners make two facets.
    void add_corners(const Words& words, std::size_t from) {
        const auto most = static_cast<double>(mesh_.vertices_m.size());
        if (words.count != from + 3 && words.count != from + 4)
            lines_.refuse(lines_text(words), "three corners, or four");
        std::array<std::size_t, 4> at{};
        for (std::size_t i = from; i < words.count; ++i) {
            const double corner = number(words.word[i]);
            if (!(corner >= 0 && corner <= most) || corner != std::floor(corner))
                lines_.refuse(words.word[i], "the number of a vertex, of which there are " +
                                                 std::to_string(mesh_.vertices_m.size()));
            at[i - from] = static_cast<std::size_t>(corner);
            from_zero_ |= corner == 0;
            last_used_ |= corner == most;
        }
        add_facet(at[0], at[1], at[2]);
        if (words.count == from + 4) add_facet(at[0], at[2], at[3]);
    }

    void settle_corners() {
        if (from_zero_ && last_used_)
            lines_.fail("corners are counted from 0 and reach the number of vertices, " +
                        std::to_string(mesh_.vertices_m.size()) +
                        "; accepted: from 0 to one less, or from 1");
        if (from_zero_) return;
        for (auto& t : mesh_.triangles)
            for (std::uint32_t& corner : t) --corner;
    }

    void read_facets(const Words& first) {
        if (first.count == 4 && (first.word[0] == "v" || first.word[0] == "V"))
            read_letters(first);
        else if (first.count == 1 || first.count == 2)
            read_counted(first);
        else
            lines_.refuse(
                lines_text(first),
                "v x y z; how many vertices, and facets; Q (.icq); or a latitude, a longitude and a radius");
    }

    void read_letters(Words words) {
        do {
            if (words.word[0] == "v" || words.word[0] == "V")
                add_vertex(vertex(words, 1));
            else if (words.word[0] == "f" || words.word[0] == "F")
                add_corners(words, 1);
            else
                lines_.refuse(lines_text(words), "v x y z, or f i j k");
        } while (more(words));
        settle_corners();
    }

    // Plates number their lines; polyhedra and quadrilaterals do not.
    void read_counted(const Words& head) {
        const std::size_t first = count(head.word[0], static_cast<double>(kMaxTriangles));
        const Words line = next("a vertex");
        if (line.count >= 4)
            read_plates(first, head, line);
        else if (head.count == 2)
            read_polyhedron(first, count(head.word[1], static_cast<double>(kMaxTriangles)), line);
        else
            read_quadrilaterals(first, line);
    }
    void read_plates(std::size_t vertices, const Words& head, Words line) {
        for (std::size_t i = 0; i < vertices; ++i) {
            if (i > 0) line = next("a vertex");
            if (count(line.word[0], static_cast<double>(vertices)) != i + 1)
                lines_.refuse(line.word[0], "the vertex's number, " + std::to_string(i + 1));
            add_vertex(vertex(line, 1));
        }
        const std::size_t plates =
            head.count == 2 ? count(head.word[1], static_cast<double>(kMaxTriangles))
                            : count(next("how many plates").word[0], static_cast<double>(kMaxTriangles));
        for (std::size_t i = 0; i < plates; ++i) add_corners(next("a plate"), 1);
        settle_corners();
    }
    void read_polyhedron(std::size_t vertices, std::size_t facets, Words line) {
        for (std::size_t i = 0; i < vertices; ++i) {
            if (i > 0) line = next("a vertex");
            if (line.count != 3) lines_.refuse(lines_text(line), "three coordinates");
            add_vertex(vertex(line, 0));
        }
        for (std::size_t i = 0; i < facets; ++i) add_polyhedron_facet(next("a facet"));
        settle_corners();
    }
    // Corners only, or after their number, which may be on a line of its own.
    void add_polyhedron_facet(Words line) {
        const auto counts = [](const Words& words) {
            return words.word[0] == "3" ? 3u : words.word[0] == "4" ? 4u : 0u;
        };
        if (line.count == 3) return add_corners(line, 0);
        const std::size_t corners = counts(line);
        if (corners == 0 || (line.count != 1 && line.count != 1 + corners))
            lines_.refuse(lines_text(line), "three corners, or 3 or 4 and as many corners");
        if (line.count > 1) return add_corners(line, 1);
        line = next("a facet's corners");
        if (line.count != corners) lines_.refuse(lines_text(line), std::to_string(corners) + " corners");
        add_corners(line, 0);
    }
    void read_quadrilaterals(std::size_t q, Words line) {
        if (q > 4096) lines_.refuse(std::to_string(q), "Q of 1 to 4096");
        // Vertices on the edges of the cube occur more than once in the file.
        std::map<std::array<float, 3>, std::uint32_t> known;
        std::vector<std::uint32_t> index;
        const std::size_t side = q + 1;
        for (std::size_t i = 0; i < 6 * side * side; ++i) {
            if (i > 0) line = next("a vertex");
            const Vec3f v = vertex(line, 0);
            const auto [at, is_new] =
                known.try_emplace({v.x, v.y, v.z}, static_cast<std::uint32_t>(mesh_.vertices_m.size()));
            if (is_new) add_vertex(v);
            index.push_back(at->second);
        }
        for (std::size_t face = 0; face < 6; ++face)
            for (std::size_t j = 0; j < q; ++j)
                for (std::size_t i = 0; i < q; ++i) {
                    const std::size_t a = (face * side + j) * side + i, b = a + side;
                    add_facet(index[a], index[b], index[b + 1]);
                    add_facet(index[a], index[b + 1], index[a + 1]);
                }
    }

    void read_radii(Words line, Longitudes longitudes, std::vector<std::string>* remarks) {
        std::vector<RadiusRow> rows;
        do {
            if (line.count < 3) lines_.refuse(lines_text(line), "a latitude, a longitude and a radius");
            if (rows.size() == kMaxTriangles) lines_.fail("has more than 100000000 radii");
            rows.push_back(
                {number(line.word[0]), number(line.word[1]), number(line.word[2]), lines_.number()});
        } while (more(line));
        mesh_ = mesh_of_radii(rows, longitudes, lines_.name());
        if (longitudes == Longitudes::kUnsaid && remarks)
            remarks->push_back(
                "its longitudes are taken as east, which neither the table nor a label (.lbl) beside it "
                "says; where "
                "they are west the shape is mirrored: a label with POSITIVE_LONGITUDE_DIRECTION = WEST says "
                "so");
    }

    // The sum of the corners' triple products is six times the enclosed volume.
    void turn_outwards() {
        double volume = 0;
        for (const auto& t : mesh_.triangles)
            volume += dot(to_double(mesh_.vertices_m[t[0]]),
                          cross(to_double(mesh_.vertices_m[t[1]]), to_double(mesh_.vertices_m[t[2]])));
        if (volume < 0)
            for (auto& t : mesh_.triangles) std::swap(t[1], t[2]);
    }
};

}  // namespace

bool is_shape_table(std::string_view kind) { return kind == ".tab" || kind == ".plt" || kind == ".icq"; }

Mesh read_shape_table(std::string_view text, const std::string& name, Longitudes longitudes,
                      std::vector<std::string>* remarks) {
    return ShapeReader(text, name).read(longitudes, remarks);
}

}  // namespace hilcam
