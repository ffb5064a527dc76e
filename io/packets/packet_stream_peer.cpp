#include "io/packets/packet_stream_peer.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace hilcam {
namespace {

constexpr std::size_t kPieceBytes = 64 * 1024;

}  // namespace

std::string has_read_nothing_for(int ms) {
    return "has read nothing for " +
           (ms % 1000 == 0 ? std::to_string(ms / 1000) + " s" : std::to_string(ms) + " ms");
}

bool PacketStreamPeer::send(std::span<const std::uint8_t> bytes) {
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    return waiting_.size() < kPieceBytes || flush();
}

bool PacketStreamPeer::flush() {
    discard_input();
    std::span<const std::uint8_t> left = waiting_;
    while (!left.empty()) {
        const ssize_t sent = ::send(socket_.get(), left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0) {
            left = left.subspan(static_cast<std::size_t>(sent));
        } else if (errno == EAGAIN) {
            if (!wait_for_room()) return false;
        } else if (errno != EINTR) {
            reason_ = std::string("is gone (") + std::strerror(errno) + ")";
            return false;
        }
    }
    waiting_.clear();
    return true;
}

bool PacketStreamPeer::wait_for_room() {
    pollfd watched{socket_.get(), POLLOUT, 0};
    int ready = 0;
    do ready = poll(&watched, 1, patience_ms_);
    while (ready < 0 && errno == EINTR);
    if (ready > 0) return true;
    reason_ = has_read_nothing_for(patience_ms_) + " and is disconnected";
    return false;
}

// Input that is left unread at the end would make the kernel reset the connection, and lose what is on its way.
void PacketStreamPeer::discard_input() {
    std::array<char, 4096> bin{};
    while (recv(socket_.get(), bin.data(), bin.size(), MSG_DONTWAIT) > 0) {
    }
}

}  // namespace hilcam
