#include "io/meshes/dsk_shape.h"

#include <cmath>
#include <limits>
#include <set>

#include "io/meshes/mesh_precheck.h"
#include "io/naif/das_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr double kMetres_km = 1000;
// Beyond Neptune.
constexpr double kMax_km = 1e10;

// Integers 1 to 3 of the file are the version and the addresses of the first and the last descriptor; -1 for
// none.
constexpr std::int32_t kDlaVersion = 1'000'000, kNoSegment = -1;
// A descriptor has the previous and the next descriptor, then base address and size of integers, doubles and
// characters. The base is the address before the first.
constexpr std::int64_t kDescriptorIntegers = 8;
constexpr std::size_t kNextSegment = 1, kIntegerBase = 2, kIntegerSize = 3, kDoubleBase = 4, kDoubleSize = 5;
// The segment's doubles begin with 24 that describe it; the vertices of type 2 follow after ten more.
constexpr std::int64_t kAboutWords = 24, kFirstVertex = 34;
// The segment's integers begin with the numbers of vertices and plates; the plates follow after eight more.
constexpr std::int64_t kFirstPlate = 10;

struct Segment {
    DskSegment about;
    std::string where;
    std::int64_t integers = 0, doubles = 0;  // base addresses
};

class DskReader {
  public:
    DskReader(std::string_view bytes, const std::string& name) : file_(bytes, name) { read_chain(); }

    const std::vector<Segment>& segments() const { return segments_; }

    void add(const Segment& segment, Mesh& mesh) const {
        const auto vertices = static_cast<std::int64_t>(segment.about.vertices);
        const auto plates = static_cast<std::int64_t>(segment.about.plates);
        const std::size_t first = mesh.vertices_m.size();
        if (first + segment.about.vertices > kMaxTriangles ||
            mesh.triangles.size() + segment.about.plates > kMaxTriangles)
            file_.fail("has more than 100000000 vertices or plates");
        const std::vector<double> places_km = file_.doubles(segment.doubles + 1 + kFirstVertex, 3 * vertices);
        for (std::size_t i = 0; i < places_km.size(); i += 3)
            mesh.vertices_m.push_back(vertex_m(segment, &places_km[i], i / 3));
        const std::vector<std::int32_t> corners =
            file_.integers(segment.integers + 1 + kFirstPlate, 3 * plates);
        for (std::size_t i = 0; i < corners.size(); i += 3)
            add_plate(segment, &corners[i], i / 3, first, mesh);
    }

  private:
    DasFile file_;
    std::vector<Segment> segments_;

    void read_chain() {
        const std::vector<std::int32_t> head = file_.integers(1, 3);
        if (head[0] != kDlaVersion)
            file_.fail("found the version " + std::to_string(head[0]) +
                       " of linked arrays; accepted: " + std::to_string(kDlaVersion));
        for (std::int64_t at = head[1]; at != kNoSegment;) {
            if (static_cast<std::int64_t>(segments_.size()) > file_.integer_count() / kDescriptorIntegers)
                file_.fail("its segments go in a circle; accepted: a chain that ends");
            const std::vector<std::int32_t> descriptor = file_.integers(at, kDescriptorIntegers);
            segments_.push_back(segment_of(descriptor));
            at = descriptor[kNextSegment];
        }
        if (segments_.empty()) file_.fail("has no segment; accepted: one or more");
    }

    int code_of(double value, const std::string& where) const {
        if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
            file_.fail(where + ": its descriptor is damaged: a code is no whole number");
        return static_cast<int>(value);
    }

