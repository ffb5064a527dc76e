#include "io/maps/gdal_placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/maps/gdal_raster.h"
#include "io/maps/label_statements.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

// The type in which OGRCoordinateTransformation::Transform counts points.
#if GDAL_VERSION_NUM >= GDAL_COMPUTE_VERSION(3, 9, 0)
using TransformCount = std::size_t;
#else
using TransformCount = int;
#endif

// Appends "what (by)" to a list.
void add(std::string& taken, const std::string& what, const std::string& by) {
    taken += (taken.empty() ? "" : ", ") + what + " (" + by + ")";
}

std::string list_text(const MapBounds& b) {
    return "[" + plain(b.west_deg) + ", " + plain(b.south_deg) + ", " + plain(b.east_deg) + ", " +
           plain(b.north_deg) + "]";
}

// Returns "1 post north"; empty for less than half a post.
std::string displacement(double posts, const char* positive, const char* negative) {
    if (std::abs(posts) < 0.5 - 1e-3) return {};
    const double rounded = std::round(100 * std::abs(posts)) / 100;
    return plain(rounded) + (rounded == 1 ? " post " : " posts ") + (posts > 0 ? positive : negative);
}

double within_half_turn(double deg) { return deg - 360 * std::round(deg / 360); }

// Returns the longitude of a projection's centre, as the projection gives it.
std::optional<double> middle_deg(const OGRSpatialReference& reference) {
    for (const char* const name :
         {SRS_PP_CENTRAL_MERIDIAN, SRS_PP_LONGITUDE_OF_CENTER, SRS_PP_LONGITUDE_OF_ORIGIN}) {
        OGRErr missing = OGRERR_NONE;
        const double found = reference.GetNormProjParm(name, 0, &missing);
        if (missing == OGRERR_NONE) return found;
    }
    return std::nullopt;
}

}  // namespace

void GdalPlacement::refuse(const std::string& what) const {
    throw InputError(map_name(config_) + ": " + what);
}

GdalPlacement::GdalPlacement(GDALDataset& file, const MapLabel& label, const GroundMapConfig& config,
                             const MappedBody& body, GroundRaster::Shape& shape,
                             GroundRaster::Reading& reading)
    : config_(config), label_(label) {
    choose_latitudes(file.GetSpatialRef(), body, reading);
    factor_ = latitude_factor(body.figure, reading.planetocentric);
    if (config.bounds_deg.empty()) {
        find_projection(file, body, shape, reading);
        return;
    }
    bounds_ = {config.bounds_deg[0], config.bounds_deg[1], config.bounds_deg[2], config.bounds_deg[3]};
    set_bounds(*bounds_, body.figure.equatorial_radius_m, shape);
    add(reading.taken, "at " + list_text(*bounds_), "bounds_deg");
}

// The label decides, else the projection's name, else its figure. On a flattened body, a sphere has
// planetocentric latitudes (IAU Working Group on Cartographic Coordinates, Archinal et al. 2018; maps of Mars
// by MOLA, HRSC and USGS). On the Earth, a sphere has geodetic ones, as in MODIS' sinusoidal grid (Masuoka et
// al., IEEE Trans. Geosci. Remote Sens. 36, 1313, 1998).
void GdalPlacement::choose_latitudes(const OGRSpatialReference* reference, const MappedBody& body,
                                     GroundRaster::Reading& reading) {
    std::string by = "latitudes";
    const char* const angles = reference ? reference->GetAttrValue("GEOGCS") : nullptr;
    const std::string name = angles ? small_letters(angles) : "";
    const bool sphere = reference && reference->GetInvFlattening() == 0 && reference->GetSemiMajor() > 0;
    if (config_.latitudes != MapLatitudes::kLabel)
        reading.planetocentric = config_.latitudes == MapLatitudes::kPlanetocentric;
    else if (label_.planetocentric)
        reading.planetocentric = *label_.planetocentric, by = "label: " + label_.latitudes_by;
    else if (name.find("ocentric") != std::string::npos || name.find("ographic") != std::string::npos)
        reading.planetocentric = name.find("ocentric") != std::string::npos, by = "projection's name";
    else if (sphere && body.name == "earth")
        by = "taken: a sphere for the Earth";
    else if (sphere && label_.format == MapLabel::Format::kNone)
        reading.planetocentric = true, by = "projection: a sphere";
    else if (reference && !sphere)
        by = "projection: an ellipsoid";
    else
        by = "taken: the file does not say; latitudes: planetocentric or planetographic does";
    if (body.figure.equatorial_radius_m == body.figure.polar_radius_m) return;
    add(reading.taken,
        std::string("latitudes ") + (reading.planetocentric ? "planetocentric" : "planetographic"), by);
}

