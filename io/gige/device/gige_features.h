#pragma once
// The table of the camera's features: SFNC names, registers, access and limits. The GenICam description is
// generated from it. The gige_*.cpp of each concept implements reading and writing; a test compares the two.

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/contract/camera_control.h"
#include "io/gige/device/gige_registers.h"
#include "io/lines/camera_lines.h"

namespace hilcam {

inline constexpr double kMax64 = 9.2e18;  // a limit below the largest 64-bit integer of GenICam

struct EnumEntry {
    std::string name;
    std::uint64_t value;
};

// A limit: a number, or the name of the feature that holds it.
struct Bound {
    Bound() = default;
    template <class Number>
    requires std::is_arithmetic_v<Number> Bound(Number n) : number(static_cast<double>(n)) {}
    Bound(const char* name) : feature(name) {}
    double number = 0;
    std::string feature{};
};

struct Feature {
    enum class Kind { kInteger, kFloat, kEnumeration, kCommand, kBoolean, kString } kind{};
    enum class Access { kRead, kReadWrite, kWrite } access = Access::kReadWrite;
    std::string category{};  // empty: only other features refer to it
    std::string name{};
    std::string meaning{};
    std::uint32_t address = 0;
    std::uint32_t bytes = 4;
    bool is_constant = false;  // the feature is `value` and has no register
    std::uint64_t value = 0;
    bool limited = false;
    Bound least{}, most{};
    double step = 1;
    std::string unit_name{}, representation{}, visibility{};
    std::vector<EnumEntry> entries{};
    int high_bit = -1, low_bit = -1;  // bits of a register that several features share; bit 0 is the lowest
    bool is_signed = false;
    std::string lock{};  // the feature that locks it when not 0
    std::vector<std::string> selected{};
    std::string port = "Device";
    std::string address_feature{};  // added to the address

    // --- modifiers, which make a table readable
    Feature&& between(Bound low, Bound high) && {
        limited = true, least = std::move(low), most = std::move(high);
        return std::move(*this);
    }
    Feature&& every(double s) && { return step = s, std::move(*this); }
    Feature&& unit(const char* u) && { return unit_name = std::string(u), std::move(*this); }
    Feature&& as(const char* r) && { return representation = std::string(r), std::move(*this); }
    Feature&& invisible() && { return visibility = std::string("Invisible"), std::move(*this); }
    Feature&& read_only(bool yes = true) && {
        if (yes) access = Access::kRead;
        return std::move(*this);
    }
    Feature&& writable() && { return access = Access::kReadWrite, std::move(*this); }
    Feature&& write_only() && { return access = Access::kWrite, std::move(*this); }
    Feature&& bits(int high, int low) && { return high_bit = high, low_bit = low, std::move(*this); }
    Feature&& bit(int n) && { return high_bit = low_bit = n, std::move(*this); }
    Feature&& locked_by(const char* f) && { return lock = std::string(f), std::move(*this); }
    Feature&& locked() && { return lock = std::string("TLParamsLocked"), std::move(*this); }
    Feature&& selects(std::vector<std::string> names) && {
        return selected = std::move(names), std::move(*this);
    }
};

inline Feature integer(const char* name, std::uint32_t address, const char* meaning) {
    return {.kind = Feature::Kind::kInteger, .name = name, .meaning = meaning, .address = address};
}
inline Feature integer64(const char* name, std::uint32_t address, const char* meaning) {
    return {
        .kind = Feature::Kind::kInteger, .name = name, .meaning = meaning, .address = address, .bytes = 8};
}
inline Feature real(const char* name, std::uint32_t address, const char* meaning) {
    return {.kind = Feature::Kind::kFloat, .name = name, .meaning = meaning, .address = address, .bytes = 8};
}
inline Feature boolean(const char* name, std::uint32_t address, const char* meaning) {
    return {.kind = Feature::Kind::kBoolean, .name = name, .meaning = meaning, .address = address};
}
inline Feature command(const char* name, std::uint32_t address, const char* meaning) {
    return {.kind = Feature::Kind::kCommand,
            .access = Feature::Access::kWrite,
            .name = name,
            .meaning = meaning,
            .address = address};
}
inline Feature string(const char* name, std::uint32_t address, std::uint32_t bytes, const char* meaning) {
    return {.kind = Feature::Kind::kString,
            .access = Feature::Access::kRead,
            .name = name,
            .meaning = meaning,
            .address = address,
            .bytes = bytes};
}
inline Feature enumeration(const char* name, std::uint32_t address, std::vector<EnumEntry> entries,
                           const char* meaning) {
    return {.kind = Feature::Kind::kEnumeration,
            .name = name,
            .meaning = meaning,
            .address = address,
            .entries = std::move(entries)};
}
// Returns entries with the values 0, 1, 2, ...
std::vector<EnumEntry> counted(std::initializer_list<const char*> names);
inline Feature fixed_number(const char* name, std::uint64_t value, const char* meaning) {
    Feature f = integer(name, 0, meaning).read_only();
    f.is_constant = true;
    f.value = value;
    return f;
}
inline Feature fixed_entry(const char* name, const char* only, const char* meaning) {
    Feature f = enumeration(name, 0, {{only, 0}}, meaning).read_only();
    f.is_constant = true;
    return f;
}

// A port other than the device: a chunk of a frame, or an event's data.
struct FeaturePort {
    std::string name;
    std::uint32_t chunk = 0;  // id; 0: none
    std::uint16_t event = 0;  // id; 0: none
};

// A number that features refer to: an expression of some bits of one register.
struct FeatureFormula {
    std::string name, formula, variable, feature;
};

struct FeatureTable {
    FeatureTable(const CameraLimits& l, bool has_parts, std::vector<std::string> line_names, LinePlan own)
        : limits(l), multipart(has_parts), lines(std::move(line_names)), plan(own) {}
    const CameraLimits limits;
    const bool multipart;
    const std::vector<std::string> lines;  // names of the trigger input, Line0 and others
    const LinePlan plan;
    std::vector<Feature> features;
    std::vector<FeaturePort> ports;
    std::vector<FeatureFormula> formulas;

    void add(const char* category, std::vector<Feature> rows);
};

// Returns the features in the order of the description. more_lines: names of the trigger input besides Line0.
FeatureTable gige_features(const CameraLimits& limits, bool multipart,
                           const std::vector<std::string>& more_lines = {}, const LinePlan& plan = {});

// Returns the entries of the camera's lines besides Line0, for selectors.
std::vector<EnumEntry> own_lines(const LinePlan& plan, bool with_outputs);

// Returns the events that counters, timers and the sequencer can follow.
std::vector<EnumEntry> events_of(const LinePlan& plan);

// Each adds the features of one concept.
void add_device_features(FeatureTable& table);
void add_image_features(FeatureTable& table);
void add_acquisition_features(FeatureTable& table);
void add_line_features(FeatureTable& table);
void add_chunk_features(FeatureTable& table);
void add_event_features(FeatureTable& table);
void add_transport_features(FeatureTable& table);
void add_fault_features(FeatureTable& table);
void add_ptp_features(FeatureTable& table);
void add_sequencer_features(FeatureTable& table);

}  // namespace hilcam
