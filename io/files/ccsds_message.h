#pragma once
// The common part of CCSDS messages (OEM, AEM, OMM): lines, words, epochs, frames, time systems. CCSDS 502.0-B-3 (2023)
// section 7 and 504.0-B-2 (2024) section 6; earlier issues differ in the keywords their readers name.
//
// A message is written as KVN (keyword = value notation) or as XML; ndm_xml.h turns XML into lines of KVN. The reader ignores the case
// of values that are words of the standard, and takes an underscore for a blank (502.0-B-3, 7.5), as STK writes "Lagrange" and
// "Earth". It notes and skips keywords that it does not use.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/ndm_xml.h"
#include "io/files/text_lines.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {

// A line that says something; blank ones and comments are passed over.
struct KvnLine {
    std::string_view text;        // trimmed
    std::string_view key, value;  // the parts of "KEY = VALUE", trimmed; empty in other lines
};

// A keyword and where it stands.
struct KvnEntry {
    std::string key, value;
    int line = 0;
};

class KvnLines : public TextLines {
  public:
    // The text is the caller's. Throws InputError for XML that is not well formed or holds no such message.
    KvnLines(std::string_view text, const std::string& name, NdmKind kind);
    bool next(KvnLine& line);
    // Keeps a remark, "file:12: ..."; a dozen at most, each about another thing. line: 0 is the last read.
    void note(const std::string& about, const std::string& what, int line = 0);
    const std::vector<std::string>& notes() const { return notes_; }

  private:
    NdmText made_;
    std::vector<std::string> notes_, noted_;
};

// Returns a word of the standard as it is compared: in capitals, with single blanks for underscores and runs of blanks.
std::string ccsds_word(std::string_view value);
// True when a value is that word.
bool is_word(std::string_view value, std::string_view word);

// Axes by their SANA names.
enum class CcsdsFrame {
    kIcrf,        // ICRF, GCRF
    kEme2000,     // EME2000, J2000
    kEarthFixed,  // ITRF and its realisations, which differ by less than a metre, and WGS 84
    kTeme,        // TEME
    kTod,         // TOD: the Earth's true equator and equinox
    kMod,         // MOD: the Earth's mean equator and equinox
    kGtod,        // GTOD, TDR, GRC: TOD turned by Greenwich's sidereal time; ITRF but for the pole's motion
    kLvlh,        // LVLH, LVLH_ROTATING: z to the centre, y against the orbit's normal
    kRtn,         // RTN, RSW, QSW, RTN_ROTATING...: x outward, z along the orbit's normal
    kBody,        // SC_BODY, SC_BODY_1, and a part of it: STARTRACKER_1, INSTRUMENT_A, IMU_FRAME_1...
};
// The frame of that name, if it is one of those accepted. InputError by `lines` otherwise, as of all below.
CcsdsFrame ccsds_frame(const TextLines& lines, const KvnEntry& entry,
                       const std::vector<CcsdsFrame>& accepted);
// UTC, TAI, TT, GPS or TDB.
TimeSystem ccsds_time_system(const TextLines& lines, const KvnEntry& entry);
// "2026-03-20T06:00:00.5" or "2026-079T06:00:00.5", a Z after it or not. line: 0 is the last read.
TimeTai ccsds_epoch(const TextLines& lines, std::string_view text, TimeSystem system, int line = 0);
// The date and time that such a text says; nothing where it is none.
std::optional<CalendarTime> ccsds_calendar(std::string_view text);

// kUnsaid: the reader's user chooses.
enum class InterpolationMethod { kUnsaid, kLinear, kLagrange, kHermite };
struct Interpolation {
    InterpolationMethod method = InterpolationMethod::kUnsaid;
    int degree = 0;
};
inline constexpr int kMaxInterpolationDegree = 31;
// Returns how many states it takes: degree + 1, or for Hermite half as many, as each has a rate, too; an even degree of
// Hermite takes as many as the next odd one.
int interpolation_nodes(const Interpolation& interpolation);

// The span of a segment: from START_TIME to STOP_TIME, which data must not leave, and what of it is to be
// used.
struct SegmentSpan {
    TimeTai start, stop, usable_start, usable_stop;
};

// A segment's keywords as they come, until META_STOP.
class KvnSection {
  public:
    // Reads up to `end`, which stands on a line by itself. Keywords that are not among those known are noted.
    void read(KvnLines& lines, std::string_view end, const std::vector<std::string_view>& known);
    const KvnEntry* find(std::string_view key) const;
    // InputError when it is missing.
    const KvnEntry& require(const TextLines& lines, std::string_view key) const;
    // START_TIME and the rest, in that time system.
    SegmentSpan span(const TextLines& lines, TimeSystem system) const;
    // The method of the keyword `key`, and INTERPOLATION_DEGREE, which must come with it (LINEAR: 1).
    Interpolation interpolation(KvnLines& lines, std::string_view key) const;

  private:
    std::vector<KvnEntry> entries_;
    int end_line_ = 0;
};

// The epoch at which the axes of REF_FRAME stand still (TEME, TOD and MOD of REF_FRAME_EPOCH); nothing for those of date.
// Frames that have no epoch of their own refuse another than J2000.
std::optional<TimeTai> frame_epoch(const TextLines& lines, const KvnSection& meta, CcsdsFrame frame,
                                   TimeSystem system);

// A value without the unit that KVN may have behind it in brackets. InputError for another unit than the standard's; `where`
// is its place, "file:12".
std::string without_unit(const std::string& where, const KvnEntry& entry);

// Steps of time that differ by more than a factor of a million leave an interpolation no digits: refused.
// Samples have a `time`; epochs that are repeated are passed over (repeated_epochs.h). line: of the segment.
template <class Sample>
void check_steps(const TextLines& lines, const std::vector<Sample>& samples, int line) {
    std::int64_t min_ns = INT64_MAX, max_ns = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const std::int64_t step_ns = samples[i].time - samples[i - 1].time;
        if (step_ns > 0) min_ns = std::min(min_ns, step_ns), max_ns = std::max(max_ns, step_ns);
    }
    if (max_ns == 0) lines.fail("the segment that begins here has no two epochs that differ", line);
    if (max_ns / 1'000'000 > min_ns)
        lines.fail("the segment that begins here has steps of time from " + std::to_string(min_ns) + " to " +
                       std::to_string(max_ns) + " ns; accepted: within a factor of a million",
                   line);
}

// A data line's numbers, after its epoch; Fortran's D of an exponent is taken.
std::vector<double> data_numbers(const TextLines& lines, std::string_view text, std::string_view& epoch);

}  // namespace hilcam
