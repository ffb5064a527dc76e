#pragma once
// Tells the filter over each pixel of the window, from the colour filter array's pattern, which begins at the
// sensor's corner.

#include <vector>

#include "sensor/camera_model.h"

namespace hilcam {

class Mosaic {
  public:
    explicit Mosaic(const CameraModel& c) : left_(window_of(c).left), top_(window_of(c).top) {
        const ColorFilterArrayConfig& array = c.color_filter;
        std::vector<int> row;
        for (const char letter : array.pattern + ' ') {
            if (letter != ' ') {
                for (std::size_t i = 0; i < array.filters.size(); ++i)
                    if (array.filters[i].name[0] == letter) row.push_back(static_cast<int>(i));
            } else if (!row.empty()) {
                rows_.push_back(std::move(row));
                row.clear();
            }
        }
    }

    bool one_color() const { return rows_.empty(); }
    // Returns the number of the filter. x, y: in the window, or up to four patterns to its left and above.
    int channel(int x, int y) const {
        if (rows_.empty()) return 0;
        const auto& row = rows_[(static_cast<std::size_t>(y + top_) + 4 * rows_.size()) % rows_.size()];
        return row[(static_cast<std::size_t>(x + left_) + 4 * row.size()) % row.size()];
    }
    // Returns the number of columns after which a row's pattern repeats.
    int period(int y) const {
        if (rows_.empty()) return 1;
        return static_cast<int>(rows_[static_cast<std::size_t>(y + top_) % rows_.size()].size());
    }

  private:
    int left_, top_;
    std::vector<std::vector<int>> rows_;
};

}  // namespace hilcam
