#include "emulator/progress/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "emulator/progress/progress_line.h"

namespace hilcam {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

struct Progress::Work {
    std::string what;
    double steps = 0, done = 0;
    std::function<double()> look;
    Clock::time_point begun = Clock::now();
};

// All work under way, the outermost first, and the thread that writes the line, which exists while there is
// work.
class ProgressLine {
  public:
    static ProgressLine& the() {
        static ProgressLine line;
        return line;
    }
    bool shown() const { return shown_; }
    void keep_silent() { shown_ = false; }

    void begin(const std::shared_ptr<Progress::Work>& work) {
        const std::lock_guard lock(mutex_);
        works_.push_back(work);
        if (works_.size() > 1) return;
        thread_ = std::jthread([this](const std::stop_token& over) { run(over); });
    }
    void end(const std::shared_ptr<Progress::Work>& work) {
        std::jthread finished;  // stopped and joined outside the lock
        const std::lock_guard lock(mutex_);
        // The object that `look` uses may no longer exist.
        std::erase(works_, work);
        if (works_.empty()) finished = std::move(thread_);
    }
    template <class Change>
    void change(const Change& change) {
        const std::lock_guard lock(mutex_);
        change();
    }

  private:
    using Pause = std::chrono::duration<double>;
    // Work that is done earlier has no line.
    static constexpr Pause kFirstLine = 700ms, kBetweenLines = 250ms;
    static constexpr std::size_t kColumnsOfLogs = 200;

    void run(const std::stop_token& over) {
        std::unique_lock lock(mutex_);
        bool written = false;
        const auto never = [] { return false; };
        for (Pause pause = terminal_ ? kFirstLine : between_;; pause = terminal_ ? kBetweenLines : between_) {
            news_.wait_for(lock, over, pause, never);
            if (over.stop_requested()) break;
            if (works_.empty()) continue;
            write(terminal_ ? over_line(text(columns()) + "\r") : text(kColumnsOfLogs) + "\n");
            written = true;
        }
        if (written && terminal_) write(over_line(""));
    }
    // Called under the lock.
    std::string text(std::size_t columns) const {
        std::vector<ProgressItem> items;
        for (const auto& work : works_) {
            ProgressItem item{
                work->what, {}, std::chrono::duration<double>(Clock::now() - work->begun).count()};
            const double done = work->look ? work->look() : work->done;
            if (work->steps > 0) item.fraction = std::clamp(done / work->steps, 0.0, 1.0);
            items.push_back(item);
        }
        return "hilcam: " + progress_text(items, columns - 9);
    }
    static std::size_t columns() {
        winsize size{};
        const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= 20;
        return known ? size.ws_col : 80;
    }
    // Clears the line first. The cursor stays at its beginning, where the next message is written over it.
    static std::string over_line(const std::string& text) { return "\r\x1b[K" + text; }
    static void write(const std::string& bytes) {
        [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, bytes.data(), bytes.size());
    }

    const bool terminal_ = isatty(STDERR_FILENO) == 1;
    const Pause between_{seconds_between_lines(std::getenv("HILCAM_PROGRESS_S"))};
    bool shown_ = terminal_ || between_ > Pause::zero();
    std::mutex mutex_;
    std::condition_variable_any news_;
    std::vector<std::shared_ptr<Progress::Work>> works_;
    std::jthread thread_;
};

Progress::Progress(std::string what, double steps, std::function<double()> look) {
    if (!ProgressLine::the().shown()) return;
    work_ = std::make_shared<Work>();
    work_->what = std::move(what), work_->steps = steps, work_->look = std::move(look);
    ProgressLine::the().begin(work_);
}

void Progress::keep_silent() { ProgressLine::the().keep_silent(); }

Progress::~Progress() {
    if (work_) ProgressLine::the().end(work_);
}

void Progress::done(double steps) {
    if (work_) ProgressLine::the().change([&] { work_->done = steps; });
}

void Progress::now(std::string what) {
    if (work_) ProgressLine::the().change([&] { work_->what = std::move(what); });
}

}  // namespace hilcam
