#pragma once
// Holds a data rate: says when the next bytes may leave. Time that was not used is made up for by no more
// than a short burst, so that a receiver's buffer does not overflow.

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hilcam {

class SendPacer {
  public:
    static constexpr std::int64_t kBurst_ns = 1'000'000;

    explicit SendPacer(double bytes_s) : ns_per_byte_(1e9 / bytes_s) {}
    // Returns when these bytes may leave, which is now_ns or later. Any clock.
    std::int64_t may_leave(std::int64_t now_ns, std::size_t bytes) {
        free_ns_ = std::max(free_ns_, static_cast<double>(now_ns - kBurst_ns));
        const double at_ns = free_ns_;
        free_ns_ += ns_per_byte_ * static_cast<double>(bytes);
        return std::max(now_ns, static_cast<std::int64_t>(at_ns));
    }

  private:
    double ns_per_byte_;
    double free_ns_ = 0;
};

}  // namespace hilcam
