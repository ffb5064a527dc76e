#pragma once
// Block ids of a GigE Vision stream: how they are counted, and the answer to a request for a block that is
// not kept.

#include <algorithm>
#include <array>
#include <cstdint>

#include "io/gige/stream/gvsp.h"

namespace hilcam {

// Counts 1, 2, 3, ...; short ids go from 65535 to 1, because 0 is no block.
class BlockIds {
  public:
    void restart() { next_ = 1; }
    // Returns the next id. jump: skips to the last ids before short ones wrap (fault block_id_wrap).
    std::uint64_t take(bool extended, bool jump) {
        if (jump) next_ = 65530;
        const std::uint64_t id = next_;
        next_ = !extended && id >= 65535 ? 1 : id + 1;
        return id;
    }

  private:
    std::uint64_t next_ = 1;
};

// Returns how many blocks `block` is behind `newest`, negative when it is ahead. Short ids wrap: the shorter
// way counts.
inline std::int64_t blocks_behind(std::uint64_t newest, std::uint64_t block, bool extended) {
    const auto difference = static_cast<std::int64_t>(newest - block);
    if (extended) return difference;
    const std::int64_t round = (difference % 65535 + 65535) % 65535;
    return round > 32767 ? round - 65535 : round;
}

// The blocks of an acquisition that have been sent lately.
class BlockHistory {
  public:
    void restart(bool extended) { *this = BlockHistory(), extended_ = extended; }
    void sent(std::uint64_t block) {
        newest_ = block;
        sent_[count_++ % sent_.size()] = block;
    }
    // Returns why a block is not kept. oldest_kept: 0 when none is.
    gvsp::Status why_missing(std::uint64_t block, std::uint64_t oldest_kept) const {
        if (count_ == 0 || block == 0) return gvsp::kUnavailable;
        const std::int64_t behind = blocks_behind(newest_, block, extended_);
        if (behind < 0) return gvsp::kNotYetAvailable;
        const auto known = sent_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, sent_.size()));
        const bool was_sent = std::find(sent_.begin(), known, block) != known;
        // When it is older than the history, it may have been sent.
        if (!was_sent && behind < static_cast<std::int64_t>(sent_.size())) return gvsp::kUnavailable;
        const bool older = oldest_kept == 0 || behind > blocks_behind(newest_, oldest_kept, extended_);
        return older ? gvsp::kRemovedWithAllBefore : gvsp::kRemoved;
    }

  private:
    std::array<std::uint64_t, 256> sent_{};
    std::size_t count_ = 0;
    std::uint64_t newest_ = 0;
    bool extended_ = false;
};

}  // namespace hilcam
