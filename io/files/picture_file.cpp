#include "io/files/picture_file.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "io/files/kept_stderr.h"
#include "io/files/picture_size.h"
#include "io/system/confined.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr const char* kAccepted = "PNG, JPEG, TIFF, BMP, WebP";

void require_size(std::span<const std::uint8_t> bytes, const std::string& what, std::uint64_t bytes_px) {
    const std::optional<PictureSize> size = picture_size(bytes);
    if (!size) throw InputError(what + " does not decode; accepted: " + kAccepted);
    // Divided, since a TIFF may claim 2^64.
    if (size->width > kMostPicturePixels / size->height)
        throw InputError(what + " has " + std::to_string(size->width) + " x " + std::to_string(size->height) +
                         " pixels; accepted: at most " + std::to_string(kMostPicturePixels) +
                         ", as 16384 x 16384");
    // 0.3 us a pixel is ten times what PNG takes, the slowest of them.
    const std::uint64_t pixels = size->width * size->height;
    allow_more(bytes_px * pixels, 3e-7 * static_cast<double>(pixels));
}

// bytes_px: what a pixel takes while it is decoded and copied.
cv::Mat decode(std::span<const std::uint8_t> bytes, int flags, const std::string& what,
               std::uint64_t bytes_px) {
    require_size(bytes, what, bytes_px);
    cv::Mat picture;
    const KeptStderr printed;
    try {
        const cv::Mat file(1, static_cast<int>(bytes.size()), CV_8UC1,
                           const_cast<std::uint8_t*>(bytes.data()));
        picture = cv::imdecode(file, flags);
    } catch (const cv::Exception& error) {
        if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();
    }
    if (picture.empty()) {
        const std::string why = printed.first_line();
        throw InputError(what + " does not decode" + (why.empty() ? "" : " (" + why + ")") +
                         "; accepted: " + kAccepted);
    }
    return picture;
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void write_numbers(const std::string& bytes, const std::string& name, bool any_sign, ConfinedOutput& out) {
    // Up to 8 bytes as it is, 4 as numbers.
    const cv::Mat picture = decode(bytes_of(bytes), cv::IMREAD_UNCHANGED, name + ":", 12);
    if (picture.channels() != 1)
        throw InputError(name + ": has " + std::to_string(picture.channels()) + " channels; accepted: one");
    cv::Mat numbers;
    picture.convertTo(numbers, CV_32F);
    out.value(numbers.cols);
    out.value(numbers.rows);
    for (int y = 0; y < numbers.rows; ++y) {
        const std::span<const float> row(numbers.ptr<float>(y), static_cast<std::size_t>(numbers.cols));
        for (std::size_t x = 0; x < row.size(); ++x)
            if (!std::isfinite(row[x]) || (!any_sign && row[x] < 0))
                throw InputError(name + ": pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is " +
                                 std::to_string(row[x]) + "; accepted: finite" +
                                 (any_sign ? "" : ", not negative"));
        out.list(row);
    }
}

// The file is read before the child is made, so that what is wrong with it is told as for every file.
ConfinedResult confine(const std::filesystem::path& file,
                       const std::function<void(const std::string&, ConfinedOutput&)>& work) {
    const std::string bytes = read_input_file(file, picture_kind());
    // The rest is allowed by the picture's header.
    const ConfinedLimits limits{(std::uint64_t{256} << 20) + bytes.size(), 10};
    return run_confined(file.string(), limits, [&](ConfinedOutput& out) { work(bytes, out); });
}

}  // namespace

const InputKind& picture_kind() {
    static const InputKind kind{std::uintmax_t{1} << 30, kAccepted};
    return kind;
}

Texture decode_texture(std::span<const std::uint8_t> bytes, const std::string& what) {
    const cv::Mat picture = decode(bytes, cv::IMREAD_COLOR, what, 8);
    Texture texture{{}, picture.cols, picture.rows, {}};
    texture.texels.resize(picture.total());
    auto to = texture.texels.begin();
    for (int y = 0; y < picture.rows; ++y) {
        const auto* const row = picture.ptr<cv::Vec3b>(y);
        to = std::transform(row, row + picture.cols, to, [](const cv::Vec3b& bgr) {
            return std::array<std::uint8_t, 3>{bgr[2], bgr[1], bgr[0]};
        });
    }
    return texture;
}

Texture read_picture(const std::filesystem::path& file) {
    ConfinedResult result = confine(file, [&](const std::string& bytes, ConfinedOutput& out) {
        const Texture texture = decode_texture(bytes_of(bytes), file.string() + ":");
        out.value(texture.width);
        out.value(texture.height);
        out.list(std::span(texture.texels));
    });
    Texture texture{file.string(), result.value<int>(), result.value<int>(), {}};
    texture.texels = result.list<std::array<std::uint8_t, 3>>();
    if (texture.width < 1 || texture.height < 1 ||
        texture.texels.size() !=
            static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height))
        result.refuse();
    return texture;
}

PixelMap read_pixel_map(const std::filesystem::path& file, bool any_sign) {
    ConfinedResult result = confine(file, [&](const std::string& bytes, ConfinedOutput& out) {
        write_numbers(bytes, file.string(), any_sign, out);
    });
    const int width = result.value<int>(), height = result.value<int>();
    if (width < 1 || height < 1 ||
        static_cast<std::uint64_t>(width) > kMostPicturePixels / static_cast<std::uint64_t>(height))
        result.refuse();
    PixelMap map(width, height);
    for (int y = 0; y < height; ++y) {
        const std::vector<float> row = result.list<float>();
        if (row.size() != map.row(y).size()) result.refuse();
        std::copy(row.begin(), row.end(), map.row(y).begin());
    }
    return map;
}

}  // namespace hilcam
