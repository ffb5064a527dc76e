#pragma once
// The notes that a picture carries, whatever its format: when and how it was taken, from where, and by which
// run. Each format writes the same notes in its own way; docs/pictures.md lists them. Nothing of the machine
// or of the day is among them: the same picture is the same bytes.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "io/contract/frame_sink.h"
#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"
#include "sensor/published_frame.h"

namespace hilcam {

// The notes that all pictures of a camera have in common.
struct PictureRun {
    std::string software;  // "hilcam 0.1.0"
    std::string scenario;  // its name
    std::int64_t camera = 1;
    std::int64_t seed = 1;
    CameraModel model;
    SpectralGrid grid{{0.4, 0.95}};
};

struct PictureNote {
    std::string key;   // key as in the lines of truth (docs/truth.md)
    std::string fits;  // keyword in FITS, which a list's numbers follow; empty: FITS has words of its own
    std::variant<std::string, std::int64_t, double, std::vector<double>, std::vector<std::int64_t>> value;
    std::string meaning;  // meaning, with its unit
};
using PictureNotes = std::vector<PictureNote>;

// The way in which the picture's pixels come from the camera's.
struct PictureLayout {
    FrameLayout frame;
    int oversampling = 1;  // pixels of the picture across one of the frame
};
PictureLayout layout_of(const FrameRecord& record);
// The lens as a picture has it [px of the picture], whose corner is the frame's.
FrameIntrinsics lens_of(const CameraModel& model, const PictureLayout& layout);

// unit: of the picture's numbers, "DN", "e-", ... Owner thread.
PictureNotes notes_of(const PictureRun& run, const FrameRecord& record, const PictureLayout& layout,
                      const std::string& unit);
const PictureNote* find_note(const PictureNotes& notes, std::string_view key);

// Numbers with as many digits as bring them back; lists in brackets.
std::string text_of(const PictureNote& note);
// Returns the texts for PNG: `Software`, then each note by its key.
std::vector<std::pair<std::string, std::string>> png_texts(const PictureNotes& notes);
// One object of JSON, UTF-8.
std::string json_of(const PictureNotes& notes);

}  // namespace hilcam
