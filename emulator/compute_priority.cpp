#include "emulator/compute_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace hilcam {
namespace {
constexpr int kNice = 10;
}

ComputePriority::ComputePriority() {
    on_scheduler_entry(false);
    observe(true);
}
ComputePriority::~ComputePriority() { observe(false); }

void ComputePriority::on_scheduler_entry(bool) {
    thread_local bool lowered = false;
    if (lowered) return;
    lowered = true;
    // Linux gives every thread a nice value of its own. Raising it never needs rights.
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

}  // namespace hilcam
