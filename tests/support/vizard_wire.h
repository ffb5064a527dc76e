#pragma once
// Messages of Basilisk's Vizard protocol as bytes, written by hand: field numbers from
// AVSLab/basilisk, src/utilities/vizProtobuffer/vizMessage.proto, bytes from protobuf's encoding document.
// Neither io/vizard/vizard.proto nor the protobuf library is asked.

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hilcam::vizard_wire {

class Message {
  public:
    Message& integer(unsigned field, std::int64_t value) {
        varint(field << 3), varint(static_cast<std::uint64_t>(value));
        return *this;
    }
    Message& number(unsigned field, double value) {
        varint(field << 3 | 1), fixed(value);
        return *this;
    }
    Message& text(unsigned field, const std::string& value) {
        varint(field << 3 | 2), varint(value.size());
        bytes_ += value;
        return *this;
    }
    Message& message(unsigned field, const Message& value) { return text(field, value.bytes_); }
    // Packed, as proto3 has repeated numbers.
    Message& numbers(unsigned field, const std::vector<double>& values) {
        Message inner;
        for (const double value : values) inner.fixed(value);
        return message(field, inner);
    }
    Message& integers(unsigned field, const std::vector<std::int64_t>& values) {
        Message inner;
        for (const std::int64_t value : values) inner.varint(static_cast<std::uint64_t>(value));
        return message(field, inner);
    }
    const std::string& bytes() const { return bytes_; }
    std::span<const std::uint8_t> span() const {
        return {reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size()};
    }

  private:
    void varint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
        bytes_ += static_cast<char>(value);
    }
    void fixed(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned i = 0; i < 8; ++i) bytes_ += static_cast<char>(bits >> 8 * i & 0xFF);
    }
    std::string bytes_;
};

inline Message time_stamp(std::int64_t frame, double elapsed_ns) {
    return Message().integer(1, frame).number(2, elapsed_ns);
}
inline Message spacecraft(const std::string& name, const std::vector<double>& position_m,
                          const std::vector<double>& velocity_m_s, const std::vector<double>& sigma_bn) {
    return Message().text(1, name).numbers(2, position_m).numbers(3, velocity_m_s).numbers(4, sigma_bn);
}
inline Message camera(std::int64_t id, const std::string& parent, const std::vector<double>& position_m,
                      const std::vector<double>& sigma_ub) {
    return Message().integer(1, id).text(2, parent).numbers(7, position_m).numbers(8, sigma_ub);
}
// 2026-03-20T14:00:00.5
inline Message epoch() {
    return Message().integer(1, 2026).integer(2, 3).integer(3, 20).integer(4, 14).number(6, 0.5);
}
// The wire's rotation of a camera whose axes are the spacecraft's: sigma_UC itself.
inline const std::vector<double> kAsTheSpacecraft = {1. / 3, 1. / 3, -1. / 3};

}  // namespace hilcam::vizard_wire
