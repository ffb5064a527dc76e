#include "io/files/ccsds_message.h"

#include <algorithm>
#include <array>

namespace hilcam {
namespace {

// Splits "KEY = VALUE"; a key has capitals, digits and underscores.
bool split(std::string_view text, KvnLine& line) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return false;
    line.key = trimmed(text.substr(0, equals));
    line.value = trimmed(text.substr(equals + 1));
    return !line.key.empty() && std::all_of(line.key.begin(), line.key.end(), [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
}

bool starts_keyword(std::string_view text, std::string_view word) {
    return text.starts_with(word) &&
           (text.size() == word.size() || text[word.size()] == ' ' || text[word.size()] == '\t');
}

// Equatorial axes may be those of an epoch.
enum class Epoch { kNone, kMayBe, kOfDate, kMustBe };
struct FrameName {
    std::string_view name;  // the word (ccsds_word()); a star matches any ending
    CcsdsFrame frame;
    Epoch epoch = Epoch::kNone;
};
// The SANA registries "Celestial Body Reference Frames", "Orbit-Relative Reference Frames" and "Spacecraft
// Body Reference Frames", and the names of the standards' earlier annexes.
constexpr std::array<FrameName, 56> kFrameNames = {{
    {"ICRF", CcsdsFrame::kIcrf},
    {"GCRF", CcsdsFrame::kIcrf},
    {"EME2000", CcsdsFrame::kEme2000},
    {"J2000", CcsdsFrame::kEme2000},
    {"TEME", CcsdsFrame::kTeme, Epoch::kMayBe},
    {"TEMEOFDATE", CcsdsFrame::kTeme, Epoch::kOfDate},
    {"TEMEOFEPOCH", CcsdsFrame::kTeme, Epoch::kMustBe},
    {"TOD", CcsdsFrame::kTod, Epoch::kMayBe},
    {"TOD EARTH", CcsdsFrame::kTod, Epoch::kOfDate},
    {"TODEARTH", CcsdsFrame::kTod, Epoch::kOfDate},
    {"TOE EARTH", CcsdsFrame::kTod, Epoch::kMustBe},
    {"MOD", CcsdsFrame::kMod, Epoch::kMayBe},
    {"MOD EARTH", CcsdsFrame::kMod, Epoch::kOfDate},
    {"MODEARTH", CcsdsFrame::kMod, Epoch::kOfDate},
    {"MOE EARTH", CcsdsFrame::kMod, Epoch::kMustBe},
    {"GTOD", CcsdsFrame::kGtod},
    {"TDR", CcsdsFrame::kGtod},
    {"GRC", CcsdsFrame::kGtod},
    {"ITRF*", CcsdsFrame::kEarthFixed},
    {"WGS84*", CcsdsFrame::kEarthFixed},
    {"WGS-84*", CcsdsFrame::kEarthFixed},
    {"LVLH", CcsdsFrame::kLvlh},
    {"LVLH ROTATING", CcsdsFrame::kLvlh},
    {"RTN", CcsdsFrame::kRtn},
    {"RSW", CcsdsFrame::kRtn},
    {"QSW", CcsdsFrame::kRtn},
    {"RTN ROTATING", CcsdsFrame::kRtn},
    {"RSW ROTATING", CcsdsFrame::kRtn},
    {"QSW ROTATING", CcsdsFrame::kRtn},
    {"SC BODY", CcsdsFrame::kBody},
    {"SC BODY *", CcsdsFrame::kBody},
    {"STARTRACKER", CcsdsFrame::kBody},
    {"STARTRACKER *", CcsdsFrame::kBody},
    {"INSTRUMENT", CcsdsFrame::kBody},
    {"INSTRUMENT *", CcsdsFrame::kBody},
    {"SENSOR", CcsdsFrame::kBody},
    {"SENSOR *", CcsdsFrame::kBody},
    {"ACTUATOR", CcsdsFrame::kBody},
    {"ACTUATOR *", CcsdsFrame::kBody},
    {"IMU", CcsdsFrame::kBody},
    {"IMU *", CcsdsFrame::kBody},
    {"GYRO", CcsdsFrame::kBody},
    {"GYRO *", CcsdsFrame::kBody},
    {"AST", CcsdsFrame::kBody},
    {"AST *", CcsdsFrame::kBody},
    {"CSS *", CcsdsFrame::kBody},
    {"DSS *", CcsdsFrame::kBody},
    {"ESA *", CcsdsFrame::kBody},
    {"ISA *", CcsdsFrame::kBody},
    {"RW *", CcsdsFrame::kBody},
    {"SA *", CcsdsFrame::kBody},
    {"TAM *", CcsdsFrame::kBody},
    {"MTA *", CcsdsFrame::kBody},
    {"THR *", CcsdsFrame::kBody},
    {"CAMERA", CcsdsFrame::kBody},
    {"CAMERA *", CcsdsFrame::kBody},
}};

bool is_named(const FrameName& frame, std::string_view word) {
    if (!frame.name.ends_with('*')) return frame.name == word;
    return word.starts_with(frame.name.substr(0, frame.name.size() - 1));
}

// Returns a name as messages write it.
std::string written(std::string_view name) {
    std::string out(name);
    std::replace(out.begin(), out.end(), ' ', '_');
    return out;
}

constexpr std::size_t kMaxNotes = 12;

}  // namespace

KvnLines::KvnLines(std::string_view text, const std::string& name, NdmKind kind) : TextLines(text, name) {
    if (!is_xml(rest())) return;
    made_ = kvn_of_xml(rest(), name, kind);
    go_on_with(made_.text, made_.lines);
}

void KvnLines::note(const std::string& about, const std::string& what, int line) {
    if (notes_.size() == kMaxNotes || std::find(noted_.begin(), noted_.end(), about) != noted_.end()) return;
    noted_.push_back(about);
    notes_.push_back(name() + ":" + std::to_string(line ? line : number()) + ": " + what);
}

std::string ccsds_word(std::string_view value) {
    std::string out;
    for (const char c : value) {
        const bool blank = c == '_' || c == ' ' || c == '\t';
        if (blank && (out.empty() || out.back() == ' ')) continue;
        out += blank ? ' ' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    if (out.ends_with(' ')) out.pop_back();
    return out;
}

bool is_word(std::string_view value, std::string_view word) { return ccsds_word(value) == ccsds_word(word); }

bool KvnLines::next(KvnLine& line) {
    std::string_view text;
    while (TextLines::next(text)) {
        text = trimmed(text);
        if (text.empty() || starts_keyword(text, "COMMENT")) continue;
        line = {text, {}, {}};
        if (!split(text, line)) line.key = line.value = {};
        return true;
    }
    return false;
}

CcsdsFrame ccsds_frame(const TextLines& lines, const KvnEntry& entry,
                       const std::vector<CcsdsFrame>& accepted) {
    std::string names;
    const std::string word = ccsds_word(entry.value);
    for (const FrameName& known : kFrameNames) {
        if (std::find(accepted.begin(), accepted.end(), known.frame) == accepted.end()) continue;
        if (is_named(known, word)) return known.frame;
        names += (names.empty() ? "" : ", ") + written(known.name);
    }
    lines.refuse(entry.value, entry.key + " of " + names, entry.line);
}

TimeSystem ccsds_time_system(const TextLines& lines, const KvnEntry& entry) {
    const std::string name = ccsds_word(entry.value);
    if (name == "UTC") return TimeSystem::kUtc;
    if (name == "TAI") return TimeSystem::kTai;
    if (name == "TT") return TimeSystem::kTt;
    if (name == "GPS") return TimeSystem::kGps;
    if (name == "TDB") return TimeSystem::kTdb;
    lines.refuse(entry.value, entry.key + " of UTC, TAI, TT, GPS, TDB", entry.line);
}

std::optional<CalendarTime> ccsds_calendar(std::string_view text) {
    std::string_view rest = text;
    if (rest.ends_with('Z')) rest.remove_suffix(1);
    const std::size_t t = rest.find('T');
    if (t == std::string_view::npos || rest.size() < t + 9 || rest[t + 3] != ':' || rest[t + 6] != ':')
        return {};
    // from_chars() accepts a minus sign, which no field may have.
    bool good = true;
    const auto field = [&](std::size_t at, std::size_t size) {
        const auto value = parsed_as<int>(rest.substr(at, size));
        good = good && value && *value >= 0;
        return value.value_or(0);
    };
    std::optional<CalendarTime> calendar = CalendarTime{};
    if (t == 10 && rest[4] == '-' && rest[7] == '-')
        calendar->year = field(0, 4), calendar->month = field(5, 2), calendar->day = field(8, 2);
    else if (t == 8 && rest[4] == '-')
        calendar = calendar_of_day(field(0, 4), field(5, 3));
    else
        return {};
    if (!calendar) return {};
    calendar->hour = field(t + 1, 2), calendar->minute = field(t + 4, 2);
    const std::string_view digits = rest.substr(t + 7);
    const auto second = number_of(digits);
    if (!good || !second || digits[0] < '0' || digits[0] > '9') return {};
    calendar->second = *second;
    return calendar;
}

TimeTai ccsds_epoch(const TextLines& lines, std::string_view text, TimeSystem system, int line) {
    const std::optional<CalendarTime> calendar = ccsds_calendar(text);
    if (!calendar) lines.refuse(text, "an epoch as 2026-03-20T06:00:00.5 or 2026-079T06:00:00.5", line);
    const std::optional<TimeTai> time = from_calendar(*calendar, system);
    if (!time) lines.refuse(text, "an instant that exists, of the years 1950 to 2200", line);
    return *time;
}

int interpolation_nodes(const Interpolation& i) {
    switch (i.method) {
        case InterpolationMethod::kHermite:
            // At least two states: degree 1 is a line between two, and their slopes are used as well.
            return std::max(2, (i.degree + 2) / 2);
        case InterpolationMethod::kLagrange:
            return i.degree + 1;
        case InterpolationMethod::kLinear:
        case InterpolationMethod::kUnsaid:
            break;
    }
    return 2;
}

void KvnSection::read(KvnLines& lines, std::string_view end, const std::vector<std::string_view>& known) {
    for (KvnLine line; lines.next(line);) {
        if (line.text == end) {
            end_line_ = lines.number();
            return;
        }
        if (line.key.empty()) lines.refuse(line.text, "KEY = VALUE, or " + std::string(end));
        if (std::find(known.begin(), known.end(), line.key) == known.end()) {
            lines.note(std::string(line.key), "the keyword " + in_quotes(line.key) + " is not used");
            continue;
        }
        if (find(line.key)) lines.fail(std::string(line.key) + " is given twice");
        if (line.value.empty()) lines.fail(std::string(line.key) + " has no value");
        entries_.push_back({std::string(line.key), std::string(line.value), lines.number()});
    }
    lines.fail("the file ends; accepted: " + std::string(end));
}

const KvnEntry* KvnSection::find(std::string_view key) const {
    const auto at =
        std::find_if(entries_.begin(), entries_.end(), [&](const KvnEntry& e) { return e.key == key; });
    return at == entries_.end() ? nullptr : &*at;
}

const KvnEntry& KvnSection::require(const TextLines& lines, std::string_view key) const {
    if (const KvnEntry* entry = find(key)) return *entry;
    lines.fail("the section that ends here has no " + std::string(key), end_line_);
}

SegmentSpan KvnSection::span(const TextLines& lines, TimeSystem system) const {
    const auto time = [&](const KvnEntry& entry) {
        return ccsds_epoch(lines, entry.value, system, entry.line);
    };
    SegmentSpan span;
    span.start = span.usable_start = time(require(lines, "START_TIME"));
    span.stop = span.usable_stop = time(require(lines, "STOP_TIME"));
    if (const KvnEntry* entry = find("USEABLE_START_TIME")) span.usable_start = time(*entry);
    if (const KvnEntry* entry = find("USEABLE_STOP_TIME")) span.usable_stop = time(*entry);
    if (!(span.start <= span.usable_start && span.usable_start <= span.usable_stop &&
          span.usable_stop <= span.stop))
        lines.fail("START_TIME, USEABLE_START_TIME, USEABLE_STOP_TIME and STOP_TIME are out of order",
                   require(lines, "START_TIME").line);
    return span;
}

Interpolation KvnSection::interpolation(KvnLines& lines, std::string_view key) const {
    const KvnEntry* method = find(key);
    const KvnEntry* degree = find("INTERPOLATION_DEGREE");
    if (!method) {
        if (degree)
            lines.note("INTERPOLATION_DEGREE",
                       "INTERPOLATION_DEGREE is not used, as there is no " + std::string(key), degree->line);
        return {};
    }
    Interpolation out;
    if (is_word(method->value, "LINEAR"))
        out = {InterpolationMethod::kLinear, 1};
    else if (is_word(method->value, "LAGRANGE"))
        out.method = InterpolationMethod::kLagrange;
    else if (is_word(method->value, "HERMITE"))
        out.method = InterpolationMethod::kHermite;
    else
        lines.refuse(method->value, std::string(key) + " of LINEAR, LAGRANGE, HERMITE", method->line);
    if (!degree && out.method == InterpolationMethod::kLinear) return out;
    const KvnEntry& given = require(lines, "INTERPOLATION_DEGREE");
    const auto number = parsed_as<int>(without_unit(lines.name() + ":" + std::to_string(given.line), given));
    const bool linear = out.method == InterpolationMethod::kLinear;
    if (!number || *number < 1 || *number > (linear ? 1 : kMaxInterpolationDegree))
        lines.refuse(
            degree->value,
            "INTERPOLATION_DEGREE 1 to " + std::to_string(kMaxInterpolationDegree) + ", 1 with LINEAR",
            degree->line);
    out.degree = *number;
    return out;
}

std::optional<TimeTai> frame_epoch(const TextLines& lines, const KvnSection& meta, CcsdsFrame frame,
                                   TimeSystem system) {
    const KvnEntry& name = meta.require(lines, "REF_FRAME");
    const KvnEntry* const entry = meta.find("REF_FRAME_EPOCH");
    const std::string word = ccsds_word(name.value);
    const auto* const known = std::find_if(kFrameNames.begin(), kFrameNames.end(),
                                           [&](const FrameName& f) { return is_named(f, word); });
    const Epoch rule = known == kFrameNames.end() ? Epoch::kNone : known->epoch;
    if (!entry) {
        if (rule == Epoch::kMustBe)
            lines.fail("REF_FRAME " + in_quotes(name.value) + " without REF_FRAME_EPOCH", name.line);
        return {};
    }
    const TimeTai epoch = ccsds_epoch(lines, entry->value, system, entry->line);
    if (rule == Epoch::kMayBe || rule == Epoch::kMustBe) return epoch;
    // J2000 is these axes' own epoch; time systems differ by less than two minutes.
    const bool inertial = frame == CcsdsFrame::kEme2000 || frame == CcsdsFrame::kIcrf;
    const std::int64_t from_j2000_ns = epoch - *from_calendar({2000, 1, 1, 12, 0, 0}, TimeSystem::kTt);
    constexpr std::int64_t kSame_ns = 120'000'000'000;
    if (inertial && from_j2000_ns >= -kSame_ns && from_j2000_ns <= kSame_ns) return {};
    lines.refuse(entry->value,
                 "no REF_FRAME_EPOCH, as " + in_quotes(name.value) +
                     " has none of its own; it goes with TEME, TOD, MOD",
                 entry->line);
}

std::string without_unit(const std::string& where, const KvnEntry& entry) {
    const std::string_view value = entry.value;
    const std::size_t at = value.find('[');
    if (at == std::string_view::npos || !value.ends_with(']')) return entry.value;
    const std::string_view unit = trimmed(value.substr(at + 1, value.size() - at - 2));
    const std::string_view own = unit_of_keyword(entry.key);
    const bool none = own.empty() && (unit.empty() || is_unit(unit, "n/a") || unit == "-" || unit == "1");
    if (!none && !is_unit(unit, own))
        throw InputError(where + ": found " + in_quotes(unit) + "; accepted: " + entry.key +
                         (own.empty() ? " without a unit" : " in " + std::string(own)));
    return std::string(trimmed(value.substr(0, at)));
}

std::vector<double> data_numbers(const TextLines& lines, std::string_view text, std::string_view& epoch) {
    std::vector<double> numbers;
    epoch = {};
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find_first_of(" \t"));
        if (epoch.empty()) {
            epoch = word;
        } else {
            const auto value = fortran_number_of(word);
            if (!value) lines.refuse(word, "a number");
            numbers.push_back(*value);
        }
        text = trimmed(text.substr(word.size()));
    }
    return numbers;
}

}  // namespace hilcam
