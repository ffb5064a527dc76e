#include "io/gige/device/gige_image.h"

#include <algorithm>

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;
using When = GigeRegisterFile::When;

namespace {

std::uint32_t rounded_down(std::uint32_t value, std::uint32_t step) { return value / step * step; }

constexpr std::uint32_t kAllChunks = (1u << kChunks) - 1;
constexpr std::uint32_t kTestPatterns = static_cast<std::uint32_t>(TestPattern::kRampHorizontalMoving) + 1;

}  // namespace

GigeImage::GigeImage(GigeCore& core) : core_(core) {
    add_window();
    add_camera_settings();
    add_chunks();
    if (core_.identity.multipart) add_components();
    reset();
}

void GigeImage::reset() {
    GigeSettings& s = core_.settings;
    s.format = native_format(core_.limits.bits, core_.limits.color_pattern);
    s.chunk_mode = false;
    s.chunks = kAllChunks;
    s.components = bit_of(GigeComponent::kIntensity);
    s.offset_x = s.offset_y = 0;
    s.width = s.height = ~0u;
    fit();
}

// --- the window

GigeImage::Span GigeImage::columns() {
    const std::uint32_t most = static_cast<std::uint32_t>(core_.limits.width) / core_.stream.binning_x;
    return {core_.settings.offset_x, core_.settings.width, rounded_down(most, step(core_.limits))};
}
GigeImage::Span GigeImage::rows() {
    const std::uint32_t most = static_cast<std::uint32_t>(core_.limits.height) / core_.stream.binning_y;
    return {core_.settings.offset_y, core_.settings.height, rounded_down(most, step(core_.limits))};
}

void GigeImage::fit() {
    const CameraSettings now = core_.camera.settings();
    core_.stream.binning_x = static_cast<std::uint32_t>(std::max<std::int64_t>(1, now.binning_x));
    core_.stream.binning_y = static_cast<std::uint32_t>(std::max<std::int64_t>(1, now.binning_y));
    const std::uint32_t grain = step(core_.limits);
    for (const Span& s : {columns(), rows()}) {
        s.size = std::clamp(rounded_down(s.size, grain), grain, s.most);
        s.offset = std::min(rounded_down(s.offset, grain), s.most - s.size);
    }
}

void GigeImage::follow_binning() {
    if (core_.locked()) return;
    const CameraSettings now = core_.camera.settings();
    if (now.binning_x == core_.stream.binning_x && now.binning_y == core_.stream.binning_y) return;
    // A window that covered the whole image still does.
    for (const Span& s : {columns(), rows()})
        if (s.size == s.most) s.size = ~0u;
    fit();
    core_.publish_stream();
}

Status GigeImage::write_size(Span span, std::uint64_t value) {
    const std::uint32_t grain = step(core_.limits);
    if (value < grain || value % grain != 0 || value > span.most - span.offset)
        return Status::kInvalidParameter;
    span.size = static_cast<std::uint32_t>(value);
    core_.publish_stream();
    return Status::kSuccess;
}

Status GigeImage::write_offset(Span span, std::uint64_t value) {
    if (value % step(core_.limits) != 0 || value > span.most - span.size) return Status::kInvalidParameter;
    span.offset = static_cast<std::uint32_t>(value);
    core_.publish_stream();
    return Status::kSuccess;
}

Status GigeImage::write_format(std::uint64_t code) {
    for (const WireFormat format : formats_of(core_.limits.color_pattern)) {
        if (pfnc_code(format, core_.limits.color_pattern) != code) continue;
        core_.settings.format = format;
        core_.publish_stream();
        return Status::kSuccess;
    }
    return Status::kInvalidParameter;
}

std::uint32_t GigeImage::payload_bytes() const {
    return static_cast<std::uint32_t>(core_.stream.payload_bytes());
}

void GigeImage::add_window() {
    GigeRegisterFile& r = core_.registers;
    const auto window = [&](std::uint32_t size, std::uint32_t offset, Span (GigeImage::*span)()) {
        r.number(
            size, [this, span] { return (this->*span)().size; },
            [this, span](std::uint64_t v) { return write_size((this->*span)(), v); }, When::kUnlocked);
        r.number(
            offset, [this, span] { return (this->*span)().offset; },
            [this, span](std::uint64_t v) { return write_offset((this->*span)(), v); }, When::kUnlocked);
    };
    window(reg::kWidth, reg::kOffsetX, &GigeImage::columns);
    window(reg::kHeight, reg::kOffsetY, &GigeImage::rows);
    r.constant(reg::kSensorWidth, static_cast<std::uint32_t>(core_.limits.width));
    r.constant(reg::kSensorHeight, static_cast<std::uint32_t>(core_.limits.height));
    r.number(reg::kWidthMax, [this] { return columns().most; });
    r.number(reg::kHeightMax, [this] { return rows().most; });
    // The room that the present offset leaves for a size, and the present size for an offset.
    r.number(reg::kWidthRoom, [this] { return columns().most - columns().offset; });
    r.number(reg::kHeightRoom, [this] { return rows().most - rows().offset; });
    r.number(reg::kOffsetXMax, [this] { return columns().most - columns().size; });
    r.number(reg::kOffsetYMax, [this] { return rows().most - rows().size; });
    r.number(
        reg::kPixelFormat, [this] { return pfnc_code(core_.settings.format, core_.limits.color_pattern); },
        [this](std::uint64_t v) { return write_format(v); }, When::kUnlocked);
    r.number(reg::kPayloadSize, [this] { return payload_bytes(); });
}

