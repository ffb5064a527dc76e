#include "io/ip42/ip42_stream.h"

#include <utility>

namespace hilcam {
namespace {

constexpr std::size_t kMaxEnd_bytes = 32;  // the words and blanks after them

bool is_end(std::string_view line) {
    if (line.size() > kMaxEnd_bytes) return false;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line == "[ENDMSG]" || line == "[EOF]";
}

}  // namespace

std::optional<Ip42Stream::Found> Ip42Stream::take() {
    std::size_t done = 0;
    std::optional<Found> found;
    while (!found) {
        const std::size_t end = bytes_.find('\n', done);
        if (end == std::string::npos) break;
        const std::string_view line(bytes_.data() + done, end - done);
        if (!std::exchange(in_cut_line_, false) && is_end(line)) {
            found = Found{std::exchange(text_, {}), std::exchange(too_long_, false)};
        } else {
            too_long_ |= text_.size() + line.size() + 1 > kMaxMessage_bytes;
            if (too_long_)
                text_.clear();
            else
                text_.append(line) += '\n';
        }
        done = end + 1;
    }
    bytes_.erase(0, done);
    // A line without an end must not grow without a bound.
    if (!found && bytes_.size() > kMaxMessage_bytes) {
        too_long_ = in_cut_line_ = true;
        text_.clear();
        bytes_.clear();
    }
    return found;
}

}  // namespace hilcam
