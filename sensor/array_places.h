#pragma once
// The position of read-out array pixels on the sensor. Random numbers of a pixel are keyed by that position,
// so that a window shows the same pixels as the whole sensor does. Black columns and rows have numbers beyond
// those of the light-sensitive ones.

#include <cstdint>

#include "sensor/camera_model.h"

namespace hilcam {

// Returns a pixel's key for random numbers. Neighbours in a row have consecutive keys.
inline std::uint32_t sensor_pixel(std::uint32_t column, std::uint32_t row) { return row << 15 | column; }

class ArrayPlaces {
  public:
    explicit ArrayPlaces(const CameraModel& c)
        : window_(window_of(c)),
          black_columns_(static_cast<int>(c.black_columns)),
          black_rows_(static_cast<int>(c.black_rows)) {}

    std::uint32_t column(int x) const {
        return static_cast<std::uint32_t>(x < black_columns_ ? kFirstBlack + x
                                                             : window_.left + x - black_columns_);
    }
    std::uint32_t row(int y) const {
        return static_cast<std::uint32_t>(y < black_rows_ ? kFirstBlack + y : window_.top + y - black_rows_);
    }
    bool black(int x, int y) const { return x < black_columns_ || y < black_rows_; }
    int black_columns() const { return black_columns_; }
    int black_rows() const { return black_rows_; }

  private:
    static constexpr int kFirstBlack = 16384;
    PixelRectangle window_;
    int black_columns_, black_rows_;
};

}  // namespace hilcam
