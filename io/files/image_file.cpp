#include "io/files/image_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

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

}  // namespace hilcam
