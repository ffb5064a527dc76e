#include "io/gige/camera_clock.h"

#include "io/ptp/ptp_note.h"
#include "io/system/monotonic.h"

namespace hilcam {
namespace {

// Returns the device's clock as it starts now.
ClockLine first_line(const DeviceClockConfig& config) {
    if (config.source == ClockSource::kTai) return {};
    return {monotonic_ns(), start_ns(config, clock_ns(CLOCK_TAI)), 0};
}

const char* name_of(ClockSource source) {
    switch (source) {
        case ClockSource::kPtp:
            return "ptp";
        case ClockSource::kFree:
            return "free";
        case ClockSource::kTai:
            break;
    }
    return "tai";
}

}  // namespace

CameraClock::CameraClock(const DeviceClockConfig& config, const NetInterface& net)
    : config_(config), clock_(oscillator_of(config, net.address), first_line(config)) {}

void CameraClock::start(const NetInterface& net, std::function<bool()> link_is_up) {
    if (config_.source != ClockSource::kPtp) return;
    const PtpSlave::Config how{config_.transport, static_cast<std::uint8_t>(config_.domain)};
    slave_ = std::make_unique<PtpSlave>(net, how, clock_, std::move(link_is_up));
    slave_->start();
}

void CameraClock::stop() noexcept {
    if (slave_) slave_->stop();
}

void CameraClock::add_to(GigeEffects& effects) {
    effects.clock = &clock_;
    effects.power_up_ns = [this] {
        const ClockLine line = first_line(config_);
        return line.device_at(monotonic_ns());
    };
    if (!slave_) return;
    effects.enable_ptp = [this](bool enabled) { slave_->enable(enabled); };
    effects.ptp_data_set = [this] { return slave_->data_set(); };
}

void CameraClock::move(const NetInterface& net) {
    if (slave_) slave_->move(net);
}

void CameraClock::look(const PtpDataSet& now) {
    const PtpDataSet before = state_.read();
    state_.write(now);
    if (slave_ || now.state == before.state) return;  // the slave says it itself
    const std::lock_guard lock(notes_mutex_);
    if (notes_.size() < kMostNotes)
        notes_.push_back({std::string("PTP is ") + hilcam::name_of(now.state) + " (was " +
                              hilcam::name_of(before.state) + "), by the machine's clock; time stamps are " +
                              hilcam::name_of(now.scale),
                          false});
}

ClockReport CameraClock::report() const {
    const PtpDataSet d = state_.read();
    ClockReport out{.source = name_of(config_.source),
                    .state = hilcam::name_of(d.state),
                    .scale = hilcam::name_of(d.scale),
                    .steps = d.steps};
    if (config_.source == ClockSource::kTai) {
        if (d.servo_locked) out.offset_from_master_ns = d.offset_from_master_ns;
        return out;
    }
    if (d.parent_id != 0) out.master = format_clock_id(d.parent_id);
    if (d.scale == TimeScale::kDevice) return out;  // no master's time has been taken over
    out.offset_from_master_ns = d.offset_from_master_ns;
    out.mean_path_delay_ns = d.mean_path_delay_ns;
    out.rate_correction_ppm = 1e6 * d.rate_correction;
    return out;
}

std::vector<SinkNote> CameraClock::take_notes(const std::string& name) {
    std::vector<SinkNote> out;
    {
        const std::lock_guard lock(notes_mutex_);
        out.swap(notes_);
    }
    if (slave_)
        for (PtpSlave::Line& line : slave_->take_lines()) out.push_back({std::move(line.text), line.warning});
    for (SinkNote& note : out) note.text = name + ": " + note.text;
    return out;
}

}  // namespace hilcam
