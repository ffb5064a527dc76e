#pragma once
// What libraries print to standard error, kept so that it can be a part of a message: the decoders of
// pictures (libpng, libtiff) know why a file does not decode, but tell only the terminal. OpenCV, which says
// only that it has not decoded, is silent from the first one on.
//
// It is the whole process's standard error while one of these lives: for start-up, while nothing else runs.
// Only one at a time. Where there is no memory for it, nothing is kept and all is printed as ever.

#include <string>

#include "io/system/fd.h"

namespace hilcam {

class KeptStderr {
  public:
    KeptStderr();
    ~KeptStderr();

    // Returns the first line so far, shortened and harmless; empty: there is none.
    std::string first_line() const;

  private:
    Fd kept_, terminal_;
};

}  // namespace hilcam
