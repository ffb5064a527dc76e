#include "io/commands/command_station.h"

#include <algorithm>

#include "io/commands/command_payload.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

constexpr std::int64_t kRetryTime_ns = 1'000'000'000;

// True for a command with an effect that adds up when it is repeated: frames, strikes and clock steps.
bool adds_up(const Command& command) {
    return std::visit(
        Overloaded{
            [](const OneOf<ExposeCommand, FaultCommand> auto&) { return true; },
            [](const ClockCommand& clock) { return clock.action == ClockCommand::Action::kStep; },
            [](const OneOf<PoseCommand, SettingsCommand, StartCommand, StopCommand, PingCommand, JointCommand,
                           TriggerModeCommand, SubscribeCommand, LampCommand> auto&) { return false; },
        },
        command);
}

}  // namespace

class CommandStation::Sender {
  public:
    Sender(std::string name, int sequence_bits) : window(sequence_bits) { report.name = std::move(name); }

    // True when the packet repeats the last one that must not be carried out twice.
    bool repeats(std::span<const std::uint8_t> packet, std::int64_t arrival_ns) const {
        return once_bytes > 0 && arrival_ns - once_arrival_ns <= kRetryTime_ns &&
               std::equal(packet.begin(), packet.end(), once.begin(),
                          once.begin() + static_cast<std::ptrdiff_t>(once_bytes));
    }
    void remember(std::span<const std::uint8_t> packet, std::int64_t arrival_ns, CommandStatus status) {
        std::copy(packet.begin(), packet.end(), once.begin());
        once_bytes = packet.size();
        once_arrival_ns = arrival_ns;
        once_status = status;
    }

    SenderReport report;
    SequenceWindow window;
    std::uint16_t acknowledgements = 0, frame_reports = 0, housekeepings = 0;  // packet counters
    std::array<std::uint8_t, kMaxPacketBytes> once{};
    std::size_t once_bytes = 0;
    std::int64_t once_arrival_ns = 0;
    CommandStatus once_status = CommandStatus::kAccepted;
};

CommandStation::CommandStation(CommandHandler& handler, const DialectConfig& dialect)
    : handler_(handler), dialect_(dialect) {}
CommandStation::~CommandStation() = default;

CommandStation::Sender& CommandStation::open(std::string name) {
    const std::lock_guard lock(mutex_);
    return senders_.emplace_back(std::move(name), sequence_bits(dialect_));
}

void CommandStation::close(Sender& sender) {
    const std::lock_guard lock(mutex_);
    senders_.remove_if([&](const Sender& s) { return &s == &sender; });
}

PacketStream CommandStation::make_stream(std::size_t read_bytes) const {
    return PacketStream(command_rule(dialect_), read_bytes);
}

void CommandStation::take(PacketStream& stream, std::int64_t arrival_ns, Sender& sender,
                          const Answer& answer) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t skipped = stream.skipped_bytes();
    for (PacketStream::Item item = stream.next(); item.kind != PacketStream::Item::Kind::kNothing;
         item = stream.next())
        take_packet(item.bytes, arrival_ns, sender, answer);
    report_.skipped_bytes += stream.skipped_bytes() - skipped;
}

void CommandStation::take_all(PacketStream& stream, std::int64_t arrival_ns, Sender& sender,
                              const Answer& answer) {
    take(stream, arrival_ns, sender, answer);
    const std::lock_guard lock(mutex_);
    const std::uint64_t skipped = stream.skipped_bytes();
    const PacketStream::Item rest = stream.end();
    if (rest.kind != PacketStream::Item::Kind::kNothing) take_packet(rest.bytes, arrival_ns, sender, answer);
    report_.skipped_bytes += stream.skipped_bytes() - skipped;
}

void CommandStation::refuse_empty(Sender& sender, const Answer& answer) {
    const std::lock_guard lock(mutex_);
    take_packet({}, 0, sender, answer);
}

