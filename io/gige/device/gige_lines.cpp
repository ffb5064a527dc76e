#include "io/gige/device/gige_lines.h"

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

GigeLines::GigeLines(GigeCore& core) : core_(core) {
    add_lines();
    add_user_outputs();
    add_counters();
    add_timers();
}

template <class Change>
Status GigeLines::change(const Change& change) {
    LineSettings settings = core_.lines.settings();
    if (!change(settings)) return Status::kInvalidParameter;
    core_.lines.change(settings, core_.now_ns);
    return Status::kSuccess;
}

template <class Place>
void GigeLines::setting(std::uint32_t address, const Place& place, std::uint64_t most) {
    using Value = std::remove_cvref_t<decltype(place(std::declval<LineSettings&>()))>;
    core_.registers.number(
        address,
        [this, place] {
            LineSettings settings = core_.lines.settings();
            return static_cast<std::uint64_t>(place(settings));
        },
        [this, place, most](std::uint64_t value) {
            return change([&](LineSettings& settings) {
                if (value > most) return false;
                place(settings) = static_cast<Value>(value);
                return true;
            });
        });
}

// True for an event that counters and timers can follow.
bool GigeLines::is_event(std::uint64_t value) const {
    const LinePlan& plan = core_.lines.plan();
    const auto first = static_cast<std::uint64_t>(LineEvent::kLine0);
    if (value < first) return true;
    return value < kLineEvents && plan.is_there[value - first] && !plan.is_output[value - first];
}

// --- lines

void GigeLines::add_lines() {
    GigeRegisterFile& r = core_.registers;
    const LinePlan& plan = core_.lines.plan();
    r.number(
        reg::kLineSelector, [this] { return selector_; },
        [this](std::uint64_t wanted) {
            const bool own = wanted > kFirstOwn && wanted < kFirstOwn + kLines &&
                             core_.lines.plan().is_there[wanted - kFirstOwn];
            if (!own && wanted > core_.identity.more_lines.size()) return Status::kInvalidParameter;
            selector_ = static_cast<std::uint32_t>(wanted);
            return Status::kSuccess;
        });
    r.number(
        reg::kLineMode, [this, &plan] { return std::uint64_t{plan.is_output[line()]}; },
        [this, &plan](std::uint64_t mode) {
            return mode == std::uint64_t{plan.is_output[line()]} ? Status::kSuccess
                                                                 : Status::kInvalidParameter;
        });
    r.number(reg::kLineFormat, [this, &plan] { return std::uint64_t{plan.has_pin[line()]}; });
    r.number(reg::kLineStatus, [this] { return core_.lines.levels() >> line() & 1u; });
    r.number(reg::kLineStatusAll, [this] { return core_.lines.levels(); });
    r.number(
        reg::kLineInverter, [this] { return std::uint64_t{core_.lines.settings().inverted[line()]}; },
        [this](std::uint64_t on) {
            return change([&](LineSettings& s) { return on <= 1 && (s.inverted[line()] = on != 0, true); });
        });
    r.number(
        reg::kLineSource,
        [this] { return static_cast<std::uint64_t>(core_.lines.settings().source[line()]); },
        [this, &plan](std::uint64_t source) {
            if (!plan.is_output[line()]) return source == 0 ? Status::kSuccess : Status::kAccessDenied;
            return change([&](LineSettings& s) {
                return source < kLineSignalNames.size() &&
                       (s.source[line()] = static_cast<LineSignal>(source), true);
            });
        });
}

void GigeLines::add_user_outputs() {
    GigeRegisterFile& r = core_.registers;
    r.variable(reg::kUserOutputSelector, user_output_, {0, kUserOutputs - 1});
    r.number(
        reg::kUserOutputValue, [this] { return core_.lines.settings().user_outputs >> user_output_ & 1u; },
        [this](std::uint64_t on) {
            return change([&](LineSettings& s) {
                const std::uint32_t bit = 1u << user_output_;
                return on <= 1 && (s.user_outputs = on ? s.user_outputs | bit : s.user_outputs & ~bit, true);
            });
        });
    setting(
        reg::kUserOutputValueAll, [](LineSettings & s) -> auto& { return s.user_outputs; },
        (1u << kUserOutputs) - 1);
}

