#include "io/command_sender.h"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "render/check.h"

namespace hilcam {

CommandSender::CommandSender(const std::string& endpoint)
    : endpoint_(endpoint), socket_(open_udp(INADDR_ANY, 0)) {
    const sockaddr_in to = parse_endpoint(endpoint);
    if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
        throw DeviceError(endpoint + ": " + std::strerror(errno));
}

Acknowledgement CommandSender::send(const Command& command, int timeout_ms) {
    std::array<std::uint8_t, kMostCommandBytes> bytes;
    const std::uint32_t sequence = sequence_++;
    const std::size_t size = encode_command(command, sequence, bytes);
    const auto silent = [&]() -> DeviceError {
        return DeviceError("no acknowledgement from " + endpoint_ + " within " + std::to_string(timeout_ms) +
                           " ms; is 'hilcam run' up and listening there?");
    };
    if (::send(socket_.get(), bytes.data(), size, 0) < 0) throw silent();
    pollfd watched{socket_.get(), POLLIN, 0};
    // Acknowledgements of earlier, given-up commands may still come in: skip them.
    while (poll(&watched, 1, timeout_ms) > 0) {
        std::array<std::uint8_t, kMostAcknowledgeBytes> answer;
        const ssize_t got = recv(socket_.get(), answer.data(), answer.size(), 0);
        if (got < 0) throw silent();
        Acknowledgement acknowledgement;
        if (decode_acknowledgement({answer.data(), static_cast<std::size_t>(got)}, acknowledgement) &&
            acknowledgement.sequence == sequence)
            return acknowledgement;
    }
    throw silent();
}

}  // namespace hilcam
