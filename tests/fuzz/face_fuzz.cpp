// The files of another camera's face: [u8 which][the file]. 0: a face table; 1: a registers file; 2: a
// description, plain or zipped. Whatever they hold, they are read or refused in one line; a table that was
// read is worn by a camera, whose registers clients then read and write, and what the stream side is told
// stays something that it can do.

#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "io/gige/device/gige_device.h"
#include "io/gige/face/description_file.h"
#include "io/gige/face/face_files.h"
#include "io/gige/stream/gige_chunk_layout.h"
#include "io/gige/stream/gige_packets.h"
#include "io/system/bytes.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

class AnyCamera : public CameraControl {
  public:
    CameraSettings s{.exposure_s = 0.001, .frame_rate_hz = 30};
    CameraSettings settings() const override { return s; }
    CameraLimits limits() const override {
        return {.width = 64,
                .height = 48,
                .bits = 12,
                .color_pattern = {},
                .min_exposure_s = 1e-5,
                .max_exposure_s = 1,
                .max_gain_db = 24,
                .min_frame_rate_hz = 0.1,
                .max_frame_rate_hz = 200};
    }
    bool change(const SettingsChange& c) override {
        apply(c, s);
        return true;
    }
    TriggerResult trigger(const TriggerOrder&) override { return TriggerResult::kTaken; }
};

void check(const GigeStreamState& s) {
    HILCAM_CHECK(s.width >= 1 && s.height >= 1 && s.width + s.offset_x <= 64 && s.height + s.offset_y <= 48);
    if (!s.chunk_mode) return;
    // The chunks fit into what the payload says.
    std::vector<std::uint8_t> out(s.payload_bytes());
    std::vector<std::uint16_t> scratch(3 * 64 + 8);
    DnImage frame(64, 48);
    write_gige_payload(frame, {}, s, {}, ~0ull, scratch, out);
}

void wear(const FaceTable& table) {
    auto files = std::make_shared<CameraFaceFiles>();
    files->xml = "<RegisterDescription></RegisterDescription>";
    files->table = table;
    files->table.width_px = 64, files->table.height_px = 48;
    AnyCamera camera;
    FaultBoard faults;
    GigeIdentity identity{"model", "serial", ""};
    identity.face = files;
    GigeDevice device(identity, camera, faults, {.stream_changed = check});
    std::minstd_rand random(static_cast<unsigned>(table.rows.size()));
    std::array<std::uint8_t, gvcp::kMaxDatagramBytes> out;
    std::uint16_t id = 1;
    const auto send = [&](std::uint16_t command, std::initializer_list<std::uint32_t> words) {
        std::vector<std::uint8_t> datagram(8 + 4 * words.size());
        ByteWriter w(datagram);
        w.u8(0x42).u8(1).u16(command).u16(4 * words.size()).u16(id++);
        for (const std::uint32_t word : words) w.u32(word);
        HILCAM_CHECK(device.handle(datagram, {0x7F000001, 5}, id * 1'000'000, out) <= out.size());
    };
    send(gvcp::kWriteRegister, {0xA00, 2});
    for (const FaceRow& row : table.rows) {
        const std::uint32_t address = row.field.address & ~3u;
        send(gvcp::kReadRegister, {address});
        send(gvcp::kReadMemory, {address, 8});
        send(gvcp::kWriteRegister, {address, static_cast<std::uint32_t>(row.command)});
        for (int i = 0; i < 3; ++i)
            send(gvcp::kWriteRegister, {address, static_cast<std::uint32_t>(random())});
        send(gvcp::kWriteMemory,
             {address, static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())});
    }
    send(gvcp::kReadMemory, {0xFFFFFFFC, 8});
    check(device.stream_state());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
    try {
        switch (data[0] % 3) {
            case 0:
                wear(face_table_of(text, "fuzz"));
                break;
            case 1:
                registers_of(text, "fuzz");
                break;
            default:
                HILCAM_CHECK(description_of(text, "fuzz").starts_with("<"));
        }
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
