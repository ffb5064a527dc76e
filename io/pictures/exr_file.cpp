#include "io/pictures/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "io/pictures/image_file.h"
#include "render/scene/color_bands.h"

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

// Whole numbers beyond 2^53 are text, as is what has no type of OpenEXR's.
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

// frame: what the display window is to be, as it lies in the picture.
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

// The mean of the bins, each with its weight and its width; empty: no bin has a weight.
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

// Returns the planes that viewers show of several bins.
std::vector<std::pair<std::string, std::vector<float>>> shown_planes(const RadianceImage& radiance,
                                                                     const SpectralGrid& grid) {
    const ColorBands bands(grid);
    std::vector<std::pair<std::string, std::vector<float>>> out = {
        {"R", mean_of_bins(radiance, grid, bands.spectrum({1, 0, 0}))},
        {"G", mean_of_bins(radiance, grid, bands.spectrum({0, 1, 0}))},
        {"B", mean_of_bins(radiance, grid, bands.spectrum({0, 0, 1}))}};
    const auto is_empty = [](const auto& plane) { return plane.second.empty(); };
    if (std::none_of(out.begin(), out.end(), is_empty)) return out;
    return {{"Y", mean_of_bins(radiance, grid, bands.spectrum({1, 1, 1}))}};
}

}  // namespace

void write_radiance_exr(const std::filesystem::path& file, const RadianceImage& radiance,
                        const SpectralGrid& grid, const PixelRectangle& frame, const PictureNotes& notes) {
    if (radiance.planes() == 1) return write_exr(file, radiance, frame, {{"Y", radiance.plane(0)}}, notes);
    std::vector<Channel> channels;
    for (int b = 0; b < radiance.planes(); ++b) {
        char name[64];
        std::snprintf(name, sizeof name, "L_%.3f_%.3fum", grid.from_um(b), grid.to_um(b));
        channels.push_back({name, radiance.plane(b)});
    }
    const auto shown = shown_planes(radiance, grid);
    for (const auto& [name, values] : shown) channels.push_back({name, values});
    write_exr(file, radiance, frame, channels, notes);
}

void write_electrons_exr(const std::filesystem::path& file, const ElectronImage& electrons,
                         const PictureNotes& notes) {
    write_exr(file, electrons, {0, 0, electrons.width(), electrons.height()}, {{"Y", electrons.plane(0)}},
              notes);
}

}  // namespace hilcam
