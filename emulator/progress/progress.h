#pragma once
// Shows how far long work is, and the time left at the present pace, for as long as the object exists. On a
// terminal it rewrites one line of standard error; elsewhere, as in a log, it writes a line every 30 s.
// $HILCAM_PROGRESS_S sets another interval [s]; 0: no lines, and no thread runs.
//
// Work within work makes a Progress of its own: the line shows the outermost, with its time, and the
// innermost. Not for a camera's loop, because functions here lock. Work that can be watched from outside
// provides `look` instead of counting.

#include <functional>
#include <memory>
#include <string>

namespace hilcam {

class Progress {
  public:
    // Shows work for which only the time taken is known.
    explicit Progress(std::string what) : Progress(std::move(what), 0) {}
    // Shows work of `steps` steps; 0: unknown. look: returns how many are done; the line's thread calls it.
    Progress(std::string what, double steps, std::function<double()> look = {});
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Ends all output of this process: for a child process whose parent shows the line. Takes no lock,
    // because the fork may have copied one that is held.
    static void keep_silent();

    // Sets how many steps are done in total. Any thread.
    void done(double steps);
    // Sets what is done now, and leaves the rest unchanged. Any thread.
    void now(std::string what);

  private:
    struct Work;
    friend class ProgressLine;
    std::shared_ptr<Work> work_;
};

}  // namespace hilcam
