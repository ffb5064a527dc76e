#pragma once
// A block of stars whose apparent directions are computed together, in vectors, with the same result as
// StarObserver::apparent_dir() to the last bit. No allocation in a frame.

#include <array>
#include <cstddef>

#include "render/sky/stars.h"

namespace hilcam {

class StarBlock {
  public:
    static constexpr std::size_t kMax = 64;

    bool full() const { return count_ == kMax; }
    // Adds a star; the block must not be full, and the star must outlive it.
    void add(const Star& star) { stars_[count_++] = &star; }

    // Calls use(star, apparent direction) for each star in the order of adding, and empties the block. Loop.
    template <class Use>
    void use_all(const StarObserver& observer, const Use& use) {
        find_dirs(observer);
        for (std::size_t i = 0; i < count_; ++i) use(*stars_[i], Vec3d{x_[i], y_[i], z_[i]});
        count_ = 0;
    }

  private:
    std::size_t count_ = 0;
    std::array<const Star*, kMax> stars_;
    alignas(64) std::array<double, kMax> x_, y_, z_;  // apparent directions, unit, ICRF

    void find_dirs(const StarObserver& observer);
};

}  // namespace hilcam
