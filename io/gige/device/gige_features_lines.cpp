// Features of lines, user outputs, counters and timers.

#include "io/gige/device/gige_features.h"
#include "io/gige/device/gige_lines.h"

namespace hilcam {

namespace r = feature_register;

namespace {

constexpr double kMaxCount = 4294967295.0;

template <std::size_t N>
std::vector<EnumEntry> named(const std::array<std::string_view, N>& names) {
    std::vector<EnumEntry> entries;
    for (const std::string_view name : names) entries.push_back({std::string(name), entries.size()});
    return entries;
}

std::string name_of_line(std::size_t line) { return "Line" + std::to_string(line); }

std::vector<EnumEntry> activations() { return counted({"RisingEdge", "FallingEdge", "AnyEdge"}); }

Feature time_us(const char* name, std::uint32_t address, double least_us, const char* meaning) {
    return real(name, address, meaning).between(least_us, LineTimer::kMaxTime_us).unit("us");
}

void add_counters(FeatureTable& t) {
    t.add("CounterAndTimerControl",
          {
              enumeration("CounterSelector", r::kCounterSelector, counted({"Counter0", "Counter1"}),
                          "A counter")
                  .selects({"CounterEventSource", "CounterEventActivation", "CounterResetSource",
                            "CounterReset", "CounterValue", "CounterValueAtReset", "CounterDuration",
                            "CounterStatus"}),
              enumeration("CounterEventSource", r::kCounterEventSource, events_of(t.plan), "What it counts"),
              enumeration("CounterEventActivation", r::kCounterEventActivation, activations(), "Of a line"),
              enumeration("CounterResetSource", r::kCounterResetSource, events_of(t.plan),
                          "What sets it to 0; a line does so as it rises"),
              command("CounterReset", r::kCounterReset, "Sets it to 0"),
              integer("CounterValue", r::kCounterValue, "Events since its reset").between(0, kMaxCount),
              integer("CounterValueAtReset", r::kCounterValueAtReset, "Events before its last reset")
                  .between(0, kMaxCount)
                  .read_only(),
              integer("CounterDuration", r::kCounterDuration, "Events until it ends and waits for a reset")
                  .between(1, kMaxCount),
              enumeration("CounterStatus", r::kCounterStatus,
                          counted({"CounterIdle", "CounterTriggerWait", "CounterActive", "CounterCompleted",
                                   "CounterOverflow"}),
                          "What it does")
                  .read_only(),
          });
}

void add_timers(FeatureTable& t) {
    t.add("CounterAndTimerControl",
          {
              enumeration("TimerSelector", r::kTimerSelector, counted({"Timer0", "Timer1"}), "A timer")
                  .selects({"TimerDuration", "TimerDelay", "TimerReset", "TimerValue", "TimerStatus",
                            "TimerTriggerSource", "TimerTriggerActivation"}),
              time_us("TimerDuration", r::kTimerDuration_us, LineTimer::kMinDuration_us, "Of its pulse"),
              time_us("TimerDelay", r::kTimerDelay_us, 0, "From what triggers it to its pulse"),
              command("TimerReset", r::kTimerReset, "Starts it anew"),
              time_us("TimerValue", r::kTimerValue_us, 0, "Since its pulse began").read_only(),
              enumeration("TimerStatus", r::kTimerStatus,
                          counted({"TimerIdle", "TimerTriggerWait", "TimerActive"}), "What it does")
                  .read_only(),
              enumeration("TimerTriggerSource", r::kTimerTriggerSource, events_of(t.plan), "What starts it"),
              enumeration("TimerTriggerActivation", r::kTimerTriggerActivation, activations(), "Of a line"),
          });
}

}  // namespace

std::vector<EnumEntry> events_of(const LinePlan& plan) {
    std::vector<EnumEntry> entries = named(kLineEventNames);
    for (std::size_t i = 0; i < kLines; ++i)
        if (plan.is_there[i] && !plan.is_output[i])
            entries.push_back({name_of_line(i), static_cast<std::uint64_t>(event_of_line(i))});
    return entries;
}

std::vector<EnumEntry> own_lines(const LinePlan& plan, bool with_outputs) {
    std::vector<EnumEntry> entries;
    for (std::size_t i = 1; i < kLines; ++i)
        if (plan.is_there[i] && (with_outputs || !plan.is_output[i]))
            entries.push_back({name_of_line(i), GigeLines::kFirstOwn + i});
    return entries;
}

void add_line_features(FeatureTable& t) {
    std::vector<EnumEntry> lines;
    for (const std::string& name : t.lines) lines.push_back({name, lines.size()});
    for (const EnumEntry& line : own_lines(t.plan, true)) lines.push_back(line);
    t.add("DigitalIOControl",
          {
              enumeration("LineSelector", r::kLineSelector, std::move(lines), "A line")
                  .selects({"LineMode", "LineFormat", "LineInverter", "LineSource", "LineStatus"}),
              enumeration("LineMode", r::kLineMode, counted({"Input", "Output"}),
                          "Which way it goes; the scenario decides"),
              enumeration("LineFormat", r::kLineFormat, counted({"NoConnect", "TTL"}),
                          "TTL: it has a pin (GPIO, PPS) of the machine")
                  .read_only(),
              boolean("LineInverter", r::kLineInverter, "Whether its level is turned round"),
              enumeration("LineSource", r::kLineSource, named(kLineSignalNames), "What an output shows"),
              boolean("LineStatus", r::kLineStatus, "Its level: an input's behind the inverter, an output's")
                  .read_only(),
              integer("LineStatusAll", r::kLineStatusAll, "All levels: bit n is Line n")
                  .between(0, (1u << kLines) - 1)
                  .as("HexNumber")
                  .read_only(),
              enumeration("UserOutputSelector", r::kUserOutputSelector,
                          counted({"UserOutput0", "UserOutput1", "UserOutput2", "UserOutput3"}),
                          "A level that the client sets")
                  .selects({"UserOutputValue"}),
              boolean("UserOutputValue", r::kUserOutputValue, "That level"),
              integer("UserOutputValueAll", r::kUserOutputValueAll, "All of them: bit n is UserOutput n")
                  .between(0, (1u << kUserOutputs) - 1)
                  .as("HexNumber"),
          });
    add_counters(t);
    add_timers(t);
}

}  // namespace hilcam
