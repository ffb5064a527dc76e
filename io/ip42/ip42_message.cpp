#include "io/ip42/ip42_message.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "io/system/text_number.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {
namespace {

constexpr std::int64_t kMaxIndex = 9999;

// A name such as SC[0].B[1].qn: its words, and its indices (-1: none).
struct Name {
    std::string_view thing, part, quantity;
    std::int64_t index = -1, part_index = -1;
};

std::string_view without_blanks(std::string_view text) {
    constexpr std::string_view kSpaces = " \t\r";
    const std::size_t first = text.find_first_not_of(kSpaces);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

// Splits "B[1]" into the word and the index. Returns false for anything else.
bool split_index(std::string_view text, std::string_view& word, std::int64_t& index) {
    const std::size_t open = text.find('[');
    if (open == std::string_view::npos || !text.ends_with(']')) return false;
    const auto value = parsed_as<std::int64_t>(text.substr(open + 1, text.size() - open - 2));
    if (!value || *value < 0 || *value > kMaxIndex) return false;
    word = text.substr(0, open), index = *value;
    return true;
}

std::optional<Name> name_of(std::string_view text) {
    Name name;
    const std::size_t first = text.find('.'), last = text.rfind('.');
    if (first == std::string_view::npos || !split_index(text.substr(0, first), name.thing, name.index))
        return {};
    name.quantity = text.substr(last + 1);
    if (first != last && !split_index(text.substr(first + 1, last - first - 1), name.part, name.part_index))
        return {};
    return name;
}

// Reads "[1 2 3]". Returns false unless there are as many finite numbers as asked for.
bool read_numbers(std::string_view text, std::span<double> values) {
    if (!text.starts_with('[') || !text.ends_with(']')) return false;
    text = text.substr(1, text.size() - 2);
    for (double& value : values) {
        text = without_blanks(text);
        const std::string_view word = text.substr(0, text.find_first_of(" \t"));
        const auto number = number_of(word);
        if (!number) return false;
        value = *number;
        text.remove_prefix(word.size());
    }
    return without_blanks(text).empty();
}

// Reads "2026-079-06:00:00.100000000". 42 rounds seconds when it writes them, so that 60 may also be the next
// minute's 0.
std::optional<TimeTai> read_time(std::string_view text) {
    const std::size_t year = text.find('-');
    const std::size_t day = text.find('-', year + 1);
    const std::size_t hour = text.find(':');
    const std::size_t minute = text.rfind(':');
    if (year == std::string_view::npos || day == std::string_view::npos || hour == std::string_view::npos ||
        hour == minute || hour < day)
        return {};
    const auto whole = [&](std::size_t from, std::size_t until) {
        return parsed_as<int>(text.substr(from, until - from));
    };
    const auto y = whole(0, year), d = whole(year + 1, day), h = whole(day + 1, hour);
    const auto m = whole(hour + 1, minute);
    const auto s = number_of(text.substr(minute + 1));
    if (!y || !d || !h || !m || !s || !(*s >= 0 && *s < 61)) return {};
    auto calendar = calendar_of_day(*y, *d);
    if (!calendar) return {};
    // Whole seconds and their fraction apart, so that nanoseconds are exact.
    const double second = std::fmin(std::floor(*s), 59);
    calendar->hour = *h, calendar->minute = *m, calendar->second = second;
    const auto time = from_calendar(*calendar, TimeSystem::kUtc);
    if (!time) return {};
    const std::int64_t rounded_ns = (time->ns + kSecond_ns / 2) / kSecond_ns * kSecond_ns;
    // From 1972 on TAI - UTC is whole seconds.
    return TimeTai{*y >= 1972 ? rounded_ns : time->ns} + to_ns(*s - second);
}

class Decoder {
  public:
    DecodedIp42 decoded;

    // Returns false at a line that refuses the message.
    bool take(std::string_view line) {
        line = without_blanks(line);
        if (line.empty()) return true;
        if (line.starts_with("TIME ")) return take_time(without_blanks(line.substr(5)));
        const std::size_t equals = line.find('=');
        const auto name = name_of(without_blanks(line.substr(0, equals)));
        if (equals == std::string_view::npos || !name) return skip();
        const std::string_view values = without_blanks(line.substr(equals + 1));
        if (name->thing == "SC") return take_spacecraft(*name, values);
        if (name->thing == "Orb" && name->part.empty()) return take_orbit(*name, values);
        return skip();
    }
    bool has_time() const { return has_time_; }
    void refuse(const std::string& what, std::string_view found, const std::string& accepted) {
        decoded.refusal = what + ": found " + in_quotes(found) + "; accepted: " + accepted;
    }

  private:
    bool has_time_ = false;

    bool skip() {
        ++decoded.message.skipped_lines;
        return true;
    }
    bool take_time(std::string_view text) {
        const auto time = read_time(text);
        if (!time) {
            refuse("TIME", text, "YYYY-DDD-HH:MM:SS.s, UTC, 1950 to 2200");
            return false;
        }
        decoded.message.time = *time;
        return has_time_ = true;
    }
    bool take_vector(const Name& name, std::string_view text, std::optional<Vec3d>& value) {
        std::array<double, 3> v{};
        if (!read_numbers(text, v)) {
            refuse(std::string(name.quantity), text, "[x y z], three finite numbers");
            return false;
        }
        value = Vec3d{v[0], v[1], v[2]};
        return true;
    }
    // 42 has the scalar last. Its quaternion of the passive matrix [BN] is the rotation from the body's axes
    // to those of N (C2Q in Kit/Source/dcmkit.c).
    bool take_rotation(const Name& name, std::string_view text, std::optional<Quat>& value) {
        std::array<double, 4> v{};
        const bool read = read_numbers(text, v);
        const Quat q{v[3], v[0], v[1], v[2]};
        if (!read || !is_turn(q)) {
            refuse(std::string(name.quantity), text, "[x y z w], a quaternion of length 1");
            return false;
        }
        value = normalized(q);
        return true;
    }
    bool take_spacecraft(const Name& name, std::string_view text) {
        if (!name.part.empty() && name.part != "B") return skip();
        const bool is_body = !name.part.empty();
        const bool is_known =
            name.quantity == "qn" || name.quantity == "wn" ||
            (!is_body && (name.quantity == "PosR" || name.quantity == "VelR" || name.quantity == "svb"));
        if (!is_known) return skip();
        Ip42Spacecraft& craft = decoded.message.spacecraft[name.index];
        if (name.quantity == "PosR") return take_vector(name, text, craft.position_r_m);
        if (name.quantity == "VelR") return take_vector(name, text, craft.velocity_r_m_s);
        if (name.quantity == "svb") return take_vector(name, text, craft.sun_body_dir);
        Ip42BodyState& body = craft.bodies[is_body ? name.part_index : 0];
        if (name.quantity == "qn") return take_rotation(name, text, body.n_from_body);
        return take_vector(name, text, body.rate_body_rad_s);
    }
    bool take_orbit(const Name& name, std::string_view text) {
        if (name.quantity == "PosN")
            return take_vector(name, text, decoded.message.orbits[name.index].position_n_m);
        if (name.quantity == "VelN")
            return take_vector(name, text, decoded.message.orbits[name.index].velocity_n_m_s);
        return skip();
    }
};

}  // namespace

DecodedIp42 decode_ip42(std::string_view text) {
    Decoder decoder;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (!decoder.take(text.substr(0, end))) {
            decoder.decoded.refusal = "line " + std::to_string(number) + ": " + decoder.decoded.refusal;
            return std::move(decoder.decoded);
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!decoder.has_time()) decoder.decoded.refusal = "no TIME; accepted: a message that begins with it";
    return std::move(decoder.decoded);
}

std::optional<Ip42BodyName> ip42_body_name(std::string_view text) {
    std::string_view word, part;
    Ip42BodyName name;
    const std::size_t dot = text.find('.');
    if (dot == std::string_view::npos || !split_index(text.substr(0, dot), word, name.spacecraft) ||
        !split_index(text.substr(dot + 1), part, name.body) || word != "SC" || part != "B")
        return {};
    return name;
}

}  // namespace hilcam
