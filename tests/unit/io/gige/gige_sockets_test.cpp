// Which datagrams a camera hears. There is one interface here, loopback: a camera that says it is on another
// one stands for all the cases.

#include "io/gige/gige_sockets.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include "io/gige/device/gvcp.h"
#include "tests/support/gvsp_receiver.h"

namespace hilcam {
namespace {

// 127.84.0.0/14, of this process alone, as a camera's port is always the same.
std::uint32_t own_loopback(std::uint32_t host) {
    return 0x7F540000u | (static_cast<std::uint32_t>(getpid()) & 0x3FFu) << 8 | host;
}

struct Heard {
    int unicast = 0, broadcast = 0;
    std::uint64_t strange = 0;
};

// What a camera on an interface of this name hears of a datagram to itself, one to everybody and one to all
// of its network, all through the loopback interface.
Heard heard_on(const std::string& interface) {
    const std::uint32_t camera = own_loopback(1);
    GigeSockets sockets({.name = interface, .address = camera, .mask = 0xFF000000});
    const Fd wakeup = open_wakeup(), sender = open_udp(own_loopback(2), 0);
    const int on = 1;
    setsockopt(sender.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    for (const std::uint32_t to : {camera, 0xFFFFFFFFu, 0x7FFFFFFFu}) {
        const sockaddr_in address = socket_address(to, gvcp::kPort);
        EXPECT_EQ(
            sendto(sender.get(), "hello", 5, 0, reinterpret_cast<const sockaddr*>(&address), sizeof address),
            5);
    }
    Heard heard;
    const Endpoint from = endpoint_of(sender);
    // Delivery on loopback is done when sendto() returns. Other tests' broadcasts may come in between.
    sockets.wait(wakeup, 0);
    heard.strange = sockets.take([&](std::span<const std::uint8_t>, Endpoint who, bool broadcast) {
        if (who == from) ++(broadcast ? heard.broadcast : heard.unicast);
    });
    return heard;
}

TEST(GigeSockets, TheCamerasOwnInterfaceIsHeard) {
    const Heard heard = heard_on("lo");
    EXPECT_EQ(heard.unicast, 1);
    EXPECT_EQ(heard.broadcast, 2);
    EXPECT_EQ(heard.strange, 0u);
}

TEST(GigeSockets, ASecondNameOfTheInterfaceIsTheInterface) { EXPECT_EQ(heard_on("lo:1").broadcast, 2); }

// Programs of this machine reach a camera on any of its addresses through the loopback interface; broadcasts
// they send into their own network alone.
TEST(GigeSockets, OfOtherInterfacesOnlyThisMachinesOwnDatagramsAreHeard) {
    const Heard heard = heard_on("elsewhere0");
    EXPECT_EQ(heard.unicast, 1);
    EXPECT_EQ(heard.broadcast, 0);
    EXPECT_GE(heard.strange, 2u);
}

}  // namespace
}  // namespace hilcam
