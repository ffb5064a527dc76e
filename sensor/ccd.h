#pragma once
// Charge packets spill and smear on their way out of a CCD.
//
// Blooming: what a full pixel cannot hold goes to its neighbours in the column, half each way, until there is
// room. Transfer inefficiency: each of n transfers leaves a share c of a packet behind; k pixels late arrives
// C(n+k-1, k) c^k (1-c)^n of it (Janesick, Scientific Charge-Coupled Devices, SPIE, 2001, ch. 5), the rest
// after three pixels with the third. Charge is conserved by both. Not modelled: traps that fill up.

#include <array>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"

namespace hilcam {

struct CcdConfig {
    bool blooming = false;
    double parallel_inefficiency = 0;  // per row transfer, towards row 0
    double serial_inefficiency = 0;    // per column transfer, towards column 0
};
Fields fields(CcdConfig& config);

// Charge beyond the full well moves along its column. Loop; on oneTBB.
void bloom(ElectronImage& charge_e, float full_well_e);

// Charge arrives late. Row 0 and column 0 are nearest to the output.
class ChargeTransfer {
  public:
    // Tables for an array of that size, whose first pixel is so many transfers from the output. Owner thread.
    ChargeTransfer(const CcdConfig& config, int width, int height, int first_column = 0, int first_row = 0);
    // Loop; on oneTBB.
    void apply(ElectronImage& charge_e) const;

  private:
    static constexpr int kLate = 4;  // 0 .. 3 pixels late
    using Shares = std::array<float, kLate>;
    static std::vector<Shares> shares(double inefficiency, int first, int count);

    std::vector<Shares> parallel_, serial_;  // by place; empty: perfect
};

}  // namespace hilcam
