#pragma once
// Handles SIGINT and SIGTERM while a campaign works: the current piece may be finished, and no new one
// begins.

#include <array>
#include <csignal>
#include <string>

namespace hilcam {

// Exit status of an interrupted command by the shells' convention: 128 + SIGINT.
inline constexpr int kInterruptedStatus = 130;

// Catches the signals for as long as it exists. A process has at most one.
class EndRequest {
  public:
    EndRequest();
    ~EndRequest();
    EndRequest(const EndRequest&) = delete;
    EndRequest& operator=(const EndRequest&) = delete;

    // True after a signal has arrived.
    static bool has_come();
    // Sets what a signal does while nothing polls has_come(): it writes this line to standard error and ends
    // the process at once with kInterruptedStatus. Empty: has_come() is polled again.
    void end_at_once(std::string farewell);

  private:
    static constexpr std::array kSignals = {SIGINT, SIGTERM};
    std::array<struct sigaction, kSignals.size()> before_{};
    std::string farewell_;
};

}  // namespace hilcam
