#include "emulator/ground/ground_survey.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/ground/globe_loader.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The list of a thousand square kilometres' smallest craters would fill a disk.
constexpr double kMost = 2e6;

// The tangent plane at a place.
struct LocalPlane {
    Vec3d up, east, north;
    double radius_m;

    LocalPlane(const Geodetic& middle, const Figure& figure) : radius_m(figure.equatorial_radius_m) {
        const Mat3d axes = transposed(body_fixed_from_local(middle));
        east = axes.x, north = axes.y, up = axes.z;
    }
    Vec3d place(double east_m, double north_m) const {
        return normalized(up + east_m / radius_m * east + north_m / radius_m * north);
    }
    std::string text_of(Vec3d place) const {
        const double scale = radius_m / dot(place, up);
        return fmt::format("{:.8f},{:.8f},{:.4f},{:.4f}", std::atan2(place.y, place.x) / kDegree_rad,
                           std::asin(std::clamp(place.z, -1.0, 1.0)) / kDegree_rad, scale * dot(place, east),
                           scale * dot(place, north));
    }
};

void require_few(double count, const char* what) {
    if (count > kMost)
        throw InputError(
            fmt::format("--within-m, --smallest-m: there are about {:.2g} {} there; accepted: {:.0g}", count,
                        what, kMost));
}

// Lists the things of a field, each with a second figure of its own. names: of the kind of thing and of that figure.
template <class Field, class Thing>
std::string list_of(const Field& field, const LocalPlane& at, const GroundSurvey& s, double smallest_m,
                    const char* things, const char* figure, double Thing::*second) {
    require_few(field.per_m2(std::max(s.smallest_m, smallest_m)) * kPi * s.within_m * s.within_m, things);
    std::vector<Thing> found;
    field.find(at.up, s.within_m / at.radius_m, s.smallest_m, found);
    std::string out = fmt::format("longitude_deg,latitude_deg,east_m,north_m,diameter_m,{}\n", figure);
    for (const Thing& thing : found)
        out += fmt::format("{},{:.4f},{:.4f}\n", at.text_of(thing.place), thing.diameter_m, thing.*second);
    return out;
}

std::string craters(const GlobeConfig& globe, const LocalPlane& at, const GroundSurvey& s) {
    if (!globe.craters) throw InputError("terrain.globe.craters: there are none in this scenario");
    return list_of(CraterField(at.radius_m, *globe.craters), at, s, globe.craters->smallest_m, "craters",
                   "worn", &Crater::worn);
}

std::string boulders(const GlobeConfig& globe, const LocalPlane& at, const GroundSurvey& s) {
    if (!globe.boulders || !(globe.boulders->abundance > 0))
        throw InputError("terrain.globe.boulders: there are none in this scenario");
    return list_of(BoulderField(at.radius_m, *globe.boulders), at, s, globe.boulders->smallest_m, "boulders",
                   "height_m", &Boulder::height_m);
}

// Slope and step at a post from those about it, `side` to a row.
std::string slope_of(const std::vector<double>& h, std::size_t i, std::size_t side, double spacing_m) {
    double east = 0, north = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        east += (h[i + 1 + k * side - side] - h[i - 1 + k * side - side]) / (6 * spacing_m);
        north += (h[i + side + k - 1] - h[i - side + k - 1]) / (6 * spacing_m);
    }
    double step_m = 0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            const auto j = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) +
                                                    y * static_cast<std::ptrdiff_t>(side) + x);
            step_m = std::max(step_m, std::abs(h[j] - h[i] - spacing_m * (x * east + y * north)));
        }
    return fmt::format("{:.4f},{:.3f},{:.4f}", h[i], std::atan(std::hypot(east, north)) / kDegree_rad,
                       step_m);
}

std::string heights(const GlobeConfig& globe, const MappedBody& body, const LocalPlane& at,
                    const GroundSurvey& s) {
    const int half = static_cast<int>(std::min(std::floor(s.within_m / s.spacing_m), kMost)),
              side = 2 * half + 3;
    require_few(1.0 * side * side, "heights");
    std::vector<Vec3d> places;
    for (int y = -half - 1; y <= half + 1; ++y)
        for (int x = -half - 1; x <= half + 1; ++x)
            places.push_back(at.place(x * s.spacing_m, y * s.spacing_m));
    std::vector<double> heights_m(places.size());
    constexpr std::size_t kBytes = std::size_t{64} << 20;
    GroundSurface surface(body.figure, open_maps(globe, body), kBytes);
    surface.find_heights(places, s.spacing_m, heights_m);
    const GroundPatch patch{side,       places, heights_m,
                            {},         at.up,  (s.within_m + 2 * s.spacing_m) * std::sqrt(2) / at.radius_m,
                            s.spacing_m};
    for (const auto& detail : details_of(globe, body)) detail->add_wide(patch), detail->add(patch);
    std::string out = "longitude_deg,latitude_deg,east_m,north_m,height_m,slope_deg,step_m\n";
    for (int y = 1; y + 1 < side; ++y)
        for (int x = 1; x + 1 < side; ++x) {
            const auto i = static_cast<std::size_t>(y * side + x);
            out += at.text_of(places[i]) + "," +
                   slope_of(heights_m, i, static_cast<std::size_t>(side), s.spacing_m) + "\n";
        }
    return out;
}

}  // namespace

std::string survey_ground(const GlobeConfig& globe, const MappedBody& body, const GroundSurvey& survey) {
    const LocalPlane at(survey.middle, body.figure);
    switch (survey.what) {
        case GroundSurvey::What::kCraters:
            return craters(globe, at, survey);
        case GroundSurvey::What::kBoulders:
            return boulders(globe, at, survey);
        case GroundSurvey::What::kHeights:
            break;
    }
    return heights(globe, body, at, survey);
}

}  // namespace hilcam
