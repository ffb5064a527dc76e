#include "emulator/run/log_setup.h"

#include <pthread.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Writes the message for the pattern's '%*'.
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

// Writes a line without allocating, because memory may be exhausted.
void write_last_line(const char* what) noexcept {
    std::array<char, 16> thread{};
    pthread_getname_np(pthread_self(), thread.data(), thread.size());
    std::array<char, 512> line{};
    const int length =
        std::snprintf(line.data(), line.size() - 1,
                      "hilcam: thread '%s' cannot go on, which ends the program: %s", thread.data(), what);
    const auto end = line.begin() + std::clamp(length, 0, static_cast<int>(line.size()) - 2);
    std::replace_if(
        line.begin(), end, [](char c) { return c >= 0 && (c < ' ' || c == 127); }, '?');
    *end = '\n';
    static_cast<void>(!write(STDERR_FILENO, line.data(), static_cast<std::size_t>(end - line.begin()) + 1));
}

// Called when an exception leaves a thread or a noexcept function.
[[noreturn]] void end_with_last_words() {
    try {
        if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
        write_last_line("std::terminate");
    } catch (const std::bad_alloc&) {
        write_last_line("not enough memory");
    } catch (const std::exception& error) {
        write_last_line(error.what());
    } catch (...) {
        write_last_line("an exception of an unknown kind");
    }
    std::abort();
}

}  // namespace

void set_up_log() {
    std::set_terminate(end_with_last_words);
    spdlog::set_default_logger(spdlog::stderr_color_mt("hilcam"));
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    // On a terminal, the line may hold the text of a Progress.
    const bool terminal = isatty(STDERR_FILENO) == 1;
    formatter->add_flag<HarmlessMessage>('*').set_pattern(terminal ? "\r\x1b[Khilcam: %^%*%$"
                                                                   : "hilcam: %^%*%$");
    spdlog::set_formatter(std::move(formatter));
}

}  // namespace hilcam
