// `hilcam clone`: a camera file with the flaws of one particular camera, from its own frames.

#include <arpa/inet.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "emulator/clone/clone_report.h"
#include "emulator/clone/frame_folder.h"
#include "emulator/progress/progress.h"
#include "emulator/run/run_helper.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct CloneArguments {
    std::filesystem::path frames, out, report;
    ConfigArguments like;
    RawShape shape;
    bool json = false;
    // Frames that are taken from a camera.
    std::filesystem::path taken;
    std::int64_t count = 0;
    bool yes = false;
    std::string cover, light;
};

bool is_address(const std::filesystem::path& word) {
    in_addr unused{};
    return inet_pton(AF_INET, word.c_str(), &unused) == 1;
}

// Takes flats and darks from the camera at an address with hilcam-record-frames, into a new folder.
std::filesystem::path take_frames(const CloneArguments& o) {
    std::filesystem::path folder = o.taken;
    if (folder.empty()) folder = o.out.parent_path() / (o.out.stem().string() + "_frames");
    if (std::filesystem::exists(folder) && !std::filesystem::is_empty(folder))
        throw InputError(folder.string() + ": found files in it; accepted: a new folder for the frames of " +
                         o.frames.string() + ", or hilcam clone " + folder.string() + " for those there");
    std::vector<std::string> arguments = {"all", o.frames.string(), folder.string()};
    if (o.count > 0) arguments.insert(arguments.end(), {"--frames", std::to_string(o.count)});
    if (o.yes) arguments.emplace_back("--yes");
    if (!o.cover.empty()) arguments.insert(arguments.end(), {"--cover", o.cover});
    if (!o.light.empty()) arguments.insert(arguments.end(), {"--light", o.light});
    std::fflush(stdout);
    if (run_helper("hilcam-record-frames", arguments, "no frames are taken") != 0)
        throw DeviceError("hilcam-record-frames failed (see above): no frames of " + o.frames.string());
    return folder;
}

// The text of --like is copied, so only its own keys can be replaced.
void require_top_level(const std::vector<std::string>& overrides) {
    for (const std::string& one : overrides)
        if (one.find('.') < one.find('='))
            throw InputError(
                "--set " + in_quotes(one) +
                ": accepted here: keys at the top of the camera file, such as focal_length_mm=12");
}

void require_size(const FrameSet& frames, const CameraModel& like, const std::filesystem::path& file) {
    if (frames.width == like.width_px && frames.height == like.height_px) return;
    throw InputError(
        fmt::format("{}: found frames of {} x {}; accepted: {} x {}, the sensor of {}, or --set width_px={} "
                    "--set height_px={}",
                    frames.name, frames.width, frames.height, like.width_px, like.height_px, file.string(),
                    frames.width, frames.height));
}

int carry_out(const CloneArguments& o) {
    if (o.out.extension() != ".yaml")
        throw InputError("--out " + o.out.string() + ": accepted: a camera file, NAME.yaml");
    if (has_top_level_key(o.like.file, "time_utc"))
        throw InputError(o.like.file.string() + ": is a scenario; accepted: a camera's data sheet");
    require_top_level(o.like.overrides);
    CloneSource source;
    read_config(o.like.file, section_of(source.like), o.like.overrides);
    const bool live = !o.taken.empty() || (is_address(o.frames) && !std::filesystem::exists(o.frames));
    const std::filesystem::path folder = live ? take_frames(o) : o.frames;
    source.frames = folder.string(), source.like_file = o.like.file, source.overrides = o.like.overrides;
    const FrameSet frames = read_frame_folder(folder, o.shape, source.like);
    require_size(frames, source.like, o.like.file);
    for (const std::vector<FrameSeries>* some : {&frames.series, &frames.others})
        for (const FrameSeries& s : *some) source.frame_count += s.frames;
    const CloneMeasurement clone = [&] {
        Progress progress("measuring frames", 1);
        CloneMeasurement out =
            measure_clone(frames, source.like, [&](double share) { progress.done(0.9 * share); });
        out.optics = measure_optics(frames, source.like, out);
        return out;
    }();
    write_clone(clone, source, o.out);
    fmt::print("{}",
               o.json ? clone_json(clone, source.like).dump(2) + "\n" : clone_table(clone, source.like));
    if (!o.report.empty()) write_comparison(clone, frames, source.like, o.out, o.report);
    return 0;
}

}  // namespace

void add_clone_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<CloneArguments>();
    CLI::App* command =
        app.add_subcommand("clone", "make a camera file with the flaws of your camera, from its frames");
    command
        ->add_option("source", o->frames,
                     "folder of darks and flats (docs/clone.md), or the address of a GigE Vision camera")
        ->required();
    command
        ->add_option("--like", o->like.file,
                     "camera file, or the name of a shipped one, for what frames do not tell: lens, quantum "
                     "efficiency")
        ->required()
        ->transform(name_of_shipped());
    command->add_option("--out", o->out, "camera file to write (.yaml); its maps go into a folder beside it")
        ->required();
    add_overrides(command, o->like.overrides, "that camera");
    command->add_option("--width", o->shape.width_px, "columns of raw files")->check(CLI::Range(1, 16384));
    command->add_option("--height", o->shape.height_px, "rows of raw files")->check(CLI::Range(1, 16384));
    command->add_option("--bits", o->shape.bits, "bits of a number")->check(CLI::Range(1, 16));
    command->add_option("--report", o->report,
                        "folder for a page that lays the frames beside those of the emulated camera");
    command->add_option("--frames", o->taken,
                        "new folder for the frames that are taken from the camera of that address or name "
                        "(NAME_frames beside --out)");
    command->add_option("--count", o->count, "frames of each exposure that are taken (64)")
        ->check(CLI::Range(8, 10000));
    command->add_flag("--yes", o->yes, "do not ask for light and darkness before frames are taken");
    command->add_option("--cover", o->cover, "shell command that makes it dark, before darks are taken");
    command->add_option("--light", o->light, "shell command that lights the surface, before flats are taken");
    command->add_flag("--json", o->json, "machine-readable");
    set_examples(command, {"hilcam clone my_frames --like mv_imx249 --out my_camera.yaml",
                           "hilcam clone my_frames --like mv_imx249 --out mine.yaml --report report",
                           "hilcam clone 192.168.1.20 --like mv_imx249 --out my_camera.yaml"});
    when_named(command, action, o, carry_out);
}

}  // namespace hilcam
