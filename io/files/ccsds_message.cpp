#include "io/files/ccsds_message.h"

#include <algorithm>
#include <array>

namespace hilcam {
namespace {

// "KEY = VALUE": the key is of capitals, digits and underscores.
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

struct FrameName {
    std::string_view name;
    CcsdsFrame frame;
};
constexpr std::array<FrameName, 17> kFrameNames = {{{"ICRF", CcsdsFrame::kIcrf},
                                                    {"GCRF", CcsdsFrame::kIcrf},
                                                    {"EME2000", CcsdsFrame::kEme2000},
                                                    {"J2000", CcsdsFrame::kEme2000},
                                                    {"TEME", CcsdsFrame::kTeme},
                                                    {"ITRF", CcsdsFrame::kEarthFixed},
                                                    {"LVLH", CcsdsFrame::kLvlh},
                                                    {"LVLH_ROTATING", CcsdsFrame::kLvlh},
                                                    {"RTN", CcsdsFrame::kRtn},
                                                    {"RSW", CcsdsFrame::kRtn},
                                                    {"QSW", CcsdsFrame::kRtn},
                                                    {"RTN_ROTATING", CcsdsFrame::kRtn},
                                                    {"RSW_ROTATING", CcsdsFrame::kRtn},
                                                    {"QSW_ROTATING", CcsdsFrame::kRtn},
                                                    {"SC_BODY", CcsdsFrame::kBody},
                                                    {"SC_BODY_n", CcsdsFrame::kBody},
                                                    {"ITRFyyyy", CcsdsFrame::kEarthFixed}}};

bool is_named(const FrameName& frame, std::string_view name) {
    if (frame.name == "SC_BODY_n") return name.starts_with("SC_BODY_");
    if (frame.name == "ITRFyyyy") return name.starts_with("ITRF");
    return frame.name == name;
}

}  // namespace

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
    for (const FrameName& known : kFrameNames) {
        if (std::find(accepted.begin(), accepted.end(), known.frame) == accepted.end()) continue;
        if (is_named(known, entry.value)) return known.frame;
        names += (names.empty() ? "" : ", ") + std::string(known.name);
    }
    lines.refuse(entry.value, entry.key + " of " + names, entry.line);
}

TimeSystem ccsds_time_system(const TextLines& lines, const KvnEntry& entry) {
    const std::string& name = entry.value;
    if (name == "UTC") return TimeSystem::kUtc;
    if (name == "TAI") return TimeSystem::kTai;
    if (name == "TT") return TimeSystem::kTt;
    if (name == "GPS") return TimeSystem::kGps;
    if (name == "TDB") return TimeSystem::kTdb;
    lines.refuse(name, entry.key + " of UTC, TAI, TT, GPS, TDB", entry.line);
}

TimeTai ccsds_epoch(const TextLines& lines, std::string_view text, TimeSystem system, int line) {
    const auto refuse = [&] {
        lines.refuse(text, "an epoch as 2026-03-20T06:00:00.5 or 2026-079T06:00:00.5", line);
    };
    std::string_view rest = text;
    if (rest.ends_with('Z')) rest.remove_suffix(1);
    const std::size_t t = rest.find('T');
    if (t == std::string_view::npos || rest.size() < t + 9 || rest[t + 3] != ':' || rest[t + 6] != ':')
        refuse();
    // from_chars() takes a minus sign, which no field may have.
    const auto field = [&](std::size_t at, std::size_t size) {
        const auto value = parsed_as<int>(rest.substr(at, size));
        if (!value || *value < 0) refuse();
        return value.value_or(0);
    };
    CalendarTime calendar;
    if (t == 10 && rest[4] == '-' && rest[7] == '-') {
        calendar.year = field(0, 4), calendar.month = field(5, 2), calendar.day = field(8, 2);
    } else if (t == 8 && rest[4] == '-') {
        const auto day = calendar_of_day(field(0, 4), field(5, 3));
        if (!day) refuse();
        calendar = *day;
    } else {
        refuse();
    }
    calendar.hour = field(t + 1, 2), calendar.minute = field(t + 4, 2);
    const std::string_view digits = rest.substr(t + 7);
    const auto second = number_of(digits);
    if (!second || digits[0] < '0' || digits[0] > '9') refuse();
    calendar.second = *second;
    const std::optional<TimeTai> time = from_calendar(calendar, system);
    if (!time) lines.refuse(text, "an instant that exists, of the years 1950 to 2200", line);
    return *time;
}

int interpolation_nodes(const Interpolation& i) {
    switch (i.method) {
        case InterpolationMethod::kHermite:
            // One state has no neighbour to go to: degree 1 is a line between two, here with their slopes.
            return std::max(2, (i.degree + 1) / 2);
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
        if (std::find(known.begin(), known.end(), line.key) == known.end())
            lines.refuse(line.key, "a keyword of this section of the message");
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

Interpolation KvnSection::interpolation(const TextLines& lines, std::string_view key) const {
    const KvnEntry* method = find(key);
    const KvnEntry* degree = find("INTERPOLATION_DEGREE");
    if (!method) {
        if (degree) lines.fail("INTERPOLATION_DEGREE without " + std::string(key), degree->line);
        return {};
    }
    Interpolation out;
    if (method->value == "LINEAR")
        out = {InterpolationMethod::kLinear, 1};
    else if (method->value == "LAGRANGE")
        out.method = InterpolationMethod::kLagrange;
    else if (method->value == "HERMITE")
        out.method = InterpolationMethod::kHermite;
    else
        lines.refuse(method->value, std::string(key) + " of LINEAR, LAGRANGE, HERMITE", method->line);
    if (!degree && out.method == InterpolationMethod::kLinear) return out;
    const auto number = parsed_as<int>(require(lines, "INTERPOLATION_DEGREE").value);
    const bool odd = number && *number % 2 == 1;
    const bool linear = out.method == InterpolationMethod::kLinear;
    if (!number || *number < 1 || *number > (linear ? 1 : kMaxInterpolationDegree) ||
        (out.method == InterpolationMethod::kHermite && !odd))
        lines.refuse(degree->value,
                     "INTERPOLATION_DEGREE 1 to " + std::to_string(kMaxInterpolationDegree) +
                         ", odd with HERMITE, 1 with LINEAR",
                     degree->line);
    out.degree = *number;
    return out;
}

std::vector<double> data_numbers(const TextLines& lines, std::string_view text, std::string_view& epoch) {
    std::vector<double> numbers;
    epoch = {};
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find_first_of(" \t"));
        if (epoch.empty()) {
            epoch = word;
        } else {
            const auto value = number_of(word);
            if (!value) lines.refuse(word, "a number");
            numbers.push_back(*value);
        }
        text = trimmed(text.substr(word.size()));
    }
    return numbers;
}

}  // namespace hilcam
