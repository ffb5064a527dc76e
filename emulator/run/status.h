#pragma once
// The present state of the run as JSON, for the preview's page (docs/preview.md). A report (report.h) covers
// a whole run; this covers an instant.

#include <memory>
#include <string>
#include <vector>

#include "emulator/loop/delivery_meter.h"
#include "emulator/loop/frame_loop.h"
#include "emulator/scenario/app_config.h"
#include "io/contract/command_receiver.h"
#include "io/contract/fault.h"

namespace hilcam {

class LightMaker;

// A camera as the page of another camera refers to it.
struct CameraPage {
    std::string name;
    std::int64_t port = 0;  // port of its preview; 0: none
};

struct StatusSources {
    const ScenarioConfig& scenario;          // scenario as the camera has it
    std::size_t number;                      // number of the camera, from 1
    const std::vector<CameraPage>& cameras;  // by number
    const FrameLoop& loop;
    const DeliveryMeter& delivery;
    const std::vector<std::unique_ptr<CommandReceiver>>& receivers;
    std::vector<FrameSink*> sinks;
    const CameraControl& camera;
    const FaultBoard& faults;
    const LightMaker* light;  // null: no tables are made during the run
};
// Any thread except the loop's.
std::string run_status(const StatusSources& sources);

}  // namespace hilcam
