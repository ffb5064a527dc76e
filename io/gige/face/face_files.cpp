#include "io/gige/face/face_files.h"

#include <algorithm>

#include "io/gige/face/description_file.h"
#include "io/gige/face/small_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::shared_ptr<const CameraFaceFiles> read_face(const std::filesystem::path& description,
                                                 const std::filesystem::path& table,
                                                 const std::filesystem::path& registers) {
    auto files = std::make_shared<CameraFaceFiles>();
    files->xml = read_description(description);
    files->table = face_table_of(read_small_file(table, kMaxFaceBytes), table.string());
    check_description(files->table, files->xml, table.string(), description.string());
    if (!registers.empty())
        files->recorded = registers_of(read_small_file(registers, kMaxRegistersBytes), registers.string());
    return files;
}

void check_camera(const FaceTable& table, int width_px, int height_px) {
    if (table.width_px == width_px && table.height_px == height_px) return;
    throw InputError("face_file: was made for a camera of " + std::to_string(table.width_px) + " x " +
                     std::to_string(table.height_px) + " pixels, this one has " + std::to_string(width_px) +
                     " x " + std::to_string(height_px) + "; run hilcam-camera-face bind again");
}

std::uint32_t free_place(const FaceTable& table, std::size_t bytes) {
    // The standard's registers and those of manufacturers end at 0x10000.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> used = {
        {0, 0x10000}, {std::uint64_t{1} << 32, std::uint64_t{1} << 32}};
    const auto add = [&](std::uint32_t address, std::size_t count) {
        used.emplace_back(address, address + std::uint64_t{count});
    };
    for (const FaceRange& r : table.registers) add(r.address, r.bytes);
    for (const RegisterRun& r : table.memory) add(r.address, r.bytes.size());
    for (const FaceRow& r : table.rows) add(r.field.address, r.field.bytes);
    std::sort(used.begin(), used.end());
    std::uint64_t end = 0, best = 0, best_begin = 0;
    for (const auto& [begin, stop] : used) {
        if (begin > end && begin - end > best) best = begin - end, best_begin = end;
        end = std::max(end, stop);
    }
    constexpr std::uint64_t kPage = 4096;
    if (best < bytes + 2 * kPage)
        throw InputError("genicam_file: the registers leave no gap for the description");
    return static_cast<std::uint32_t>((best_begin + (best - bytes) / 2) / kPage * kPage);
}

}  // namespace hilcam
