#pragma once
// Finds what truth needs to know of a scenario: whose it is, and of which object each of the renderer's is a
// part.

#include <cstddef>
#include <memory>

#include "emulator/scenario/app_config.h"
#include "io/truth/sink_truth.h"
#include "io/truth/truth_document.h"
#include "render/frame/renderer.h"

namespace hilcam {

// run_id: no other run's; empty: of none. number: of the camera that the scenario is about, from 1.
TruthSource truth_source(const ScenarioConfig& scenario, const SpectralGrid& grid, std::size_t number,
                         const std::string& run_id);
// Returns the request of outputs.truth, whether or not it is given.
TruthRequest truth_request(const ScenarioConfig& scenario);
// A record for any frame of the camera. Owner thread.
FrameTruth make_truth(const ScenarioConfig& scenario, const Renderer& renderer, const TruthRequest& request);

// The output outputs.truth, or what serves the listener alone; what the scenario is about is loaded. Throws
// InputError.
std::unique_ptr<TruthSink> make_truth_sink(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                           std::size_t number, const Renderer& renderer,
                                           const std::string& run_id = {},
                                           const TruthSurroundings& surroundings = {});

}  // namespace hilcam
