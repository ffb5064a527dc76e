#include "io/meshes/radius_grid.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Angles as integers, so that equal ones compare equal in spite of rounding.
using Microdegrees = long long;
constexpr Microdegrees kDegree = 1'000'000, kPole = 90 * kDegree, kCircle = 360 * kDegree;

Microdegrees rounded(double angle_deg) { return std::llround(angle_deg * static_cast<double>(kDegree)); }
double degrees_of(Microdegrees angle) { return static_cast<double>(angle) / static_cast<double>(kDegree); }

class RadiusGrid {
  public:
    RadiusGrid(const std::vector<RadiusRow>& rows, Longitudes longitudes, const std::string& name)
        : name_(name), west_(longitudes == Longitudes::kWest) {
        const bool longitude_first = is_longitude_first(rows);
        for (const RadiusRow& row : rows)
            longitude_first ? add(row, row.second_deg, row.first_deg)
                            : add(row, row.first_deg, row.second_deg);
        longitudes_.assign(seen_.begin(), seen_.end());
    }

    Mesh mesh() {
        require_round();
        mesh_.surfaces.push_back({.name = "shape"});
        const std::uint32_t south = add_pole(-1, rings_.begin()->second);
        std::vector<std::uint32_t> below;
        for (const auto& [latitude, radii] : rings_) {
            const std::vector<std::uint32_t> ring = add_ring(latitude, radii);
            if (below.empty())
                join_pole(south, ring);
            else
                join(below, ring);
            below = ring;
        }
        join_pole(add_pole(1, rings_.rbegin()->second), below);
        mesh_.surface_of_triangle.assign(mesh_.triangles.size(), 0);
        return std::move(mesh_);
    }

  private:
    using Ring = std::map<Microdegrees, double>;  // radius by longitude

    const std::string& name_;
    bool west_;
    std::map<Microdegrees, Ring> rings_;  // by latitude, without the poles
    double pole_sum_[2] = {0, 0};         // south, north
    int pole_count_[2] = {0, 0};
    std::set<Microdegrees> seen_;
    std::vector<Microdegrees> longitudes_;
    Mesh mesh_;

    [[noreturn]] void refuse(const std::string& what) const { throw InputError(name_ + ": " + what); }
    [[noreturn]] void refuse(int line, const std::string& what) const {
        throw InputError(name_ + ":" + std::to_string(line) + ": " + what);
    }

    bool is_longitude_first(const std::vector<RadiusRow>& rows) const {
        const auto goes_round = [&](double RadiusRow::*angle_deg) {
            return std::any_of(rows.begin(), rows.end(),
                               [&](const RadiusRow& row) { return std::abs(row.*angle_deg) > 90; });
        };
        const bool first = goes_round(&RadiusRow::first_deg), second = goes_round(&RadiusRow::second_deg);
        if (first == second)
            refuse("a table of three columns whose " +
                   std::string(first ? "first two both go" : "first two do not go") +
                   " beyond 90; accepted: latitude, longitude and radius, or longitude, latitude and radius, "
                   "in degrees");
        return first;
    }

    void add(const RadiusRow& row, double latitude_deg, double longitude_deg) {
        if (std::abs(latitude_deg) > 90)
            refuse(row.line, "found the latitude " + plain(latitude_deg) + "; accepted: -90 to 90");
        if (std::abs(longitude_deg) > 360)
            refuse(row.line, "found the longitude " + plain(longitude_deg) + "; accepted: -360 to 360");
        if (!(row.radius > 0))
            refuse(row.line, "found the radius " + plain(row.radius) + "; accepted: above 0");
        const Microdegrees latitude = rounded(latitude_deg);
        if (std::abs(latitude) == kPole) {
            pole_sum_[latitude > 0] += row.radius;
            ++pole_count_[latitude > 0];
            return;
        }
        const Microdegrees longitude = (rounded(longitude_deg) % kCircle + kCircle) % kCircle;
        rings_[latitude].emplace(longitude, row.radius);
        seen_.insert(longitude);
    }

