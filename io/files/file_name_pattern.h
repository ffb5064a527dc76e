#pragma once
// Names of a run's pictures by a pattern: "frame_%08d" or "{camera_name}_{frame:6}".
//
//  %d, %6d, %06d        the frame's number, padded with zeros to that many digits
//  {frame}, {frame:6}   the same
//  {camera}             the camera's number on the bench, from 1
//  {camera_name}        its model; all but letters, digits, dots and dashes become _
//  {time_tai_ns}        mid-exposure, TAI nanoseconds since 1970
//  %%, {{, }}           %, {, }

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/contract/frame_sink.h"

namespace hilcam {

class FileNamePattern {
  public:
    // ending: with its dot. A pattern that ends in it names whole files; to others it is appended. Throws
    // InputError for another picture's ending, an unknown field, a folder in the name, and a pattern without
    // the frame's number, with which each frame would overwrite the previous one.
    FileNamePattern(std::string_view pattern, std::string_view ending);

    struct Camera {
        std::int64_t number = 1;
        std::string name;
    };
    // Returns the name without the ending.
    std::string stem(const FrameRecord& record, const Camera& camera) const;
    const std::string& ending() const { return ending_; }
    // True for a file name that a run with this pattern may have written: in any format, as a view, or as a
    // label.
    bool may_have_named(std::string_view file_name) const;

  private:
    enum class Kind { kText, kFrame, kCamera, kCameraName, kTime };
    struct Piece {
        Kind kind = Kind::kText;
        std::string text;
        std::size_t digits = 1;
    };
    std::vector<Piece> pieces_;
    std::string ending_;

    void parse(std::string_view pattern);
    void add_text(std::string_view text);
    void add_field(std::string_view field);
};

}  // namespace hilcam
