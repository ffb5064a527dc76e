#include "io/images/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "io/images/image_file.h"
#include "render/scene/color_bands.h"

namespace hilcam {
namespace {

struct Channel {
    std::string name;
    std::span<const float> values;
};

// OpenEXR's boxes include their last pixels.
Imath::Box2i box(int left, int top, int width, int height) {
    return {{left, top}, {left + width - 1, top + height - 1}};
}

// Integers beyond 2^53 become text, as does anything without an OpenEXR type.
void insert(const PictureNote& note, Imf::Header& header) {
    const auto* const list = std::get_if<std::vector<double>>(&note.value);
    if (const auto* const real = std::get_if<double>(&note.value))
        header.insert(note.key, Imf::DoubleAttribute(*real));
    else if (list && list->size() == 2)
        header.insert(note.key, Imf::V2dAttribute({(*list)[0], (*list)[1]}));
    else if (list && list->size() == 3)
        header.insert(note.key, Imf::V3dAttribute({(*list)[0], (*list)[1], (*list)[2]}));
    else
        header.insert(note.key, Imf::StringAttribute(text_of(note)));
}

// frame: the future display window, in the picture's pixels.
template <class Image>
void write_exr(const std::filesystem::path& file, const Image& image, const PixelRectangle& frame,
               const std::vector<Channel>& channels, const PictureNotes& notes) {
    const Imath::Box2i data = box(-frame.left, -frame.top, image.width(), image.height());
    try {
        Imf::Header header(box(0, 0, frame.width, frame.height), data);
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const PictureNote& note : notes) insert(note, header);
        Imf::FrameBuffer buffer;
        for (const Channel& channel : channels) {
            header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
            buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), data));
        }
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(image.height());
    } catch (const std::exception& error) {
        give_up_file(file, error.what());
    }
}

// Returns the mean of the bins, weighted by `weights` and bin width; empty when no bin has a weight.
std::vector<float> mean_of_bins(const RadianceImage& radiance, const SpectralGrid& grid,
                                const Spectrum& weights) {
    double sum = 0;
    for (int b = 0; b < radiance.planes(); ++b) sum += static_cast<double>(weights[b]) * grid.width_um(b);
    if (!(sum > 0)) return {};
    std::vector<float> out(radiance.pixels());
    for (int b = 0; b < radiance.planes(); ++b) {
        const auto share = static_cast<float>(static_cast<double>(weights[b]) * grid.width_um(b) / sum);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += share * radiance.plane(b)[i];
    }
    return out;
}

std::string picture_bin_name(const SpectralGrid& grid, int bin) {
    char name[64];
    std::snprintf(name, sizeof name, "L_%.3f_%.3fum", grid.from_um(bin), grid.to_um(bin));
    return name;
}

// Returns a name without a dot, which would end the layer's name.
std::string layer_bin_name(const SpectralGrid& grid, int bin) {
    char name[64];
    std::snprintf(name, sizeof name, "L_%.6g_%.6gnm", 1e3 * grid.from_um(bin), 1e3 * grid.to_um(bin));
    std::replace(name, name + std::strlen(name), '.', 'p');
    return name;
}

constexpr std::size_t kMaxMade = 3 * (1 + kLightParts);

// Adds a picture's channels: its bins and, for several bins, the colours for viewers. made: must have room
// for three more planes.
void add_picture(const RadianceImage& radiance, const SpectralGrid& grid, const std::string& layer,
                 std::string (*bin_name)(const SpectralGrid&, int), std::vector<std::vector<float>>& made,
                 std::vector<Channel>& channels) {
    if (radiance.planes() == 1) return channels.push_back({layer + "Y", radiance.plane(0)});
    for (int b = 0; b < radiance.planes(); ++b)
        channels.push_back({layer + bin_name(grid, b), radiance.plane(b)});
    const ColorBands bands(grid);
    std::array<std::vector<float>, 3> planes = {mean_of_bins(radiance, grid, bands.red()),
                                                mean_of_bins(radiance, grid, bands.green()),
                                                mean_of_bins(radiance, grid, bands.blue())};
    const auto add = [&](const char* name, std::vector<float>&& plane) {
        made.push_back(std::move(plane));
        channels.push_back({layer + name, made.back()});
    };
    if (std::any_of(planes.begin(), planes.end(), [](const auto& plane) { return plane.empty(); }))
        return add("Y", mean_of_bins(radiance, grid, bands.spectrum({1, 1, 1})));
    add("R", std::move(planes[0])), add("G", std::move(planes[1])), add("B", std::move(planes[2]));
}

}  // namespace

void write_radiance_exr(const std::filesystem::path& file, const RadianceImage& radiance,
                        const SpectralGrid& grid, const PixelRectangle& frame, const PictureNotes& notes,
                        const LightParts* parts) {
    std::vector<std::vector<float>> made;  // planes that channels show
    made.reserve(kMaxMade);
    std::vector<Channel> channels;
    add_picture(radiance, grid, "", picture_bin_name, made, channels);
    for (std::size_t i = 0; parts && i < kLightParts; ++i)
        add_picture(parts->of(static_cast<LightPart>(i)), grid, std::string(kLightPartNames[i]) + '.',
                    layer_bin_name, made, channels);
    write_exr(file, radiance, frame, channels, notes);
}

void write_electrons_exr(const std::filesystem::path& file, const ElectronImage& electrons,
                         const PictureNotes& notes) {
    write_exr(file, electrons, {0, 0, electrons.width(), electrons.height()}, {{"Y", electrons.plane(0)}},
              notes);
}

}  // namespace hilcam
