#include "emulator/recording/recording_codec.h"

#include <cmath>
#include <type_traits>

#include "io/commands/command_payload.h"
#include "io/system/bytes.h"
#include "io/system/crc32.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

enum class Kind : std::uint8_t { kHeader = 1, kCommand, kChange, kTrigger, kShown, kFrame, kLoss, kEnd };

// Writer and Reader have the same functions, so that the list of each record's fields exists once.
class Writer {
  public:
    explicit Writer(std::span<std::uint8_t> bytes) : out_(bytes) {}

    std::size_t size() const { return out_.size(); }
    static bool at_end() { return false; }
    void u8(std::uint8_t value) { out_.u8(value); }
    void operator()(bool value) { out_.u8(value ? 1u : 0u); }
    void operator()(std::uint16_t value) { out_.u16(value); }
    void operator()(std::uint32_t value) { out_.u32(value); }
    void operator()(std::uint64_t value) { out_.u64(value); }
    void operator()(std::int64_t value) { out_.u64(static_cast<std::uint64_t>(value)); }
    void operator()(double value) { out_.f64(value); }
    void operator()(const std::string& text) {
        out_.u32(text.size());
        for (const char c : text) out_.u8(static_cast<std::uint8_t>(c));
    }
    template <class E>
    void word(E value, E) {
        out_.u8(static_cast<std::uint8_t>(value));
    }
    template <class T, class F>
    void maybe(const std::optional<T>& value, const F& field) {
        (*this)(value.has_value());
        if (value) field(*value);
    }
    void payload(const Command& command) { write_payload(command, out_); }

  private:
    ByteWriter out_;
};

class Reader {
  public:
    explicit Reader(std::span<const std::uint8_t> bytes) : in_(bytes) {}

    // True when all bytes were read, and no more.
    bool ended_well() const { return ok_ && in_.ok() && in_.left() == 0; }
    void fail() { ok_ = false; }
    // True at the end of a record of a program that did not have what follows.
    bool at_end() const { return in_.left() == 0; }
    std::uint8_t u8() { return in_.u8(); }
    void operator()(bool& value) {
        const std::uint8_t byte = in_.u8();
        value = byte == 1;
        ok_ = ok_ && byte <= 1;
    }
    void operator()(std::uint16_t& value) { value = in_.u16(); }
    void operator()(std::uint32_t& value) { value = in_.u32(); }
    void operator()(std::uint64_t& value) { value = in_.u64(); }
    void operator()(std::int64_t& value) { value = in_.i64(); }
    void operator()(double& value) {
        value = in_.f64();
        ok_ = ok_ && std::isfinite(value);
    }
    void operator()(std::string& text) {
        const std::uint32_t size = in_.u32();
        if (size > in_.left()) return fail();
        text.resize(size);
        for (char& c : text) c = static_cast<char>(in_.u8());
    }
    template <class E>
    void word(E& value, E last) {
        const std::uint8_t byte = in_.u8();
        if (byte > static_cast<std::uint8_t>(last)) return fail();
        value = static_cast<E>(byte);
    }
    template <class T, class F>
    void maybe(std::optional<T>& value, const F& field) {
        bool given = false;
        (*this)(given);
        if (given) field(value.emplace());
    }
    void payload(std::uint8_t function, Command& command) {
        const std::optional<std::size_t> size = payload_bytes(function);
        if (!size || *size > in_.left()) return fail();
        ok_ = ok_ && read_payload(in_, function, command).status == CommandStatus::kAccepted;
    }

  private:
    ByteReader in_;
    bool ok_ = true;
};

TriggerSource last_of(TriggerSource) { return TriggerSource::kLine7; }
TriggerActivation last_of(TriggerActivation) { return TriggerActivation::kLevelLow; }
TriggerOverlap last_of(TriggerOverlap) { return TriggerOverlap::kReadOut; }
ExposureMode last_of(ExposureMode) { return ExposureMode::kTriggerWidth; }
TestPattern last_of(TestPattern) { return TestPattern::kRampHorizontalMoving; }

// --- the lists of fields. R is the record, const for a Writer.

