#include "emulator/run/truth_source.h"

#include "emulator/recording/program_version.h"
#include "emulator/run/ground_footprint.h"

namespace hilcam {

// The renderer's objects are the scenario's, then all their parts on joints, then the terrain
// (scene_loader.cpp).
TruthSource truth_source(const ScenarioConfig& s, const SpectralGrid& grid, std::size_t number,
                         const std::string& run_id) {
    TruthSource source;
    source.run = {run_id, s.name, s.seed, std::string(kProgramVersion)};
    source.camera = static_cast<int>(number);
    source.model = s.camera;
    source.oversampling = static_cast<int>(s.quality.oversampling);
    source.grid = grid;
    for (const ObjectConfig& object : s.objects) source.things.push_back(object.name);
    source.parts = source.things;
    for (const ObjectConfig& object : s.objects)
        for (const JointConfig& joint : object.joints) source.parts.push_back(object.name + "/" + joint.node);
    source.ground = ground_truth_of(s);
    if (s.terrain) {
        source.things.push_back(s.terrain->name);
        source.parts.push_back(s.terrain->name);
    }
    return source;
}

TruthRequest truth_request(const ScenarioConfig& s) {
    TruthRequest request = request_of(s.outputs.config<TruthConfig>());
    const auto objects = static_cast<std::uint32_t>(s.objects.size());
    for (std::uint32_t i = 0; i < objects; ++i) request.thing_of_object.push_back(i);
    for (std::uint32_t i = 0; i < objects; ++i)
        request.thing_of_object.insert(request.thing_of_object.end(), s.objects[i].joints.size(), i);
    if (s.terrain) request.thing_of_object.push_back(objects);
    return request;
}

FrameTruth make_truth(const ScenarioConfig& s, const Renderer& renderer, const TruthRequest& request) {
    const auto [width, height] = array_size(s.camera);  // largest size of a frame
    return renderer.make_truth(request, width, height);
}

std::unique_ptr<TruthSink> make_truth_sink(const ScenarioConfig& s, const SpectralGrid& grid,
                                           std::size_t number, const Renderer& renderer,
                                           const std::string& run_id, const TruthSurroundings& surroundings) {
    return std::make_unique<TruthSink>(
        s.outputs.config<TruthConfig>(), truth_source(s, grid, number, run_id),
        [&] { return make_truth(s, renderer, truth_request(s)); }, surroundings);
}

}  // namespace hilcam
