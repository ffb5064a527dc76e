#pragma once
// How charge packets spill and smear on their way out of a CCD.
//
// Blooming: what a full pixel cannot hold goes to its neighbours in the column, half each way, until there is
// room. Transfer inefficiency: each of n transfers leaves a share c of a packet behind; k pixels late arrives
// C(n+k-1, k) c^k (1-c)^n of it (Janesick, Scientific Charge-Coupled Devices, SPIE, 2001, ch. 5), the rest
// after three pixels with the third. Charge is conserved by both. Not modelled: traps that fill up.

#include "render/config_field.h"

namespace hilcam {

struct CcdConfig {
    bool blooming = false;
    double parallel_inefficiency = 0;  // per row transfer, towards row 0
    double serial_inefficiency = 0;    // per column transfer, towards column 0
};
Fields fields(CcdConfig& config);

}  // namespace hilcam
