#include "io/image_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/kept_stderr.h"
#include "render/check.h"
#include "render/quoted.h"

namespace hilcam {
namespace {

struct Channel {
    std::string name;
    std::span<const float> values;
};

// OpenEXR's boxes have their last pixels in them.
Imath::Box2i box(int left, int top, int width, int height) {
    return {{left, top}, {left + width - 1, top + height - 1}};
}

// A picture that ends half-way is worse than none.
[[noreturn]] void give_up(const std::filesystem::path& file, const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw DeviceError(file.string() + ": cannot be written: " + why);
}

// frame: what the display window is to be, as it lies in the picture.
template <class Image>
void write_exr(const std::filesystem::path& file, const Image& image, const PixelRectangle& frame,
               const std::vector<Channel>& channels, const std::string& unit) {
    const Imath::Box2i data = box(-frame.left, -frame.top, image.width(), image.height());
    try {
        Imf::Header header(box(0, 0, frame.width, frame.height), data);
        header.compression() = Imf::ZIP_COMPRESSION;
        header.insert("unit", Imf::StringAttribute(unit));
        Imf::FrameBuffer buffer;
        for (const Channel& channel : channels) {
            header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
            buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), data));
        }
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(image.height());
    } catch (const std::exception& error) {
        give_up(file, error.what());
    }
}

// All of it, or no file.
void write_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    if (!out) throw DeviceError(file.string() + ": cannot be written: " + std::strerror(errno));
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) give_up(file, std::strerror(errno));
}

cv::Mat decode(const std::filesystem::path& file, int flags) {
    cv::Mat picture;
    std::string why;
    {
        const KeptStderr printed;
        try {
            picture = cv::imread(file.string(), flags);
        } catch (const cv::Exception&) {
        }
        why = printed.first_line();
    }
    if (picture.empty())
        throw InputError(file.string() + ": is missing or does not decode" +
                         (why.empty() ? "" : " (" + why + ")") + "; accepted: PNG, JPEG, TIFF");
    return picture;
}

}  // namespace

void write_frame(const std::filesystem::path& file, const DnImage& frame) {
    const std::string kind = file.extension().string();
    if (kind != ".png" && kind != ".tiff" && kind != ".tif")
        throw InputError(file.string() + ": found the ending " + in_quotes(kind) +
                         "; accepted for frames: .png .tiff .raw");
    const cv::Mat picture(frame.height(), frame.width(), CV_16UC1, const_cast<std::uint16_t*>(frame.data()));
    // In memory first: the libraries print what goes wrong with a file, and leave its beginning behind.
    std::vector<std::uint8_t> bytes;
    bool encoded = false;
    try {
        // Level 1: frames are noise in the low bits, harder compression costs time and gains nothing.
        encoded = cv::imencode(kind, picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
    } catch (const cv::Exception&) {
    }
    if (!encoded) throw DeviceError(file.string() + ": cannot be encoded");
    write_file(file, bytes);
}

std::string encode_png(std::span<std::uint8_t> samples, int width, int height, PngSamples kind) {
    const bool rgb = kind == PngSamples::kRgb8;
    if (rgb)  // OpenCV has blue first
        for (std::size_t i = 0; i + 2 < samples.size(); i += 3) std::swap(samples[i], samples[i + 2]);
    const cv::Mat picture(height, width,
                          rgb                           ? CV_8UC3
                          : kind == PngSamples::kGray16 ? CV_16UC1
                                                        : CV_8UC1,
                          samples.data());
    std::vector<std::uint8_t> png;
    try {
        if (!cv::imencode(".png", picture, png, {cv::IMWRITE_PNG_COMPRESSION, 1})) return {};
    } catch (const cv::Exception&) {
        return {};
    }
    return {png.begin(), png.end()};
}

void write_raw(const std::filesystem::path& file, const DnImage& frame, const PixelLayout& layout) {
    std::vector<std::uint8_t> bytes(packed_bytes(frame.pixels(), layout));
    pack(frame.plane(0), layout, bytes);
    write_file(file, bytes);
}

void write_radiance_exr(const std::filesystem::path& file, const RadianceImage& radiance,
                        const SpectralGrid& grid, const PixelRectangle& frame) {
    std::vector<Channel> channels;
    for (int b = 0; b < radiance.planes(); ++b) {
        char name[64];
        std::snprintf(name, sizeof name, "L_%.3f_%.3fum", grid.from_um(b), grid.to_um(b));
        channels.push_back({name, radiance.plane(b)});
    }
    write_exr(file, radiance, frame, channels, "W m^-2 sr^-1 um^-1");
}

void write_electrons_exr(const std::filesystem::path& file, const ElectronImage& electrons) {
    write_exr(file, electrons, {0, 0, electrons.width(), electrons.height()},
              {{"electrons", electrons.plane(0)}}, "e-");
}

Texture read_picture(const std::filesystem::path& file) {
    const cv::Mat picture = decode(file, cv::IMREAD_COLOR);
    Texture texture{file.string(), picture.cols, picture.rows, {}};
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const cv::Vec3b bgr = picture.at<cv::Vec3b>(y, x);
            texture.texels.push_back({bgr[2], bgr[1], bgr[0]});
        }
    return texture;
}

PixelMap read_pixel_map(const std::filesystem::path& file, bool any_sign) {
    const cv::Mat picture = decode(file, cv::IMREAD_UNCHANGED);
    if (picture.channels() != 1)
        throw InputError(file.string() + ": has " + std::to_string(picture.channels()) +
                         " channels; accepted: one");
    cv::Mat numbers;
    picture.convertTo(numbers, CV_32F);
    PixelMap map(numbers.cols, numbers.rows);
    for (int y = 0; y < numbers.rows; ++y) {
        std::copy_n(numbers.ptr<float>(y), numbers.cols, map.row(y).begin());
        for (std::size_t x = 0; x < map.row(y).size(); ++x) {
            const float value = map.row(y)[x];
            if (std::isfinite(value) && (any_sign || value >= 0)) continue;
            throw InputError(file.string() + ": pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                             ") is " + std::to_string(value) + "; accepted: finite" +
                             (any_sign ? "" : ", not negative"));
        }
    }
    return map;
}

}  // namespace hilcam
