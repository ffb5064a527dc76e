// A conversation with the camera's control port: [u8 sender, way and time][u16 length][datagram] repeated.
// The byte: bit 0 which client, bit 1 by broadcast, bit 2 a mosaic's camera, bit 3 an exposure begins, upper
// half: tenths of seconds that pass. Whatever is said, answers fit their buffer, the window stays on the
// sensor, and what is told to the stream side is something it can do.

#include <algorithm>
#include <random>
#include <vector>

#include "io/gige/device/gige_device.h"
#include "io/gige/device/gige_transport.h"
#include "io/system/bytes.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

class AnyCamera : public CameraControl {
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
                   .min_frame_rate_hz = 0.1,
                   .max_frame_rate_hz = 200,
                   .max_binning = 4,
                   .reversible = true,
                   .has_sequencer = true};
    Sequencer own_sequencer;

    CameraSettings settings() const override { return s; }
    CameraLimits limits() const override { return l; }
    Sequencer* sequencer() override { return &own_sequencer; }
    bool change(const SettingsChange& c) override {
        const auto within = [](const auto& value, double least, double most) {
            return !value || (static_cast<double>(*value) >= least && static_cast<double>(*value) <= most);
        };
        if (!within(c.exposure_s, l.min_exposure_s, l.max_exposure_s) ||
            !within(c.gain_db, l.min_gain_db, l.max_gain_db) ||
            !within(c.frame_rate_hz, l.min_frame_rate_hz, l.max_frame_rate_hz) ||
            !within(c.binning_x, 1, 4) || !within(c.binning_y, 1, 4))
            return false;
        s.exposure_s = c.exposure_s.value_or(s.exposure_s);
        s.gain_db = c.gain_db.value_or(s.gain_db);
        s.frame_rate_hz = c.frame_rate_hz.value_or(s.frame_rate_hz);
        s.triggered = c.triggered.value_or(s.triggered);
        s.burst_frames = c.burst_frames.value_or(s.burst_frames);
        s.binning_x = c.binning_x.value_or(s.binning_x);
        s.binning_y = c.binning_y.value_or(s.binning_y);
        return true;
    }
    TriggerResult trigger(const TriggerOrder&) override { return TriggerResult::kTaken; }
};

void check(const GigeStreamState& s) {
    HILCAM_CHECK(s.width >= 1 && s.height >= 1 && s.width + s.offset_x <= 640 / s.binning_x &&
                 s.height + s.offset_y <= 480 / s.binning_y);
    HILCAM_CHECK(s.packet_bytes >= GigeTransport::kMinPacketBytes &&
                 s.packet_bytes <= GigeTransport::kMaxPacketBytes && s.packet_bytes % 4 == 0);
    HILCAM_CHECK(s.payload_bytes() < 640 * 480 * 3 + 1000);
    HILCAM_CHECK(s.chunks < 1u << kChunks);
}

