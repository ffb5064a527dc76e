#pragma once
// Has the tiles of the Earth's finer levels that a frame needs: what is not in memory is read by a thread of its own, and the frame
// waits for it; what the next frames will need, if the camera moves on as it did, is read beside them. What a frame shows is the
// same either way.

#include <cstdint>
#include <memory>

#include "render/earth/detail_need.h"
#include "render/earth/detail_tiles.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

class DetailStream {
  public:
    // below: the map in memory, which outlives this. bytes: memory for tiles. Owner thread.
    DetailStream(std::shared_ptr<EarthDetail> detail, const EarthMap& below, std::size_t bytes);
    DetailStream(const DetailStream&) = delete;
    DetailStream& operator=(const DetailStream&) = delete;

    // Ends the thread (AheadThread); from then on frames read for themselves. Owner thread.
    void stop_looking_ahead() { thread_.stop(); }

    // Returns the tiles of a frame. Loop; allocates nothing, unless the thread is ended.
    const DetailTiles& place(const DetailView& view);
    const DetailTiles& tiles() const { return tiles_; }
    // Returns how many frames had to wait for tiles. Owner thread.
    std::uint64_t waits() const { return waits_; }
    bool is_reading_ahead() const { return thread_.is_at_work(); }

    // Says how many tiles could not be read whole so far, each as often as it was tried; empty: none. Any thread.
    std::string fault() const;
    // Says how many tiles the last frame needed, and what it lacks for want of memory. Not for the loop.
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
    std::vector<Load> loads_;  // the thread's while it is at work
    DetailView before_;
    std::uint64_t frames_ = 0, waits_ = 0;
    std::atomic<std::uint64_t> unreadable_{0};
    AheadThread thread_;  // the last: it ends first

    bool is_stopped() const { return thread_.is_busy() && !thread_.is_at_work(); }
    bool choose_all();
    void want(const DetailNeed& need);
    void load();
    void settle();
    void look_ahead(const DetailView& now);
};

}  // namespace hilcam
