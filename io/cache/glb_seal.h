#pragma once
// The checksum of a binary glTF, in the file itself: one more chunk at its end, of a type that readers of glTF
// pass over (glTF 2.0, 4.4: "Client implementations MUST ignore chunks with unknown types"), with the CRC-32
// of all bytes before it.

#include <filesystem>

namespace hilcam {

// Adds the chunk and brings the file to the disk. Throws DeviceError when it is no binary glTF, or cannot be
// written.
void seal_glb(const std::filesystem::path& file);
// True when that chunk ends the file and its checksum holds. fd: open for reading.
bool is_sealed_glb(int fd);

}  // namespace hilcam
