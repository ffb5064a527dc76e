#include "io/gige/stream/receiver_room.h"

#include <gtest/gtest.h>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstring>
#include <thread>

namespace hilcam {
namespace {

// Asked another way than ReceiverRoom asks, for all UDP sockets at once, so that a fault of its own is no
// skip.
bool kernel_tells_udp_sockets() {
    const Fd netlink(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
    if (!netlink) return false;
    struct {
        nlmsghdr header;
        inet_diag_req_v2 request;
    } dump{};
    dump.header.nlmsg_len = sizeof dump;
    dump.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
    dump.header.nlmsg_flags = NLM_F_REQUEST | NLM_F_DUMP;
    dump.request.sdiag_family = AF_INET;
    dump.request.sdiag_protocol = IPPROTO_UDP;
    dump.request.idiag_states = ~0u;
    alignas(nlmsghdr) std::array<char, 16384> answer{};
    if (::send(netlink.get(), &dump, sizeof dump, 0) < 0 ||
        recv(netlink.get(), answer.data(), answer.size(), 0) <= 0)
        return false;
    nlmsghdr header;
    std::memcpy(&header, answer.data(), sizeof header);
    return header.nlmsg_type == SOCK_DIAG_BY_FAMILY;  // this test's own sockets are among them
}

class LocalReceiver : public testing::Test {
  protected:
    Fd sender_ = open_udp(INADDR_LOOPBACK, 0), receiver_ = open_udp(INADDR_LOOPBACK, 0);
    sockaddr_in from_ = address_of(sender_), to_ = address_of(receiver_);
    ReceiverRoom room_;
    std::atomic<bool> stop_{false};
    static constexpr std::size_t kDatagram = 7650;  // the payload of a packet of 7680 bytes

    static sockaddr_in address_of(const Fd& socket) {
        sockaddr_in address{};
        socklen_t size = sizeof address;
        getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
        return address;
    }
    void SetUp() override {
        if (!kernel_tells_udp_sockets()) GTEST_SKIP() << "this kernel does not tell of UDP sockets";
        ASSERT_TRUE(room_.free_bytes(from_, to_));
    }
    void send() {
        const std::array<char, kDatagram> bytes{};
        ASSERT_EQ(sendto(sender_.get(), bytes.data(), bytes.size(), 0,
                         reinterpret_cast<const sockaddr*>(&to_), sizeof to_),
                  static_cast<ssize_t>(bytes.size()));
    }
    // Datagrams that were in the buffer.
    int drain() {
        std::array<char, kDatagram> bytes;
        int count = 0;
        while (recv(receiver_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) ++count;
        return count;
    }
};

TEST_F(LocalReceiver, ADatagramTakesWhatWasReckoned) {
    const std::size_t empty = *room_.free_bytes(from_, to_);
    send();
    const std::size_t taken = empty - *room_.free_bytes(from_, to_);
    EXPECT_LE(taken, ReceiverRoom::bytes_of(7680));
    EXPECT_GT(taken, kDatagram);
}

// The largest packet a client may ask for: even one alone must fit what is waited for.
TEST_F(LocalReceiver, EveryPacketSizeFitsAnEmptyDefaultBuffer) {
    for (const std::size_t bytes : {576u, 1500u, 7680u, 9000u, 16384u})
        EXPECT_LT(ReceiverRoom::bytes_of(bytes), *room_.free_bytes(from_, to_)) << bytes;
}

TEST_F(LocalReceiver, NothingIsLostWhileRoomIsWaitedForAndTheReceiverReads) {
    std::atomic<int> received{0};
    std::thread reader([&] {
        while (received < 400) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            received += drain();
        }
    });
    for (int i = 0; i < 400; ++i) {
        room_.wait(from_, to_, ReceiverRoom::bytes_of(7680), stop_);
        send();
    }
    reader.join();  // ends only when all have come
    EXPECT_EQ(received, 400);
}

TEST_F(LocalReceiver, WithoutWaitingTheSameIsLost) {
    for (int i = 0; i < 400; ++i) send();
    EXPECT_LT(drain(), 400);
}

TEST_F(LocalReceiver, AReceiverThatDoesNotReadIsWaitedForOnceUntilItReadsAgain) {
    for (int i = 0; i < 400; ++i) send();
    const auto ms_of_wait = [&] {
        const auto start = std::chrono::steady_clock::now();
        room_.wait(from_, to_, ReceiverRoom::bytes_of(7680), stop_);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    EXPECT_GE(ms_of_wait(), ReceiverRoom::kPatience_ns * 1e-6);
    const std::size_t before = *room_.free_bytes(from_, to_);
    ms_of_wait();
    EXPECT_EQ(*room_.free_bytes(from_, to_), before);
    drain();
    EXPECT_GT(*room_.free_bytes(from_, to_), ReceiverRoom::bytes_of(7680));
}

TEST_F(LocalReceiver, NoSocketNoAnswer) {
    receiver_.reset();
    EXPECT_FALSE(room_.free_bytes(from_, to_));
    room_.wait(from_, to_, 1 << 30, stop_);  // returns
}

}  // namespace
}  // namespace hilcam
