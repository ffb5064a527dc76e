#pragma once
// hilcam's command protocol over UDP, with tools/client/hilcam_client.h: what a dynamics simulator sends.

#include <cstdint>
#include <stdexcept>
#include <string>

#include "tools/client/hilcam_client.h"

namespace flight {

// One thread. Throws std::runtime_error: nothing heard for ten seconds, or a command refused.
class Link {
  public:
    explicit Link(const std::string& endpoint);  // ADDRESS:PORT
    ~Link();
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;

    // Each waits for its acknowledgement.
    void set_pose(const hilcam_pose& pose);
    // Lockstep: takes a frame, its exposure's middle at that time.
    void expose(std::int64_t exposure_mid_tai_ns);
    hilcam_acknowledgement ping();

    // Without waiting; the answers that came by now are looked at.
    void post_pose(const hilcam_pose& pose);

    // Simulated TAI = CLOCK_MONOTONIC + this, from the quickest of some pings. Not in lockstep.
    std::int64_t simulated_offset_ns();

  private:
    hilcam_acknowledgement ask(std::size_t bytes);
    bool receive(int timeout_ms, hilcam_acknowledgement& answer);
    std::runtime_error silent() const;

    std::string endpoint_;
    int socket_ = -1;
    std::int64_t heard_ns_ = 0;   // the last answer; 0: none was asked for yet
    hilcam_envelope envelope_{};  // of the command being encoded into bytes_
    std::uint8_t bytes_[HILCAM_MOST_PACKET_BYTES] = {};
};

std::int64_t monotonic_ns();

}  // namespace flight
