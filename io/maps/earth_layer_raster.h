#pragma once
// Reads one layer of the Earth (EarthLayerConfig) on any grid of longitude and latitude.

#include <memory>
#include <string>
#include <vector>

#include "io/maps/ground_map_file.h"
#include "render/earth/earth_config.h"

namespace hilcam {

// A grid over the whole Earth: `columns` cells from 180 W once around, `rows` cells from 90 N to 90 S.
struct LayerGrid {
    double columns, rows;
};
struct LayerWindow {
    int column, row, columns, rows;  // columns beyond the grid wrap around, rows are clamped
};

// Returns the map config of a layer's file. Coding, scale and offset stay with the layer, because they apply
// to all formats alike.
GroundMapConfig map_of_layer(const EarthLayerConfig& layer);
// Returns the body that layers cover.
const MappedBody& earth_body();

class EarthLayerRaster {
  public:
    // Throws InputError, one line that names the key and the file, when the file is missing, has no known
    // format, projection or size, does not cover the whole Earth, or has another number of channels.
    explicit EarthLayerRaster(const EarthLayerConfig& config);
    // Uses an open file, which was opened with map_of_layer().
    EarthLayerRaster(const EarthLayerConfig& config, std::unique_ptr<GroundRaster> raster);

    const EarthLayerConfig& config() const { return config_; }
    int columns() const { return raster_->shape().columns; }
    int rows() const { return raster_->shape().rows; }
    int channels() const { return raster_->shape().channels; }
    bool has_failed() const { return raster_->failed_reads() > 0; }
    // Returns the beginning of messages: the key's place and the file.
    std::string name() const;
    // Reads the values at the centres of cells, row by row, the channels of a cell together, after coding,
    // scale and offset; NaN for holes. They are bilinear between the file's posts, and means where the grid
    // is coarser. Returns false when something cannot be read, which counts as a hole. One thread at a time.
    bool read(const LayerGrid& grid, const LayerWindow& window, std::vector<float>& values);

  private:
    EarthLayerConfig config_;
    std::unique_ptr<GroundRaster> raster_;
    double first_column_ = 0;  // column of 180 W, counted from the outer edge of the first column
    std::vector<float> posts_, part_;

    [[noreturn]] void refuse(const std::string& what) const;
    void require_whole_earth() const;
    void read_posts(int level, const LayerWindow& window);
    float decoded(float raw) const;
};

}  // namespace hilcam
