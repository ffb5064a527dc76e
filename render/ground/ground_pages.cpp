#include "render/ground/ground_pages.h"

#include <algorithm>

namespace hilcam {

const float* GroundPages::post(GroundRaster& raster, std::uint32_t key, int level, int column, int row) {
    const int page_column = column / kPage, page_row = row / kPage;
    // Levels are below 32, and a raster has fewer than 2^25 pages along an edge.
    const std::uint64_t word = (std::uint64_t{key} << 55) | (static_cast<std::uint64_t>(level) << 50) |
                               (static_cast<std::uint64_t>(page_row) << 25) |
                               static_cast<std::uint64_t>(page_column);
    if (pages_.empty() || pages_.front().key != word) page(raster, word, level, page_column, page_row);
    const Page& at = pages_.front();
    const std::size_t index = static_cast<std::size_t>(row % kPage) * static_cast<std::size_t>(at.columns) +
                              static_cast<std::size_t>(column % kPage);
    return at.values.data() + index * static_cast<std::size_t>(raster.shape().channels);
}

GroundPages::Page& GroundPages::page(GroundRaster& raster, std::uint64_t key, int level, int page_column,
                                     int page_row) {
    if (const auto found = found_.find(key); found != found_.end()) {
        pages_.splice(pages_.begin(), pages_, found->second);
        return pages_.front();
    }
    const GroundRaster::Shape& shape = raster.shape();
    const int columns = std::min(kPage, (shape.columns >> level) - page_column * kPage);
    const int rows = std::min(kPage, (shape.rows >> level) - page_row * kPage);
    const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                              static_cast<std::size_t>(shape.channels);
    while (!pages_.empty() && bytes_ + count * sizeof(float) > max_bytes_) {
        bytes_ -= pages_.back().values.size() * sizeof(float);
        found_.erase(pages_.back().key);
        pages_.pop_back();
    }
    pages_.push_front({key, columns, std::vector<float>(count)});
    found_[key] = pages_.begin();
    bytes_ += count * sizeof(float);
    ++reads_;
    raster.read(level, page_column * kPage, page_row * kPage, columns, rows, pages_.front().values);
    return pages_.front();
}

}  // namespace hilcam
