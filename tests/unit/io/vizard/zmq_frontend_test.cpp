// The guard before ZeroMQ's socket, with a plain socket of this test behind it that sends back what comes.

#include "io/vizard/zmq_frontend.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

namespace hilcam {
namespace {

constexpr int kPatience_ms = 30'000;

// What a ZMTP 3.0 peer sends first (rfc.zeromq.org/spec/23).
std::array<char, 64> greeting() {
    std::array<char, 64> bytes{};
    bytes[0] = '\xFF', bytes[9] = '\x7F', bytes[10] = 3;
    return bytes;
}

// Listens at an abstract Unix socket, sends back what comes.
class Echo {
  public:
    explicit Echo(const std::string& name) : listener_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path + 1, name.data(), name.size());
        const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
        EXPECT_EQ(bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
        EXPECT_EQ(listen(listener_.get(), 64), 0);
        thread_ = std::thread([this] { run(); });
    }
    ~Echo() {
        wake(wakeup_);
        thread_.join();
    }

  private:
    void run() {
        std::vector<pollfd> watched = {{wakeup_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
        std::vector<Fd> open;
        while (poll(watched.data(), watched.size(), -1) > 0 && !watched[0].revents) {
            const std::size_t known = watched.size();
            if (watched[1].revents) {
                open.emplace_back(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
                watched.push_back({open.back().get(), POLLIN, 0});
            }
            for (std::size_t i = 2; i < known; ++i) {
                if (!watched[i].revents) continue;
                std::array<char, 256> bytes;
                const ssize_t got = recv(watched[i].fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
                if (got <= 0)
                    watched[i].fd = -1;
                else
                    send(watched[i].fd, bytes.data(), static_cast<std::size_t>(got), MSG_NOSIGNAL);
            }
        }
    }
    Fd listener_, wakeup_ = open_wakeup();
    std::thread thread_;
};

class Guard : public testing::Test {
  protected:
    static constexpr std::size_t kPeers = 3;
    const std::string name_ = "hilcam-guard-test-" + std::to_string(getpid());
    const std::uint16_t port_ = free_port();
    Echo echo_{name_};
    std::mutex mutex_;
    std::vector<std::string> ended_;
    ZmqFrontend frontend_{{"tcp://127.0.0.1:" + std::to_string(port_),
                           name_,
                           kPeers,
                           {1000, 5},
                           1500,
                           [this](const std::string& why) {
                               const std::lock_guard lock(mutex_);
                               ended_.push_back(why);
                           }}};

    void SetUp() override { frontend_.start(); }
    void TearDown() override { frontend_.stop(); }

    static std::uint16_t free_port() {
        const Fd probe = listen_tcp(0x7F000001, 0);
        sockaddr_in address{};
        socklen_t size = sizeof address;
        getsockname(probe.get(), reinterpret_cast<sockaddr*>(&address), &size);
        return ntohs(address.sin_port);
    }
    Fd connected() const {
        Fd fd(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        const sockaddr_in to = socket_address(0x7F000001, port_);
        EXPECT_EQ(connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
        return fd;
    }
    // Sends a greeting; true when it comes back, false when the connection ends.
    static bool is_answered(const Fd& fd) {
        const auto bytes = greeting();
        if (send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) return false;
        for (std::size_t came = 0; came < bytes.size();) {
            pollfd ready{fd.get(), POLLIN, 0};
            if (poll(&ready, 1, kPatience_ms) != 1) return false;
            std::array<char, 64> back;
            const ssize_t got = recv(fd.get(), back.data(), back.size(), 0);
            if (got <= 0) return false;
            came += static_cast<std::size_t>(got);
        }
        return true;
    }
    // Sends a message of one part, `size` bytes; true when it comes back. More to come: with no end.
    static bool is_passed_on(const Fd& fd, std::uint8_t size = 1, bool is_more_to_come = false) {
        std::vector<std::uint8_t> frame(2u + size);
        frame[0] = is_more_to_come, frame[1] = size;
        if (send(fd.get(), frame.data(), frame.size(), MSG_NOSIGNAL) < 0) return false;
        return recv(fd.get(), frame.data(), frame.size(), MSG_WAITALL) == static_cast<ssize_t>(frame.size());
    }
    static bool is_ended(const Fd& fd) {
        pollfd ready{fd.get(), POLLIN, 0};
        std::uint8_t byte = 0;
        return poll(&ready, 1, kPatience_ms) == 1 && recv(fd.get(), &byte, 1, 0) <= 0;
    }
    bool was_told(const std::string& words) {
        const std::lock_guard lock(mutex_);
        for (const std::string& why : ended_)
            if (why.find(words) != std::string::npos) return true;
        return false;
    }
};

TEST_F(Guard, APeerIsHeardWhileStrangersHoldAHundredConnections) {
    std::vector<Fd> strangers;
    for (int i = 0; i < 100; ++i) {
        strangers.push_back(connected());
        // Half of them have begun a greeting that never ends.
        if (i % 2 == 1) {
            EXPECT_EQ(send(strangers.back().get(), "\xFF", 1, MSG_NOSIGNAL), 1);
        }
    }
    std::vector<Fd> peers;
    for (std::size_t i = 0; i < kPeers; ++i) {
        peers.push_back(connected());
        EXPECT_TRUE(is_answered(peers.back())) << i;
        EXPECT_TRUE(is_passed_on(peers.back())) << i;
    }
    EXPECT_TRUE(was_told("has said nothing"));
    // Further strangers end strangers, never a peer.
    for (int i = 0; i < 100; ++i) strangers.push_back(connected());
    for (const Fd& peer : peers) EXPECT_TRUE(is_passed_on(peer));
}

// As Basilisk leaves its connections: each of them has spoken, and none will again.
TEST_F(Guard, ThePeerThatHasBeenSilentLongestMakesRoomForAnother) {
    std::vector<Fd> peers;
    for (int i = 0; i < 10; ++i) {
        peers.push_back(connected());
        EXPECT_TRUE(is_answered(peers.back()));
        EXPECT_TRUE(is_passed_on(peers.back())) << i;
    }
    for (int i = 0; i < 7; ++i) EXPECT_TRUE(is_ended(peers[static_cast<std::size_t>(i)])) << i;
    EXPECT_TRUE(was_told("there are more than 3"));
    // Those that come back and say nothing end none that has spoken.
    std::vector<Fd> back;
    for (int i = 0; i < 40; ++i) {
        back.push_back(connected());
        EXPECT_TRUE(is_answered(back.back())) << i;
    }
    EXPECT_TRUE(is_ended(back[0]));
    for (std::size_t i = 7; i < 10; ++i) EXPECT_TRUE(is_passed_on(peers[i])) << i;
}

TEST_F(Guard, AllTogetherHoldNoMoreThanTheyMay) {
    const Fd greedy = connected(), other = connected(), third = connected();
    for (const Fd* peer : {&greedy, &other, &third}) EXPECT_TRUE(is_answered(*peer));
    // Messages that have their answers hold nothing, however many they are.
    for (int i = 0; i < 30; ++i) EXPECT_TRUE(is_passed_on(third, 250)) << i;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_passed_on(greedy, 250, true)) << i;
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(is_passed_on(other, 250, true)) << i;
    // 750, 500 and 250 bytes are as much as may wait; a sixth hundred of the second's is too much.
    EXPECT_TRUE(is_passed_on(third, 250, true));
    EXPECT_TRUE(is_passed_on(other, 100, true));
    EXPECT_TRUE(is_ended(greedy));
    EXPECT_TRUE(was_told("all together"));
    EXPECT_TRUE(is_passed_on(third));
}

}  // namespace
}  // namespace hilcam