// --- counters and timers

void GigeLines::add_counters() {
    GigeRegisterFile& r = core_.registers;
    const auto own = [this](LineSettings& s) -> LineCounter::Settings& { return s.counters[counter_]; };
    const auto event = [this](std::uint32_t address, auto member) {
        core_.registers.number(
            address,
            [this, member] {
                return static_cast<std::uint64_t>(core_.lines.settings().counters[counter_].*member);
            },
            [this, member](std::uint64_t value) {
                return change([&](LineSettings& s) {
                    return is_event(value) &&
                           (s.counters[counter_].*member = static_cast<LineEvent>(value), true);
                });
            });
    };
    r.variable(reg::kCounterSelector, counter_, {0, kCounters - 1});
    event(reg::kCounterEventSource, &LineCounter::Settings::event);
    event(reg::kCounterResetSource, &LineCounter::Settings::reset);
    setting(
        reg::kCounterEventActivation, [own](LineSettings & s) -> auto& { return own(s).activation; },
        static_cast<std::uint64_t>(TriggerActivation::kAnyEdge));
    r.number(
        reg::kCounterDuration, [this] { return core_.lines.settings().counters[counter_].duration; },
        [this](std::uint64_t events) {
            return change([&](LineSettings& s) {
                return events >= 1 &&
                       (s.counters[counter_].duration = static_cast<std::uint32_t>(events), true);
            });
        });
    r.command(reg::kCounterReset, [this] {
        core_.lines.reset_counter(counter_, core_.now_ns);
        return Status::kSuccess;
    });
    r.number(
        reg::kCounterValue, [this] { return core_.lines.counter(counter_).value(); },
        [this](std::uint64_t value) {
            core_.lines.set_counter(counter_, static_cast<std::uint32_t>(value));
            return Status::kSuccess;
        });
    r.number(reg::kCounterValueAtReset, [this] { return core_.lines.counter(counter_).value_at_reset(); });
    r.number(reg::kCounterStatus, [this] {
        return static_cast<std::uint64_t>(
            core_.lines.counter(counter_).status(core_.lines.settings().counters[counter_]));
    });
}

void GigeLines::add_timers() {
    GigeRegisterFile& r = core_.registers;
    const auto time = [this](std::uint32_t address, double least_us, auto member) {
        core_.registers.real(
            address, [this, member] { return core_.lines.settings().timers[timer_].*member; },
            [this, member, least_us](double us) {
                return change([&](LineSettings& s) {
                    return us >= least_us && us <= LineTimer::kMaxTime_us &&
                           (s.timers[timer_].*member = us, true);
                });
            });
    };
    r.variable(reg::kTimerSelector, timer_, {0, kTimers - 1});
    r.number(
        reg::kTimerTriggerSource,
        [this] { return static_cast<std::uint64_t>(core_.lines.settings().timers[timer_].trigger); },
        [this](std::uint64_t value) {
            return change([&](LineSettings& s) {
                return is_event(value) && (s.timers[timer_].trigger = static_cast<LineEvent>(value), true);
            });
        });
    setting(
        reg::kTimerTriggerActivation,
        [this](LineSettings & s) -> auto& { return s.timers[timer_].activation; },
        static_cast<std::uint64_t>(TriggerActivation::kAnyEdge));
    time(reg::kTimerDuration_us, LineTimer::kMinDuration_us, &LineTimer::Settings::duration_us);
    time(reg::kTimerDelay_us, 0, &LineTimer::Settings::delay_us);
    r.command(reg::kTimerReset, [this] {
        core_.lines.start_timer(timer_, core_.now_ns);
        return Status::kSuccess;
    });
    r.real(reg::kTimerValue_us, [this] { return core_.lines.timer(timer_).value_us(core_.now_ns); });
    r.number(reg::kTimerStatus, [this] {
        return static_cast<std::uint64_t>(
            core_.lines.timer(timer_).status(core_.lines.settings().timers[timer_]));
    });
}

}  // namespace hilcam