GigeEffects effects() {
    GigeEffects e;
    e.stream_changed = check;
    e.resend = [](const gvcp::ResendRequest& r, Endpoint) {
        HILCAM_CHECK(r.block != 0 && r.first_packet <= r.last_packet);
    };
    e.test_packet = [](const GigeStreamState&, std::size_t bytes) { HILCAM_CHECK(bytes <= 16384 - 28); };
    e.send_message = [](std::span<const std::uint8_t> bytes, Endpoint to) {
        HILCAM_CHECK(gvcp::read_header(bytes) && to.port != 0);
    };
    e.send_answer = [](std::span<const std::uint8_t> bytes, Endpoint) {
        HILCAM_CHECK(gvcp::read_answer_header(bytes));
    };
    e.change_address = [](std::uint32_t ip, std::uint32_t, std::uint32_t) { return ip % 2 == 0; };
    e.system_clock = [] { return GigeSystemClock{37'000'000'000, true, true, 0}; };
    return e;
}

// A conversation's datagrams with the byte before each.
struct Said {
    std::uint8_t how;
    std::vector<std::uint8_t> datagram;
};

std::vector<Said> read(std::span<const std::uint8_t> bytes) {
    std::vector<Said> all;
    while (bytes.size() >= 3) {
        const std::size_t length =
            std::min<std::size_t>(ByteReader(bytes.subspan(1)).u16(), bytes.size() - 3);
        const auto datagram = bytes.subspan(3, length);
        all.push_back({bytes[0], {datagram.begin(), datagram.end()}});
        bytes = bytes.subspan(3 + length);
    }
    return all;
}

// One datagram changed: a byte, a bit, a register's neighbour, cut or longer. Mostly with a length and a
// request id (bytes 4-7 of GVCP's header) that let it pass for a new command.
void damage(std::vector<std::uint8_t>& datagram, std::mt19937& random) {
    if (datagram.empty()) return;
    const std::size_t at = random() % datagram.size();
    switch (random() % 6) {
        case 0:
            datagram[at] = static_cast<std::uint8_t>(random());
            break;
        case 1:
            datagram[at] ^= static_cast<std::uint8_t>(1u << random() % 8);
            break;
        case 2:
            datagram[at] = random() % 2 ? 0xFF : 0;
            break;
        case 3:
            datagram[at] = static_cast<std::uint8_t>(datagram[at] + (random() % 2 ? 4 : -4));
            break;
        case 4:
            datagram.resize(at);
            break;
        default: {  // its tail twice
            const std::size_t tail = datagram.size() - at;
            datagram.resize(datagram.size() + tail);
            std::copy_n(datagram.begin() + static_cast<std::ptrdiff_t>(at), tail,
                        datagram.end() - static_cast<std::ptrdiff_t>(tail));
        }
    }
    if (datagram.size() < 8 || random() % 8 == 0) return;
    const std::size_t body = datagram.size() - 8;
    datagram[4] = static_cast<std::uint8_t>(body >> 8);
    datagram[5] = static_cast<std::uint8_t>(body);
    datagram[6] = static_cast<std::uint8_t>(random());
    datagram[7] = static_cast<std::uint8_t>(random());
}

}  // namespace

// Keeps the datagrams apart, which bytes changed anywhere would not: what is said changes, not the framing.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Said> all = read({data, size});
    ByteWriter out({data, most});
    const auto write = [&](const Said& said) {
        if (out.size() + 3 + said.datagram.size() > most) return;
        out.u8(said.how);
        out.u16(static_cast<std::uint16_t>(said.datagram.size()));
        out.copy(said.datagram);
    };
    for (Said& said : all) {
        if (random() % 4 == 0) damage(said.datagram, random);
        if (random() % 32 == 0) said.how = static_cast<std::uint8_t>(random());
        if (random() % 32 != 0) write(said);
        if (random() % 32 == 0) write(all[random() % all.size()]);
    }
    return out.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    AnyCamera camera;
    if (size > 0 && data[0] & 4) camera.l.color_pattern = "RGGB";
    FaultBoard faults;
    GigeDevice device({"camera", "S1", "", 0x7F000001, 0xFF000000, 0, 0x020000000001, 1500}, camera, faults,
                      effects());
    std::vector<std::uint8_t> out(gvcp::kMaxDatagramBytes);
    std::span<const std::uint8_t> rest(data, size);
    std::int64_t now_ns = 1'000'000'000;
    while (rest.size() >= 3) {
        const Endpoint from{0x7F000001, static_cast<std::uint16_t>(40000 + (rest[0] & 1))};
        now_ns += std::int64_t{rest[0] >> 4} * 100'000'000;
        const std::size_t length = std::min<std::size_t>(ByteReader(rest.subspan(1)).u16(), rest.size() - 3);
        if (rest[0] & 8) device.on_event({CameraEvent::Kind::kExposureStart, 1, now_ns}, 1, now_ns);
        HILCAM_CHECK(device.handle(rest.subspan(3, length), from, now_ns, out, rest[0] & 2) <= out.size());
        check(device.stream_state());
        HILCAM_CHECK(device.wake_ns() <= now_ns + GigeDevice::kLongestSleep_ns);
        rest = rest.subspan(3 + length);
    }
    return 0;
}
