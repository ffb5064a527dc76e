#include "sensor/ccd.h"

namespace hilcam {

Fields fields(CcdConfig& c) {
    return {
        flag("blooming", c.blooming, "a full pixel spills into its column; false: it drains"),
        number("parallel_inefficiency", c.parallel_inefficiency, 1, {0, 1e-2}, "per row transfer"),
        number("serial_inefficiency", c.serial_inefficiency, 1, {0, 1e-2}, "per column transfer"),
    };
}

}  // namespace hilcam
