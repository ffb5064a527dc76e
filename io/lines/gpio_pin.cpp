#include "io/lines/gpio_pin.h"

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::uint64_t flag_of(PinConfig::Bias bias) {
    switch (bias) {
        case PinConfig::Bias::kPullUp:
            return GPIO_V2_LINE_FLAG_BIAS_PULL_UP;
        case PinConfig::Bias::kPullDown:
            return GPIO_V2_LINE_FLAG_BIAS_PULL_DOWN;
        case PinConfig::Bias::kDisabled:
            return GPIO_V2_LINE_FLAG_BIAS_DISABLED;
        case PinConfig::Bias::kAsIs:
            break;
    }
    return 0;
}

std::string advice_for(int error) {
    switch (error) {
        case EBUSY:
            return "; another program has the pin (gpioinfo names it)";
        case EACCES:
        case EPERM:
            return "; hilcam needs the right to it: a group or a udev rule";
        case EINVAL:
            return "; the chip has fewer pins, or cannot do that (edges, bias, debounce)";
        case ENOTTY:
            return "; it is no GPIO chip";
        case ENOENT:
        case ENODEV:
            return "; gpiodetect lists the chips";
        default:
            return {};
    }
}

std::string text_of(int error, const PinConfig& pin) {
    return pin.gpio + " pin " + std::to_string(pin.pin) + ": " + std::strerror(error) + advice_for(error);
}

[[noreturn]] void fail(const PinConfig& pin) { throw DeviceError(text_of(errno, pin)); }

Fd request(const PinConfig& pin, gpio_v2_line_request& wanted) {
    const Fd chip(::open(pin.gpio.c_str(), O_RDWR | O_CLOEXEC));
    if (!chip) fail(pin);
    wanted.offsets[0] = static_cast<std::uint32_t>(pin.pin);
    wanted.num_lines = 1;
    std::strncpy(wanted.consumer, "hilcam", sizeof wanted.consumer - 1);
    if (ioctl(chip.get(), GPIO_V2_GET_LINE_IOCTL, &wanted) < 0) fail(pin);
    Fd line(wanted.fd);
    fcntl(line.get(), F_SETFD, FD_CLOEXEC);
    return line;
}

}  // namespace

Fd open_input_pin(const PinConfig& pin) {
    gpio_v2_line_request wanted{};
    wanted.config.flags = GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING |
                          GPIO_V2_LINE_FLAG_EDGE_FALLING | flag_of(pin.bias);
    wanted.event_buffer_size = 1024;
    if (pin.debounce_s > 0) {
        wanted.config.num_attrs = 1;
        wanted.config.attrs[0].mask = 1;
        wanted.config.attrs[0].attr.id = GPIO_V2_LINE_ATTR_ID_DEBOUNCE;
        wanted.config.attrs[0].attr.debounce_period_us =
            static_cast<std::uint32_t>(std::lround(pin.debounce_s * 1e6));
    }
    Fd line = request(pin, wanted);
    fcntl(line.get(), F_SETFL, O_NONBLOCK);
    return line;
}

Fd open_output_pin(const PinConfig& pin, bool level) {
    gpio_v2_line_request wanted{};
    wanted.config.flags = GPIO_V2_LINE_FLAG_OUTPUT;
    wanted.config.num_attrs = 1;
    wanted.config.attrs[0].mask = 1;
    wanted.config.attrs[0].attr.id = GPIO_V2_LINE_ATTR_ID_OUTPUT_VALUES;
    wanted.config.attrs[0].attr.values = level ? 1 : 0;
    return request(pin, wanted);
}

std::string fault_of(const PinConfig& pin) {
    const Fd chip(::open(pin.gpio.c_str(), O_RDWR | O_CLOEXEC));
    if (!chip) return text_of(errno, pin);
    gpiochip_info about{};
    if (ioctl(chip.get(), GPIO_GET_CHIPINFO_IOCTL, &about) < 0) return text_of(errno, pin);
    gpio_v2_line_info line{};
    line.offset = static_cast<std::uint32_t>(pin.pin);
    if (ioctl(chip.get(), GPIO_V2_GET_LINEINFO_IOCTL, &line) < 0) return text_of(errno, pin);
    return line.flags & GPIO_V2_LINE_FLAG_USED ? text_of(EBUSY, pin) : std::string();
}

bool read_pin(const Fd& pin) {
    gpio_v2_line_values values{};
    values.mask = 1;
    return ioctl(pin.get(), GPIO_V2_LINE_GET_VALUES_IOCTL, &values) == 0 && (values.bits & 1) != 0;
}

bool write_pin(const Fd& pin, bool level) {
    gpio_v2_line_values values{};
    values.mask = 1;
    values.bits = level ? 1 : 0;
    return ioctl(pin.get(), GPIO_V2_LINE_SET_VALUES_IOCTL, &values) == 0;
}

std::size_t read_edges(const Fd& pin, std::span<PinEdge> edges) {
    std::array<gpio_v2_line_event, 16> events;
    const std::size_t room = std::min(edges.size(), events.size());
    const ssize_t size = ::read(pin.get(), events.data(), room * sizeof events[0]);
    if (size < 0) return 0;
    const std::size_t count = static_cast<std::size_t>(size) / sizeof events[0];
    for (std::size_t i = 0; i < count; ++i)
        edges[i] = {events[i].id == GPIO_V2_LINE_EVENT_RISING_EDGE,
                    static_cast<std::int64_t>(events[i].timestamp_ns), events[i].line_seqno};
    return count;
}

}  // namespace hilcam
