#pragma once
// SPICE's time: TDB seconds since J2000 ("ET"), as NAIF's leap-second kernels define it.
//
// ET - TAI = DELTA_T_A + K sin E, E = M + EB sin M, M = M0 + M1 t: NAIF, "Time Required Reading", section
// "Leapseconds Kernels". It agrees with the IAU's TDB (render/vocabulary/time_system.h) to 30 us. Kernels are
// read with this definition because their times, clocks and attitudes were made with it.

#include "io/spice/kernel_pool.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {

struct EphemerisTime {
    // The values in every leap-second kernel so far, naif0001.tls to naif0012.tls.
    double delta_t_a_s = 32.184, k_s = 1.657e-3, eb = 1.671e-2;
    double m0_rad = 6.239996, m1_rad_s = 1.99096871e-7;

    // Convert to a double's rounding, 1e-7 s in this century. Loop, both.
    double et_s(TimeTai time) const;
    TimeTai tai(double et_s) const;
    // Returns TT seconds since J2000, which SCLK kernels call TDT.
    double tt_s(double et_s) const;
};

// Returns the constants of the pool's leap-second kernel, or those above when there is none. Throws
// InputError.
EphemerisTime ephemeris_time(const KernelPool& pool);
// Returns the kernel's leap seconds; empty when there is no such kernel. Throws InputError.
std::vector<LeapSecond> leap_seconds_of(const KernelPool& pool);

}  // namespace hilcam
