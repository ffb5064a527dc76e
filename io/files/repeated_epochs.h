#pragma once
// Splits segments of ephemerides at an epoch that occurs twice, as STK and GMAT write the states before and
// after a manoeuvre, so that nothing is interpolated across it (CCSDS 502.0-B-3, 5.2.4.7, asks for a segment
// on each side). At the epoch itself the later state counts.

#include <algorithm>
#include <string>
#include <vector>

#include "io/files/ccsds_message.h"

namespace hilcam {

// Returns the pieces of a segment. Its samples are in time order, each with a `time`. A piece of one sample
// is dropped, because its neighbours share its epoch. A piece or whole segment with fewer samples than the
// interpolation needs gets a lower degree, which is noted. nodes_of: returns how many samples an
// interpolation of the segment needs.
template <class Segment, class Sample>
std::vector<Segment> cut_at_repeated_epochs(KvnLines& lines, Segment&& whole,
                                            std::vector<Sample> Segment::*samples,
                                            int (*nodes_of)(const Segment&)) {
    const std::vector<Sample> all = std::move(whole.*samples);
    std::vector<Segment> out;
    for (std::size_t begin = 0, end; begin < all.size(); begin = end) {
        for (end = begin + 1; end < all.size() && all[end].time != all[end - 1].time;) ++end;
        if (end - begin < 2) continue;
        Segment piece = whole;
        (piece.*samples)
            .assign(all.begin() + static_cast<std::ptrdiff_t>(begin),
                    all.begin() + static_cast<std::ptrdiff_t>(end));
        piece.usable_start = std::max(whole.usable_start, all[begin].time);
        piece.usable_stop = std::min(whole.usable_stop, all[end - 1].time);
        if (piece.usable_stop < piece.usable_start) continue;
        const int has = static_cast<int>(end - begin);
        if (nodes_of(piece) > has) {
            const bool part = end - begin < all.size();
            lines.note("few samples",
                       std::string(part ? "a part of the segment that begins here, between repeated epochs,"
                                        : "the segment that begins here") +
                           " has " + std::to_string(has) + " samples, fewer than INTERPOLATION_DEGREE " +
                           std::to_string(piece.interpolation.degree) + " takes: as many are taken",
                       whole.line);
            while (piece.interpolation.degree > 1 && nodes_of(piece) > has) --piece.interpolation.degree;
        }
        out.push_back(std::move(piece));
    }
    return out;
}

}  // namespace hilcam
