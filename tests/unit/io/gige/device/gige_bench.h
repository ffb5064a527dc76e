#pragma once
// A GigE Vision device without sockets, a camera that keeps what it is told, and a client's words.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "io/gige/device/gige_device.h"
#include "io/gige/device/gige_registers.h"
#include "io/system/bytes.h"

namespace hilcam {

class PlainCamera : public CameraControl {
  public:
    CameraSettings s{.exposure_s = 0.001, .frame_rate_hz = 30};
    CameraLimits l{.width = 640,
                   .height = 480,
                   .bits = 12,
                   .color_pattern = {},
                   .min_exposure_s = 1e-5,
                   .max_exposure_s = 1,
                   .min_gain_db = 0,
                   .max_gain_db = 24,
                   .max_black_level_dn = 200,
                   .min_frame_rate_hz = 0.1,
                   .max_frame_rate_hz = 200,
                   .max_binning = 4,
                   .has_automatic_exposure = true,
                   .reversible = true,
                   .has_sequencer = true};
    std::vector<TriggerOrder> triggers;
    TriggerResult trigger_result = TriggerResult::kTaken;
    std::shared_ptr<Sequencer> own_sequencer = std::make_shared<Sequencer>();  // shared: cameras are copied

    CameraSettings settings() const override { return s; }
    CameraLimits limits() const override { return l; }
    Sequencer* sequencer() override { return l.has_sequencer ? own_sequencer.get() : nullptr; }
    bool change(const SettingsChange& c) override {
        const auto within = [](const auto& value, double least, double most) {
            return !value || (static_cast<double>(*value) >= least && static_cast<double>(*value) <= most);
        };
        const auto binning = [&](const std::optional<std::int64_t>& b) {
            return !b || (*b >= 1 && *b <= l.max_binning && (*b & (*b - 1)) == 0);
        };
        if (!within(c.exposure_s, l.min_exposure_s, l.max_exposure_s) ||
            !within(c.gain_db, l.min_gain_db, l.max_gain_db) ||
            !within(c.black_level_dn, 0, l.max_black_level_dn) ||
            !within(c.frame_rate_hz, l.min_frame_rate_hz, l.max_frame_rate_hz) ||
            !within(c.trigger_delay_s, 0, l.max_trigger_delay_s) ||
            !within(c.trigger_divider, 1, static_cast<double>(l.max_trigger_divider)) ||
            !binning(c.binning_x) || !binning(c.binning_y))
            return false;
        apply(c, s);
        return true;
    }
    TriggerResult trigger(const TriggerOrder& order) override {
        triggers.push_back(order);
        return trigger_result;
    }
};

inline constexpr Endpoint kClient{0x7F000001, 40000}, kOther{0x7F000001, 40001};

struct GigeBench {
    struct Sent {
        std::vector<std::uint8_t> bytes;
        Endpoint to;
    };
    struct Reply {
        unsigned status = 0xFFFF, command = 0, id = 0;  // status 0xFFFF: no answer
        std::vector<std::uint8_t> payload;
    };

    PlainCamera camera;
    CameraLines lines;
    FaultBoard faults{7};
    std::vector<gvcp::ResendRequest> resends;
    std::vector<std::size_t> tests;
    std::vector<Sent> messages, late;
    std::vector<std::uint32_t> addresses;
    bool has_address = true;
    int resets = 0;
    GigeSystemClock system_clock;
    std::int64_t now_ns = 1'000'000'000;
    std::uint16_t id = 1;

