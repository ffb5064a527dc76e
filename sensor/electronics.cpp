#include "sensor/electronics.h"

namespace hilcam {

Fields fields(FilterConfig& c) {
    return {
        number("low_pass_cy_px", c.low_pass_cy_px, 1, {0, 100}, "-3 dB frequency along a row; 0: none"),
        number("high_pass_cy_px", c.high_pass_cy_px, 1, {0, 0.5}, "-3 dB frequency along a row; 0: none"),
        number("boost", c.boost, 1, {0, 4}, "b: gain 1 + b (1 - cos 2 pi f) along a row"),
    };
}

Fields fields(ConverterConfig& c) {
    return {
        number("inl_lsb", c.inl_lsb, 1, {0, 64}, "integral nonlinearity: greatest deviation at mid-scale"),
        number("dnl_lsb", c.dnl_lsb, 1, {0, 0.3}, "differential nonlinearity, standard deviation"),
        choice("companding", c.companding, {"none", "square_root"}, "to 8 bits"),
    };
}

}  // namespace hilcam
