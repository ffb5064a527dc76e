#pragma once
// Commands as bytes, and a handler that remembers them.

#include <cstdio>
#include <mutex>
#include <string>
#include <vector>

#include "io/commands/command_dialect.h"

namespace hilcam {

inline std::vector<std::uint8_t> encoded(const Command& command, std::uint32_t sequence,
                                         const DialectConfig& dialect = {}) {
    std::vector<std::uint8_t> bytes(kMaxPacketBytes);
    bytes.resize(encode_command(command, sequence, dialect, bytes));
    return bytes;
}

inline std::vector<std::uint8_t> operator+(std::vector<std::uint8_t> a, const std::vector<std::uint8_t>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline std::vector<std::uint8_t> with_crc(std::vector<std::uint8_t> bytes) {
    const std::uint16_t crc = crc16(std::span(bytes).first(bytes.size() - 2));
    bytes[bytes.size() - 2] = static_cast<std::uint8_t>(crc >> 8);
    bytes[bytes.size() - 1] = static_cast<std::uint8_t>(crc & 0xFF);
    return bytes;
}

inline PoseCommand some_pose() {
    PoseCommand p;
    p.object = 2;
    p.motion.time.ns = 123456789;
    p.motion.pose.position_world_m = {1.5, -2.5, 3.25};
    p.motion.pose.world_from_body = {0.5, 0.5, -0.5, 0.5};
    p.motion.velocity_world_m_s = {0.1, 0.2, 0.3};
    p.motion.rate_body_rad_s = {-0.01, 0, 0.01};
    return p;
}

inline std::string hex(std::span<const std::uint8_t> bytes) {
    std::string out;
    for (const std::uint8_t b : bytes) {
        char text[4];
        std::snprintf(text, sizeof text, "%02X ", b);
        out += text;
    }
    if (!out.empty()) out.pop_back();
    return out;
}

class CommandRecorder : public CommandHandler {
  public:
    CommandStatus handle(const Command& command, const CommandSource& source) override {
        const std::lock_guard lock(mutex_);
        commands_.push_back(command);
        sequences_.push_back(source.sequence);
        const auto* pose = std::get_if<PoseCommand>(&command);
        return pose && pose->object > 2 ? CommandStatus::kUnknownObject : CommandStatus::kAccepted;
    }
    TimeTai now() const override { return {42}; }

    std::vector<Command> commands() const {
        const std::lock_guard lock(mutex_);
        return commands_;
    }
    std::vector<std::uint32_t> sequences() const {
        const std::lock_guard lock(mutex_);
        return sequences_;
    }

  private:
    mutable std::mutex mutex_;
    std::vector<Command> commands_;
    std::vector<std::uint32_t> sequences_;
};

}  // namespace hilcam
