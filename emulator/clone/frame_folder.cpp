#include "emulator/clone/frame_folder.h"

#include <fnmatch.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "emulator/clone/frame_names.h"
#include "emulator/clone/raw_frame.h"
#include "io/config/config_yaml.h"
#include "io/images/picture_file.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "frames.yaml";
constexpr const char* kWanted =
    "darks of several exposures and flats of several levels, in folders or files that are named like "
    "dark_20ms_25c/0001.png and flat_5ms_25c/0001.png, or frames.yaml (docs/clone.md)";
constexpr std::size_t kKeep_bytes = std::size_t{2} << 30;
constexpr std::size_t kMostFiles = 100'000;

bool is_raw(const fs::path& file) { return file.extension() == ".raw" || file.extension() == ".bin"; }
bool is_picture(const fs::path& file) {
    if (file.stem().extension() == ".view") return false;  // hilcam's own pictures for the eye
    static const std::vector<std::string> kEndings = {".png", ".tif", ".tiff", ".fits", ".fit", ".pgm"};
    return is_raw(file) ||
           std::find(kEndings.begin(), kEndings.end(), file.extension().string()) != kEndings.end();
}

// Returns the files of the folder and of those in it, in the order of their names, as relative paths.
std::vector<fs::path> files_in(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> out;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        if (it.depth() > 2) it.disable_recursion_pending();
        if (it->is_regular_file(error)) out.push_back(fs::relative(it->path(), folder, error));
        if (out.size() > kMostFiles)
            throw InputError(folder.string() + ": found more than " + std::to_string(kMostFiles) +
                             " files; accepted: the frames of one camera");
    }
    if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
    std::sort(out.begin(), out.end());
    return out;
}

struct NamedSeries {
    std::string name;
    SeriesConfig settings;
    std::vector<fs::path> files;
};

std::vector<NamedSeries> series_by_manifest(const fs::path& folder, const FramesConfig& config) {
    const std::vector<fs::path> all = files_in(folder);
    std::vector<NamedSeries> out;
    for (const SeriesConfig& s : config.series) {
        NamedSeries series{s.files.front(), s, {}};
        for (const std::string& pattern : s.files) {
            const std::size_t before = series.files.size();
            for (const fs::path& file : all)
                if (fnmatch(pattern.c_str(), file.c_str(), FNM_PATHNAME) == 0) series.files.push_back(file);
            if (series.files.size() == before)
                throw InputError((folder / kManifest).string() + ": series." + std::to_string(out.size()) +
                                 ".files: found no file like " + in_quotes(pattern) +
                                 "; accepted: names in that folder, with * and ?");
        }
        out.push_back(std::move(series));
    }
    return out;
}

std::vector<NamedSeries> series_by_names(const fs::path& folder) {
    using Key = std::tuple<int, double, double, double, double, std::string>;
    std::map<Key, NamedSeries> found;
    for (const fs::path& file : files_in(folder)) {
        if (!is_picture(file)) continue;
        fs::path name = file;
        const std::optional<SeriesConfig> s = settings_in_name(name.replace_extension().string());
        if (!s) continue;
        if (shows_pixels(s->kind) && s->exposure_s <= 0)
            throw InputError((folder / file).string() +
                             ": found no exposure in the name; accepted: one such as 20ms, 250us or 1.5s");
        if (s->kind == SeriesKind::kChessboard && s->corners.empty())
            throw InputError((folder / file).string() +
                             ": found no number of corners in the name; accepted: the inner corners of the "
                             "chessboard, as chessboard_9x6");
        // Each edge, and each board, is a folder of its own.
        const std::string place = shows_pixels(s->kind) ? "" : file.parent_path().string();
        const Key key{static_cast<int>(s->kind),
                      s->exposure_s,
                      s->has_temperature_c ? s->temperature_c : -1e3,
                      s->gain_db,
                      s->light,
                      place};
        NamedSeries& series = found[key];
        if (series.files.empty()) {
            series.settings = *s;
            series.name = (folder / (file.has_parent_path() ? file.parent_path() : file)).string();
        }
        series.files.push_back(file);
    }
    std::vector<NamedSeries> out;
    for (auto& [key, series] : found) out.push_back(std::move(series));
    return out;
}

// Reads files into frames and keeps what fits.
class FrameFiles {
  public:
    FrameFiles(fs::path folder, FramesConfig config)
        : folder_(std::move(folder)), config_(std::move(config)) {}

