#pragma once
// Caches pages of maps in bounded memory, and drops the least recently used ones.

#include <cstdint>
#include <list>
#include <memory>
#include <unordered_map>
#include <vector>

#include "render/ground/ground_raster.h"

namespace hilcam {

// One thread at a time.
class GroundPages {
  public:
    static constexpr int kPage = 64;  // posts along the edge of a page

    explicit GroundPages(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    // Returns the values of a post of a raster at a level; valid until the next call. key: a number unique to
    // the raster.
    const float* post(GroundRaster& raster, std::uint32_t key, int level, int column, int row);

    std::size_t bytes() const { return bytes_; }
    std::uint64_t reads() const { return reads_; }  // number of pages read so far

  private:
    struct Page {
        std::uint64_t key;
        int columns;
        std::vector<float> values;
    };
    std::size_t max_bytes_, bytes_ = 0;
    std::uint64_t reads_ = 0;
    std::list<Page> pages_;  // most recently used first
    std::unordered_map<std::uint64_t, std::list<Page>::iterator> found_;

    Page& page(GroundRaster& raster, std::uint64_t key, int level, int page_column, int page_row);
};

}  // namespace hilcam
