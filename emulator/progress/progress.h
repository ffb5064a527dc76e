#pragma once
// Tells how far long work is while the object lives, with the time that is left by the pace so far: on one line of
// standard error, which is written over, where that is a terminal; elsewhere, as in a log, by a line each 30 s.
// $HILCAM_PROGRESS_S is another number of seconds between such lines; 0: there are none, and no thread runs.
//
// Work within work makes a Progress of its own: the line has the outermost, whose time it tells, and the
// innermost. Not for a camera's loop: functions here lock. Who may be watched from outside gives `look`
// instead of counting.

#include <functional>
#include <memory>
#include <string>

namespace hilcam {

class Progress {
  public:
    // Tells of work of which nothing is known but the time that it has taken.
    explicit Progress(std::string what) : Progress(std::move(what), 0) {}
    // Tells of work of `steps` steps; 0: unknown. look: gives how many are done, asked by the line's thread.
    Progress(std::string what, double steps, std::function<double()> look = {});
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // From now on nothing is told: for a child process, whose parent has the line. It takes no lock, which the
    // fork may have left behind.
    static void keep_silent();

    // Says that so many steps are done in all. Any thread.
    void done(double steps);
    // Says what comes now; nothing else changes. Any thread.
    void now(std::string what);

  private:
    struct Work;
    friend class ProgressLine;
    std::shared_ptr<Work> work_;
};

}  // namespace hilcam
