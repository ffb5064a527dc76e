#pragma once
// The truth of a frame as one line of JSON; docs/truth.md has every key with its frame and unit.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/contract/frame_sink.h"
#include "io/truth/ground_truth.h"
#include "render/frame/frame_truth.h"
#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"
#include "sensor/point_electrons.h"

namespace hilcam {

// Identifies a run.
struct RunLabel {
    std::string id;        // different in every run
    std::string scenario;  // its name
    std::int64_t seed = 0;
    std::string program;  // "hilcam 0.3.0"
};

// Facts that are the same for all frames of a run.
struct TruthSource {
    RunLabel run{};
    int camera = 1;  // number on the bench
    CameraModel model;
    int oversampling = 1;  // oversampling of the radiance image
    SpectralGrid grid{{0.4, 0.7}};
    std::vector<std::string> things;              // names of the objects, by number from 1
    std::vector<std::string> parts;               // names of the renderer's objects
    std::shared_ptr<const GroundTruth> ground{};  // finds craters and boulders; null: not wanted
};

class TruthDocument {
  public:
    explicit TruthDocument(const TruthSource& source)
        : source_(source), electrons_(source.model, source.grid) {}

    // Returns the first line of a file of lines, which identifies the run. Without a newline. Any thread.
    std::string header() const;
    // Returns a frame's line, without a newline. Values that are unknown or not finite are null. Any thread.
    std::string line(const FrameTruth& truth, const FrameRecord& record, bool with_stars = true) const;
    // Returns the names for the object layer's numbers that this frame can have: "1 target", "1000399 earth".
    std::vector<std::string> legend(const FrameTruth& truth) const;
    const TruthSource& source() const { return source_; }

  private:
    std::string name_of_thing(const SeenThing& thing) const;

    TruthSource source_;
    PointElectrons electrons_;
};

}  // namespace hilcam