void GdalPlacement::require_body(const OGRSpatialReference& reference, const MappedBody& body) const {
    // A projection may use the equator's, the pole's or a place's own radius.
    constexpr double kShare = 0.01;
    const double radius_m = reference.GetSemiMajor();
    const auto [min_m, max_m] = std::minmax(body.figure.polar_radius_m, body.figure.equatorial_radius_m);
    if (!(radius_m > (1 - kShare) * min_m && radius_m < (1 + kShare) * max_m))
        refuse("its projection is of a body of radius " + plain(radius_m * 1e-3) + " km; accepted: that of " +
               body.name + ", " + plain(body.figure.equatorial_radius_m * 1e-3) + " km, within 1 %");
}

void GdalPlacement::find_projection(GDALDataset& file, const MappedBody& body, GroundRaster::Shape& shape,
                                    GroundRaster::Reading& reading) {
    const OGRSpatialReference* const found = file.GetSpatialRef();
    double to_ground[6];
    if (!found || file.GetGeoTransform(to_ground) != CE_None)
        refuse(
            "has no projection; accepted: one that says where it lies, or with bounds_deg: [west, south, "
            "east, north]");
    if (!GDALInvGeoTransform(to_ground, from_ground_)) refuse("its rows and columns fall together");
    OGRSpatialReference reference(*found);
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (!reference.IsGeographic() && !reference.IsProjected())
        refuse("its projection is of neither longitudes and latitudes nor a plane; accepted: one of them");
    require_body(reference, body);
    const double unit = reference.IsGeographic()
                            ? reference.GetAngularUnits() * body.figure.equatorial_radius_m
                            : reference.GetLinearUnits();
    shape.spacing_m = unit * std::sqrt(std::abs(to_ground[1] * to_ground[5] - to_ground[2] * to_ground[4]));
    // Angles are degrees, as in nearly all files.
    if (reference.IsGeographic() && std::abs(reference.GetAngularUnits() / kDegree_rad - 1) > 1e-6)
        refuse("has angles in other units than degrees; accepted: degrees");
    if (reference.IsProjected()) {
        const std::unique_ptr<OGRSpatialReference> angles(reference.CloneGeogCS());
        if (!angles) refuse("its projection has no longitudes and latitudes");
        angles->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        projection_.reset(OGRCreateCoordinateTransformation(angles.get(), &reference));
        if (!projection_) refuse("its projection is unknown (" + QuietErrors::last() + ")");
    }
    choose_longitudes(reference, reading);
    const std::optional<Grid> grid = grid_of(reference, to_ground);
    if (!grid) return;
    judge(*grid, shape, reading);
    find_turn(*grid, shape);
}