    Segment segment_of(const std::vector<std::int32_t>& descriptor) const {
        Segment out;
        out.where = "segment " + std::to_string(segments_.size() + 1);
        out.integers = descriptor[kIntegerBase], out.doubles = descriptor[kDoubleBase];
        if (out.integers < 0 || out.doubles < 0 || descriptor[kDoubleSize] < kAboutWords)
            file_.fail(out.where + ": its descriptor is damaged");
        const std::vector<double> about = file_.doubles(out.doubles + 1, kAboutWords);
        out.about.surface = code_of(about[0], out.where), out.about.body = code_of(about[1], out.where);
        out.about.type = code_of(about[3], out.where), out.about.frame = code_of(about[4], out.where);
        if (out.about.type != 2) return out;
        if (descriptor[kIntegerSize] < kFirstPlate) file_.fail(out.where + ": its descriptor is damaged");
        const std::vector<std::int32_t> counts = file_.integers(out.integers + 1, 2);
        const std::int64_t vertices = counts[0], plates = counts[1];
        if (vertices < 3 || plates < 1 || kFirstVertex + 3 * vertices > descriptor[kDoubleSize] ||
            kFirstPlate + 3 * plates > descriptor[kIntegerSize])
            file_.fail(out.where + ": found " + std::to_string(vertices) + " vertices and " +
                       std::to_string(plates) + " plates in " + std::to_string(descriptor[kDoubleSize]) +
                       " doubles and " + std::to_string(descriptor[kIntegerSize]) +
                       " integers; accepted: as many as it has room for");
        out.about.vertices = static_cast<std::uint32_t>(vertices);
        out.about.plates = static_cast<std::uint32_t>(plates);
        return out;
    }

    Vec3f vertex_m(const Segment& segment, const double* km, std::size_t number) const {
        const Vec3d place_km{km[0], km[1], km[2]};
        if (!(length(place_km) < kMax_km))
            file_.fail(segment.where + ": vertex " + std::to_string(number + 1) +
                       " is no place; accepted: finite coordinates below 1e10 km");
        return to_float(kMetres_km * place_km);
    }

    void add_plate(const Segment& segment, const std::int32_t* corners, std::size_t number, std::size_t first,
                   Mesh& mesh) const {
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (corners[k] < 1 || static_cast<std::uint32_t>(corners[k]) > segment.about.vertices)
                file_.fail(segment.where + ": plate " + std::to_string(number + 1) + ": found vertex " +
                           std::to_string(corners[k]) + "; accepted: 1 to " +
                           std::to_string(segment.about.vertices));
            triangle[k] = static_cast<std::uint32_t>(first + static_cast<std::size_t>(corners[k]) - 1);
        }
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) return;
        mesh.triangles.push_back(triangle);
    }
};

std::string list_of(const std::set<int>& codes) {
    std::string out;
    for (const int code : codes) {
        if (!out.empty()) out += ", ";
        out += std::to_string(code);
    }
    return out;
}

// Throws unless all chosen segments are plates of one surface of one body in one frame.
void require_one(const std::vector<const Segment*>& chosen, const std::string& name) {
    std::set<int> surfaces, bodies, frames;
    for (const Segment* segment : chosen) {
        surfaces.insert(segment->about.surface), bodies.insert(segment->about.body);
        frames.insert(segment->about.frame);
        if (segment->about.type != 2)
            throw InputError(name + ": " + segment->where + ": found data type " +
                             std::to_string(segment->about.type) + "; accepted: 2 (triangular plates)");
    }
    if (surfaces.size() > 1)
        throw InputError(name + ": has the surfaces " + list_of(surfaces) +
                         "; accepted: one of them, chosen by 'mesh_surface'");
    if (bodies.size() > 1 || frames.size() > 1)
        throw InputError(name + ": its surface is of the bodies " + list_of(bodies) + " in the frames " +
                         list_of(frames) + "; accepted: one body in one frame");
}

}  // namespace

std::vector<DskSegment> dsk_segments(std::string_view bytes, const std::string& name) {
    std::vector<DskSegment> out;
    const DskReader reader(bytes, name);
    for (const Segment& segment : reader.segments()) out.push_back(segment.about);
    return out;
}

Mesh read_dsk_shape(std::string_view bytes, const std::string& name, std::optional<int> surface) {
    const DskReader reader(bytes, name);
    std::vector<const Segment*> chosen;
    std::set<int> surfaces;
    for (const Segment& segment : reader.segments()) {
        surfaces.insert(segment.about.surface);
        if (!surface || segment.about.surface == *surface) chosen.push_back(&segment);
    }
    if (chosen.empty())
        throw InputError(name + ": has no surface " + std::to_string(surface.value_or(0)) +
                         "; accepted: " + list_of(surfaces));
    require_one(chosen, name);
    Mesh mesh;
    mesh.surfaces.push_back({.name = "shape"});
    for (const Segment* segment : chosen) reader.add(*segment, mesh);
    if (mesh.triangles.empty())
        throw InputError(name + ": has no plate with three corners; accepted: one or more");
    mesh.surface_of_triangle.assign(mesh.triangles.size(), 0);
    return mesh;
}

}  // namespace hilcam
