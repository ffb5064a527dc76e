#include "io/preview/preview_request.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/system/text_number.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxFields = 32;
constexpr int kLongestSide_px = 1 << 20;
constexpr int kMaxStep = 256;

constexpr std::array<std::string_view, 10> kSources = {"software", "line0", "action1", "line1", "line2",
                                                       "line3",    "line4", "line5",   "line6", "line7"};
constexpr std::array<std::string_view, 5> kActivations = {"rising_edge", "falling_edge", "any_edge",
                                                          "level_high", "level_low"};
constexpr std::array<std::string_view, 2> kOverlaps = {"off", "read_out"};
constexpr std::array<std::string_view, 2> kExposureModes = {"timed", "trigger_width"};
enum class NumbersFormat { kPng, kTiff };
constexpr std::array<std::string_view, 2> kPictureFormats = {"png", "tiff"};
constexpr std::array<std::string_view, 6> kPatternWords = {
    "off", "black", "white", "ramp_horizontal", "ramp_vertical", "ramp_horizontal_moving"};

bool is_plain_in_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '+' || c == '-';
}

[[noreturn]] void refuse(std::string_view key, std::string_view found, const std::string& accepted) {
    throw InputError("'" + std::string(key) + "' is '" + std::string(found) + "'; accepted: " + accepted);
}

