#include "io/image_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "render/check.h"

namespace hilcam {
namespace {

struct Channel {
    std::string name;
    std::span<const float> values;
};

void write_exr(const std::filesystem::path& file, int width, int height, const std::vector<Channel>& channels,
               const std::string& unit) {
    try {
        Imf::Header header(width, height);
        header.compression() = Imf::ZIP_COMPRESSION;
        header.insert("unit", Imf::StringAttribute(unit));
        Imf::FrameBuffer buffer;
        for (const Channel& channel : channels) {
            header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
            // OpenEXR's slices are for reading too, hence not const; writing does not touch them.
            char* base = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
            buffer.insert(channel.name, Imf::Slice(Imf::FLOAT, base, sizeof(float),
                                                   sizeof(float) * static_cast<std::size_t>(width)));
        }
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(height);
    } catch (const std::exception& error) {
        throw DeviceError(file.string() + ": cannot be written: " + error.what());
    }
}

}  // namespace

void write_frame(const std::filesystem::path& file, const DnImage& frame) {
    const std::string kind = file.extension().string();
    if (kind != ".png" && kind != ".tiff" && kind != ".tif")
        throw InputError(file.string() + ": found the ending '" + kind +
                         "'; accepted for frames: .png .tiff .raw");
    const cv::Mat picture(frame.height(), frame.width(), CV_16UC1, const_cast<std::uint16_t*>(frame.data()));
    bool written = false;
    try {
        // Level 1: frames are noise in the low bits, harder compression costs time and gains nothing.
        written = cv::imwrite(file.string(), picture, {cv::IMWRITE_PNG_COMPRESSION, 1});
    } catch (const cv::Exception&) {
    }
    if (!written)
        throw DeviceError(file.string() + ": cannot be written; is the folder there, writable and not full?");
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
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out)
        throw DeviceError(file.string() + ": cannot be written; is the folder there, writable and not full?");
}

void write_radiance_exr(const std::filesystem::path& file, const RadianceImage& radiance,
                        const SpectralGrid& grid) {
    std::vector<Channel> channels;
    for (int b = 0; b < radiance.planes(); ++b) {
        char name[64];
        std::snprintf(name, sizeof name, "L_%.3f_%.3fum", grid.from_um(b), grid.to_um(b));
        channels.push_back({name, radiance.plane(b)});
    }
    write_exr(file, radiance.width(), radiance.height(), channels, "W m^-2 sr^-1 um^-1");
}

void write_electrons_exr(const std::filesystem::path& file, const ElectronImage& electrons) {
    write_exr(file, electrons.width(), electrons.height(), {{"electrons", electrons.plane(0)}}, "e-");
}

}  // namespace hilcam
