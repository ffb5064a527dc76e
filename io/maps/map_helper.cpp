#include "io/maps/map_helper.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "io/maps/longitude_latitude.h"
#include "io/maps/map_messages.h"
#include "io/system/helper_process.h"
#include "io/system/input_file.h"
#include "io/system/program_files.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// The longest request examines some hundred thousand posts of a map without overviews.
constexpr HelperProcess::Limits kOpening{60, 30}, kReading{30, 30};

std::string name_of(const GroundMapConfig& config) {
    return (config.where.empty() ? "" : config.where + ": ") + config.file.string();
}

// The readers of all maps that have ended.
class EndedReaders {
  public:
    void add(const std::string& what) {
        const std::lock_guard lock(mutex_);
        constexpr std::size_t kMax = 10;
        if (list_.size() < kMax) list_.push_back(what);
    }
    std::string text() {
        const std::lock_guard lock(mutex_);
        std::string out;
        for (const std::string& one : list_) out += (out.empty() ? "" : "; ") + one;
        return out;
    }

  private:
    std::mutex mutex_;
    std::vector<std::string> list_;
};

EndedReaders& ended_readers() {
    static EndedReaders all;
    return all;
}

class HelpedRaster final : public GroundRaster {
  public:
    HelpedRaster(std::filesystem::path program, const GroundMapConfig& config, const MappedBody& body)
        : program_(std::move(program)),
          config_(config),
          file_(std::filesystem::absolute(config.file)),
          body_(body) {
        if (!config.bounds_deg.empty())
            bounds_ = {config.bounds_deg[0], config.bounds_deg[1], config.bounds_deg[2],
                       config.bounds_deg[3]};
        constexpr std::uintmax_t kMaxMapBytes = std::uintmax_t{1} << 50;  // a petabyte; no map is larger
        open_input_file(config.file, {kMaxMapBytes, "a map"});
        shape_ = opened(reading_);
    }

    void find_posts(std::span<const Vec3d> places, std::span<Vec2d> posts) override {
        if (bounds_) {
            for (std::size_t i = 0; i < places.size(); ++i)
                posts[i] = post_at(*bounds_, shape_, places[i], factor_);
            return;
        }
        for (std::size_t i = 0; i < places.size(); i += kMaxMapPlaces) {
            const std::size_t count = std::min(kMaxMapPlaces, places.size() - i);
            find_some(places.subspan(i, count), posts.subspan(i, count));
        }
    }

