// hilcam-read-map: reads one map with GDAL for hilcam, which starts it (io/maps/map_helper.h). Not useful by
// hand.

#include <fcntl.h>

#include <cstdio>

#include "io/maps/map_service.h"
#include "io/system/helper_process.h"

int main() {
    if (fcntl(hilcam::kHelperSocket, F_GETFD) < 0 || fcntl(hilcam::kHelperMemory, F_GETFD) < 0) {
        std::fputs("hilcam-read-map: it is started by hilcam, which reads maps by it\n", stderr);
        return 2;
    }
    hilcam::serve_map(hilcam::kHelperSocket, hilcam::kHelperMemory);
}
