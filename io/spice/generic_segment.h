#pragma once
// The "generic segments" of SPK types 10 and 14: constants, packets of one size, and the times at which these
// begin. The last 17 numbers give the addresses of the parts, counted from the segment's first word.

#include <algorithm>

#include "io/spice/segment_words.h"

namespace hilcam {

struct GenericSegment {
    // Position, from the end, of the rule that selects the packet of a time; 3: the last packet that has
    // begun.
    static constexpr std::size_t kIndexKindFromEnd = 13;

    std::size_t constants = 0, times = 0, count = 0, packets = 0, packet_words = 0, words_before = 0;

    // Throws InputError when a part is outside the segment. constant_count: the number that its type has;
    // least: the smallest packet.
    GenericSegment(const SegmentWords& words, double constant_count, double least) {
        constexpr std::size_t kItems = 17;
        words.count_from_end(1, "items at its end", kItems, kItems);
        const auto item = [&](std::size_t number, const char* what, double from, double to) {
            return words.count_from_end(kItems - number + 1, what, from, to);
        };
        constants = item(1, "place of constants", 0, kMaxRecords);
        const std::size_t constants_there = item(2, "constants", constant_count, constant_count);
        times = item(6, "place of times", 0, kMaxRecords), count = item(7, "times", 1, kMaxRecords);
        packets = item(11, "place of packets", 0, kMaxRecords);
        item(12, "packets", static_cast<double>(count), static_cast<double>(count));
        packet_words = item(15, "words of a packet", least, 1e6);
        words_before = item(16, "words before a packet", 0, 1e6);
        words.require_size(std::max(
            {constants + constants_there, times + count, packets + count * (packet_words + words_before)}));
        words.require_rising(times, count, "time");
    }
    // Returns the index of a packet's first word.
    std::size_t packet(std::size_t i) const {
        return packets + i * (packet_words + words_before) + words_before;
    }
};

}  // namespace hilcam
