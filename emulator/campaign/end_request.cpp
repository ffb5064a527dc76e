#include "emulator/campaign/end_request.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>

namespace hilcam {
namespace {

std::atomic<bool> end_has_come{false};
std::atomic<const std::string*> farewell_at_once{nullptr};
static_assert(std::atomic<const std::string*>::is_always_lock_free);

void on_end_request(int) {
    const int kept = errno;
    end_has_come.store(true);
    if (const std::string* const line = farewell_at_once.load()) {
        [[maybe_unused]] const ssize_t wrote = write(STDERR_FILENO, line->data(), line->size());
        _exit(kInterruptedStatus);
    }
    errno = kept;
}

}  // namespace

EndRequest::EndRequest() {
    end_has_come.store(false);
    struct sigaction action {};
    action.sa_handler = on_end_request;
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

EndRequest::~EndRequest() {
    farewell_at_once.store(nullptr);
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool EndRequest::has_come() { return end_has_come.load(); }

void EndRequest::end_at_once(std::string farewell) {
    farewell_at_once.store(nullptr);
    farewell_ = std::move(farewell);
    if (!farewell_.empty()) farewell_at_once.store(&farewell_);
}

}  // namespace hilcam
