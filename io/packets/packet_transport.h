#pragma once
// Ways for packets to leave: datagrams, byte streams, files. One thread, the output's own, uses a transport
// after open(). A transport may wait for a receiver, but not longer than its patience.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/contract/frame_sink.h"
#include "io/contract/loss_count.h"

namespace hilcam {

struct PacketsConfig;

class PacketTransport {
  public:
    // The fate of a frame.
    enum class Outcome : std::uint8_t {
        kDelivered,
        kUnwanted,  // nobody was there
        kDropped,   // its receiver vanished, or was given up
    };

    virtual ~PacketTransport() = default;
    const std::string& name() const { return name_; }  // "udp 127.0.0.1:5020"
    // Throws InputError and DeviceError. Owner thread.
    virtual void open() = 0;
    // Returns true when somebody takes the next frame. Connects, or accepts clients, first.
    virtual bool begin_frame(std::uint64_t frame) = 0;
    // Sends one packet, or what wraps it. False: the rest of the frame need not be sent.
    // Throws DeviceError where a file cannot be written; then the frame has ended and left nothing.
    virtual bool send(std::span<const std::uint8_t> bytes) = 0;
    // Throws as send().
    virtual Outcome end_frame() = 0;
    virtual void close() noexcept = 0;

    // Any thread.
    const LossCount& packets_lost() const { return packets_lost_; }  // the kernel did not take them
    std::vector<SinkNote> take_notes() {
        const std::lock_guard lock(mutex_);
        return std::exchange(notes_, {});
    }

  protected:
    explicit PacketTransport(std::string name) : name_(std::move(name)) {}
    void note(const std::string& text, bool warning) {
        const std::lock_guard lock(mutex_);
        notes_.push_back({name_ + ": " + text, warning});
    }
    LossCount packets_lost_;

  private:
    std::string name_;
    std::mutex mutex_;
    std::vector<SinkNote> notes_;
};

// Makes the transport that the configuration names. Throws InputError.
std::unique_ptr<PacketTransport> make_packet_transport(const PacketsConfig& config);

std::unique_ptr<PacketTransport> make_udp_transport(const PacketsConfig& config);
std::unique_ptr<PacketTransport> make_stream_client(const PacketsConfig& config);  // TCP, Unix
std::unique_ptr<PacketTransport> make_stream_server(const PacketsConfig& config);
std::unique_ptr<PacketTransport> make_usb_transport(const PacketsConfig& config);
std::unique_ptr<PacketTransport> make_file_transport(const PacketsConfig& config);

}  // namespace hilcam
