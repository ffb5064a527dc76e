#pragma once
// What CCSDS ephemeris messages have in common in their KVN form (keyword = value notation): lines, epochs,
// frames, time systems. CCSDS 502.0-B-3 (2023) section 7 and 504.0-B-2 (2024) section 6; earlier issues
// differ in the keywords their readers name.

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/text_lines.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {

// A line that says something; blank ones and comments are passed over.
struct KvnLine {
    std::string_view text;        // trimmed
    std::string_view key, value;  // of "KEY = VALUE", trimmed; empty in other lines
};

// A keyword and where it stands.
struct KvnEntry {
    std::string key, value;
    int line = 0;
};

class KvnLines : public TextLines {
  public:
    using TextLines::TextLines;
    bool next(KvnLine& line);
};

// Axes by their SANA names.
enum class CcsdsFrame {
    kIcrf,        // ICRF, GCRF
    kEme2000,     // EME2000, J2000
    kEarthFixed,  // ITRF and its realisations, which differ by less than a metre
    kTeme,        // TEME
    kLvlh,        // LVLH, LVLH_ROTATING: z to the centre, y against the orbit's normal
    kRtn,         // RTN, RSW, QSW, RTN_ROTATING...: x outward, z along the orbit's normal
    kBody,        // SC_BODY, SC_BODY_1...
};
// The frame of that name, if it is one of those accepted. InputError by `lines` otherwise, as of all below.
CcsdsFrame ccsds_frame(const TextLines& lines, const KvnEntry& entry,
                       const std::vector<CcsdsFrame>& accepted);
// UTC, TAI, TT, GPS or TDB.
TimeSystem ccsds_time_system(const TextLines& lines, const KvnEntry& entry);
// "2026-03-20T06:00:00.5" or "2026-079T06:00:00.5", a Z after it or not. line: 0 is the last read.
TimeTai ccsds_epoch(const TextLines& lines, std::string_view text, TimeSystem system, int line = 0);

// kUnsaid: the reader's user chooses.
enum class InterpolationMethod { kUnsaid, kLinear, kLagrange, kHermite };
struct Interpolation {
    InterpolationMethod method = InterpolationMethod::kUnsaid;
    int degree = 0;
};
inline constexpr int kMaxInterpolationDegree = 31;
// How many states it takes: degree + 1, of Hermite half as many, as each has a rate, too.
int interpolation_nodes(const Interpolation& interpolation);

// The span of a segment: from START_TIME to STOP_TIME, which data must not leave, and what of it is to be
// used.
struct SegmentSpan {
    TimeTai start, stop, usable_start, usable_stop;
};

// A segment's keywords as they come, until META_STOP.
class KvnSection {
  public:
    // Reads up to `end`, which stands on a line by itself.
    void read(KvnLines& lines, std::string_view end, const std::vector<std::string_view>& known);
    const KvnEntry* find(std::string_view key) const;
    // InputError when it is missing.
    const KvnEntry& require(const TextLines& lines, std::string_view key) const;
    // START_TIME and the rest, in that time system.
    SegmentSpan span(const TextLines& lines, TimeSystem system) const;
    // The method of the keyword `key`, and INTERPOLATION_DEGREE, which must come with it (LINEAR: 1).
    Interpolation interpolation(const TextLines& lines, std::string_view key) const;

  private:
    std::vector<KvnEntry> entries_;
    int end_line_ = 0;
};

// Steps of time that differ by more than a factor of a million leave an interpolation no digits: refused.
// Samples have a `time`; line: of the segment.
template <class Sample>
void check_steps(const TextLines& lines, const std::vector<Sample>& samples, int line) {
    std::int64_t min_ns = INT64_MAX, max_ns = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const std::int64_t step_ns = samples[i].time - samples[i - 1].time;
        min_ns = std::min(min_ns, step_ns), max_ns = std::max(max_ns, step_ns);
    }
    if (max_ns / 1'000'000 > min_ns)
        lines.fail("the segment that begins here has steps of time from " + std::to_string(min_ns) + " to " +
                       std::to_string(max_ns) + " ns; accepted: within a factor of a million",
                   line);
}

// A data line's numbers, after its epoch.
std::vector<double> data_numbers(const TextLines& lines, std::string_view text, std::string_view& epoch);

}  // namespace hilcam