    // A table of part of the body would be closed over what it lacks.
    void require_round() const {
        constexpr Microdegrees kWidest = 45 * kDegree;
        if (longitudes_.size() < 3 || rings_.empty())
            refuse("has too few latitudes or longitudes; accepted: a whole body");
        for (std::size_t i = 0; i < longitudes_.size(); ++i) {
            const Microdegrees gap =
                i > 0 ? longitudes_[i] - longitudes_[i - 1] : longitudes_[0] + kCircle - longitudes_.back();
            if (gap > kWidest)
                refuse("has no radius for " + plain(degrees_of(gap)) +
                       " degrees of longitude; accepted: a whole body");
        }
        Microdegrees before = -kPole;
        for (const auto& [latitude, radii] : rings_) require_near(before, latitude), before = latitude;
        require_near(before, kPole);
    }
    void require_near(Microdegrees below, Microdegrees above) const {
        constexpr Microdegrees kWidest = 45 * kDegree;
        if (above - below > kWidest)
            refuse("has no radius from latitude " + plain(degrees_of(below)) + " to " +
                   plain(degrees_of(above)) + "; accepted: a whole body");
    }

    std::uint32_t add_vertex(double latitude_rad, double longitude_rad, double radius) {
        const double across = radius * std::cos(latitude_rad);
        mesh_.vertices_m.push_back(
            to_float({across * std::cos(longitude_rad), (west_ ? -across : across) * std::sin(longitude_rad),
                      radius * std::sin(latitude_rad)}));
        return static_cast<std::uint32_t>(mesh_.vertices_m.size() - 1);
    }
    std::uint32_t add_pole(int sign, const Ring& nearest) {
        double sum = pole_sum_[sign > 0];
        double count = pole_count_[sign > 0];
        if (count == 0)
            for (const auto& [longitude, radius] : nearest) sum += radius, ++count;
        mesh_.vertices_m.push_back(to_float({0, 0, sign * sum / count}));
        return static_cast<std::uint32_t>(mesh_.vertices_m.size() - 1);
    }
    std::vector<std::uint32_t> add_ring(Microdegrees latitude, const Ring& radii) {
        std::vector<std::uint32_t> ring;
        for (const Microdegrees longitude : longitudes_) {
            const auto radius = radii.find(longitude);
            if (radius == radii.end())
                refuse("has no radius at latitude " + plain(degrees_of(latitude)) + ", longitude " +
                       plain(degrees_of(longitude)));
            ring.push_back(add_vertex(degrees_of(latitude) * kDegree_rad, degrees_of(longitude) * kDegree_rad,
                                      radius->second));
        }
        return ring;
    }
    void join_pole(std::uint32_t pole, const std::vector<std::uint32_t>& ring) {
        const bool south = mesh_.vertices_m[pole].z < 0;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
            south ? mesh_.triangles.push_back({pole, b, a}) : mesh_.triangles.push_back({pole, a, b});
        }
    }
    void join(const std::vector<std::uint32_t>& below, const std::vector<std::uint32_t>& above) {
        for (std::size_t i = 0; i < below.size(); ++i) {
            const std::size_t next = (i + 1) % below.size();
            mesh_.triangles.push_back({below[i], below[next], above[next]});
            mesh_.triangles.push_back({below[i], above[next], above[i]});
        }
    }
};

// Returns the label in capitals, with single blanks between its words.
std::string words_of_label(std::string_view label) {
    std::string out;
    for (const char c : label) {
        const auto code = static_cast<unsigned char>(c);
        if (!std::isspace(code) && c != '_' && c != '"')
            out += static_cast<char>(std::toupper(code));
        else if (!out.empty() && out.back() != ' ')
            out += ' ';
    }
    return out;
}

}  // namespace

Mesh mesh_of_radii(const std::vector<RadiusRow>& rows, Longitudes longitudes, const std::string& name) {
    return RadiusGrid(rows, longitudes, name).mesh();
}

Longitudes longitudes_of_label(std::string_view label) {
    const std::string words = words_of_label(label);
    const auto says = [&](const std::string& direction) {
        return words.find("POSITIVE LONGITUDE DIRECTION = " + direction) != std::string::npos;
    };
    const auto tells = [&](const std::string& direction) {
        return words.find(direction + " LONGITUDE") != std::string::npos ||
               words.find("INCREASING TO THE " + direction) != std::string::npos;
    };
    if (says("EAST") || says("WEST")) return says("EAST") ? Longitudes::kEast : Longitudes::kWest;
    if (tells("EAST") == tells("WEST")) return Longitudes::kUnsaid;
    return tells("EAST") ? Longitudes::kEast : Longitudes::kWest;
}

}  // namespace hilcam