template <class Number>
Number parse_number(std::string_view key, std::string_view text, Number least, Number most) {
    const auto value = parsed_as<Number>(text);
    // Negated, so that NaN is refused.
    if (!value || !(*value >= least && *value <= most)) {
        if constexpr (std::is_floating_point_v<Number>)
            refuse(key, text, "a number");
        else
            refuse(key, text, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    return *value;
}

double parse_real(std::string_view key, std::string_view text) {
    return parse_number<double>(key, text, -1e300, 1e300);
}

bool parse_flag(std::string_view key, std::string_view text) {
    if (text != "0" && text != "1") refuse(key, text, "0 or 1");
    return text == "1";
}

// Parses one of a list of words into the enum with these indices.
template <class Enum, std::size_t N>
Enum parse_word(std::string_view key, std::string_view text, const std::array<std::string_view, N>& words) {
    std::string accepted;
    for (std::size_t i = 0; i < N; ++i) {
        if (text == words[i]) return static_cast<Enum>(i);
        accepted += (i ? ", " : "") + std::string(words[i]);
    }
    refuse(key, text, accepted);
}

void parse_setting(std::string_view key, std::string_view text, double& value) {
    value = parse_real(key, text);
}
void parse_setting(std::string_view key, std::string_view text, bool& value) {
    value = parse_flag(key, text);
}
void parse_setting(std::string_view key, std::string_view text, std::int64_t& value) {
    value = parse_number<std::int64_t>(key, text, 0, 1 << 30);
}
void parse_setting(std::string_view key, std::string_view text, TriggerSource& value) {
    value = parse_word<TriggerSource>(key, text, kSources);
}
void parse_setting(std::string_view key, std::string_view text, TriggerActivation& value) {
    value = parse_word<TriggerActivation>(key, text, kActivations);
}
void parse_setting(std::string_view key, std::string_view text, TriggerOverlap& value) {
    value = parse_word<TriggerOverlap>(key, text, kOverlaps);
}
void parse_setting(std::string_view key, std::string_view text, ExposureMode& value) {
    value = parse_word<ExposureMode>(key, text, kExposureModes);
}
void parse_setting(std::string_view key, std::string_view text, TestPattern& value) {
    value = parse_word<TestPattern>(key, text, kPatternWords);
}

// ":8080"
bool is_port(std::string_view text) {
    return text.size() >= 2 && text.size() <= 6 && text[0] == ':' &&
           std::all_of(text.begin() + 1, text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

[[noreturn]] void refuse_key(std::string_view key, const char* accepted) {
    throw InputError("unknown key '" + std::string(key) + "'; accepted: " + accepted);
}

}  // namespace

FormFields parse_form(std::string_view text) {
    FormFields fields;
    while (!text.empty()) {
        const std::string_view field = text.substr(0, text.find('&'));
        text.remove_prefix(std::min(text.size(), field.size() + 1));
        for (const char c : field)
            if (!is_plain_in_name(c) && c != '=')
                throw InputError("character " + std::to_string(static_cast<unsigned char>(c)) +
                                 " in a request; accepted: letters, digits, _ . + -");
        const std::size_t equals = field.find('=');
        if (equals == std::string_view::npos || equals == 0)
            throw InputError("'" + std::string(field.substr(0, 40)) + "' is not KEY=VALUE");
        if (fields.size() == kMaxFields)
            throw InputError("more than " + std::to_string(kMaxFields) + " keys in a request");
        fields.emplace_back(field.substr(0, equals), field.substr(equals + 1));
    }
    return fields;
}

PictureRequest parse_picture_request(std::string_view query) {
    PictureRequest r;
    const auto pixels = [](auto key, auto text) { return parse_number<int>(key, text, 0, kLongestSide_px); };
    for (const auto& [key, text] : parse_form(query)) {
        if (key == "viewer")
            r.viewer = parse_number<std::uint64_t>(key, text, 0, ~std::uint64_t{0});
        else if (key == "after")
            r.after = parse_number<std::uint64_t>(key, text, 0, ~std::uint64_t{0});
        else if (key == "x")
            r.x = pixels(key, text);
        else if (key == "y")
            r.y = pixels(key, text);
        else if (key == "width")
            r.width = pixels(key, text);
        else if (key == "height")
            r.height = pixels(key, text);
        else if (key == "step")
            r.step = parse_number<int>(key, text, 1, kMaxStep);
        else if (key == "hold")
            r.hold = parse_flag(key, text);
        else if (key == "truth")
            r.truth = parse_flag(key, text);
        else if (key == "light")
            r.light = parse_word<LightPart>(key, text, kLightPartNames);
        else
            refuse_key(key, "viewer, after, x, y, width, height, step, hold, truth, light");
    }
    return r;
}

NumbersRequest parse_numbers_request(std::string_view query) {
    NumbersRequest r;
    for (const auto& [key, text] : parse_form(query)) {
        if (key == "viewer")
            r.viewer = parse_number<std::uint64_t>(key, text, 0, ~std::uint64_t{0});
        else if (key == "frame")
            r.frame = parse_number<std::uint64_t>(key, text, 0, ~std::uint64_t{0});
        else if (key == "format")
            r.tiff = parse_word<NumbersFormat>(key, text, kPictureFormats) == NumbersFormat::kTiff;
        else
            refuse_key(key, "viewer, frame, format");
    }
    return r;
}

std::uint64_t parse_truth_request(std::string_view query) {
    std::uint64_t frame = 0;
    for (const auto& [key, text] : parse_form(query)) {
        if (key != "frame") refuse_key(key, "frame");
        frame = parse_number<std::uint64_t>(key, text, 1, ~std::uint64_t{0});
    }
    if (frame == 0) throw InputError("missing key 'frame'; accepted: frame=ID");
    return frame;
}

SettingsChange parse_settings_change(std::string_view body) {
    SettingsChange c;
    for (const auto& [key, text] : parse_form(body)) {
        bool known = false;
        std::string names;
        visit_settings([&, &key = key, &text = text](std::string_view name, auto, auto wish) {
            names.append(names.empty() ? "" : ", ").append(name);
            if (key != name) return;
            known = true;
            parse_setting(key, text, (c.*wish).emplace());
        });
        if (!known) refuse_key(key, names.c_str());
    }
    return c;
}

TriggerOrder parse_trigger_order(std::string_view body) {
    TriggerOrder order;
    for (const auto& [key, text] : parse_form(body)) {
        if (key == "source")
            order.source = parse_word<TriggerSource>(key, text, kSources);
        else if (key == "frames")
            order.frames = parse_number<std::int64_t>(key, text, 0, 65535);
        else
            refuse_key(key, "source, frames");
    }
    return order;
}

FaultRequest parse_fault_request(std::string_view body) {
    FaultRequest r;
    bool has_kind = false;
    for (const auto& [key, text] : parse_form(body)) {
        if (key == "kind") {
            const auto kind = fault_named(text);
            if (!kind) refuse(key, text, "a name of GET /status, as packet_drop");
            r.order.kind = *kind;
            has_kind = true;
        } else if (key == "rate") {
            r.order.rate = parse_real(key, text);
        } else if (key == "value") {
            r.order.value = parse_real(key, text);
        } else if (key == "from_frame") {
            r.order.from_frame = parse_number<std::uint64_t>(key, text, 0, ~std::uint64_t{0});
        } else if (key == "frames") {
            r.order.frames = parse_number<std::uint64_t>(key, text, 0, 1'000'000'000'000);
        } else if (key == "duration_s") {
            r.order.duration_s = parse_real(key, text);
        } else if (key == "clear_all") {
            r.clear_all = parse_flag(key, text);
        } else {
            refuse_key(key, "kind, rate, value, from_frame, frames, duration_s, clear_all");
        }
    }
    if (r.clear_all) return r;
    if (!has_kind) throw InputError("missing key 'kind'");
    if (const std::string_view why = refusal_of(r.order); !why.empty())
        throw InputError(std::string(name_of(r.order.kind)) + ": " + std::string(why) + " (" +
                         std::string(meaning_of(r.order.kind)) + ")");
    return r;
}

std::string_view name_of(TriggerSource source) { return kSources[static_cast<std::size_t>(source)]; }
std::string_view name_of(TriggerActivation activation) {
    return kActivations[static_cast<std::size_t>(activation)];
}
std::string_view name_of(TriggerOverlap overlap) { return kOverlaps[static_cast<std::size_t>(overlap)]; }
std::string_view name_of(ExposureMode mode) { return kExposureModes[static_cast<std::size_t>(mode)]; }
std::string_view name_of(TestPattern pattern) { return kPatternWords[static_cast<std::size_t>(pattern)]; }

bool is_own_host(std::string_view host, std::string_view machine_name) {
    // "[::1]:8080", "127.0.0.1:8080", "localhost"
    const bool bracketed = host.starts_with('[');
    const std::size_t name_end = bracketed ? host.find(']') : std::min(host.find(':'), host.size());
    if (name_end == std::string_view::npos) return false;
    const std::string_view rest = host.substr(name_end + (bracketed ? 1 : 0));
    if (!rest.empty() && !is_port(rest)) return false;
    const std::string name(bracketed ? host.substr(1, name_end - 1) : host.substr(0, name_end));
    if (name.find('\0') != std::string::npos) return false;
    in6_addr address{};
    if (bracketed) return inet_pton(AF_INET6, name.c_str(), &address) == 1;
    return inet_pton(AF_INET, name.c_str(), &address) == 1 || name == "localhost" ||
           (!machine_name.empty() && name == machine_name);
}

bool is_own_origin(std::string_view origin, std::string_view host) {
    return !host.empty() && origin.starts_with("http://") && origin.substr(7) == host;
}

}  // namespace hilcam