template <class A, class V>
void vec3(A& a, V& v) {
    a(v.x), a(v.y), a(v.z);
}
template <class A, class T>
void maybe(A& a, T& value) {
    a.maybe(value, [&](auto& v) { a(v); });
}

// Codes commands that their payload on the wire does not represent completely, because it rounds, checks or
// leaves out.
template <class A, class R>
void pose(A& a, R& p) {
    a(p.object), a(p.motion.time.ns);
    vec3(a, p.motion.pose.position_world_m);
    auto& q = p.motion.pose.world_from_body;
    a(q.w), a(q.x), a(q.y), a(q.z);
    vec3(a, p.motion.velocity_world_m_s);
    vec3(a, p.motion.rate_body_rad_s);
    a(p.alone);
}
template <class A, class R>
void joint(A& a, R& j) {
    a(j.object), a(j.joint), a(j.time.ns), a(j.angle_rad), a(j.rate_rad_s);
}
template <class A, class R>
void settings(A& a, R& s) {
    maybe(a, s.exposure_s), maybe(a, s.gain_db), maybe(a, s.frame_rate_hz);
}
template <class A, class R>
void expose(A& a, R& e) {
    a(e.time.ns), a(e.frames), a(e.at_any_time);
}
// True for a command with its own fields here; false for one that its wire format represents completely.
template <class A, class C>
bool own_fields(A& a, C& command) {
    return std::visit(
        [&]<class T>(T& c) {
            using Alternative = std::remove_const_t<T>;
            constexpr bool as_on_the_wire =
                OneOf<Alternative, StartCommand, StopCommand, PingCommand, FaultCommand, TriggerModeCommand,
                      SubscribeCommand, ClockCommand, LampCommand>;
            if constexpr (std::is_same_v<Alternative, PoseCommand>)
                pose(a, c);
            else if constexpr (std::is_same_v<Alternative, JointCommand>)
                joint(a, c);
            else if constexpr (std::is_same_v<Alternative, SettingsCommand>)
                settings(a, c);
            else if constexpr (std::is_same_v<Alternative, ExposeCommand>)
                expose(a, c);
            else
                static_assert(as_on_the_wire, "say here how a recording keeps the new command");
            return !as_on_the_wire;
        },
        command);
}

void command(Writer& a, const Command& c) {
    a.u8(function_of(c));
    if (!own_fields(a, c)) a.payload(c);
}
// Returns the command for a function code, with default values.
template <std::size_t... I>
bool make_command(std::uint8_t function, Command& c, std::index_sequence<I...>) {
    return ((function == I + 1 && (c.emplace<I>(), true)) || ...);
}
void command(Reader& a, Command& c) {
    const std::uint8_t function = a.u8();
    if (!make_command(function, c, std::make_index_sequence<std::variant_size_v<Command>>{})) return a.fail();
    if (!own_fields(a, c)) a.payload(function, c);
}

template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordingHeader> {
    a(r.program), a(r.build), a(r.processor), a(r.start.ns), a(r.monotonic_start_ns);
    a(r.cameras), a(r.lockstep), a(r.scenario);
}
template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordedCommand> {
    a(r.number), a(r.source.arrival_monotonic_ns), a(r.source.sequence);
    a(r.source.camera), a(r.source.event), a(r.forgets);
    command(a, r.command);
}
template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordedChange> {
    a(r.camera), a(r.monotonic_ns);
    visit_settings([&](std::string_view, auto, auto wish) {
        if (a.at_end()) return;
        a.maybe(r.change.*wish, [&](auto& value) {
            if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>)
                a.word(value, last_of(value));
            else
                a(value);
        });
    });
}
template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordedTrigger> {
    a(r.camera), a(r.monotonic_ns);
    auto& o = r.order;
    a.word(o.source, last_of(o.source));
    a(o.at_monotonic_ns), a(o.at_simulated.ns), a(o.frames), a(o.sequence), a(o.at_any_time);
    a.word(r.result, TriggerResult::kTooEarly);
    if (!a.at_end()) a(o.until_monotonic_ns);
}
template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordedShown> {
    a(r.camera), a(r.thing), a(r.number);
}
template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordedFrame> {
    a(r.camera);
    auto& u = r.use;
    a(u.id), a(u.skipped), a(u.late), a(u.reverse_x), a(u.reverse_y);
    a.word(u.test_pattern, last_of(u.test_pattern));
    a(u.trigger_sequence), a(u.quality_level), a(u.begin_ns), a(u.middle_ns), a(u.end_ns);
    a(u.exposure_mid.ns), a(u.shown_at.ns), a(u.moving), a(u.shutter_closed);
    a(u.exposure_s), a(u.gain_db), a(u.black_level_dn), a(u.binning_x), a(u.binning_y), a(u.faults);
    a(u.image.stuck), a(u.image.black), a(u.image.saturated);
    maybe(a, u.image.tear_share), maybe(a, u.image.flip_rate);
    if (!a.at_end()) a(u.sequencer_set);
}
template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordedLoss> {
    a(r.records);
}
template <class A, class R>
void list(A& a, R& r) requires std::is_same_v<std::remove_const_t<R>, RecordedEnd> {
    a(r.monotonic_ns);
}

