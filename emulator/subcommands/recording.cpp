// `hilcam recording`: lists the contents of a recording.

#include <spdlog/fmt/fmt.h>

#include "emulator/recording/recording_text.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"

namespace hilcam {
namespace {

struct RecordingArguments {
    std::filesystem::path file;
};

int carry_out(const RecordingArguments& o) {
    RecordingReader recording(o.file);
    list_recording(recording, [](const std::string& line) { fmt::print("{}\n", line); });
    return 0;
}

}  // namespace

void add_recording_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<RecordingArguments>();
    CLI::App* recording = app.add_subcommand("recording", "print what is in a recording, as JSON lines");
    recording->add_option("file", o->file, "recording made by run --record")->required();
    set_examples(recording,
                 {"hilcam run small --frames 3 --record flight.rec", "hilcam recording flight.rec"});
    when_named(recording, action, o, carry_out);
}

}  // namespace hilcam
