#pragma once
// The run as it is now, in JSON: what the preview's page shows (docs/preview.md). A report is of a whole run
// (report.h), this is of an instant.

#include <memory>
#include <string>
#include <vector>

#include "emulator/loop/frame_loop.h"
#include "emulator/scenario/app_config.h"
#include "io/contract/command_receiver.h"
#include "io/contract/fault.h"

namespace hilcam {

class LightMaker;

// A camera of the bench as a page of another one names it.
struct CameraPage {
    std::string name;
    std::int64_t port = 0;  // port of its preview; 0: it has none
};

struct StatusSources {
    const ScenarioConfig& scenario;          // the scenario of the camera
    std::size_t number;                      // number of the camera, from 1
    const std::vector<CameraPage>& cameras;  // by number
    const FrameLoop& loop;
    const DeliveryMeter& delivery;
    const std::vector<std::unique_ptr<CommandReceiver>>& receivers;
    std::vector<FrameSink*> sinks;
    const CameraControl& camera;
    const FaultBoard& faults;
    const LightMaker* light;  // null: nothing is made beside the run
};
// Any thread but the loop.
std::string run_status(const StatusSources& sources);

}  // namespace hilcam
