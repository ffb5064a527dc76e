#pragma once
// The other side of map_helper.h: answers requests about one map until whoever asks has gone.

namespace hilcam {

// Serves at the descriptors of a helper (helper_process.h) and never returns. One thread, but for one that watches over the socket.
[[noreturn]] void serve_map(int socket, int memory);

}  // namespace hilcam
