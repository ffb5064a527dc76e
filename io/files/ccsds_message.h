#pragma once
// The part that OEM, AEM and OMM have in common: lines, words, epochs, frames, time systems. CCSDS 502.0-B-3
// (2023) section 7 and 504.0-B-2 (2024) section 6; earlier issues differ in keywords that their readers name.
//
// A message is KVN (keyword = value notation) or XML, which ndm_xml.h turns into lines of KVN. For values
// that are words of the standard, the reader ignores case and treats an underscore as a blank (502.0-B-3,
// 7.5): STK writes "Lagrange" and "Earth". Keywords that it does not use are noted and skipped.

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

// A line with content; blank lines and comments are skipped.
struct KvnLine {
    std::string_view text;        // trimmed
    std::string_view key, value;  // the two parts of "KEY = VALUE", trimmed; empty in other lines
};

// A keyword with its value and line.
struct KvnEntry {
    std::string key, value;
    int line = 0;
};

class KvnLines : public TextLines {
  public:
    // text: must outlive this. Throws InputError for XML that is malformed or has no such message.
    KvnLines(std::string_view text, const std::string& name, NdmKind kind);
    bool next(KvnLine& line);
    // Keeps a remark, "file:12: ...", one for each `about` and a dozen at most. line: 0 is the line last
    // read.
    void note(const std::string& about, const std::string& what, int line = 0);
    const std::vector<std::string>& notes() const { return notes_; }

  private:
    NdmText made_;
    std::vector<std::string> notes_, noted_;
};

// Returns a word of the standard in the form for comparison: capitals, with a single blank for underscores
// and runs of blanks.
std::string ccsds_word(std::string_view value);
// True when a value is that word of the standard.
bool is_word(std::string_view value, std::string_view word);

// Axes, by their SANA names.
enum class CcsdsFrame {
    kIcrf,        // ICRF, GCRF
    kEme2000,     // EME2000, J2000
    kEarthFixed,  // ITRF and its realisations, which differ by less than a metre, and WGS 84
    kTeme,        // TEME
    kTod,         // TOD: the Earth's true equator and equinox
    kMod,         // MOD: the Earth's mean equator and equinox
    kGtod,        // GTOD, TDR, GRC: TOD turned by Greenwich sidereal time; ITRF without polar motion
    kLvlh,        // LVLH, LVLH_ROTATING: z to the centre, y opposite the orbit normal
    kRtn,         // RTN, RSW, QSW, RTN_ROTATING...: x outward, z along the orbit normal
    kBody,        // SC_BODY, SC_BODY_1, and a part of it: STARTRACKER_1, INSTRUMENT_A, IMU_FRAME_1...
};
// Returns the frame of that name. Throws InputError, as all functions below, when it is not among `accepted`.
CcsdsFrame ccsds_frame(const TextLines& lines, const KvnEntry& entry,
                       const std::vector<CcsdsFrame>& accepted);
// Returns UTC, TAI, TT, GPS or TDB.
TimeSystem ccsds_time_system(const TextLines& lines, const KvnEntry& entry);
// Parses "2026-03-20T06:00:00.5" or "2026-079T06:00:00.5", with or without a final Z. line: 0 is the line
// last read.
TimeTai ccsds_epoch(const TextLines& lines, std::string_view text, TimeSystem system, int line = 0);
// Returns the date and time of such a text; nothing when it is malformed.
std::optional<CalendarTime> ccsds_calendar(std::string_view text);

// kUnsaid: the caller chooses.
enum class InterpolationMethod { kUnsaid, kLinear, kLagrange, kHermite };
struct Interpolation {
    InterpolationMethod method = InterpolationMethod::kUnsaid;
    int degree = 0;
};
inline constexpr int kMaxInterpolationDegree = 31;
// Returns how many states the interpolation needs: degree + 1, or for Hermite half as many, because each
// state has a rate. An even Hermite degree needs as many as the next odd one.
int interpolation_nodes(const Interpolation& interpolation);

// The span of a segment, START_TIME to STOP_TIME, which its data must not leave, and the usable part of it.
struct SegmentSpan {
    TimeTai start, stop, usable_start, usable_stop;
};

// The keywords of a segment, up to META_STOP.
class KvnSection {
  public:
    // Reads up to `end`, which is a line of its own. Notes keywords that are not in `known`.
    void read(KvnLines& lines, std::string_view end, const std::vector<std::string_view>& known);
    const KvnEntry* find(std::string_view key) const;
    // Returns the entry; InputError when it is missing.
    const KvnEntry& require(const TextLines& lines, std::string_view key) const;
    // Returns the span from START_TIME, STOP_TIME and the usable times, in that time system.
    SegmentSpan span(const TextLines& lines, TimeSystem system) const;
    // Returns the method in the keyword `key`, and INTERPOLATION_DEGREE, which must accompany it (LINEAR: 1).
    Interpolation interpolation(KvnLines& lines, std::string_view key) const;

  private:
    std::vector<KvnEntry> entries_;
    int end_line_ = 0;
};

// Returns the epoch at which the axes of REF_FRAME are frozen (TEME, TOD and MOD with REF_FRAME_EPOCH);
// nothing for axes of date. A frame without an epoch of its own accepts J2000 only.
std::optional<TimeTai> frame_epoch(const TextLines& lines, const KvnSection& meta, CcsdsFrame frame,
                                   TimeSystem system);

// Returns a value without the unit in brackets that KVN may append. Throws InputError for a unit other than
// the standard's. where: the place, "file:12".
std::string without_unit(const std::string& where, const KvnEntry& entry);

// Refuses time steps that differ by more than a factor of a million, which leave an interpolation no digits.
// Repeated epochs are skipped (repeated_epochs.h). Each sample has a `time`; line: of the segment.
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

// Returns the numbers of a data line and sets `epoch` to its first word. Exponents may have Fortran's D.
std::vector<double> data_numbers(const TextLines& lines, std::string_view text, std::string_view& epoch);

}  // namespace hilcam
