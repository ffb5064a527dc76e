#pragma once
// Who takes the frames of a camera under test: an application of GigE Vision, and somebody at the preview's page.

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string_view>
#include <thread>

#include "io/gige/device/gige_features.h"
#include "io/gige/device/gvcp.h"
#include "io/system/bytes.h"
#include "io/system/fd.h"

namespace hilcam {

// An application that has the camera stream to it and reads what comes.
class StreamReader {
  public:
    static constexpr std::uint32_t kCamera = 0x7F530401;  // 127.83.4.1

    StreamReader() : stream_(open_udp(kCamera, 0)), control_(open_udp(kCamera, 0)) {
        sockaddr_in own{};
        socklen_t size = sizeof own;
        getsockname(stream_.get(), reinterpret_cast<sockaddr*>(&own), &size);
        write(bootstrap::kControl, 2);
        write(bootstrap::kStreamAddress, kCamera);
        write(bootstrap::kStreamPort, ntohs(own.sin_port));
        write(feature_register::kAcquisitionStart, 1);
    }
    // Gives the number of datagrams since the last call.
    int drain() {
        int count = 0;
        while (recv(stream_.get(), bytes_.data(), bytes_.size(), MSG_DONTWAIT) > 0) ++count;
        return count;
    }

  private:
    // Until it is answered: the camera opens its sockets in its own time.
    void write(std::uint32_t address, std::uint32_t value) {
        const sockaddr_in to = socket_address(kCamera, gvcp::kPort);
        for (int i = 0; i < 5000; ++i) {
            std::array<std::uint8_t, 16> command;
            ByteWriter(command).u8(0x42).u8(1).u16(gvcp::kWriteRegister).u16(8).u16(++id_);
            ByteWriter(std::span(command).subspan(8)).u32(address).u32(value);
            sendto(control_.get(), command.data(), command.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                   sizeof to);
            pollfd watched{control_.get(), POLLIN, 0};
            if (poll(&watched, 1, 10) > 0 && recv(control_.get(), bytes_.data(), bytes_.size(), 0) >= 8) {
                EXPECT_EQ(ByteReader(bytes_).u16(), 0u);
                return;
            }
        }
        ADD_FAILURE() << "the camera does not answer";
    }
    Fd stream_, control_;
    std::array<std::uint8_t, 16384> bytes_{};
    std::uint16_t id_ = 0;
};

// Somebody who looks at the preview's page with truth drawn over the picture, and in turn at one part of the frame's light.
class PreviewReader {
  public:
    static constexpr std::uint16_t kPort = 15263;

    PreviewReader() : thread_([this] { look(); }) {}
    ~PreviewReader() {
        over_ = true;
        thread_.join();
    }
    int pictures() const { return pictures_; }
    int with_truth() const { return with_truth_; }
    int of_light() const { return of_light_; }

  private:
    void look() {
        for (bool light = false; !over_; light = !light) {
            const Fd connection(socket(AF_INET, SOCK_STREAM, 0));
            const sockaddr_in to = socket_address(INADDR_LOOPBACK, kPort);
            if (connect(connection.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0)
                ask(connection.get(), light);
        }
    }
    void ask(int connection, bool light) {
        constexpr std::string_view kPicture =
            "GET /frame?viewer=1&truth=1&hold=1 HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
        // Another part than before is another frame.
        constexpr std::string_view kLights[] = {
            "GET /frame?viewer=1&truth=1&light=direct.sun HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: "
            "close\r\n\r\n",
            "GET /frame?viewer=1&truth=1&light=points HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: "
            "close\r\n\r\n"};
        const std::string_view question = light ? kLights[of_light_ % 2] : kPicture;
        send(connection, question.data(), question.size(), 0);
        std::size_t size = 0;
        for (ssize_t got = 1; got > 0 && size < bytes_.size();
             size += static_cast<std::size_t>(std::max<ssize_t>(got, 0)))
            got = recv(connection, bytes_.data() + size, bytes_.size() - size, 0);
        const std::string_view answer(bytes_.data(), size);
        const std::size_t picture = answer.find("HCP1");
        if (picture == std::string_view::npos || picture + 140 > size) return;
        ++pictures_;
        if (light) ++of_light_;
        if (answer[picture + 136] == 1) ++with_truth_;
    }
    std::array<char, 200'000> bytes_{};  // 256 x 192 px of two bytes, and headers
    std::atomic<bool> over_{false};
    std::atomic<int> pictures_{0}, with_truth_{0}, of_light_{0};
    std::thread thread_;
};

}  // namespace hilcam
