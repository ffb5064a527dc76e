#include "io/system/output_queue.h"

#include <sys/socket.h>

#include <cerrno>

namespace hilcam {

bool OutputQueue::put(std::span<const std::uint8_t> packet) {
    if (bytes() + packet.size() > max_bytes_) return false;
    // Removes the sent part once it is the larger one, so each byte is moved once on average.
    if (begin_ > bytes_.size() / 2) {
        bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
        begin_ = 0;
    }
    bytes_.insert(bytes_.end(), packet.begin(), packet.end());
    if (whole_packets_) sizes_.push_back(packet.size());
    return true;
}

bool OutputQueue::flush(int socket) {
    while (!empty()) {
        const std::size_t size = whole_packets_ ? sizes_.front() : bytes();
        const ssize_t sent = send(socket, bytes_.data() + begin_, size, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (sent < 0) return errno == EAGAIN || errno == EINTR;
        advance(static_cast<std::size_t>(sent));
    }
    return true;
}

void OutputQueue::advance(std::size_t sent) {
    begin_ += sent;
    if (whole_packets_) sizes_.pop_front();
    if (begin_ == bytes_.size()) bytes_.clear(), begin_ = 0;
}

}  // namespace hilcam
