#pragma once
// Where the posts of a file that GDAL reads are on a body: its projection, or bounds in degrees that the scenario gives, with what GDAL does
// not hand on - the kind of latitudes, and longitudes that count to the west - from its label (map_label.h).

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
    // shape: has columns and rows, and gets what follows from the place. reading: gets what was taken and why. Throws InputError, which begins
    // with the map's name: there is no projection, it is of another body, or it puts posts beyond a pole.
    GdalPlacement(GDALDataset& file, const MapLabel& label, const GroundMapConfig& config,
                  const MappedBody& body, GroundRaster::Shape& shape, GroundRaster::Reading& reading);

    // See GroundRaster::find_posts().
    void find_posts(std::span<const Vec3d> places, const GroundRaster::Shape& shape, std::span<Vec2d> posts);

  private:
    struct DestroyTransformation {
        void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
    };
    // A map whose columns are meridians and whose rows are parallels, in degrees east and north.
    struct Grid {
        double west_deg, north_deg, column_deg, row_deg;
    };

    // Tells how far a map is from its label's own bounds, as "1 post north", and these as the key has them; both empty: it is not, or cannot be told.
    struct Contradiction {
        std::string off, bounds;
    };

    const GroundMapConfig& config_;
    const MapLabel& label_;
    std::optional<MapBounds> bounds_;
    std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation>
        projection_;  // null: longitudes, latitudes
    double from_ground_[6] = {};
    double factor_ = 1;        // see latitude_factor()
    double sign_ = 1;          // -1: longitudes of degrees count to the west
    double shift_deg_ = 0;     // is added to longitudes, so that a middle of west longitude is at its place
    double turn_columns_ = 0;  // columns of 360 deg; 0: no such thing
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
