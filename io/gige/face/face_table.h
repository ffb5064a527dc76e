#pragma once
// The table that `hilcam-camera-face bind` makes of a camera's GenICam description: where the features that
// hilcam acts on are among the camera's registers, and what every other register holds. docs/camera_face.md
// describes its JSON.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/gige/face/register_field.h"
#include "io/gige/face/register_formula.h"
#include "io/gige/face/registers_file.h"

namespace hilcam {

// A number of a register and hilcam's entry for it ("Mono12Packed"), or hilcam's number.
struct FaceValue {
    std::uint64_t raw = 0;
    std::string entry{};
    double number = 0;  // without an entry
};

// The row holds while a field, the selector of the vendor's, has this number.
struct FaceGuard {
    RegisterField field;
    std::uint64_t is = 0;
};

struct FaceRow {
    enum class Of : std::uint8_t { kValue, kLeast, kMost, kCommand } of = Of::kValue;
    std::string feature{};  // hilcam's (gige_features.h)
    RegisterField field;
    RegisterFormula formula{};           // meaning of a number
    std::vector<FaceValue> values{};     // numbers of choices; with them the formula means nothing
    std::uint64_t command = 0;           // the number that runs it
    std::vector<FaceGuard> when{};       // all must hold
    std::string selector{}, selected{};  // hilcam's selector and its entry; empty: none
};

// A field that does not keep what makes it run.
struct FaceCommand {
    RegisterField field;
    std::uint64_t command = 0;
};

// A chunk's data: some of hilcam's values at places of the vendor's.
struct FaceChunkField {
    std::string chunk{};  // hilcam's ChunkSelector entry
    RegisterField field;  // its address counts from the chunk's begin
    RegisterFormula formula{};
    std::vector<FaceValue> values{};
};
struct FaceChunk {
    std::uint32_t id = 0, bytes = 0;
    std::vector<FaceChunkField> fields{};
};

struct FaceRange {
    std::uint32_t address = 0, bytes = 0;
    bool read_only = false;
};

struct FaceTable {
    std::uint32_t description_crc32 = 0;
    std::uint32_t description_bytes = 0;
    std::string vendor{}, model{}, version{};
    int width_px = 0, height_px = 0;  // size of the camera that the table was made for
    std::vector<FaceRow> rows{};
    std::vector<FaceCommand> self_clearing{};
    std::uint32_t image_chunk_id = 0;
    std::vector<FaceChunk> chunks{};
    std::vector<FaceRange> registers{};
    std::vector<RegisterRun> memory{};
};

inline constexpr std::size_t kMaxFaceBytes = std::size_t{16} << 20;

// Throws InputError for what is no such table, with the place in it; also when two rows of values share
// bits of a register.
FaceTable face_table_of(const std::string& text, const std::string& name);
// Throws InputError when the table was made of another description.
void check_description(const FaceTable& table, const std::string& xml, const std::string& table_name,
                       const std::string& xml_name);

}  // namespace hilcam
