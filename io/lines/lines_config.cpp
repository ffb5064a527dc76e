#include "io/lines/lines_config.h"

#include <algorithm>

#include "io/system/allow_list.h"
#include "io/system/fd.h"

namespace hilcam {
namespace {

constexpr double kLastLine = kLines - 1;

Field line_key(std::int64_t& line, double first, std::string_view meaning) {
    return integer("line", line, {first, kLastLine}, meaning);
}

void add_pin(PinConfig& pin, Fields& list) {
    list.push_back(text("gpio", pin.gpio, "GPIO chip of its pin, such as /dev/gpiochip0; empty: no pin"));
    list.push_back(integer("pin", pin.pin, {0, 65535}, "number (offset) of the pin on that chip"));
}

std::vector<std::string> signal_words() {
    return words_of({"off", "exposure_active", "frame_trigger_wait", "frame_active", "counter0_active",
                     "counter1_active", "timer0_active", "timer1_active", "user_output0", "user_output1",
                     "user_output2", "user_output3"});
}

bool same_camera(std::int64_t a, std::int64_t b) { return a == 0 || b == 0 || a == b; }

}  // namespace

Fields fields(LineUdpConfig& c) {
    return {
        text("address", c.address, "IPv4 address of this machine to listen on"),
        integer("port", c.port, {1, 65535}, "UDP port to listen on for edges of inputs"),
        allow_field(c.allow),
        texts("send_to", c.send_to, "receivers of the outputs' edges, as [10.0.0.5:5015]"),
        choice("clock", c.clock, {"monotonic", "tai"},
               "clock of the times in sent edges: this machine's CLOCK_MONOTONIC or CLOCK_TAI"),
    };
}

void validate(const LineUdpConfig& c) {
    AllowList(c.allow, c.address, "lines.udp");
    at_key("send_to", [&] {
        for (const std::string& receiver : c.send_to) parse_endpoint(receiver);
    });
}

Fields fields(LineInputConfig& c) {
    Fields list = {
        line_key(c.line, 0, "number of the line: 2 is Line2"),
        integer("camera", c.camera, {0, 65535}, "camera that it belongs to; 0: every camera"),
    };
    add_pin(c.pin, list);
    list.push_back(
        choice("bias", c.pin.bias, {"as_is", "pull_up", "pull_down", "disabled"}, "resistor of the pin"));
    list.push_back(number("debounce_us", c.pin.debounce_s, 1e-6, {0, 1e6},
                          "time for which a level has to last to count; 0: at once"));
    list.push_back(text("pps", c.pps, "device of a pulse per second, such as /dev/pps0, in place of a pin"));
    return list;
}

void validate(const LineInputConfig& c) {
    if (!c.pps.empty() && !c.pin.gpio.empty())
        throw KeyError("pps", "found beside gpio; accepted: one of them for a line");
}

Fields fields(LineOutputConfig& c) {
    Fields list = {
        line_key(c.line, 1, "number of the line: 1 is Line1"),
        integer("camera", c.camera, {1, 65535}, "camera whose output it is"),
        choice("source", c.source, signal_words(), "signal on it at the start (LineSource)"),
        flag("inverted", c.inverted, "true: low when its signal is active (LineInverter)"),
    };
    add_pin(c.pin, list);
    return list;
}

Fields fields(LineTriggerConfig& c) {
    return {
        line_key(c.line, 0, "input that triggers (TriggerSource)"),
        choice("activation", c.activation,
               {"rising_edge", "falling_edge", "any_edge", "level_high", "level_low"},
               "edge that triggers, or level while which frames follow one another (TriggerActivation)"),
        integer("divider", c.divider, {1, 65535}, "each n-th such edge triggers (TriggerDivider)"),
        choice("overlap", c.overlap, {"off", "read_out"},
               "read_out: a trigger may come while the frame before is read out (TriggerOverlap)"),
        choice("exposure", c.exposure, {"timed", "trigger_width"},
               "trigger_width: the pulse's length is the exposure (ExposureMode)"),
    };
}

Fields fields(LinesConfig& c) {
    return {
        section("udp", c.udp, "edges as UDP datagrams (docs/lines.md)"),
        sections("inputs", c.inputs, "input lines besides Line0, and pins of inputs"),
        sections("outputs", c.outputs, "output lines"),
        section("trigger", c.trigger, "trigger of the cameras at the start, in mode: triggered"),
    };
}

void validate(const LinesConfig& c) {
    const auto clash = [](const std::string& key, std::int64_t line, const char* other) {
        return refused_key(key, std::to_string(line) + ", which is " + other, "a line for each");
    };
    for (std::size_t i = 0; i < c.inputs.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (c.inputs[i].line == c.inputs[k].line && same_camera(c.inputs[i].camera, c.inputs[k].camera))
                throw clash("inputs." + std::to_string(i) + ".line", c.inputs[i].line, "an input already");
    for (std::size_t i = 0; i < c.outputs.size(); ++i) {
        const LineOutputConfig& own = c.outputs[i];
        const std::string key = "outputs." + std::to_string(i) + ".line";
        for (std::size_t k = 0; k < i; ++k)
            if (own.line == c.outputs[k].line && own.camera == c.outputs[k].camera)
                throw clash(key, own.line, "an output already");
        for (const LineInputConfig& input : c.inputs)
            if (own.line == input.line && same_camera(own.camera, input.camera))
                throw clash(key, own.line, "an input");
    }
    if (c.trigger && c.trigger->line != 0 &&
        std::none_of(c.inputs.begin(), c.inputs.end(),
                     [&](const LineInputConfig& input) { return input.line == c.trigger->line; }))
        throw refused_key("trigger.line", std::to_string(c.trigger->line), "0, or a line of lines.inputs");
}

LinePlan plan_of(const LinesConfig& c, std::size_t camera) {
    LinePlan plan;
    const auto number = static_cast<std::int64_t>(camera);
    for (const LineInputConfig& input : c.inputs) {
        if (!same_camera(input.camera, number)) continue;
        const auto line = static_cast<std::size_t>(input.line);
        plan.is_there[line] = true;
        plan.has_pin[line] = !input.pin.gpio.empty() || !input.pps.empty();
    }
    for (const LineOutputConfig& output : c.outputs) {
        if (output.camera != number) continue;
        const auto line = static_cast<std::size_t>(output.line);
        plan.is_there[line] = plan.is_output[line] = true;
        plan.has_pin[line] = !output.pin.gpio.empty();
        plan.source[line] = output.source;
        plan.inverted[line] = output.inverted;
    }
    return plan;
}

SettingsChange change_of(const LineTriggerConfig& c) {
    SettingsChange change;
    change.trigger_source = source_of_line(static_cast<std::size_t>(c.line));
    change.trigger_activation = c.activation;
    change.trigger_divider = c.divider;
    change.trigger_overlap = c.overlap;
    change.exposure_mode = c.exposure;
    return change;
}

}  // namespace hilcam