// A projection depends only on the longitude relative to its centre. In PDS3 and ISIS, columns go east even
// where longitudes count to the west, and GDAL reads the centre's number as an east longitude. The true
// centre is the negative of it, so twice the number is added.
void GdalPlacement::choose_longitudes(const OGRSpatialReference& reference, GroundRaster::Reading& reading) {
    const bool by_key = config_.longitudes != MapLongitudes::kLabel;
    const bool west =
        by_key ? config_.longitudes == MapLongitudes::kWest : label_.longitudes_west.value_or(false);
    const std::string by = by_key ? "longitudes" : "label: " + label_.longitudes_by;
    if (by_key || label_.longitudes_west)
        add(reading.taken, west ? "longitudes to the west" : "longitudes to the east", by);
    else if (label_.format != MapLabel::Format::kNone)
        add(reading.taken, "longitudes to the east", "taken: the label does not say");
    if (!west) return;
    if (reference.IsGeographic()) {
        sign_ = -1;
        return;
    }
    const std::optional<double> middle = middle_deg(reference);
    // GDAL itself converts the longitudes of PDS4, and of oblique cylinders (Cassini's radar).
    if (!by_key && (label_.format == MapLabel::Format::kPds4 || label_.oblique)) return;
    if (!middle)
        refuse(
            "counts longitudes to the west in a projection without a middle one; accepted: with longitudes: "
            "east, where the file is right as it is");
    constexpr double kSame_deg = 1e-3;
    if (!by_key && label_.center_longitude_deg) {
        const double there = *label_.center_longitude_deg;
        const bool is_east = std::abs(within_half_turn(*middle - there)) < kSame_deg,
                   is_turned = std::abs(within_half_turn(*middle + there)) < kSame_deg;
        if (!is_east && is_turned) return;
        if (!is_east)
            refuse("counts longitudes to the west, and its label's middle is " + plain(there) +
                   " deg, its projection's " + plain(*middle) + "; accepted: with longitudes: east or west");
    }
    shift_deg_ = 2 * *middle;
}

// Returns the grid of degrees, if the map has one.
std::optional<GdalPlacement::Grid> GdalPlacement::grid_of(const OGRSpatialReference& reference,
                                                          const double* to_ground) {
    const double column = to_ground[1], row = -to_ground[5];
    if (to_ground[2] != 0 || to_ground[4] != 0 || !(column > 0) || !(row > 0) || sign_ < 0)
        return std::nullopt;
    if (!reference.IsProjected()) return Grid{to_ground[0], to_ground[3], column, row};
    const char* const name = reference.GetAttrValue("PROJECTION");
    if (!name || !EQUAL(name, SRS_PT_EQUIRECTANGULAR)) return std::nullopt;
    const double middle = reference.GetNormProjParm(SRS_PP_CENTRAL_MERIDIAN, 0);
    double x[2] = {middle, middle + 90}, y[2] = {0, 90};
    if (!projection_->Transform(2, x, y) || !(x[1] > x[0]) || !(y[1] > y[0])) return std::nullopt;
    const double across = 90 / (x[1] - x[0]), down = 90 / (y[1] - y[0]);
    return Grid{middle - shift_deg_ + (to_ground[0] - x[0]) * across, (to_ground[3] - y[0]) * down,
                column * across, row * down};
}

// Finds how many columns make a turn, and whether rows reach the poles.
void GdalPlacement::find_turn(const Grid& grid, GroundRaster::Shape& shape) {
    turn_columns_ = 360 / grid.column_deg;
    shape.whole_turn = std::abs(turn_columns_ - shape.columns) < 0.5;
    if (!shape.whole_turn) return;
    turn_columns_ = shape.columns;
    shape.pole_above_first_row = std::abs(grid.north_deg - 90) < 0.5 * grid.row_deg;
    shape.pole_below_last_row =
        std::abs(grid.north_deg - grid.row_deg * shape.rows + 90) < 0.5 * grid.row_deg;
}

