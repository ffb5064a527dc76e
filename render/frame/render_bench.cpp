#include "render/frame/render_bench.h"

#include <algorithm>

#include "render/vocabulary/median.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

PathModelSpeed speed_of(const std::string& name, FrameSetup& setup, FrameTracer& tracer,
                        RadianceImage& radiance, int runs) {
    std::vector<double> frame_ms;
    // The first round warms the caches, the last one is recorded.
    for (int run = 0; run < runs + 2; ++run) {
        if (run == runs + 1) setup.embree().start_recording();
        const Stopwatch watch;
        tracer.trace(setup, radiance);
        if (run > 0 && run <= runs) frame_ms.push_back(watch.ms());
    }
    const EmbreeScene::Replay replay = setup.embree().replay();
    return {name, replay.rays, median(frame_ms), replay.milliseconds};
}

}  // namespace

double bare_rays_ms(FrameSetup& setup, FrameTracer& tracer) {
    const FrameContext& frame = setup.frame();
    RadianceImage radiance(frame.geometry.padded_width(), frame.geometry.padded_height(), frame.bins);
    setup.embree().start_recording();
    tracer.trace(setup, radiance);
    return setup.embree().replay(EmbreeScene::Replayed::kPrimaryAndShadow).milliseconds;
}

std::vector<PathModelSpeed> path_model_speeds(FrameSetup& setup, FrameTracer& tracer, const Modules& modules,
                                              int runs) {
    const FrameContext& frame = setup.frame();
    RadianceImage radiance(frame.geometry.padded_width(), frame.geometry.padded_height(), frame.bins);
    std::vector<PathModelSpeed> speeds;
    for (const std::string& name : modules.paths.list()) {
        FrameTracer::Paths paths = FrameTracer::make_paths(modules, name);
        setup.set_paths(*paths.front());
        tracer.exchange_paths(paths);
        speeds.push_back(speed_of(name, setup, tracer, radiance, runs));
        tracer.exchange_paths(paths);
    }
    setup.set_paths(tracer.paths(0));
    return speeds;
}

}  // namespace hilcam