    // Returns a frame of the file's own size.
    DnImage read(const fs::path& relative) const {
        const fs::path file = folder_ / relative;
        if (is_raw(file)) {
            DnImage frame(static_cast<int>(config_.width_px), static_cast<int>(config_.height_px));
            decode_raw(read_input_file(file, {std::uintmax_t{1} << 30, "raw frames"}), config_, file.string(),
                       frame);
            return frame;
        }
        const PixelMap numbers = read_pixel_map(file, false);
        DnImage frame(numbers.width(), numbers.height());
        const int shift = static_cast<int>(config_.shift_bits);
        for (std::size_t i = 0; i < numbers.pixels(); ++i) {
            const float value = numbers.all()[i];
            if (value > 65535 || value != std::floor(value))
                throw InputError(
                    fmt::format("{}: found the number {:g} in a pixel; accepted: whole numbers, 0 "
                                "to 65535, as the converter made them",
                                file.string(), value));
            frame.all()[i] = static_cast<std::uint16_t>(static_cast<unsigned>(value) >> shift);
        }
        return frame;
    }
    void read_into(const fs::path& relative, DnImage& out) {
        const auto kept = kept_.find(relative.string());
        if (kept != kept_.end()) {
            std::copy(kept->second.all().begin(), kept->second.all().end(), out.all().begin());
            return;
        }
        DnImage frame = read(relative);
        if (frame.width() != out.width() || frame.height() != out.height())
            throw InputError(fmt::format("{}: found {} x {} pixels; accepted: {} x {}, as the first frame",
                                         (folder_ / relative).string(), frame.width(), frame.height(),
                                         out.width(), out.height()));
        std::copy(frame.all().begin(), frame.all().end(), out.all().begin());
        const std::size_t bytes = 2 * frame.pixels();
        if (kept_bytes_ + bytes > kKeep_bytes) return;
        kept_bytes_ += bytes;
        kept_.emplace(relative.string(), std::move(frame));
    }

    std::string name_of(const fs::path& relative) const { return (folder_ / relative).string(); }

  private:
    fs::path folder_;
    FramesConfig config_;
    std::map<std::string, DnImage> kept_;
    std::size_t kept_bytes_ = 0;
};

FramesConfig config_of(const fs::path& folder, const RawShape& shape, const CameraModel& like) {
    FramesConfig config;
    if (fs::exists(folder / kManifest)) {
        read_config(folder / kManifest, section_of(config));
        if (config.series.empty())
            throw InputError((folder / kManifest).string() +
                             ": found no series; accepted: series: with kind, "
                             "exposure_ms and files of each");
    }
    const auto choose = [](std::int64_t& value, std::int64_t stated, std::int64_t otherwise) {
        if (stated != 0) value = stated;
        if (value == 0) value = otherwise;
    };
    choose(config.bits, shape.bits, like.bits);
    choose(config.width_px, shape.width_px, like.width_px);
    choose(config.height_px, shape.height_px, like.height_px);
    choose(config.container_bits, 0, config.bits <= 8 ? 8 : 16);
    return config;
}

FrameSeries series_of(const NamedSeries& named, const std::shared_ptr<FrameFiles>& files) {
    FrameSeries out;
    out.name = named.name;
    out.kind = named.settings.kind;
    if (named.settings.corners.size() == 2) {
        out.corner_columns = static_cast<int>(named.settings.corners[0]);
        out.corner_rows = static_cast<int>(named.settings.corners[1]);
    }
    for (const fs::path& file : named.files) out.files.push_back(files->name_of(file));
    out.exposure_s = named.settings.exposure_s;
    if (named.settings.has_temperature_c) out.temperature_c = named.settings.temperature_c;
    out.gain_db = named.settings.gain_db;
    out.light = named.settings.light;
    out.frames = named.files.size();
    out.read = [paths = named.files, files](std::size_t i, DnImage& frame) {
        files->read_into(paths[i], frame);
    };
    return out;
}

}  // namespace

FrameSet read_frame_folder(const fs::path& folder, const RawShape& shape, const CameraModel& like) {
    if (!fs::is_directory(folder))
        throw InputError(folder.string() + ": is no folder; accepted: a folder with " + kWanted);
    const FramesConfig config = config_of(folder, shape, like);
    const std::vector<NamedSeries> named =
        config.series.empty() ? series_by_names(folder) : series_by_manifest(folder, config);
    if (named.empty())
        throw InputError(folder.string() +
                         ": found no frames whose names say what they are; accepted: " + kWanted);
    const auto files = std::make_shared<FrameFiles>(folder, config);
    const DnImage first = files->read(named.front().files.front());
    FrameSet out;
    out.name = folder.string();
    out.width = first.width(), out.height = first.height();
    out.bits = static_cast<int>(config.bits);
    for (const NamedSeries& one : named) {
        FrameSeries series = series_of(one, files);
        (shows_pixels(series.kind) ? out.series : out.others).push_back(std::move(series));
    }
    return out;
}

}  // namespace hilcam