    void read(int level, int column, int row, int columns, int rows, std::span<float> values) override {
        const int channels = shape_.channels, most = static_cast<int>(kMaxMapValues) / channels;
        const int wide = std::min(columns, most), high = std::max(1, most / wide);
        for (int y = 0; y < rows; y += high)
            for (int x = 0; x < columns; x += wide) {
                const int w = std::min(wide, columns - x), h = std::min(high, rows - y);
                const bool there = read_piece({level, column + x, row + y, w, h});
                failed_reads_ += !there;
                const std::size_t line = static_cast<std::size_t>(w) * static_cast<std::size_t>(channels);
                for (int j = 0; j < h; ++j) {
                    const std::size_t to =
                        (static_cast<std::size_t>(y + j) * static_cast<std::size_t>(columns) +
                         static_cast<std::size_t>(x)) *
                        static_cast<std::size_t>(channels);
                    std::copy_n(
                        piece_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(j) * line),
                        line, values.begin() + static_cast<std::ptrdiff_t>(to));
                }
            }
    }

  private:
    struct Window {
        int level, column, row, columns, rows;
    };
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::filesystem::path program_;
    GroundMapConfig config_;
    std::filesystem::path file_;  // absolute, because a reader may be started later from another folder
    MappedBody body_;
    std::optional<MapBounds> bounds_;
    double factor_ = 1;                      // see latitude_factor()
    std::unique_ptr<HelperProcess> helper_;  // null: it has ended, and is not started again
    std::vector<float> piece_;

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(name_of(config_) + ": " + what);
    }

    // Starts a reader and lets it open the map. Throws InputError.
    Shape opened(Reading& reading) {
        std::error_code error;
        if (!std::filesystem::is_regular_file(program_, error))
            refuse(std::string("is read by ") + kMapProgram +
                   ", which is not installed; accepted: with it (apt install hilcam-maps), or a picture "
                   "(.png) with "
                   "bounds_deg");
        helper_ = std::make_unique<HelperProcess>(program_, kMapMemory_bytes);
        const MapRequest request = written_request();
        MapAnswer answer;
        if (const std::string fault = ask(request, answer, kOpening); !fault.empty())
            refuse("does not parse: " + fault);
        if (answer.refused_bytes > 0) throw InputError(refusal(answer));
        factor_ = latitude_factor(body_.figure, answer.planetocentric != 0);
        reading = reading_in(answer);
        return believable(answer);
    }

    MapRequest written_request() {
        MapRequest out;
        const std::string file = file_.string();
        out.file_bytes = static_cast<std::uint32_t>(file.size());
        out.where_bytes = static_cast<std::uint32_t>(config_.where.size());
        out.body_bytes = static_cast<std::uint32_t>(body_.name.size());
        const std::string texts = file + config_.where + body_.name;
        if (texts.size() > kMapMemory_bytes) refuse("its name is too long");
        std::memcpy(helper_->memory().data(), texts.data(), texts.size());
        out.ground_kind = static_cast<std::uint32_t>(config_.kind);
        out.coding = static_cast<std::uint32_t>(config_.coding);
        out.holes = static_cast<std::uint32_t>(config_.holes);
        out.latitudes = static_cast<std::uint32_t>(config_.latitudes);
        out.longitudes = static_cast<std::uint32_t>(config_.longitudes);
        out.no_data = static_cast<std::uint32_t>(config_.no_data.size());
        std::copy(config_.no_data.begin(), config_.no_data.end(), out.no_data_values);
        out.bounds = static_cast<std::uint32_t>(config_.bounds_deg.size());
        std::copy(config_.bounds_deg.begin(), config_.bounds_deg.end(), out.bounds_deg);
        out.scale = config_.scale, out.offset = config_.offset;
        out.equatorial_radius_m = body_.figure.equatorial_radius_m;
        out.polar_radius_m = body_.figure.polar_radius_m;
        return out;
    }

    // The reader knows the file by its absolute path; the message gives the path of the scenario.
    std::string refusal(const MapAnswer& answer) const {
        const std::size_t size = std::min<std::size_t>(answer.refused_bytes, kMaxText_bytes);
        const std::string text = harmless({reinterpret_cast<const char*>(helper_->memory().data()), size});
        GroundMapConfig absolute = config_;
        absolute.file = file_;
        const std::string begin = name_of(absolute);
        return text.starts_with(begin) ? name_of(config_) + text.substr(begin.size()) : text;
    }

    // The reader's words are shown, but limited in length and without control characters.
    Reading reading_in(const MapAnswer& answer) const {
        const std::size_t size = std::min<std::size_t>(answer.reading_bytes, kMaxText_bytes);
        std::istringstream lines(std::string(reinterpret_cast<const char*>(helper_->memory().data()), size));
        Reading out;
        std::string line;
        if (std::getline(lines, line)) out.taken = harmless(line);
        while (std::getline(lines, line)) out.doubts.push_back(harmless(line));
        return out;
    }

    Shape believable(const MapAnswer& a) const {
        Shape out;
        out.columns = a.columns, out.rows = a.rows, out.channels = a.channels, out.bands = a.bands;
        out.has_overviews = a.has_overviews != 0, out.whole_turn = a.whole_turn != 0;
        out.pole_above_first_row = a.pole_above_first_row != 0;
        out.pole_below_last_row = a.pole_below_last_row != 0;
        out.spacing_m = a.spacing_m;
        if (out.columns < 2 || out.rows < 2 || (out.channels != 1 && out.channels != 3) ||
            out.bands < out.channels || !(out.spacing_m > 0) || !std::isfinite(out.spacing_m))
            refuse("does not parse: it is broken in a way that confuses its reader; export it anew");
        return out;
    }

    std::string ask(const MapRequest& request, MapAnswer& answer, HelperProcess::Limits limits) {
        const auto* const from = reinterpret_cast<const std::uint8_t*>(&request);
        std::string fault = helper_->ask({from, sizeof request},
                                         {reinterpret_cast<std::uint8_t*>(&answer), sizeof answer}, limits);
        if (!fault.empty()) helper_.reset();
        return fault;
    }

    // Asks again while the map is open. False: there is no answer, and there never will be.
    bool ask_on(const MapRequest& request, MapAnswer& answer) {
        const std::string fault = ask(request, answer, kReading);
        if (!fault.empty())
            ended_readers().add(name_of(config_) + ": does not parse: " + fault +
                                "; what lies below it is shown from then on");
        return fault.empty() && answer.refused_bytes == 0;
    }

    // A forked process gets a reader of its own. False: there is none, because the map has ended it or it has
    // gone.
    bool has_reader() {
        if (!helper_ || helper_->is_own()) return helper_ != nullptr;
        try {
            Reading again;
            const Shape now = opened(again);
            if (now.columns == shape_.columns && now.rows == shape_.rows && now.channels == shape_.channels)
                return true;
        } catch (const std::exception&) {
        }
        helper_.reset();
        return false;
    }

    void find_some(std::span<const Vec3d> places, std::span<Vec2d> posts) {
        MapRequest request;
        request.kind = MapRequest::Kind::kFind, request.places = places.size();
        MapAnswer answer;
        bool there = has_reader();
        if (there) {
            std::memcpy(helper_->memory().data(), places.data(), places.size_bytes());
            there = ask_on(request, answer);
        }
        failed_reads_ += !there;
        if (!there) return std::fill(posts.begin(), posts.end(), Vec2d{kNone, kNone});
        std::memcpy(posts.data(), helper_->memory().data() + kPosts_at, posts.size_bytes());
        for (Vec2d& post : posts) {
            const bool whole = !shape_.whole_turn || (post.x >= -0.5 && post.x <= shape_.columns - 0.5);
            if (!whole || !std::isfinite(post.x + post.y)) post = {kNone, kNone};
        }
    }

    // Reads into piece_. Returns false, with holes, where nothing can be read.
    bool read_piece(const Window& w) {
        piece_.resize(static_cast<std::size_t>(w.columns) * static_cast<std::size_t>(w.rows) *
                      static_cast<std::size_t>(shape_.channels));
        MapRequest request;
        request.kind = MapRequest::Kind::kRead;
        request.level = w.level, request.column = w.column, request.row = w.row;
        request.columns = w.columns, request.rows = w.rows;
        MapAnswer answer;
        constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
        if (!has_reader() || !ask_on(request, answer)) {
            std::fill(piece_.begin(), piece_.end(), kHole);
            return false;
        }
        std::memcpy(piece_.data(), helper_->memory().data(), piece_.size() * sizeof(float));
        for (float& value : piece_)
            if (!std::isfinite(value)) value = kHole;
        return answer.failed == 0;
    }
};

}  // namespace

std::unique_ptr<GroundRaster> open_map_by(const std::filesystem::path& program, const GroundMapConfig& config,
                                          const MappedBody& body) {
    return std::make_unique<HelpedRaster>(program, config, body);
}

std::unique_ptr<GroundRaster> open_map_by_helper(const GroundMapConfig& config, const MappedBody& body) {
    return open_map_by(helper_program(kMapProgram), config, body);
}

std::string ended_map_readers() { return ended_readers().text(); }

}  // namespace hilcam
