#include "emulator/run/log_setup.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// The message, for the pattern's '%*'.
class HarmlessMessage final : public spdlog::custom_flag_formatter {
  public:
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
        const std::string text = harmless({message.payload.data(), message.payload.size()});
        out.append(text.data(), text.data() + text.size());
    }
    std::unique_ptr<custom_flag_formatter> clone() const override {
        return std::make_unique<HarmlessMessage>();
    }
};

}  // namespace

void set_up_log() {
    spdlog::set_default_logger(spdlog::stderr_color_mt("hilcam"));
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    // On a terminal the line may have a Progress's words in it.
    const bool terminal = isatty(STDERR_FILENO) == 1;
    formatter->add_flag<HarmlessMessage>('*').set_pattern(terminal ? "\r\x1b[Khilcam: %^%*%$"
                                                                   : "hilcam: %^%*%$");
    spdlog::set_formatter(std::move(formatter));
}

}  // namespace hilcam
