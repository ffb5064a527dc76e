#pragma once
// One layer of the Earth (EarthLayerConfig) as a raster on any grid of longitude and latitude.

#include <memory>
#include <string>
#include <vector>

#include "io/maps/ground_map_file.h"
#include "render/earth/earth_config.h"

namespace hilcam {

// Cells of a grid that goes once around from 180 W and from 90 N to 90 S, so many to a turn and from pole to pole.
struct LayerGrid {
    double columns, rows;
};
struct LayerWindow {
    int column, row, columns, rows;  // columns beyond the grid's wrap around, rows are held
};

// Returns the map that a layer's file is: coding, scale and offset stay with the layer, as they count for all formats alike.
GroundMapConfig map_of_layer(const EarthLayerConfig& layer);
// The body that layers lie on.
const MappedBody& earth_body();

class EarthLayerRaster {
  public:
    // Throws InputError, one line that names the key and the file: it is missing, of no known format, projection or size, not of the
    // whole Earth, of another number of channels.
    explicit EarthLayerRaster(const EarthLayerConfig& config);
    // The same of a file that is open, by the map that map_of_layer() makes of the layer.
    EarthLayerRaster(const EarthLayerConfig& config, std::unique_ptr<GroundRaster> raster);

    const EarthLayerConfig& config() const { return config_; }
    int columns() const { return raster_->shape().columns; }
    int rows() const { return raster_->shape().rows; }
    int channels() const { return raster_->shape().channels; }
    bool has_failed() const { return raster_->failed_reads() > 0; }
    // Returns how messages begin: the key's place and the file.
    std::string name() const;
    // Reads the values at the middles of cells, by row, channels together: after coding, scale and offset, NaN for holes. Between
    // the file's posts they are bilinear; a coarser grid sees means. False: something cannot be read, which is a hole. One thread at a
    // time.
    bool read(const LayerGrid& grid, const LayerWindow& window, std::vector<float>& values);

  private:
    EarthLayerConfig config_;
    std::unique_ptr<GroundRaster> raster_;
    double first_column_ = 0;  // where 180 W is, from the outer edge of the first column
    std::vector<float> posts_, part_;

    [[noreturn]] void refuse(const std::string& what) const;
    void require_whole_earth() const;
    void read_posts(int level, const LayerWindow& window);
    float decoded(float raw) const;
};

}  // namespace hilcam