    // With a source other than tai: the device's clock, and what its PTP slave says and is told.
    ClockSource source;
    DeviceClock clock{{.rate = 100e-6}, {1'000'000'000, 0, 0}};
    PtpDataSet ptp_set;
    std::vector<bool> ptp_orders;
    GigeDevice device;

    explicit GigeBench(const CameraLimits* limits = nullptr, std::vector<std::string> more_lines = {},
                       ClockSource clock_source = ClockSource::kTai, bool ptp_at_power_up = false,
                       const LinePlan& plan = {}, std::shared_ptr<const CameraFaceFiles> face = {})
        : camera(limits ? with(*limits) : PlainCamera()),
          lines(camera, plan),
          source(clock_source),
          device({.model = "cam",
                  .serial = "S1",
                  .user_name = {},
                  .ip = 0x7F000001,
                  .mask = 0xFF000000,
                  .mac = 0x020000000001,
                  .multipart = true,
                  .more_lines = std::move(more_lines),
                  .clock_source = clock_source,
                  .ptp_at_power_up = ptp_at_power_up,
                  .face = std::move(face)},
                 camera, faults, effects(), &lines) {
        device.tick(now_ns);
    }
    static PlainCamera with(const CameraLimits& limits) {
        PlainCamera camera;
        camera.l = limits;
        return camera;
    }
    GigeEffects effects() {
        GigeEffects e;
        e.resend = [this](const gvcp::ResendRequest& r, Endpoint) { resends.push_back(r); };
        e.test_packet = [this](const GigeStreamState&, std::size_t n) { tests.push_back(n); };
        e.send_message = [this](auto bytes, Endpoint to) {
            messages.push_back({{bytes.begin(), bytes.end()}, to});
        };
        e.send_answer = [this](auto bytes, Endpoint to) {
            late.push_back({{bytes.begin(), bytes.end()}, to});
        };
        e.reset = [this] { ++resets; };
        e.change_address = [this](std::uint32_t ip, std::uint32_t, std::uint32_t) {
            if (has_address) addresses.push_back(ip);
            return has_address;
        };
        e.system_clock = [this] { return system_clock; };
        if (source == ClockSource::kTai) return e;
        e.clock = &clock;
        e.power_up_ns = [] { return std::int64_t{0}; };
        e.enable_ptp = [this](bool enabled) { ptp_orders.push_back(enabled); };
        e.ptp_data_set = [this] { return ptp_set; };
        return e;
    }

    static std::vector<std::uint8_t> words(std::initializer_list<std::uint32_t> values) {
        std::vector<std::uint8_t> out(4 * values.size());
        ByteWriter w(out);
        for (const std::uint32_t v : values) w.u32(v);
        return out;
    }
    static Reply decoded(std::span<const std::uint8_t> bytes) {
        if (bytes.empty()) return {};
        ByteReader in(bytes);
        Reply r;
        r.status = in.u16();
        r.command = in.u16();
        EXPECT_EQ(in.u16(), bytes.size() - 8);
        r.id = in.u16();
        r.payload.assign(in.rest().begin(), in.rest().end());
        return r;
    }
    std::span<const std::uint8_t> raw(const std::vector<std::uint8_t>& bytes, Endpoint from = kClient,
                                      bool broadcast = false) {
        return {out.data(), device.handle(bytes, from, now_ns, out, broadcast)};
    }
    // reuse: an id that was used before; 0: a new one.
    Reply send(std::uint16_t command, const std::vector<std::uint8_t>& payload, Endpoint from = kClient,
               std::uint16_t reuse = 0, std::uint8_t flags = 1, bool broadcast = false) {
        std::vector<std::uint8_t> bytes(8 + payload.size());
        const unsigned length = static_cast<unsigned>(payload.size());
        ByteWriter(bytes).u8(0x42).u8(flags).u16(command).u16(length).u16(reuse ? reuse : id++).copy(payload);
        return decoded(raw(bytes, from, broadcast));
    }
    unsigned write(std::uint32_t address, std::uint32_t value, Endpoint from = kClient) {
        return send(gvcp::kWriteRegister, words({address, value}), from).status;
    }
    unsigned write64(std::uint32_t address, std::uint64_t value) {
        std::vector<std::uint8_t> payload(12);
        ByteWriter(payload).u32(address).u64(value);
        return send(gvcp::kWriteMemory, payload).status;
    }
    unsigned write_real(std::uint32_t address, double value) {
        return write64(address, std::bit_cast<std::uint64_t>(value));
    }
    std::uint32_t read(std::uint32_t address, Endpoint from = kClient) {
        return ByteReader(send(gvcp::kReadRegister, words({address}), from).payload).u32();
    }
    Reply read_memory(std::uint32_t address, std::uint16_t bytes) {
        std::vector<std::uint8_t> ask(8);
        ByteWriter(ask).u32(address).u16(0).u16(bytes);
        return send(gvcp::kReadMemory, ask);
    }
    std::uint64_t read64(std::uint32_t address) {
        const Reply r = read_memory(address, 8);
        return ByteReader(std::span(r.payload).subspan(4)).u64();
    }
    double read_real(std::uint32_t address) { return std::bit_cast<double>(read64(address)); }
    void take_control() { ASSERT_EQ(write(bootstrap::kControl, 2), gvcp::kSuccess); }
    void open_stream() {
        write(bootstrap::kStreamAddress, kClient.ip);
        write(bootstrap::kStreamPort, 50000);
    }
    void wait_ms(std::int64_t ms) {
        now_ns += ms * 1'000'000;
        device.tick(now_ns);
    }

    std::vector<std::uint8_t> out = std::vector<std::uint8_t>(gvcp::kMaxDatagramBytes);
};

}  // namespace hilcam
