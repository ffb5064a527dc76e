#pragma once
// Collects what truth needs to know about a scenario: its names, and which object each of the renderer's
// objects belongs to.

#include <cstddef>
#include <memory>

#include "emulator/scenario/app_config.h"
#include "io/truth/sink_truth.h"
#include "io/truth/truth_document.h"
#include "render/frame/renderer.h"

namespace hilcam {

// run_id: unique name of the run; empty: not of a run. number: number of the scenario's camera, from 1.
TruthSource truth_source(const ScenarioConfig& scenario, const SpectralGrid& grid, std::size_t number,
                         const std::string& run_id);
// Returns the request in outputs.truth, or the default when that is missing.
TruthRequest truth_request(const ScenarioConfig& scenario);
// Makes a record for any frame of the camera. Owner thread.
FrameTruth make_truth(const ScenarioConfig& scenario, const Renderer& renderer, const TruthRequest& request);

// Makes the output outputs.truth, or a sink that only serves a listener. The scenario's scene must be loaded.
// Throws InputError.
std::unique_ptr<TruthSink> make_truth_sink(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                           std::size_t number, const Renderer& renderer,
                                           const std::string& run_id = {},
                                           const TruthSurroundings& surroundings = {});

}  // namespace hilcam