void CommandStation::take_packet(std::span<const std::uint8_t> packet, std::int64_t arrival_ns,
                                 Sender& sender, const Answer& answer) {
    const DecodedCommand decoded = decode_command(packet, dialect_);
    Acknowledgement out;
    out.function = decoded.function;
    out.sequence = decoded.sequence;
    out.status = decoded.status;
    out.reason = decoded.reason;
    CommandNotes notes;
    const bool known = decoded.is_intact && count(decoded.sequence, sender);
    if (decoded.status == CommandStatus::kAccepted) {
        const bool is_retry = known && sender.repeats(packet, arrival_ns);
        out.status = is_retry ? sender.once_status : perform(decoded, packet, arrival_ns, sender, notes);
        if (notes.notify_sender)
            out.reason = name_of(CommandStatus::kTimeBackwards);
        else if (out.status != CommandStatus::kAccepted)
            out.reason =
                (notes.refused_by > 0 ? "camera " + std::to_string(notes.refused_by) + ": " : "") +
                (notes.why.empty() ? std::string(meaning_of(out.status, decoded.command)) : notes.why);
        if (const auto* ping = std::get_if<PingCommand>(&decoded.command)) out.token = ping->token;
    }
    const std::uint64_t went_back = notes.went_back ? 1 : 0;
    report_.went_back += went_back, sender.report.went_back += went_back;
    const std::uint64_t refused = out.status == CommandStatus::kAccepted ? 0 : 1;
    report_.received += 1, sender.report.received += 1;
    report_.refused += refused, sender.report.refused += refused;
    out.simulated_time = handler_.now();
    const auto* clock = std::get_if<ClockCommand>(&decoded.command);
    if (clock && out.status == CommandStatus::kAccepted) {
        out.token = static_cast<std::uint64_t>(clock->sender_ns);
        out.clock = handler_.read_clock(arrival_ns);
        out.simulated_time = out.clock->departure;
    }
    std::array<std::uint8_t, kMaxPacketBytes> bytes;
    const std::size_t size = encode_acknowledgement(out, sender.acknowledgements++, dialect_, bytes);
    answer(std::span(bytes).first(size));
}

CommandStatus CommandStation::perform(const DecodedCommand& decoded, std::span<const std::uint8_t> packet,
                                      std::int64_t arrival_ns, Sender& sender, CommandNotes& notes) {
    if (const auto* subscription = std::get_if<SubscribeCommand>(&decoded.command))
        sender.report.subscription = *subscription;
    const CommandStatus status =
        handler_.handle(decoded.command, {decoded.sequence, arrival_ns, decoded.camera, &notes});
    if (adds_up(decoded.command)) sender.remember(packet, arrival_ns, status);
    return status;
}

// Returns true for a sequence number that had come before.
bool CommandStation::count(std::uint32_t sequence, Sender& sender) {
    const SequenceWindow::Finding finding = sender.window.take(sequence);
    switch (finding.kind) {
        case SequenceWindow::Finding::Kind::kGap:
            report_.lost += finding.lost, sender.report.lost += finding.lost;
            return false;
        case SequenceWindow::Finding::Kind::kLate:
            report_.lost -= 1, sender.report.lost -= 1;
            return false;
        case SequenceWindow::Finding::Kind::kDuplicate:
            report_.duplicates += 1, sender.report.duplicates += 1;
            return true;
        case SequenceWindow::Finding::Kind::kNext:
            break;
    }
    return false;
}

void CommandStation::notify(const Telemetry& telemetry, const Notify& notify) {
    const bool is_report = std::holds_alternative<FrameReport>(telemetry);
    const std::lock_guard lock(mutex_);
    for (Sender& sender : senders_) {
        const SubscribeCommand& wants = sender.report.subscription;
        if (!(is_report ? wants.frame_reports : wants.housekeeping)) continue;
        std::uint16_t& count = is_report ? sender.frame_reports : sender.housekeepings;
        std::array<std::uint8_t, kMaxPacketBytes> bytes;
        const std::size_t size = encode_telemetry(telemetry, count++, dialect_, bytes);
        notify(sender, std::span(bytes).first(size));
    }
}

void CommandStation::subscribe(Sender& sender, SubscribeCommand subscription) {
    const std::lock_guard lock(mutex_);
    sender.report.subscription = subscription;
}

void CommandStation::count_stranger() {
    const std::lock_guard lock(mutex_);
    report_.strangers += 1;
}
void CommandStation::count_cut_off() {
    const std::lock_guard lock(mutex_);
    report_.cut_off += 1;
}

CommandReport CommandStation::report() const {
    const std::lock_guard lock(mutex_);
    CommandReport out = report_;
    out.clients = senders_.size();
    return out;
}

std::vector<SenderReport> CommandStation::senders() const {
    const std::lock_guard lock(mutex_);
    std::vector<SenderReport> out;
    for (const Sender& sender : senders_) out.push_back(sender.report);
    return out;
}

}  // namespace hilcam