// --- records

Kind kind_of(const Record& record) {
    return static_cast<Kind>(record.index() + static_cast<std::size_t>(Kind::kCommand));
}
static_assert(std::variant_size_v<Record> ==
              static_cast<std::size_t>(Kind::kEnd) - static_cast<std::size_t>(Kind::kCommand) + 1);

template <std::size_t... I>
bool make_record(std::uint8_t kind, Record& record, std::index_sequence<I...>) {
    return ((kind == I + static_cast<std::size_t>(Kind::kCommand) && (record.emplace<I>(), true)) || ...);
}

// Writes length and CRC into the space in front of a body.
std::size_t seal(std::span<std::uint8_t> bytes, std::size_t body_bytes) {
    ByteWriter prefix(bytes);
    prefix.u32(body_bytes).u32(crc32_of(bytes.subspan(kRecordPrefixBytes, body_bytes)));
    return kRecordPrefixBytes + body_bytes;
}

}  // namespace

std::vector<std::uint8_t> encode_header(const RecordingHeader& header) {
    constexpr std::size_t kRest = 64;  // kind, lengths and numbers
    const std::size_t most = header.program.size() + header.processor.size() + header.scenario.size() + kRest;
    if (most > kMaxHeaderBytes)
        throw InputError("a scenario of " + std::to_string(header.scenario.size()) +
                         " bytes of values cannot be recorded; accepted: at most 16 MiB");
    std::vector<std::uint8_t> bytes(kRecordPrefixBytes + most);
    Writer writer(std::span<std::uint8_t>{bytes}.subspan(kRecordPrefixBytes));
    writer.u8(static_cast<std::uint8_t>(Kind::kHeader));
    list(writer, header);
    bytes.resize(seal(bytes, writer.size()));
    return bytes;
}

std::size_t encode_record(const Record& record, std::span<std::uint8_t> bytes) {
    Writer writer(bytes.subspan(kRecordPrefixBytes));
    writer.u8(static_cast<std::uint8_t>(kind_of(record)));
    std::visit([&](const auto& r) { list(writer, r); }, record);
    return seal(bytes, writer.size());
}

std::optional<RecordingHeader> decode_header(std::span<const std::uint8_t> body) {
    Reader reader(body);
    if (reader.u8() != static_cast<std::uint8_t>(Kind::kHeader)) return {};
    RecordingHeader header;
    list(reader, header);
    // Limits monotonic times so that their differences do not overflow.
    constexpr std::int64_t kFarthest_ns = 4'000'000'000'000'000'000;
    if (!reader.ended_well() || header.monotonic_start_ns < 0 || header.monotonic_start_ns > kFarthest_ns)
        return {};
    return header;
}

std::optional<Record> decode_record(std::span<const std::uint8_t> body) {
    Reader reader(body);
    const std::uint8_t kind = reader.u8();
    Record record;
    if (!make_record(kind, record, std::make_index_sequence<std::variant_size_v<Record>>{})) return {};
    std::visit([&](auto& r) { list(reader, r); }, record);
    if (!reader.ended_well()) return {};
    return record;
}

}  // namespace hilcam
