#include "render/earth/detail_stream.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

std::size_t tiles_in(std::size_t bytes) {
    return std::max<std::size_t>(1, bytes / (EarthDetail::kTexels * sizeof(EarthMap::Texel)));
}

}  // namespace

DetailStream::DetailStream(std::shared_ptr<EarthDetail> detail, const EarthMap& below, std::size_t bytes)
    : detail_(std::move(detail)),
      below_(below),
      tiles_(detail_->shape(), tiles_in(bytes)),
      need_(detail_->shape(), tiles_in(bytes)),
      next_(detail_->shape(), tiles_in(bytes)) {
    loads_.reserve(tiles_.most());
    // Reading a tile is little work, but not for the loop, because it allocates. One thread does it.
    thread_.start([this] { load(); }, AheadThread::Rank::kEqual);
}

void DetailStream::load() {
    for (Load& load : loads_) {
        load.is_whole = detail_->read(load.key, below_, tiles_.texels_of(load.place));
        if (!load.is_whole) unreadable_.fetch_add(1, std::memory_order_relaxed);
    }
}

void DetailStream::settle() {
    for (const Load& load : loads_) tiles_.put(load.place, load.key, load.is_whole);
    loads_.clear();
}

bool DetailStream::choose_all() {
    tiles_.begin_frame();
    bool all = true;
    for (const DetailKey& key : need_.tiles()) all = tiles_.choose(key) && all;
    return all;
}

// Assigns places to missing tiles, as long as there are places that this frame does not need.
void DetailStream::want(const DetailNeed& need) {
    for (const DetailKey& key : need.tiles()) {
        if (tiles_.has(key)) continue;
        const std::size_t place = tiles_.take_place();
        if (place == DetailTiles::kNone) return;
        loads_.push_back({key, place, false});
    }
}

const DetailTiles& DetailStream::place(const DetailView& view) {
    need_.find(view);
    if (!thread_.is_at_work()) settle();
    if (!choose_all()) {
        ++waits_;
        thread_.wait();
        settle();
        // Tiles in memory keep their places.
        choose_all();
        want(need_);
        if (is_stopped()) {
            load();
        } else {
            thread_.ask();
            thread_.wait();
        }
        settle();
        choose_all();
    }
    // The next frame settles what the thread has finished in the meantime.
    if (!thread_.is_busy() && loads_.empty()) look_ahead(view);
    before_ = view, ++frames_;
    return tiles_;
}

std::string DetailStream::fault() const {
    const std::uint64_t count = unreadable_.load(std::memory_order_relaxed);
    if (count == 0) return {};
    return "earth_surface.layers: " + std::to_string(count) + (count == 1 ? " tile of " : " tiles of ") +
           detail_->files() + " could not be read; coarser levels are shown there";
}

std::string DetailStream::explain() const {
    std::string out = "earth: " + std::to_string(need_.tiles().size()) + " tiles of " + detail_->files() +
                      ", of " + std::to_string(tiles_.most()) + " that earth_surface.memory_mb has room for";
    if (need_.coarser_by() > 0)
        out += "; for want of room the map is " + plain(std::exp2(need_.coarser_by())) +
               " times as coarse as pixels ask for";
    return out;
}

// Requests a tile of a future frame, alternating between near and far ones.
void DetailStream::look_ahead(const DetailView& now) {
    if (frames_ == 0) return;
    constexpr double kAhead[] = {4, 16, 64, 256};  // frames
    // The path of a camera that jumps is not predictable.
    constexpr double kFarthest_m = 3e6;
    const double ahead = kAhead[frames_ % std::size(kAhead)];
    DetailView next = now;
    const Vec3d way_m = ahead * (now.camera_m - before_.camera_m);
    if (length(way_m) > kFarthest_m) return;
    next.camera_m = now.camera_m + way_m;
    const Vec3d turned = now.boresight + ahead * (now.boresight - before_.boresight);
    if (!(length(turned) > 0.1)) return;
    next.boresight = normalized(turned);
    next_.find(next);
    want(next_);
    if (!loads_.empty()) thread_.ask();
}

}  // namespace hilcam
