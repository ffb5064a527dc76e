#pragma once
// Charge that spills or lags on its way out of a CCD.
//
// Blooming: charge above a pixel's full well spills into its neighbours in the column, half each way, until
// there is room. Transfer inefficiency: each of n transfers leaves a share c of a packet behind. C(n+k-1, k)
// c^k (1-c)^n of the packet arrives k pixels late (Janesick, Scientific Charge-Coupled Devices, SPIE, 2001,
// ch. 5); what would be later than three pixels arrives with the third. Both conserve charge. Not modelled:
// traps that fill up.

#include <array>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"

namespace hilcam {

struct CcdConfig {
    bool blooming = false;
    double parallel_inefficiency = 0;  // for each row transfer, towards row 0
    double serial_inefficiency = 0;    // for each column transfer, towards column 0
};
Fields fields(CcdConfig& config);

// Moves charge beyond the full well along its column. Loop; on oneTBB.
void bloom(ElectronImage& charge_e, float full_well_e);

// Delays charge. Row 0 and column 0 are nearest to the output.
class ChargeTransfer {
  public:
    // Makes tables for an array of that size. first_column, first_row: number of transfers from its first
    // pixel to the output. Owner thread.
    ChargeTransfer(const CcdConfig& config, int width, int height, int first_column = 0, int first_row = 0);
    // Loop; on oneTBB.
    void apply(ElectronImage& charge_e) const;

  private:
    static constexpr int kLate = 4;  // 0 .. 3 pixels late
    using Shares = std::array<float, kLate>;
    static std::vector<Shares> shares(double inefficiency, int first, int count);

    std::vector<Shares> parallel_, serial_;  // by column or row; empty: perfect transfer
};

}  // namespace hilcam
