#pragma once
// The outputs, where a camera's frames go: a new output is its header here and its configuration at the end of the list.
//
// An output is a FrameSink (io/contract/frame_sink.h) and its configuration, which says all that is asked of
// it here: kKey and kMeaning; fields(), and validate() if keys depend on each other; make_sink(config, context,
// shape). Where they hold, too: kFixedSize, when frames cannot change size while it runs; kLive, when it hands frames to
// clients while they are made, who must not wait for a disk; listening(config),
// what it listens on; run_folder(config), a folder that it fills. docs/extending.md adds one.

#include <tuple>

#include "io/contract/output_shape.h"
#include "io/contract/run_folder.h"
#include "io/files/sink_files.h"
#include "io/gige/sink_gige.h"
#include "io/preview/sink_preview.h"
#include "io/shm/sink_shm.h"
#include "io/truth/truth_config.h"
#include "io/uvc/sink_uvc.h"
#include "io/v4l2/sink_v4l2.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// The outputs that a scenario gives a camera, of those that there are.
template <class... Configs>
class OutputList {
  public:
    // Null where the scenario does not give this output.
    template <class Config>
    const Config* find() const {
        const Given<Config>& output = std::get<Given<Config>>(all_);
        return output.given ? &output.config : nullptr;
    }
    // Returns it as the scenario gives it, or its defaults.
    template <class Config>
    const Config& config() const {
        return std::get<Given<Config>>(all_).config;
    }
    template <class Config>
    void give(bool given = true) {
        std::get<Given<Config>>(all_).given = given;
    }

    // Calls visit(config) for every output that is given.
    template <class Visit>
    void for_each_given(const Visit& visit) const {
        (visit_given(std::get<Given<Configs>>(all_), visit), ...);
    }
    // Calls visit(config, given) for every output that there is.
    template <class Visit>
    void for_each(const Visit& visit) {
        (visit(std::get<Given<Configs>>(all_).config, std::get<Given<Configs>>(all_).given), ...);
    }
    // True when one of those that are given is as asked for.
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

using OutputsConfig =
    OutputList<GigeConfig, V4l2Config, UvcConfig, FilesConfig, PreviewConfig, TruthConfig, ShmConfig>;
Fields fields(OutputsConfig& outputs);

// Returns what they listen on, in the order of the list; key: "outputs.gige.interface".
std::vector<ListeningPort> listening(const OutputsConfig& outputs);
// The folders that they fill.
std::vector<RunFolder> run_folders(const OutputsConfig& outputs);
// True when one of them needs frames of one size.
bool have_fixed_size(const OutputsConfig& outputs);
// True when one of them hands frames to clients while they are made.
bool have_live(const OutputsConfig& outputs);

}  // namespace hilcam
