#pragma once
// The list of outputs for a camera's frames. A new output adds its header here and its configuration at the
// end of the list.
//
// An output is a FrameSink (io/contract/frame_sink.h) and its configuration, which provides everything that
// is needed here: kKey and kMeaning; fields(), and validate() if keys depend on each other; make_sink(config,
// context, shape). Where they apply, also: kFixedSize, when frames cannot change size during a run; kLive
// or is_live(config), when it hands frames to clients as they are made, which must not wait for a disk;
// listening(config), the ports it listens on; run_folder(config), a folder that it fills. docs/extending.md
// shows how to add one.

#include <tuple>

#include "io/contract/output_shape.h"
#include "io/contract/run_folder.h"
#include "io/files/sink_files.h"
#include "io/gige/sink_gige.h"
#include "io/packets/sink_packets.h"
#include "io/preview/sink_preview.h"
#include "io/shm/sink_shm.h"
#include "io/truth/truth_config.h"
#include "io/uvc/sink_uvc.h"
#include "io/v4l2/sink_v4l2.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// The outputs that a scenario gives a camera.
template <class... Configs>
class OutputList {
  public:
    // Returns null when the scenario does not give this output.
    template <class Config>
    const Config* find() const {
        const Given<Config>& output = std::get<Given<Config>>(all_);
        return output.given ? &output.config : nullptr;
    }
    // Returns the configuration, or its defaults when the scenario does not give this output.
    template <class Config>
    const Config& config() const {
        return std::get<Given<Config>>(all_).config;
    }
    template <class Config>
    void give(bool given = true) {
        std::get<Given<Config>>(all_).given = given;
    }

    // Calls visit(config) for every output that the scenario gives.
    template <class Visit>
    void for_each_given(const Visit& visit) const {
        (visit_given(std::get<Given<Configs>>(all_), visit), ...);
    }
    // Calls visit(config, given) for every output in the list.
    template <class Visit>
    void for_each(const Visit& visit) {
        (visit(std::get<Given<Configs>>(all_).config, std::get<Given<Configs>>(all_).given), ...);
    }
    // True when ask(config) is true for one of the given outputs.
    template <class Ask>
    bool any(const Ask& ask) const {
        bool found = false;
        for_each_given([&](const auto& config) { found = found || ask(config); });
        return found;
    }
    bool any() const {
        return any([](const auto&) { return true; });
    }

  private:
    template <class Config>
    struct Given {
        Config config;
        bool given = false;
    };
    template <class Output, class Visit>
    static void visit_given(const Output& output, const Visit& visit) {
        if (output.given) visit(output.config);
    }

    std::tuple<Given<Configs>...> all_;
};

using OutputsConfig = OutputList<GigeConfig, V4l2Config, UvcConfig, FilesConfig, PreviewConfig, TruthConfig,
                                 ShmConfig, PacketsConfig>;
Fields fields(OutputsConfig& outputs);

// Returns the ports that the outputs listen on, in the order of the list; key: "outputs.gige.interface".
std::vector<ListeningPort> listening(const OutputsConfig& outputs);
// Returns the folders that the outputs fill.
std::vector<RunFolder> run_folders(const OutputsConfig& outputs);
// True when one of the outputs needs frames of constant size.
bool have_fixed_size(const OutputsConfig& outputs);
// True when one of the outputs hands frames to clients as they are made.
bool have_live(const OutputsConfig& outputs);

}  // namespace hilcam
