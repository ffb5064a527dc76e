#pragma once
// A checksum inside a binary glTF: one more chunk at the end, of a type that readers of glTF skip (glTF 2.0,
// 4.4: "Client implementations MUST ignore chunks with unknown types"), with the CRC-32 of all bytes before
// it.

#include <filesystem>

namespace hilcam {

// Appends the chunk and syncs the file to the disk. Throws DeviceError when it is not a binary glTF or cannot
// be written.
void seal_glb(const std::filesystem::path& file);
// True when the file ends with that chunk and the checksum is right. fd: open for reading.
bool is_sealed_glb(int fd);

}  // namespace hilcam
