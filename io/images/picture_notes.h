#pragma once
// The notes of a picture, in any format: when, how and from where it was taken, and by which run. Each format
// writes the same notes in its own way; docs/pictures.md lists them. The machine and the date are not among
// them, so the same picture always gives the same bytes.

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

// The notes that all pictures of a camera share.
struct PictureRun {
    std::string software;  // "hilcam 0.3.0"
    std::string scenario;  // its name
    std::int64_t camera = 1;
    std::int64_t seed = 1;
    CameraModel model;
    SpectralGrid grid{{0.4, 0.95}};
};

struct PictureNote {
    std::string key;   // the key in the lines of truth (docs/truth.md)
    std::string fits;  // keyword in FITS, numbered for the values of a list; empty: FITS has words of its own
    std::variant<std::string, std::int64_t, double, std::vector<double>, std::vector<std::int64_t>> value;
    std::string meaning;  // meaning, with its unit
};
using PictureNotes = std::vector<PictureNote>;

// Says how the picture's pixels follow from the camera's.
struct PictureLayout {
    FrameLayout frame;
    int oversampling = 1;  // pixels of the picture across one pixel of the frame
};
PictureLayout layout_of(const FrameRecord& record);
// Returns the lens of a picture [px of the picture]; the origin is the corner of the frame.
FrameIntrinsics lens_of(const CameraModel& model, const PictureLayout& layout);

// Returns the notes of a picture. unit: of its numbers, "DN", "e-", ... Owner thread.
PictureNotes notes_of(const PictureRun& run, const FrameRecord& record, const PictureLayout& layout,
                      const std::string& unit);
const PictureNote* find_note(const PictureNotes& notes, std::string_view key);

// Returns a note's value as text: numbers with enough digits to read them back exactly, lists in brackets.
std::string text_of(const PictureNote& note);
// Returns the texts for PNG: `Software`, then each note by its key.
std::vector<std::pair<std::string, std::string>> png_texts(const PictureNotes& notes);
// Returns the notes as one JSON object, UTF-8.
std::string json_of(const PictureNotes& notes);

}  // namespace hilcam
