#pragma once
// The section `outputs`: where frames go.

#include "io/files/sink_files.h"
#include "io/gige/sink_gige.h"
#include "io/preview/sink_preview.h"
#include "io/truth/truth_config.h"
#include "io/uvc/sink_uvc.h"
#include "io/v4l2/sink_v4l2.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct OutputsConfig {
    bool has_gige = false, has_v4l2 = false, has_uvc = false, has_files = false, has_preview = false,
         has_truth = false;
    GigeConfig gige;
    V4l2Config v4l2;
    UvcConfig uvc;
    FilesConfig files;
    PreviewConfig preview;
    TruthConfig truth;
};
Fields fields(OutputsConfig& outputs);

}  // namespace hilcam
