#pragma once
// A source of positions and attitudes of the Sun and bodies that replaces the program's own series: SPICE
// kernels (emulator/motion/spice_sky.h).

#include <optional>

#include "render/sky/bodies.h"

namespace hilcam {

// All states are geometric, ICRF axes [m, m/s]. None: the source has no data, and the series is used. Loop,
// any thread: no allocation, no lock.
class BodySource {
  public:
    virtual ~BodySource() = default;
    virtual std::optional<StateVector> from_sun(BodyId id, TimeTai time) const = 0;
    virtual std::optional<StateVector> sun_from_barycenter(TimeTai time) const = 0;
    virtual std::optional<Mat3d> fixed_from_icrf(BodyId id, TimeTai time) const = 0;
    // Returns the state of the object that an origin of kind spice belongs to; where it is not known, that of
    // the nearest instant.
    virtual StateVector origin_from_sun(TimeTai time) const = 0;
};

}  // namespace hilcam
