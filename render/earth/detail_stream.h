#pragma once
// Provides the tiles of the Earth's finer levels that a frame needs. A thread reads tiles that are not in
// memory, and the frame waits for them. It also reads ahead what the next frames will need if the camera
// continues its motion. Frames show the same either way.

#include <cstdint>
#include <memory>

#include "render/earth/detail_need.h"
#include "render/earth/detail_tiles.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

class DetailStream {
  public:
    // below: the map in memory, which must outlive this. bytes: memory for tiles. Owner thread.
    DetailStream(std::shared_ptr<EarthDetail> detail, const EarthMap& below, std::size_t bytes);
    DetailStream(const DetailStream&) = delete;
    DetailStream& operator=(const DetailStream&) = delete;

    // Ends the thread (AheadThread); frames then read for themselves. Owner thread.
    void stop_looking_ahead() { thread_.stop(); }

    // Returns the tiles of a frame. Loop; no allocation, unless the thread has ended.
    const DetailTiles& place(const DetailView& view);
    const DetailTiles& tiles() const { return tiles_; }
    // Returns the number of frames that had to wait for tiles. Owner thread.
    std::uint64_t waits() const { return waits_; }
    bool is_reading_ahead() const { return thread_.is_at_work(); }

    // Says how many reads of tiles have failed so far; empty: none. Any thread.
    std::string fault() const;
    // Says how many tiles the last frame needed, and what it lacks because of too little memory. Not for the
    // loop.
    std::string explain() const;

  private:
    struct Load {
        DetailKey key;
        std::size_t place;
        bool is_whole;
    };
    std::shared_ptr<EarthDetail> detail_;
    const EarthMap& below_;
    DetailTiles tiles_;
    DetailNeed need_, next_;
    std::vector<Load> loads_;  // owned by the thread while it is at work
    DetailView before_;
    std::uint64_t frames_ = 0, waits_ = 0;
    std::atomic<std::uint64_t> unreadable_{0};
    AheadThread thread_;  // last member, so that it ends first

    bool is_stopped() const { return thread_.is_busy() && !thread_.is_at_work(); }
    bool choose_all();
    void want(const DetailNeed& need);
    void load();
    void settle();
    void look_ahead(const DetailView& now);
};

}  // namespace hilcam
