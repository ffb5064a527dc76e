#include "io/maps/map_service.h"

#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "io/maps/gdal_file.h"
#include "io/maps/gdal_raster.h"
#include "io/maps/map_files.h"
#include "io/maps/map_messages.h"
#include "io/system/child_watch.h"
#include "io/system/confinement.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Memory that a map may take besides the libraries: GDAL's cache, a block as stored and as read, overviews.
constexpr std::uint64_t kMemory_bytes = std::uint64_t{1} << 30;

[[noreturn]] void end(ChildStatus status) { _exit(static_cast<int>(status)); }

// Ends the process when the parent has gone, whatever it is doing.
void watch_over(int socket) {
    std::thread([socket] {
        for (;;) {
            pollfd hang_up{socket, 0, 0};
            if (poll(&hang_up, 1, -1) > 0) end(ChildStatus::kBroken);
        }
    }).detach();
}

class MapService {
  public:
    MapService(int socket, std::uint8_t* memory) : socket_(socket), memory_(memory) {}

    // Answers one request; false when the parent has gone.
    bool serve_one() {
        MapRequest request;
        ssize_t got = 0;
        while ((got = recv(socket_, &request, sizeof request, 0)) < 0 && errno == EINTR) {
        }
        if (got != static_cast<ssize_t>(sizeof request)) return false;
        const MapAnswer answer = answer_to(request);
        return send(socket_, &answer, sizeof answer, MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof answer);
    }

  private:
    int socket_;
    std::uint8_t* memory_;
    std::unique_ptr<GroundRaster> raster_;

    MapAnswer answer_to(const MapRequest& request) {
        MapAnswer answer;
        try {
            switch (request.kind) {
                case MapRequest::Kind::kOpen:
                    open(request, answer);
                    break;
                case MapRequest::Kind::kFind:
                    raster_->find_posts({reinterpret_cast<const Vec3d*>(memory_), request.places},
                                        {reinterpret_cast<Vec2d*>(memory_ + kPosts_at), request.places});
                    break;
                case MapRequest::Kind::kRead:
                    read(request, answer);
                    break;
            }
        } catch (const InputError& error) {
            const std::string text = std::string(error.what()).substr(0, kMaxText_bytes);
            std::memcpy(memory_, text.data(), text.size());
            answer.refused_bytes = static_cast<std::uint32_t>(std::max<std::size_t>(text.size(), 1));
        }
        return answer;
    }

    void open(const MapRequest& r, MapAnswer& answer) {
        const auto* at = reinterpret_cast<const char*>(memory_);
        GroundMapConfig config;
        config.file = std::string(at, r.file_bytes);
        config.where.assign(at + r.file_bytes, r.where_bytes);
        const MappedBody body{{at + r.file_bytes + r.where_bytes, r.body_bytes},
                              {r.equatorial_radius_m, r.polar_radius_m}};
        config.kind = static_cast<GroundKind>(r.ground_kind);
        config.coding = static_cast<MapCoding>(r.coding);
        config.holes = static_cast<MapHoles>(r.holes);
        config.latitudes = static_cast<MapLatitudes>(r.latitudes);
        config.longitudes = static_cast<MapLongitudes>(r.longitudes);
        config.scale = r.scale, config.offset = r.offset;
        config.no_data.assign(r.no_data_values, r.no_data_values + r.no_data);
        config.bounds_deg.assign(r.bounds_deg, r.bounds_deg + r.bounds);
        const MapFiles files = find_map_files(config.file, map_name(config));
        confine(files);
        raster_ = open_gdal_raster(config, body, files);
        put(raster_->reading(), answer);
        const GroundRaster::Shape& shape = raster_->shape();
        answer.columns = shape.columns, answer.rows = shape.rows;
        answer.channels = shape.channels, answer.bands = shape.bands;
        answer.has_overviews = shape.has_overviews, answer.whole_turn = shape.whole_turn;
        answer.pole_above_first_row = shape.pole_above_first_row;
        answer.pole_below_last_row = shape.pole_below_last_row;
        answer.spacing_m = shape.spacing_m;
    }

    void put(const GroundRaster::Reading& reading, MapAnswer& answer) {
        answer.planetocentric = reading.planetocentric;
        std::string text = reading.taken;
        for (const std::string& doubt : reading.doubts) text += '\n' + doubt;
        text.resize(std::min(text.size(), kMaxText_bytes));
        std::memcpy(memory_, text.data(), text.size());
        answer.reading_bytes = static_cast<std::uint32_t>(text.size());
    }

    // Restricts the process to what this one map needs, before any of its bytes are read.
    void confine(const MapFiles& files) const {
        const std::filesystem::path folder = files.file.parent_path();
        std::vector<std::filesystem::path> readable = gdal_folders();
        readable.push_back(folder);
        // The targets of symlinks are elsewhere.
        for (const auto* const names : {&files.beside, &files.pointed_at})
            for (const std::string& name : *names) {
                std::error_code error;
                const std::filesystem::path real = std::filesystem::canonical(folder / name, error);
                if (!error && real.parent_path() != folder) readable.push_back(real);
            }
        restrict_files(readable);
        watch_over(socket_);
        restrict_calls();
    }

    void read(const MapRequest& r, MapAnswer& answer) {
        const std::uint64_t before = raster_->failed_reads();
        const std::size_t count = static_cast<std::size_t>(r.columns) * static_cast<std::size_t>(r.rows) *
                                  static_cast<std::size_t>(raster_->shape().channels);
        raster_->read(r.level, r.column, r.row, r.columns, r.rows,
                      {reinterpret_cast<float*>(memory_), count});
        answer.failed = raster_->failed_reads() != before;
    }
};

}  // namespace

void serve_map(int socket, int memory) {
    void* const mapped = mmap(nullptr, kMapMemory_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
    if (mapped == MAP_FAILED) end(ChildStatus::kBroken);
    close_all_but(std::array{STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO, socket, memory});
    limit_own_memory(kMemory_bytes);
    MapService service(socket, static_cast<std::uint8_t*>(mapped));
    try {
        while (service.serve_one()) {
        }
    } catch (const std::bad_alloc&) {
        end(ChildStatus::kMemory);
    } catch (...) {
        end(ChildStatus::kBroken);
    }
    end(ChildStatus::kDone);
}

}  // namespace hilcam
