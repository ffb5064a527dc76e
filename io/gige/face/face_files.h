#pragma once
// The files of a camera's face, read together.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/gige/face/face_table.h"
#include "io/gige/face/registers_file.h"

namespace hilcam {

struct CameraFaceFiles {
    std::string xml{};
    FaceTable table{};
    std::vector<RegisterRun> recorded{};  // from the real camera
};

// registers: may be empty. Throws InputError.
std::shared_ptr<const CameraFaceFiles> read_face(const std::filesystem::path& description,
                                                 const std::filesystem::path& table,
                                                 const std::filesystem::path& registers);

// Throws InputError when the table was made for a camera of another size.
void check_camera(const FaceTable& table, int width_px, int height_px);

// Returns a multiple of 4096 from which `bytes` bytes are free, in the middle of the largest gap between
// the registers that the table names. Throws InputError when there is none.
std::uint32_t free_place(const FaceTable& table, std::size_t bytes);

}  // namespace hilcam