// --- settings of the camera itself

Status GigeImage::write_binning(std::uint64_t x, std::uint64_t y) {
    SettingsChange change;
    const CameraSettings now = core_.camera.settings();
    const auto wanted_x = static_cast<std::int64_t>(x), wanted_y = static_cast<std::int64_t>(y);
    if (wanted_x != now.binning_x) change.binning_x = wanted_x;
    if (wanted_y != now.binning_y) change.binning_y = wanted_y;
    const Status status = core_.change(change);
    follow_binning();
    return status;
}

void GigeImage::add_camera_settings() {
    GigeRegisterFile& r = core_.registers;
    const auto settings = [this] { return core_.camera.settings(); };
    r.number(
        reg::kBinningX, [settings] { return static_cast<std::uint64_t>(settings().binning_x); },
        [this, settings](std::uint64_t v) {
            return write_binning(v, static_cast<std::uint64_t>(settings().binning_y));
        },
        When::kUnlocked);
    r.number(
        reg::kBinningY, [settings] { return static_cast<std::uint64_t>(settings().binning_y); },
        [this, settings](std::uint64_t v) {
            return write_binning(static_cast<std::uint64_t>(settings().binning_x), v);
        },
        When::kUnlocked);
    const auto mirror = [this](std::optional<bool> SettingsChange::*member) {
        return [this, member](std::uint64_t on) {
            if (on > 1) return Status::kInvalidParameter;
            SettingsChange change;
            change.*member = on != 0;
            return core_.change(change);
        };
    };
    r.number(
        reg::kReverseX, [settings] { return settings().reverse_x; }, mirror(&SettingsChange::reverse_x));
    r.number(
        reg::kReverseY, [settings] { return settings().reverse_y; }, mirror(&SettingsChange::reverse_y));
    r.number(
        reg::kTestPattern, [settings] { return static_cast<std::uint64_t>(settings().test_pattern); },
        [this](std::uint64_t v) {
            if (v >= kTestPatterns) return Status::kInvalidParameter;
            return core_.change({.test_pattern = static_cast<TestPattern>(v)});
        });
}

// --- chunks

void GigeImage::add_chunks() {
    GigeRegisterFile& r = core_.registers;
    r.number(
        reg::kChunkMode, [this] { return core_.settings.chunk_mode; },
        [this](std::uint64_t on) {
            if (on > 1) return Status::kInvalidParameter;
            core_.settings.chunk_mode = on != 0;
            core_.publish_stream();
            return Status::kSuccess;
        },
        When::kUnlocked);
    r.variable(reg::kChunkSelector, chunk_selector_, {0, kChunks - 1});
    r.number(
        reg::kChunkEnable, [this] { return core_.settings.chunks >> chunk_selector_ & 1u; },
        [this](std::uint64_t on) {
            if (on > 1) return Status::kInvalidParameter;
            const std::uint32_t bit = 1u << chunk_selector_;
            core_.settings.chunks = on ? core_.settings.chunks | bit : core_.settings.chunks & ~bit;
            core_.publish_stream();
            return Status::kSuccess;
        },
        When::kUnlocked);
}

// Clients switch all components off before they switch on those they want; a frame without any has its
// intensity.
void GigeImage::add_components() {
    GigeRegisterFile& r = core_.registers;
    const auto selected = [this] { return static_cast<GigeComponent>(component_selector_); };
    r.variable(reg::kComponentSelector, component_selector_, {0, 1});
    r.number(
        reg::kComponentEnable,
        [this, selected] { return (core_.settings.components & bit_of(selected())) != 0; },
        [this, selected](std::uint64_t on) {
            if (on > 1) return Status::kInvalidParameter;
            std::uint32_t& all = core_.settings.components;
            all = on ? all | bit_of(selected()) : all & ~bit_of(selected());
            core_.publish_stream();
            return Status::kSuccess;
        },
        When::kUnlocked);
    r.number(reg::kComponentId, [selected] { return std::uint64_t{id_of(selected())}; });
}

}  // namespace hilcam
