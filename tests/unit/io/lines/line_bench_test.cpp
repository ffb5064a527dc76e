// The wires of a bench over loopback. Ports are the kernel's choice where possible.

#include "io/lines/line_bench.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <functional>
#include <mutex>
#include <thread>

#include "io/lines/gpio_pin.h"
#include "io/lines/pps_source.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"
#include "wired_camera.h"

namespace hilcam {
namespace {

// Triggers come from the bench's thread.
class SharedCamera : public WiredCamera {
  public:
    TriggerResult trigger(const TriggerOrder& order) override {
        const std::lock_guard lock(mutex_);
        return WiredCamera::trigger(order);
    }
    std::vector<TriggerOrder> taken() const {
        const std::lock_guard lock(mutex_);
        return orders;
    }

  private:
    mutable std::mutex mutex_;
};

std::uint16_t port_of(const Fd& socket) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
}

constexpr std::uint32_t kLoopback = 0x7F000001;

std::uint16_t free_port() { return port_of(open_udp(kLoopback, 0)); }

bool eventually(const std::function<bool()>& condition) {
    const std::int64_t until_ns = monotonic_ns() + 10'000'000'000;
    while (!condition()) {
        if (monotonic_ns() > until_ns) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

// Two cameras. Line0 and Line2 are inputs of both, Line1 is an output of the second.
struct UdpBench {
    Fd client = open_udp(kLoopback, 0);
    LinesConfig config;
    SharedCamera cameras[2];
    std::unique_ptr<CameraLines> lines[2];
    std::unique_ptr<LineBench> bench;
    sockaddr_in to{};

    UdpBench() {
        config.udp.emplace().port = free_port();
        config.udp->send_to = {"127.0.0.1:" + std::to_string(port_of(client))};
        config.inputs.emplace_back().line = 2;
        config.outputs.push_back({.line = 1, .camera = 2, .source = LineSignal::kUserOutput0});
        for (std::size_t i = 0; i < 2; ++i)
            lines[i] = std::make_unique<CameraLines>(cameras[i], plan_of(config, i + 1));
        bench = std::make_unique<LineBench>(config, std::vector{lines[0].get(), lines[1].get()});
        bench->start();
        to = socket_address(kLoopback, static_cast<std::uint16_t>(config.udp->port));
    }
    template <class Bytes>
    void send(const Bytes& bytes) {
        sendto(client.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
               sizeof to);
    }
    void edge(const EdgeDatagram& edge) { send(encode_edge(edge)); }
    std::optional<EdgeDatagram> receive() {
        pollfd watched{client.get(), POLLIN, 0};
        std::array<std::uint8_t, 64> bytes;
        if (poll(&watched, 1, 10'000) != 1) return {};
        const ssize_t size = recv(client.get(), bytes.data(), bytes.size(), 0);
        return decode_edge(std::span(bytes).first(static_cast<std::size_t>(size)));
    }
};

TEST(LineBench, AnEdgeByUdpTriggersWhereItIsMeantTo) {
    UdpBench b;
    const std::int64_t before_ns = monotonic_ns();
    b.edge({0, true, EdgeClock::kNow, 0, 11, 0});
    ASSERT_TRUE(
        eventually([&] { return b.cameras[0].taken().size() == 1 && b.cameras[1].taken().size() == 1; }));
    const TriggerOrder order = b.cameras[0].taken()[0];
    EXPECT_EQ(order.sequence, 11u);
    EXPECT_GE(order.at_monotonic_ns, before_ns - 1'000'000);  // the kernel's stamp is of another clock
    EXPECT_LE(order.at_monotonic_ns, monotonic_ns());
    b.edge({0, false, EdgeClock::kNow, 0, 12, 0});
    b.edge({0, true, EdgeClock::kNow, 2, 13, 0});
    ASSERT_TRUE(eventually([&] { return b.cameras[1].taken().size() == 2; }));
    EXPECT_EQ(b.cameras[0].taken().size(), 1u);
    EXPECT_TRUE(eventually([&] { return b.bench->report().edges_in == 3; }));
    EXPECT_EQ(b.bench->report().edges_refused, 0u);
}

TEST(LineBench, AnEdgeWithATimeCountsFromThen) {
    UdpBench b;
    const std::int64_t at_ns = monotonic_ns() + 30'000'000;
    b.edge({0, true, EdgeClock::kMonotonic, 1, 1, at_ns});
    ASSERT_TRUE(eventually([&] { return b.cameras[0].taken().size() == 1; }));
    EXPECT_GE(monotonic_ns(), at_ns);
    EXPECT_EQ(b.cameras[0].taken()[0].at_monotonic_ns, at_ns);
    b.edge({0, true, EdgeClock::kTai, 2, 2, clock_ns(CLOCK_TAI) + 30'000'000});
    const std::int64_t due_ns = monotonic_ns() + 30'000'000;
    ASSERT_TRUE(eventually([&] { return b.cameras[1].taken().size() == 1; }));
    EXPECT_NEAR(static_cast<double>(b.cameras[1].taken()[0].at_monotonic_ns - due_ns), 0, 20e6);
}

TEST(LineBench, WhatIsNoEdgeOrForNobodyIsCounted) {
    UdpBench b;
    b.send(std::array<std::uint8_t, 3>{1, 2, 3});
    b.send(std::array<std::uint8_t, 200>{});
    b.edge({1, true, EdgeClock::kNow, 0, 0, 0});                // an output, or nothing
    b.edge({0, true, EdgeClock::kNow, 3, 0, 0});                // no such camera
    b.edge({0, true, EdgeClock::kMonotonic, 0, 0, 1});          // long ago
    b.edge({0, true, EdgeClock::kMonotonic, 0, 0, INT64_MAX});  // never
    b.edge({0, true, EdgeClock::kTai, 0, 0, INT64_MIN});        // before all times
    EXPECT_TRUE(eventually([&] { return b.bench->report().edges_refused == 7; }));
    EXPECT_TRUE(b.cameras[0].taken().empty());
    EXPECT_EQ(b.bench->report().edges_in, 0u);
}

TEST(LineBench, AnOutputsEdgesGoToTheReceivers) {
    UdpBench b;
    for (const bool level : {true, false}) {
        LineSettings settings = b.lines[1]->settings();
        settings.user_outputs = level ? 1 : 0;
        const std::int64_t at_ns = monotonic_ns();
        b.lines[1]->change(settings, at_ns);
        const auto edge = b.receive();
        ASSERT_TRUE(edge);
        EXPECT_EQ(*edge, (EdgeDatagram{1, level, EdgeClock::kMonotonic, 2, level ? 1u : 2u, at_ns}));
    }
    EXPECT_TRUE(eventually([&] { return b.bench->report().edges_out == 2; }));
    EXPECT_EQ(b.bench->report().edges_lost, 0u);
}

TEST(LineBench, AWidthByUdpIsExactWhateverTheNetworkDoes) {
    UdpBench b;
    for (SharedCamera& camera : b.cameras) camera.s.exposure_mode = ExposureMode::kTriggerWidth;
    const std::int64_t begin_ns = monotonic_ns() + 20'000'000;
    b.edge({0, false, EdgeClock::kMonotonic, 1, 2, begin_ns + 3'000'000});  // its end comes first
    b.edge({0, true, EdgeClock::kMonotonic, 1, 1, begin_ns});
    ASSERT_TRUE(eventually([&] { return b.cameras[0].taken().size() == 1; }));
    const TriggerOrder order = b.cameras[0].taken()[0];
    EXPECT_EQ(order.until_monotonic_ns - order.at_monotonic_ns, 3'000'000);
}

TEST(LineBench, ADeviceThatIsNotThereIsNamed) {
    const auto reason = [](const std::function<void()>& open) -> std::string {
        try {
            open();
        } catch (const DeviceError& error) {
            return error.what();
        }
        return "opened";
    };
    PinConfig pin{.gpio = "/dev/no_such_chip", .pin = 17};
    EXPECT_EQ(reason([&] { open_input_pin(pin); }),
              "/dev/no_such_chip pin 17: No such file or directory; gpiodetect lists the chips");
    pin.gpio = "/dev/null";
    EXPECT_EQ(reason([&] { open_output_pin(pin, true); }),
              "/dev/null pin 17: Inappropriate ioctl for device; it is no GPIO chip");
    EXPECT_EQ(reason([] { PpsSource source("/dev/no_such_pps"); }),
              "/dev/no_such_pps: No such file or directory; ls /dev/pps* shows what there is");
    EXPECT_EQ(reason([] { PpsSource source("/dev/null"); }),
              "/dev/null: Inappropriate ioctl for device; it is no PPS device");
}

std::string refusal(const LinesConfig& config) {
    try {
        validate(config);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(LinesConfig, ALineHasOneUse) {
    LinesConfig c;
    c.inputs = {{.line = 2}, {.line = 0, .pin = {.gpio = "/dev/gpiochip0"}}};
    c.outputs = {{.line = 1, .camera = 1}, {.line = 1, .camera = 2}};
    EXPECT_EQ(refusal(c), "");
    const LinePlan first = plan_of(c, 1), third = plan_of(c, 3);
    EXPECT_TRUE(first.is_output[1] && first.is_there[2] && first.has_pin[0]);
    EXPECT_TRUE(third.is_there[2] && !third.is_there[1]);
    c.outputs.push_back({.line = 2, .camera = 3});
    EXPECT_EQ(refusal(c), "outputs.2.line: found 2, which is an input; accepted: a line for each");
    c.outputs[2] = {.line = 1, .camera = 2};
    EXPECT_EQ(refusal(c), "outputs.2.line: found 1, which is an output already; accepted: a line for each");
    c.outputs.pop_back();
    c.inputs.push_back({.line = 2, .camera = 1});
    EXPECT_EQ(refusal(c), "inputs.2.line: found 2, which is an input already; accepted: a line for each");
    c.inputs.pop_back();
    c.trigger.emplace().line = 3;
    EXPECT_EQ(refusal(c), "trigger.line: found 3; accepted: 0, or a line of lines.inputs");
    c.trigger->line = 2, c.trigger->divider = 4, c.trigger->exposure = ExposureMode::kTriggerWidth;
    EXPECT_EQ(refusal(c), "");
    const SettingsChange change = change_of(*c.trigger);
    EXPECT_EQ(change.trigger_source, TriggerSource::kLine2);
    EXPECT_EQ(change.trigger_divider, 4);
    EXPECT_EQ(change.exposure_mode, ExposureMode::kTriggerWidth);
}

}  // namespace
}  // namespace hilcam
