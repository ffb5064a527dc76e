#include "io/pictures/image_file.h"

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
#include <string>
#include <utility>
#include <vector>

#include "io/pictures/picture_codecs.h"
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
    const PictureSamples samples{{reinterpret_cast<const std::uint8_t*>(frame.data()), 2 * frame.pixels()},
                                 frame.width(),
                                 frame.height(),
                                 SampleKind::kGray16};
    const std::string bytes = kind == ".png" ? encode_png(samples) : encode_tiff(samples);
    if (bytes.empty()) throw DeviceError(file.string() + ": cannot be encoded");
    write_file(file, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
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
