#pragma once
// Something that knows better than the program's own series where the Sun and bodies are and how they are turned: SPICE's
// kernels (emulator/motion/spice_sky.h).

#include <optional>

#include "render/sky/bodies.h"

namespace hilcam {

// All states are geometric, ICRF axes [m, m/s]. None: it does not know, and the series counts. Loop, any thread: no
// allocation, no lock.
class BodySource {
  public:
    virtual ~BodySource() = default;
    virtual std::optional<StateVector> from_sun(BodyId id, TimeTai time) const = 0;
    virtual std::optional<StateVector> sun_from_barycenter(TimeTai time) const = 0;
    virtual std::optional<Mat3d> fixed_from_icrf(BodyId id, TimeTai time) const = 0;
    // The thing that an origin of kind spice belongs to; where it is not known, it stands as at the nearest instant.
    virtual StateVector origin_from_sun(TimeTai time) const = 0;
};

}  // namespace hilcam
