#pragma once
// Measures the resident set of this process.

#include "io/system/fd.h"

namespace hilcam {

// Reading allocates nothing.
class ResidentMemory {
  public:
    ResidentMemory();
    // Returns the resident set [10^6 bytes]; 0 when the kernel does not say.
    double megabytes() const;

  private:
    Fd statm_;
};

}  // namespace hilcam
