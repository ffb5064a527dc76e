#pragma once
// Measures how much of the machine's memory this process holds: its resident set.

#include "io/system/fd.h"

namespace hilcam {

// Reading it allocates nothing.
class ResidentMemory {
  public:
    ResidentMemory();
    // [10^6 bytes]; 0 when the kernel does not tell.
    double megabytes() const;

  private:
    Fd statm_;
};

}  // namespace hilcam
