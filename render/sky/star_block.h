#pragma once
// Some stars whose apparent directions are worked out together, in vectors: StarObserver::apparent_dir() of
// each, to the last bit. Inside a frame nothing is allocated.

#include <array>
#include <cstddef>

#include "render/sky/stars.h"

namespace hilcam {

class StarBlock {
  public:
    static constexpr std::size_t kMax = 64;

    bool full() const { return count_ == kMax; }
    // There is room for it. The star outlives the block.
    void add(const Star& star) { stars_[count_++] = &star; }

    // Calls use(star, apparent direction) for each, in the order of adding, and is empty then. Loop.
    template <class Use>
    void use_all(const StarObserver& observer, const Use& use) {
        find_dirs(observer);
        for (std::size_t i = 0; i < count_; ++i) use(*stars_[i], Vec3d{x_[i], y_[i], z_[i]});
        count_ = 0;
    }

  private:
    std::size_t count_ = 0;
    std::array<const Star*, kMax> stars_;
    alignas(64) std::array<double, kMax> x_, y_, z_;  // apparent directions; unit, ICRF

    void find_dirs(const StarObserver& observer);
};

}  // namespace hilcam
