#pragma once
// Finds 42's messages in a stream of bytes. A message ends with a line "[ENDMSG]" or "[EOF]". Owner thread.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

class Ip42Stream {
  public:
    // 42's own buffer has 16 KiB. A longer message is not kept, and its end is still found.
    static constexpr std::size_t kMaxMessage_bytes = 64 * 1024;

    struct Found {
        std::string text;       // the lines before the end
        bool too_long = false;  // the text is not kept
    };
    void put(std::string_view bytes) { bytes_ += bytes; }
    // Returns the next whole message; nothing when more bytes are needed.
    std::optional<Found> take();
    // Forgets what has come, for a new connection.
    void clear() { *this = {}; }
    // Returns how many bytes are kept.
    std::size_t size() const { return bytes_.size() + text_.size(); }

  private:
    std::string bytes_;  // not looked at yet
    std::string text_;   // whole lines of the present message
    bool too_long_ = false;
    bool in_cut_line_ = false;  // the begin of the present line is not kept
};

}  // namespace hilcam
