#pragma once
// SIGINT and SIGTERM while a campaign works: the piece that is being done may end, and nothing new is begun.

#include <array>
#include <csignal>
#include <string>

namespace hilcam {

// The exit status of an interrupted command as shells have it: 128 + SIGINT.
inline constexpr int kInterruptedStatus = 130;

// Listens while it lives; there is one at a time in a process.
class EndRequest {
  public:
    EndRequest();
    ~EndRequest();
    EndRequest(const EndRequest&) = delete;
    EndRequest& operator=(const EndRequest&) = delete;

    // True once a signal has come.
    static bool has_come();
    // While nothing looks at has_come(), a signal ends the process at once: it writes this line to standard error and
    // has the status kInterruptedStatus. Empty: from now on somebody looks.
    void end_at_once(std::string farewell);

  private:
    static constexpr std::array kSignals = {SIGINT, SIGTERM};
    std::array<struct sigaction, kSignals.size()> before_{};
    std::string farewell_;
};

}  // namespace hilcam
