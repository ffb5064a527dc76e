# Writes the commit of the source tree into OUT, a C++ source, when that changes; run in each build:
#   cmake -DSOURCE=... -DOUT=... -P write_commit.cmake
set(commit "no commit: not built in a git clone")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
    execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --tags --abbrev=12
        OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(NOT failed)
        set(commit "${described}")
    endif()
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [=[
#include "emulator/commit.h"

namespace hilcam {

const char* program_commit() { return "@commit@"; }

}  // namespace hilcam
]=])