// Compares the placement with the label's bounds, if these are the map's: as wide as its posts, from edge to
// edge or from centre to centre. MOLA's labels of 2003 have offsets that are one post off, and correct
// bounds.
GdalPlacement::Contradiction GdalPlacement::contradiction(const Grid& grid,
                                                          const GroundRaster::Shape& shape) const {
    if (!label_.bounds) return {};
    const MapBounds& b = *label_.bounds;
    const double wide = (b.east_deg - b.west_deg) / grid.column_deg,
                 high = (b.north_deg - b.south_deg) / grid.row_deg;
    constexpr double kSlack = 0.1;
    const auto fits = [&](double less) {
        return std::abs(wide - shape.columns + less) < kSlack && std::abs(high - shape.rows + less) < kSlack;
    };
    if (!fits(0) && !fits(1)) return {};
    const double edge = fits(0) ? 0 : 0.5;  // from the bounds to the outer edges, in posts
    MapBounds own{b.west_deg - edge * grid.column_deg, b.south_deg - edge * grid.row_deg,
                  b.east_deg + edge * grid.column_deg, b.north_deg + edge * grid.row_deg};
    const double north = (grid.north_deg - own.north_deg) / grid.row_deg;
    double east = within_half_turn(grid.west_deg - own.west_deg) / grid.column_deg;
    // A whole turn may begin anywhere, and its label may say 0 to 360 or -180 to 180.
    constexpr double kMaxOff = 2;
    if (std::abs(b.east_deg - b.west_deg - 360) < 0.5 * grid.column_deg && std::abs(east) > kMaxOff)
        own.west_deg = grid.west_deg, own.east_deg = grid.west_deg + 360, east = 0;
    const std::string up = displacement(north, "north", "south"), across = displacement(east, "east", "west");
    return {up + (up.empty() || across.empty() ? "" : " and ") + across, list_text(own)};
}

// Refuses posts beyond a pole, and adds a doubt for what the label contradicts.
void GdalPlacement::judge(const Grid& grid, const GroundRaster::Shape& shape,
                          GroundRaster::Reading& reading) const {
    const Contradiction found = contradiction(grid, shape);
    const double first_deg = grid.north_deg - 0.5 * grid.row_deg,
                 last_deg = grid.north_deg - (shape.rows - 0.5) * grid.row_deg,
                 beyond_deg = 90 + 0.25 * grid.row_deg;
    if (first_deg > beyond_deg || last_deg < -beyond_deg)
        refuse("its projection puts posts beyond a pole, at a latitude of " +
               plain(std::round(1e3 * (first_deg > beyond_deg ? first_deg : last_deg)) / 1e3) +
               " deg; accepted: with bounds_deg: " +
               (found.bounds.empty() ? "[west, south, east, north]" : found.bounds + ", its label's own"));
    if (!found.off.empty())
        reading.doubts.push_back("the offsets of its projection put it " + found.off +
                                 " of the bounds that its label gives; bounds_deg: " + found.bounds +
                                 " takes those");
}

void GdalPlacement::find_posts(std::span<const Vec3d> places, const GroundRaster::Shape& shape,
                               std::span<Vec2d> posts) {
    if (bounds_) {
        for (std::size_t i = 0; i < places.size(); ++i)
            posts[i] = post_at(*bounds_, shape, places[i], factor_);
        return;
    }
    x_.resize(places.size()), y_.resize(places.size()), success_.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        x_[i] = sign_ * longitude_deg(places[i]) + shift_deg_, y_[i] = latitude_deg(places[i], factor_);
    if (projection_)
        projection_->Transform(static_cast<TransformCount>(places.size()), x_.data(), y_.data(), nullptr,
                               nullptr, success_.data());
    else
        std::fill(success_.begin(), success_.end(), 1);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!success_[i] || !std::isfinite(x_[i] + y_[i])) {
            posts[i] = {kNone, kNone};
            continue;
        }
        double column = from_ground_[0] + from_ground_[1] * x_[i] + from_ground_[2] * y_[i] - 0.5;
        if (turn_columns_ > 0) column = within_turn(column, turn_columns_);
        posts[i] = {column, from_ground_[3] + from_ground_[4] * x_[i] + from_ground_[5] * y_[i] - 0.5};
    }
}

}  // namespace hilcam
