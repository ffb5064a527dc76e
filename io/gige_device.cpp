#include "io/gige_device.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/bytes.h"
#include "io/genicam_xml.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

namespace {

constexpr std::uint32_t kMemoryBytes = 0x10000;
constexpr std::uint32_t kExclusive = 1, kControl = 2;
constexpr std::uint32_t kFireTest = 1u << 31, kDoNotFragment = 1u << 30;
constexpr std::uint32_t kMostMemoryRead = 536;

}  // namespace

GigeDevice::GigeDevice(const GigeIdentity& id, CameraControl& camera, FaultBoard& faults, Effects effects)
    : camera_(camera),
      faults_(faults),
      effects_(std::move(effects)),
      features_(gige_features(camera.limits())),
      memory_(kMemoryBytes) {
    const std::string xml = genicam_xml(features_, id.model);
    xml_.assign(xml.begin(), xml.end());
    xml_.resize((xml_.size() + 3) / 4 * 4);

    namespace b = bootstrap;
    put(b::kVersion, 1u << 16 | 2);
    put(b::kDeviceMode, 1u << 31 | 1);  // big-endian transmitter, UTF-8
    put(b::kMacHigh, static_cast<std::uint32_t>(id.mac >> 32));
    put(b::kMacLow, static_cast<std::uint32_t>(id.mac));
    put(b::kIpSupported, 7);
    put(b::kIpCurrent, 4);
    put(b::kIp, id.ip);
    put(b::kMask, id.mask);
    put(b::kGateway, id.gateway);
    put_text(b::kVendor, 32, "hilcam");
    put_text(b::kModel, 32, id.model);
    put_text(b::kDeviceVersion, 32, "1.0");
    put_text(b::kInfo, 48, "emulated spacecraft camera");
    put_text(b::kSerial, 16, id.serial);
    put_text(b::kUserName, 16, id.user_name);
    char url[128];
    std::snprintf(url, sizeof url, "Local:///hilcam.xml;%X;%zX", kXmlAddress, xml_.size());
    put_text(b::kXmlUrl, 512, url);
    put(b::kInterfaces, 1);
    put(b::kStreamChannels, 1);
    // User name, serial number, heartbeat disable; packet resend, WRITEMEM, concatenation.
    put(b::kGvcpCapability, 1u << 31 | 1u << 30 | 1u << 29 | 1u << 2 | 1u << 1 | 1u);
    put(b::kHeartbeat, 3000);
    put_u64(b::kTickFrequency, 1'000'000'000);
    put(b::kPacketSize, id.packet_bytes);

    const CameraLimits limits = camera.limits();
    put(reg::kSensorWidth, static_cast<std::uint32_t>(limits.width));
    put(reg::kSensorHeight, static_cast<std::uint32_t>(limits.height));
    put(reg::kWidth, static_cast<std::uint32_t>(limits.width));
    put(reg::kHeight, static_cast<std::uint32_t>(limits.height));
    put(reg::kPixelFormat, pfnc_code(native_format(limits.bits, limits.color_pattern), limits.color_pattern));
    put(reg::kAcquisitionFrameCount, 1);
    put(reg::kExposureMode, 1);
    put(reg::kFrameRateEnable, 1);
    publish_stream();
}

// --- memory
// --------------------------------------------------------------------------------------------------------

std::uint32_t GigeDevice::get(std::uint32_t address) const {
    return ByteReader(std::span(memory_).subspan(address, 4)).u32();
}
void GigeDevice::put(std::uint32_t address, std::uint32_t value) {
    ByteWriter(std::span(memory_).subspan(address, 4)).u32(value);
}
void GigeDevice::put_u64(std::uint32_t address, std::uint64_t value) {
    ByteWriter(std::span(memory_).subspan(address, 8)).u64(value);
}
void GigeDevice::put_text(std::uint32_t address, std::size_t size, const std::string& text) {
    const auto field = std::span(memory_).subspan(address, size);
    std::fill(field.begin(), field.end(), std::uint8_t{0});
    // The last byte stays zero.
    std::copy_n(text.begin(), std::min(text.size(), size - 1), field.begin());
}

// Features that others may have changed: read from the camera just before they are sent.
void GigeDevice::refresh_live_registers() {
    const CameraSettings s = camera_.settings();
    put_u64(reg::kExposureTime_us, std::bit_cast<std::uint64_t>(s.exposure_s * 1e6));
    put_u64(reg::kGain_db, std::bit_cast<std::uint64_t>(s.gain_db));
    put_u64(reg::kFrameRate_hz, std::bit_cast<std::uint64_t>(s.frame_rate_hz));
}

// --- messages
// ------------------------------------------------------------------------------------------------------

std::size_t GigeDevice::handle(std::span<const std::uint8_t> datagram, Endpoint from, std::int64_t now_ns,
                               std::span<std::uint8_t> out, bool broadcast) {
    gvcp::Header header;
    if (!gvcp::read_header(datagram, header)) return 0;
    if (broadcast && (header.command != gvcp::kDiscovery ||
                      (from.ip & get(bootstrap::kMask)) != (get(bootstrap::kIp) & get(bootstrap::kMask))))
        return 0;
    tick(now_ns);
    if (from == controller_) last_heard_ns_ = now_ns;
    const bool changes = header.command == gvcp::kWriteRegister || header.command == gvcp::kWriteMemory;
    if (changes && last_write_.request_id == header.request_id && last_write_.command == header.command &&
        last_write_.from == from) {
        std::copy_n(last_write_.answer.begin(), last_write_.bytes, out.begin());
        return last_write_.bytes;
    }
    const auto payload = datagram.subspan(gvcp::kHeaderBytes);
    const Answer result = answer(header, payload, from, now_ns, out.subspan(gvcp::kHeaderBytes));
    if (header.command == gvcp::kPacketResend) return 0;  // answered on the stream
    gvcp::write_answer_header(result.status, header.command, result.bytes, header.request_id, out);
    const std::size_t size = gvcp::kHeaderBytes + result.bytes;
    if (changes) {
        last_write_.from = from, last_write_.request_id = header.request_id,
        last_write_.command = header.command;
        last_write_.bytes = size;
        std::copy_n(out.begin(), size, last_write_.answer.begin());
    }
    const bool wanted = header.flags & gvcp::Header::kAcknowledgeFlag || header.command == gvcp::kDiscovery;
    return wanted ? size : 0;
}

GigeDevice::Answer GigeDevice::answer(const gvcp::Header& header, std::span<const std::uint8_t> payload,
                                      Endpoint from, std::int64_t now_ns, std::span<std::uint8_t> out) {
    // An exclusive controller hides all but the device's existence.
    const bool hidden = controlled() && (get(bootstrap::kControl) & kExclusive) && from != controller_;
    switch (header.command) {
        case gvcp::kDiscovery:
            std::copy_n(memory_.begin(), gvcp::kDiscoveryBytes, out.begin());
            return {Status::kSuccess, gvcp::kDiscoveryBytes};
        case gvcp::kReadRegister:
            return hidden ? Answer{Status::kAccessDenied} : read_registers(payload, out);
        case gvcp::kReadMemory:
            return hidden ? Answer{Status::kAccessDenied} : read_memory(payload, out);
        case gvcp::kWriteRegister:
            return write_registers(payload, from, now_ns, out);
        case gvcp::kWriteMemory:
            return write_memory(payload, from, now_ns, out);
        case gvcp::kPacketResend: {
            gvcp::ResendRequest request;
            // From the stream's own address only; Aravis asks from its stream socket, not from the
            // controller's.
            if (gvcp::read_resend(payload, header.flags & gvcp::Header::kExtendedFlag, request) &&
                effects_.resend && from.ip == stream_.destination.ip)
                effects_.resend(request, from);
            return {};
        }
        default:
            return {Status::kNotImplemented};
    }
}

GigeDevice::Answer GigeDevice::read_registers(std::span<const std::uint8_t> payload,
                                              std::span<std::uint8_t> out) {
    if (payload.empty() || payload.size() % 4 != 0 || payload.size() > kMostMemoryRead)
        return {Status::kInvalidParameter};
    refresh_live_registers();
    ByteReader in(payload);
    ByteWriter values(out);
    while (in.left() > 0) {
        const std::uint32_t address = in.u32();
        if (address % 4 != 0) return {Status::kBadAlignment, values.size()};
        if (address > kMemoryBytes - 4) return {Status::kInvalidAddress, values.size()};
        values.u32(get(address));
    }
    return {Status::kSuccess, values.size()};
}

GigeDevice::Answer GigeDevice::read_memory(std::span<const std::uint8_t> payload,
                                           std::span<std::uint8_t> out) {
    ByteReader in(payload);
    const std::uint32_t address = in.u32();
    in.u16();
    const std::uint16_t count = in.u16();
    if (!in.ok() || in.left() != 0 || count == 0 || count > kMostMemoryRead)
        return {Status::kInvalidParameter};
    if (address % 4 != 0 || count % 4 != 0) return {Status::kBadAlignment};
    refresh_live_registers();
    std::span<const std::uint8_t> source = memory_;
    std::size_t at = address;
    if (address >= kXmlAddress) source = xml_, at = address - kXmlAddress;
    if (at + count > source.size()) {
        // Clients read the description in fixed pieces; the part past its end reads as zeros.
        if (address < kXmlAddress || at >= source.size()) return {Status::kInvalidAddress};
    }
    ByteWriter answer(out);
    answer.u32(address);
    for (std::size_t i = at; i < at + count; ++i) answer.u8(i < source.size() ? source[i] : 0u);
    return {Status::kSuccess, answer.size()};
}

GigeDevice::Answer GigeDevice::write_registers(std::span<const std::uint8_t> payload, Endpoint from,
                                               std::int64_t now_ns, std::span<std::uint8_t> out) {
    ByteReader in(payload);
    Status status = payload.empty() || payload.size() % 8 != 0 ? Status::kInvalidParameter : Status::kSuccess;
    std::uint16_t done = 0;
    while (status == Status::kSuccess && in.left() > 0) {
        const std::uint32_t address = in.u32();
        std::array<std::uint8_t, 4> data;
        ByteWriter(data).u32(in.u32());
        status = address % 4 != 0 ? Status::kBadAlignment : write(address, data, from, now_ns);
        if (status == Status::kSuccess) ++done;
    }
    ByteWriter(out).u16(0).u16(done);
    return {status, 4};
}

GigeDevice::Answer GigeDevice::write_memory(std::span<const std::uint8_t> payload, Endpoint from,
                                            std::int64_t now_ns, std::span<std::uint8_t> out) {
    ByteReader in(payload);
    const std::uint32_t address = in.u32();
    const auto data = in.ok() ? in.rest() : std::span<const std::uint8_t>{};
    Status status = data.empty() ? Status::kInvalidParameter : Status::kSuccess;
    if (status == Status::kSuccess && (address % 4 != 0 || data.size() % 4 != 0))
        status = Status::kBadAlignment;
    if (status == Status::kSuccess) status = write(address, data, from, now_ns);
    ByteWriter(out).u16(0).u16(status == Status::kSuccess ? data.size() : 0);
    return {status, 4};
}

// --- writing
// -------------------------------------------------------------------------------------------------------

bool GigeDevice::may_write(Endpoint from, std::uint32_t address) const {
    if (from == controller_) return true;
    return address == bootstrap::kControl && !controlled();
}

Status GigeDevice::write(std::uint32_t address, std::span<const std::uint8_t> data, Endpoint from,
                         std::int64_t now_ns) {
    if (address > kMemoryBytes - 4 || data.size() > kMemoryBytes - address)
        return address >= kXmlAddress && address - kXmlAddress < xml_.size() ? Status::kWriteProtect
                                                                             : Status::kInvalidAddress;
    if (!may_write(from, address)) return Status::kAccessDenied;
    if (address == bootstrap::kUserName && data.size() <= 16) {
        put_text(address, 16,
                 std::string(data.begin(), std::find(data.begin(), data.end(), std::uint8_t{0})));
        return Status::kSuccess;
    }
    if (data.size() == 8) {
        ByteReader in(data);
        return write_float(address, in.f64());
    }
    if (data.size() != 4) return Status::kInvalidParameter;
    return write_number(address, ByteReader(data).u32(), from, now_ns);
}

Status GigeDevice::write_float(std::uint32_t address, double value) {
    SettingsChange change;
    if (address == reg::kExposureTime_us)
        change.exposure_s = value * 1e-6;
    else if (address == reg::kGain_db)
        change.gain_db = value;
    else if (address == reg::kFrameRate_hz)
        change.frame_rate_hz = value;
    else
        return Status::kWriteProtect;
    return camera_.change(change) ? Status::kSuccess : Status::kInvalidParameter;
}

Status GigeDevice::write_number(std::uint32_t address, std::uint32_t value, Endpoint from,
                                std::int64_t now_ns) {
    namespace b = bootstrap;
    switch (address) {
        case b::kControl: {
            const Status status = write_privilege(value, from);
            if (from == controller_) last_heard_ns_ = now_ns;
            return status;
        }
        case b::kPacketSize:
            return write_packet_size(value);
        case b::kStreamPort:
            put(address, value & 0xFFFF);
            if ((value & 0xFFFF) == 0) stop_acquisition();
            publish_stream();
            return Status::kSuccess;
        case b::kStreamAddress:
        case b::kPacketDelay:
            put(address, value);
            publish_stream();
            return Status::kSuccess;
        case b::kTimestampControl:
            if (value & 2) put_u64(b::kTimestamp, static_cast<std::uint64_t>(now_ns));
            return Status::kSuccess;
        case b::kGvcpConfig:
            put(address, value & 1);  // heartbeat disable
            return Status::kSuccess;
        case reg::kAcquisitionStart:
            if (value & 1) start_acquisition();
            return Status::kSuccess;
        case reg::kAcquisitionStop:
            if (value & 1) stop_acquisition();
            return Status::kSuccess;
        default:
            break;
    }
    for (const Feature& feature : features_)
        if (feature.address == address && feature.bytes == 4 && feature.lsb < 0)
            return write_feature(feature, value);
    return Status::kWriteProtect;
}

Status GigeDevice::write_feature(const Feature& feature, std::uint32_t value) {
    if (feature.access == Feature::Access::kRead) return Status::kWriteProtect;
    if (feature.locked_while_streaming && stream_.acquiring) return Status::kWriteProtect;
    if (!feature.entries.empty()) {
        const auto known = [&](const EnumEntry& entry) { return entry.value == value; };
        if (std::none_of(feature.entries.begin(), feature.entries.end(), known))
            return Status::kInvalidParameter;
    } else if (value < feature.least || value > feature.most) {
        return Status::kInvalidParameter;
    }
    return write_geometry(feature.address, value);
}

// Offsets and sizes together must stay on the sensor; the offset gives way as SFNC cameras do it: a size that
// does not fit is refused, so set offsets to 0 first.
Status GigeDevice::write_geometry(std::uint32_t address, std::uint32_t value) {
    const std::uint32_t before = get(address);
    put(address, value);
    if (get(reg::kWidth) + get(reg::kOffsetX) > get(reg::kSensorWidth) ||
        get(reg::kHeight) + get(reg::kOffsetY) > get(reg::kSensorHeight)) {
        put(address, before);
        return Status::kInvalidParameter;
    }
    publish_stream();
    return Status::kSuccess;
}

Status GigeDevice::write_privilege(std::uint32_t value, Endpoint from) {
    value &= kExclusive | kControl;
    if (value == 0) {
        release_control();
        return Status::kSuccess;
    }
    put(bootstrap::kControl, value);
    controller_ = from;
    put(bootstrap::kPrimaryPort, from.port);
    put(bootstrap::kPrimaryIp, from.ip);
    return Status::kSuccess;
}

Status GigeDevice::write_packet_size(std::uint32_t value) {
    const std::uint32_t size = value & 0xFFFF;
    if (size < 576 || size > 16384) return Status::kInvalidParameter;
    if (stream_.acquiring && size != stream_.packet_bytes) return Status::kWriteProtect;
    put(bootstrap::kPacketSize, (value & kDoNotFragment) | size);
    publish_stream();
    if (value & kFireTest && effects_.test_packet && stream_.open)
        effects_.test_packet(stream_, size - 28);  // without IP and UDP headers
    return Status::kSuccess;
}

void GigeDevice::start_acquisition() {
    stream_.acquiring = true;
    ++stream_.epoch;
    publish_stream();
}

void GigeDevice::stop_acquisition() {
    if (!stream_.acquiring) return;
    stream_.acquiring = false;
    publish_stream();
}

void GigeDevice::acquisition_finished(std::uint32_t epoch) {
    if (epoch == stream_.epoch) stop_acquisition();
}

void GigeDevice::release_control() {
    controller_ = {};
    put(bootstrap::kControl, 0);
    put(bootstrap::kPrimaryPort, 0);
    put(bootstrap::kPrimaryIp, 0);
    put(bootstrap::kStreamPort, 0);
    put(reg::kParamsLocked, 0);
    last_write_ = {};
    stop_acquisition();
    publish_stream();
}

void GigeDevice::set_ports(std::uint16_t stream, std::uint16_t) { put(bootstrap::kStreamSourcePort, stream); }

void GigeDevice::happened(const CameraEvent&, std::uint64_t, std::int64_t) {}

std::int64_t GigeDevice::wake_ns() const { return ticked_ns_ + kLongestSleep_ns; }

void GigeDevice::tick(std::int64_t now_ns) {
    ticked_ns_ = now_ns;
    if (!controlled() || get(bootstrap::kGvcpConfig) & 1) return;
    if (now_ns - last_heard_ns_ > std::int64_t{get(bootstrap::kHeartbeat)} * 1'000'000) release_control();
}

void GigeDevice::publish_stream() {
    namespace b = bootstrap;
    stream_.destination = {get(b::kStreamAddress), static_cast<std::uint16_t>(get(b::kStreamPort))};
    stream_.open = stream_.destination.port != 0 && stream_.destination.ip != 0;
    const std::uint32_t size = get(b::kPacketSize);
    stream_.packet_bytes = size & 0xFFFF;
    stream_.do_not_fragment = size & kDoNotFragment;
    stream_.packet_delay_ns = get(b::kPacketDelay);
    const CameraLimits limits = camera_.limits();
    for (const WireFormat format : formats_of(limits.color_pattern))
        if (pfnc_code(format, limits.color_pattern) == get(reg::kPixelFormat)) stream_.format = format;
    stream_.width = get(reg::kWidth), stream_.height = get(reg::kHeight);
    stream_.offset_x = get(reg::kOffsetX), stream_.offset_y = get(reg::kOffsetY);
    const std::uint32_t mode = get(reg::kAcquisitionMode);
    stream_.frames = mode == kSingleFrame ? 1 : mode == kMultiFrame ? get(reg::kAcquisitionFrameCount) : 0;
    put(reg::kPayloadSize, static_cast<std::uint32_t>(stream_.payload_bytes()));
    put(reg::kParamsLocked, stream_.acquiring ? 1 : 0);
    if (effects_.stream_changed) effects_.stream_changed(stream_);
}

}  // namespace hilcam
