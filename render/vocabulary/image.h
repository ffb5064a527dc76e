#pragma once
// Images. Each physical quantity has its own type, so a stage cannot be given the wrong one. Rows run
// downwards (+y), columns to the right (+x); the centre of pixel (0, 0) is at (0.5, 0.5).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {

// A stack of `planes` images of one size in one block of memory, aligned to 64 bytes. Rows are contiguous.
template <class T, class Quantity>
class Image {
  public:
    Image() = default;
    Image(int width, int height, int planes = 1)
        : width_(width),
          height_(height),
          planes_(planes),
          capacity_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
          data_(static_cast<T*>(
              ::operator new[](static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                   static_cast<std::size_t>(planes) * sizeof(T),
                               std::align_val_t{64}))) {
        HILCAM_CHECK(width > 0 && height > 0 && planes > 0);
        for (T& value : all()) value = T{};
    }

    // Changes the shape within the same memory, which must be large enough. Pixel values are undefined
    // afterwards. Loop.
    void reshape(int width, int height) {
        HILCAM_CHECK(width > 0 && height > 0 &&
                     static_cast<std::size_t>(width) * static_cast<std::size_t>(height) <= capacity_);
        width_ = width, height_ = height;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int planes() const { return planes_; }
    std::size_t pixels() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    std::span<T> all() { return {data(), pixels() * static_cast<std::size_t>(planes_)}; }
    std::span<const T> all() const { return {data(), pixels() * static_cast<std::size_t>(planes_)}; }
    std::span<T> plane(int p) { return all().subspan(static_cast<std::size_t>(p) * pixels(), pixels()); }
    std::span<const T> plane(int p) const {
        return all().subspan(static_cast<std::size_t>(p) * pixels(), pixels());
    }
    std::span<T> row(int y, int p = 0) {
        return plane(p).subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_),
                                static_cast<std::size_t>(width_));
    }
    std::span<const T> row(int y, int p = 0) const {
        return plane(p).subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_),
                                static_cast<std::size_t>(width_));
    }

  private:
    struct Release {
        void operator()(T* block) const { ::operator delete[](block, std::align_val_t{64}); }
    };
    int width_ = 0;
    int height_ = 0;
    int planes_ = 0;
    std::size_t capacity_ = 0;  // pixels of a plane
    std::unique_ptr<T[], Release> data_;
};

// Charge collected in one exposure [e-].
using ElectronImage = Image<float, struct ElectronQuantity>;
// Digital numbers, right-aligned (a 12-bit camera uses 0..4095).
using DnImage = Image<std::uint16_t, struct DnQuantity>;

}  // namespace hilcam
