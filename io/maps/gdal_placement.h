#pragma once
// Places the posts of a GDAL file on a body, from the file's projection or from the scenario's bounds in
// degrees. The label (map_label.h) gives what GDAL does not pass on: the kind of latitudes, and longitudes
// that count to the west.

#include <ogr_spatialref.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/maps/gdal_file.h"
#include "io/maps/ground_map_file.h"
#include "io/maps/longitude_latitude.h"
#include "io/maps/map_label.h"

namespace hilcam {

class GdalPlacement {
  public:
    // shape: has columns and rows on entry; gets the rest. reading: gets which choices were made and why.
    // Throws InputError that begins with the map's name when there is no projection, when it is another
    // body's, or when it puts posts beyond a pole.
    GdalPlacement(GDALDataset& file, const MapLabel& label, const GroundMapConfig& config,
                  const MappedBody& body, GroundRaster::Shape& shape, GroundRaster::Reading& reading);

    // See GroundRaster::find_posts().
    void find_posts(std::span<const Vec3d> places, const GroundRaster::Shape& shape, std::span<Vec2d> posts);

  private:
    struct DestroyTransformation {
        void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
    };
    // A map with meridians as columns and parallels as rows, in degrees east and north.
    struct Grid {
        double west_deg, north_deg, column_deg, row_deg;
    };

    // Says how far a map is from its label's own bounds, "1 post north", and these bounds as the key has
    // them. Both empty: they agree, or cannot be compared.
    struct Contradiction {
        std::string off, bounds;
    };

    const GroundMapConfig& config_;
    const MapLabel& label_;
    std::optional<MapBounds> bounds_;
    std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation>
        projection_;  // null: longitude and latitude
    double from_ground_[6] = {};
    double factor_ = 1;  // see latitude_factor()
    double sign_ = 1;    // -1: longitudes count to the west
    // Added to longitudes, to put a central meridian given as a west longitude in its place.
    double shift_deg_ = 0;
    double turn_columns_ = 0;  // columns in 360 deg; 0: not a grid of longitudes
    std::vector<double> x_, y_;
    std::vector<int> success_;

    [[noreturn]] void refuse(const std::string& what) const;
    void choose_latitudes(const OGRSpatialReference* reference, const MappedBody& body,
                          GroundRaster::Reading& reading);
    void find_projection(GDALDataset& file, const MappedBody& body, GroundRaster::Shape& shape,
                         GroundRaster::Reading& reading);
    void require_body(const OGRSpatialReference& reference, const MappedBody& body) const;
    void choose_longitudes(const OGRSpatialReference& reference, GroundRaster::Reading& reading);
    std::optional<Grid> grid_of(const OGRSpatialReference& reference, const double* to_ground);
    void find_turn(const Grid& grid, GroundRaster::Shape& shape);
    Contradiction contradiction(const Grid& grid, const GroundRaster::Shape& shape) const;
    void judge(const Grid& grid, const GroundRaster::Shape& shape, GroundRaster::Reading& reading) const;
};

}  // namespace hilcam
