#pragma once
// The other end of map_helper.h: answers requests about one map until the parent has gone.

namespace hilcam {

// Serves on the descriptors of a helper (helper_process.h) and never returns. One thread, and another that
// watches the socket.
[[noreturn]] void serve_map(int socket, int memory);

}  // namespace hilcam
