#include "io/files/height_map_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "io/system/input_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// The largest size that columns and rows can give. A map is not read whole.
constexpr std::uintmax_t kMaxHeightBytes = 4'000'000'000'000;

// Returns advice for a file in another format that is often mistaken for raw heights; empty for other files.
// TIFF 6.0 and BigTIFF begin with their byte order and 42 or 43, PDS3 labels with their version.
std::string format_with_heights_inside(int fd) {
    std::array<char, 16> head{};
    if (pread(fd, head.data(), head.size(), 0) != static_cast<ssize_t>(head.size())) return {};
    const std::string_view magic(head.data(), head.size());
    const auto advice = [](const std::string& what, const std::string& file) {
        return "is a " + what +
               "; accepted: raw heights. terrain.globe in place of terrain.heights reads it as it is: globe: "
               "{body: moon, maps: [{file: " +
               file + "}]}; or 'gdal_translate -of ENVI -ot Float32 " + file + " heights.raw' makes raw ones";
    };
    using namespace std::string_view_literals;
    for (const std::string_view tiff : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
        if (magic.starts_with(tiff)) return advice("TIFF", "FILE.tif");
    return magic.starts_with("PDS_VERSION_ID") ? advice("PDS label", "FILE.lbl") : std::string();
}

class MappedHeights final : public HeightMap {
  public:
    explicit MappedHeights(const HeightMapConfig& c)
        : columns_(static_cast<int>(c.columns)),
          rows_(static_cast<int>(c.rows)),
          format_(c.format),
          spacing_m_(c.spacing_m),
          scale_(static_cast<float>(c.scale)),
          offset_m_(static_cast<float>(c.offset_m)) {
        const auto refuse = [&](const std::string& what) { throw InputError(c.file.string() + ": " + what); };
        const InputFile in = open_input_file(c.file, {kMaxHeightBytes, "a raw file of heights"});
        if (const std::string other = format_with_heights_inside(in.fd.get()); !other.empty()) refuse(other);
        size_ = static_cast<std::size_t>(c.columns) * static_cast<std::size_t>(c.rows) * bytes_each();
        if (in.bytes != size_)
            refuse("has " + std::to_string(in.bytes) + " bytes; " + std::to_string(c.columns) +
                   " columns of " + std::to_string(c.rows) + " rows of " + std::to_string(bytes_each()) +
                   " bytes make " + std::to_string(size_));
        void* const mapped = mmap(nullptr, size_, PROT_READ, MAP_SHARED, in.fd.get(), 0);
        if (mapped == MAP_FAILED) refuse("cannot be mapped into memory");
        bytes_ = static_cast<const unsigned char*>(mapped);
    }
    ~MappedHeights() override { munmap(const_cast<unsigned char*>(bytes_), size_); }
    MappedHeights(const MappedHeights&) = delete;
    MappedHeights& operator=(const MappedHeights&) = delete;

    int columns() const override { return columns_; }
    int rows() const override { return rows_; }
    double spacing_m() const override { return spacing_m_; }
    float height_m(int column, int row) const override {
        const std::size_t index = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                  static_cast<std::size_t>(column);
        const unsigned char* const at = bytes_ + index * bytes_each();
        float value = 0;
        if (format_ == HeightFormat::kInt16)
            value = static_cast<std::int16_t>(static_cast<std::uint16_t>(at[0] | at[1] << 8));
        else
            std::memcpy(&value, at, sizeof value);  // the machine is little-endian, as x86 is
        const float height = offset_m_ + scale_ * value;
        return std::isfinite(height) ? height : 0.0f;
    }

  private:
    int columns_, rows_;
    HeightFormat format_;
    double spacing_m_;
    float scale_, offset_m_;
    std::size_t size_ = 0;
    const unsigned char* bytes_ = nullptr;

    std::size_t bytes_each() const { return format_ == HeightFormat::kInt16 ? 2 : 4; }
};

}  // namespace

Fields fields(HeightMapConfig& c) {
    return {
        required(
            path("file", c.file, "raw heights, little-endian, rows from the north, columns from the west")),
        required(integer("columns", c.columns, {2, 1'000'000}, "number of columns in the file")),
        required(integer("rows", c.rows, {2, 1'000'000}, "number of rows in the file")),
        choice("format", c.format, {"int16", "float32"}, "number format of a height"),
        required(number("spacing_m", c.spacing_m, 1, {1e-3, 1e6},
                        "distance between neighbouring columns or rows")),
        number("scale", c.scale, 1, {-1e6, 1e6}, "metres per unit of the file"),
        number("offset_m", c.offset_m, 1, {-1e7, 1e7}, "height at the file's value 0"),
    };
}

std::unique_ptr<HeightMap> open_height_map(const HeightMapConfig& config) {
    return std::make_unique<MappedHeights>(config);
}

}  // namespace hilcam
