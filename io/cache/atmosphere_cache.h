#pragma once
// Keeps tables of an atmosphere on disk, because making them takes seconds.

#include "io/cache/cache.h"
#include "render/sky/atmosphere.h"

namespace hilcam {

class AtmosphereCache final : public AtmosphereStore {
  public:
    explicit AtmosphereCache(Cache cache) : cache_(std::move(cache)) {}
    bool find(std::span<const double> key, std::span<float> values) const override;
    void keep(std::span<const double> key, std::span<const float> values) const override;

  private:
    Cache cache_;
};

}  // namespace hilcam
