#include "io/gige/device/gige_device.h"

#include <algorithm>
#include <cmath>

#include "io/gige/device/genicam_xml.h"
#include "io/gige/device/gige_parts.h"
#include "io/gige/device/gige_registers.h"
#include "io/gige/device/gige_zip.h"

namespace hilcam {

namespace b = bootstrap;
namespace reg = feature_register;
using gvcp::Status;

namespace {

// Trailing blanks make the length a multiple of 4.
std::string padded(std::string xml) {
    xml.resize((xml.size() + 3) / 4 * 4, '\n');
    return xml;
}
std::span<const std::uint8_t> text_bytes(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

GigeDevice::Parts::Parts(const GigeIdentity& id, CameraControl& camera, FaultBoard& board,
                         GigeEffects effects, CameraLines* the_lines)
    : own_lines(the_lines ? nullptr : std::make_unique<CameraLines>(camera)),
      core(id, camera, the_lines ? *the_lines : *own_lines, board, std::move(effects)),
      bootstrap(core,
                [this](std::uint32_t before) {
                    const std::uint32_t changed = before ^ core.gvcp_config;
                    if (changed & b::gvcp_config::kPtpEnable)
                        clock.set_ptp(core.gvcp_config & b::gvcp_config::kPtpEnable);
                }),
      acquisition(core),
      transport(core, [this] { acquisition.stop(); }),
      messages(core),
      access(core, {.switched = [this] { messages.on_event(gvcp::Event::kPrimarySwitch); },
                    .released = [this] { left(); }}),
      clock(core),
      image(core),
      trigger(core),
      lines(core),
      sequencer(core),
      actions(core, [this] { messages.on_event(gvcp::Event::kActionLate); }),
      faults(core),
      user_sets(core,
                [this] {
                    image.fit();
                    trigger.rearm();
                    sequencer.stop();
                    core.publish_stream();
                }),
      xml(padded(id.face
                     ? id.face->xml
                     : genicam_xml(gige_features(core.limits, id.multipart, id.more_lines, core.lines.plan()),
                                   id.model))),
      zip(zip_of(id.face ? "camera.xml" : "hilcam.xml", id.face ? id.face->xml : xml)) {
    if (!id.face) bootstrap.add_description(text_bytes(xml), zip);
    add_device_registers();
    if (id.face) put_on_face(*id.face);
    acquisition.on_end([this] { trigger.rearm(); });
    core.publish_stream();
    bootstrap.power_up();
}

void GigeDevice::Parts::add_device_registers() {
    GigeRegisterFile& r = core.registers;
    r.command(reg::kDeviceReset, [this] {
        reset_wanted = true;  // after the answer is written
        return Status::kSuccess;
    });
    for (const std::uint32_t selector :
         {reg::kTemperatureSelector, reg::kInterfaceSelector, reg::kStreamSelector})
        r.variable(selector, only, {0, 0});
    r.real(reg::kTemperature_c, [this] { return core.camera.limits().temperature_c; });
    const GigeStreamStatistics& s = core.statistics;
    std::uint32_t address = reg::kStatistics;
    for (const std::uint64_t* const count : {&s.frames, &s.frames_dropped, &s.packets, &s.packets_dropped,
                                             &s.resend_requests, &s.packets_resent, &s.packets_refused}) {
        r.number64(address, [count] { return *count; });
        address += 8;
    }
    r.number64(address, [this] { return core.statistics.events_dropped + core.events_lost; });
}

void GigeDevice::Parts::put_on_face(const CameraFaceFiles& files) {
    const std::uint32_t place = free_place(files.table, zip.size());
    bootstrap.add_description("camera", zip, place);
    features = std::make_unique<FeatureTable>(
        gige_features(core.limits, core.identity.multipart, core.identity.more_lines, core.lines.plan()));
    face = std::make_unique<CameraFace>(files, core.registers, *features, place, zip.size());
    chunk_layout = chunk_layout_of(files.table, core.limits.color_pattern);
    if (!chunk_layout.parts.empty()) core.stream.chunk_layout = &chunk_layout;
}

void GigeDevice::Parts::left() {
    core.host_locked = false;
    messages.close();
    if (core.stream.unconditional) return;
    acquisition.stop();
    transport.close();
}

std::uint64_t GigeDevice::Parts::fault_index(std::uint16_t id) {
    if (id == last_id && core.from == last_from)
        ++attempt;
    else
        last_id = id, last_from = core.from, attempt = 0;
    return attempt << 16 | id;
}
GigeDevice::GigeDevice(const GigeIdentity& id, CameraControl& camera, FaultBoard& faults, Effects effects,
                       CameraLines* lines)
    : parts_(std::make_unique<Parts>(id, camera, faults, std::move(effects), lines)) {}
GigeDevice::~GigeDevice() = default;

void GigeDevice::set_ports(std::uint16_t stream, std::uint16_t message) {
    parts_->transport.set_source_port(stream);
    parts_->messages.set_source_port(message);
}
void GigeDevice::acquisition_finished(std::uint32_t epoch) { parts_->acquisition.finished(epoch); }
void GigeDevice::set_statistics(const GigeStreamStatistics& s) { parts_->core.statistics = s; }
bool GigeDevice::controlled() const { return parts_->access.controlled(); }
std::uint64_t GigeDevice::foreign_resend_requests() const { return parts_->foreign_resend_requests; }
PtpDataSet GigeDevice::ptp_data_set() const { return parts_->clock.data_set(); }
const GigeStreamState& GigeDevice::stream_state() const { return parts_->core.stream; }
std::string GigeDevice::xml() const { return parts_->xml; }

void GigeDevice::on_event(const CameraEvent& event, std::uint64_t block, std::int64_t now_ns) {
    parts_->core.now_ns = now_ns;
    parts_->messages.on_event(event, block);
    parts_->trigger.on_event(event);
    parts_->acquisition.on_event(event);
}

// --- time

void GigeDevice::tick(std::int64_t now_ns) {
    Parts& my = *parts_;
    my.core.now_ns = my.ticked_ns = now_ns;
    strike_device();
    my.access.tick();
    my.clock.tick();
    my.actions.tick();
    my.messages.tick();
    my.image.follow_binning();
    Endpoint to;
    for (auto answer = my.answers.take_due(now_ns, to); !answer.empty();
         answer = my.answers.take_due(now_ns, to))
        if (my.core.effects.send_answer && my.core.link_is_up()) my.core.effects.send_answer(answer, to);
}

std::int64_t GigeDevice::wake_ns() const {
    const Parts& my = *parts_;
    return std::min({my.ticked_ns + kLongestSleep_ns, my.access.deadline_ns(), my.actions.deadline_ns(),
                     my.messages.deadline_ns(), my.answers.deadline_ns()});
}

void GigeDevice::strike_device() {
    GigeCore& core = parts_->core;
    if (core.faults.strikes(FaultKind::kDeviceReset, 0)) reset();
    if (const auto step = core.faults.strikes(FaultKind::kIpChange, 0)) {
        const std::uint32_t last = core.identity.ip + static_cast<std::uint32_t>(std::lround(*step));
        const std::uint32_t ip = (core.identity.ip & ~0xFFu) | (last & 0xFF);
        if (core.effects.change_address &&
            core.effects.change_address(ip, core.identity.mask, core.identity.gateway))
            core.identity.ip = ip;
    }
}

void GigeDevice::reset() {
    Parts& my = *parts_;
    my.reset_wanted = false;
    my.core.stream.unconditional = false;
    my.access.reset();
    my.acquisition.stop();
    my.bootstrap.reset();
    my.clock.reset();
    my.transport.reset();
    my.actions.reset();
    my.user_sets.reset();
    my.messages.reset();
    my.answers.forget();
    if (my.face) my.face->reset();
    my.bootstrap.power_up();
    if (my.core.effects.reset) my.core.effects.reset();
}

}  // namespace hilcam
