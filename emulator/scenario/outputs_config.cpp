#include "emulator/scenario/outputs_config.h"

namespace hilcam {

Fields fields(OutputsConfig& o) {
    return {
        optional(section("gige", o.gige, "frames sent as a GigE Vision camera"), o.has_gige),
        optional(section("v4l2", o.v4l2, "frames fed to a v4l2loopback device"), o.has_v4l2),
        optional(section("uvc", o.uvc, "frames sent as a USB camera, with a USB device controller"),
                 o.has_uvc),
        optional(section("files", o.files, "frames written as pictures"), o.has_files),
        optional(section("preview", o.preview, "web page with the live picture"), o.has_preview),
        optional(section("truth", o.truth, "truth about each frame, known by the renderer (docs/truth.md)"),
                 o.has_truth),
    };
}

}  // namespace hilcam
