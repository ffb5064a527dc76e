#include "io/truth/truth_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "io/images/image_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Collects an image's channels.
class Layers {
  public:
    Layers(Imf::Header& header, Imf::FrameBuffer& buffer) : header_(header), buffer_(buffer) {}

    void add(const char* channel, Imf::PixelType type, const void* values, int width) {
        header_.channels().insert(channel, Imf::Channel(type));
        // OpenEXR uses slices for reading as well, so they are not const; writing does not change the values.
        char* base = static_cast<char*>(const_cast<void*>(values));
        buffer_.insert(channel, Imf::Slice(type, base, 4, 4 * static_cast<std::size_t>(width)));
    }
    template <class Layer>
    void add_vector(const std::string& name, const Layer& layer) {
        for (int p = 0; p < layer.planes(); ++p)
            add((name + "." + "XYZ"[p]).c_str(), Imf::FLOAT, layer.plane(p).data(), layer.width());
    }
    void say(const std::string& name, const std::string& text) {
        header_.insert(name, Imf::StringAttribute(text));
    }

  private:
    Imf::Header& header_;
    Imf::FrameBuffer& buffer_;
};

}  // namespace

void write_truth_exr(const std::filesystem::path& file, const FrameTruth& truth,
                     std::span<const std::string> legend) {
    const FrameRaster& raster = truth.raster;
    const TruthLayers& t = truth.layers;
    try {
        Imf::Header header(raster.width_px, raster.height_px);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer buffer;
        Layers layers(header, buffer);
        layers.say("time_utc", format_utc(truth.time));
        layers.say("time_tai_ns", std::to_string(truth.time.ns));
        if (truth.request.object) {
            layers.add("object.ID", Imf::UINT, t.object.data(), raster.width_px);
            std::string names;
            for (const std::string& line : legend) names += line + "\n";
            layers.say("object.names", names);
        }
        if (truth.request.range) {
            layers.add("range.D", Imf::FLOAT, t.range_m.data(), raster.width_px);
            layers.say("range.unit", "m along the ray");
        }
        if (truth.request.depth) {
            layers.add("depth.Z", Imf::FLOAT, t.depth_m.data(), raster.width_px);
            layers.say("depth.unit", "m along the boresight");
        }
        if (truth.request.normal) {
            layers.add_vector("normal", t.normal);
            layers.say("normal.unit", "1, camera axes");
        }
        if (truth.request.position) {
            layers.add_vector("position", t.position_m);
            layers.say("position.unit", "m, camera axes");
        }
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(raster.height_px);
    } catch (const std::exception& error) {
        // Removes the incomplete file.
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
        throw DeviceError(file.string() + ": cannot be written: " + error.what());
    }
}

void write_channels_exr(const std::filesystem::path& file, int width_px, int height_px,
                        const std::string& unit, std::span<const NamedChannel> channels) {
    try {
        Imf::Header header(width_px, height_px);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer buffer;
        Layers layers(header, buffer);
        layers.say("unit", unit);
        for (const NamedChannel& channel : channels)
            layers.add(channel.name, Imf::FLOAT, channel.values.data(), width_px);
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(height_px);
    } catch (const std::exception& error) {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
        throw DeviceError(file.string() + ": cannot be written: " + error.what());
    }
}

std::uint16_t mask_number(std::uint32_t id) {
    constexpr std::uint32_t kFirstBody = 60'000;
    if (id < kFirstBody) return static_cast<std::uint16_t>(id);
    const bool is_body = id >= kFirstBodyId && id - kFirstBodyId < 65'535 - kFirstBody;
    return static_cast<std::uint16_t>(is_body ? kFirstBody + (id - kFirstBodyId) : 65'535);
}

void write_object_mask(const std::filesystem::path& file, const FrameTruth& truth,
                       std::span<const std::string> legend) {
    const IdImage& ids = truth.layers.object;
    DnImage mask(truth.raster.width_px, truth.raster.height_px);
    std::transform(ids.data(), ids.data() + mask.pixels(), mask.data(), mask_number);
    std::string names;
    for (const std::string& line : legend) {
        std::uint32_t id = 0;
        const auto read = std::from_chars(line.data(), line.data() + line.size(), id);
        names.append(names.empty() ? "" : "; ").append(std::to_string(mask_number(id)));
        names.append(read.ptr, line.data() + line.size());
    }
    write_numbers(file, mask,
                  {{"time_utc", "", format_utc(truth.time), ""},
                   {"time_tai_ns", "", truth.time.ns, ""},
                   {"object.names", "", names, ""}});
}

// O_EXCL: when two runs begin at once, only one gets the file.
TruthFiles::TruthFiles(const std::filesystem::path& folder, std::string_view header) : folder_(folder) {
    const std::filesystem::path file = folder / kTruthLines;
    lines_ = Fd(open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666));
    if (!lines_) throw DeviceError(file.string() + " cannot be written: " + std::strerror(errno));
    add_line(header);
}

// Writes the whole line or nothing: a line that does not fit is removed again.
void TruthFiles::add_line(std::string_view line) {
    const std::string text = std::string(line) + '\n';
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t wrote = ::write(lines_.get(), text.data() + done, text.size() - done);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) break;
        done += static_cast<std::size_t>(wrote);
    }
    if (done == text.size()) {
        lines_bytes_ += static_cast<off_t>(done);
        return;
    }
    [[maybe_unused]] const int cut = ftruncate(lines_.get(), lines_bytes_);
    throw DeviceError((folder_ / kTruthLines).string() + " cannot be written; is the disk full?");
}

void TruthFiles::write_layers(const FrameTruth& truth, std::uint64_t frame,
                              std::span<const std::string> legend) const {
    if (!truth.request.layers()) return;
    char stem[64];
    std::snprintf(stem, sizeof stem, "truth_%08llu", static_cast<unsigned long long>(frame));
    write_truth_exr(folder_ / (stem + std::string(".exr")), truth, legend);
    if (truth.request.object) write_object_mask(folder_ / (stem + std::string(".object.png")), truth, legend);
}

PictureTruthFiles picture_truth_files(const std::filesystem::path& folder,
                                      const std::filesystem::path& picture) {
    const std::string name = picture.stem().string();
    return {folder / (name + ".truth.jsonl"), folder / (name + ".truth.exr"),
            folder / (name + ".truth.object.png")};
}

void write_picture_truth(const PictureTruthFiles& files, std::string_view text, const FrameTruth& truth,
                         std::span<const std::string> legend) {
    std::error_code error;
    const std::filesystem::path folder = files.lines.parent_path();
    std::filesystem::create_directories(folder, error);
    if (error) throw DeviceError(folder.string() + " cannot be made: " + error.message());
    std::ofstream out(files.lines, std::ios::binary);
    out << text;
    if (!out.flush()) throw DeviceError(files.lines.string() + " cannot be written");
    if (truth.request.layers()) write_truth_exr(files.layers, truth, legend);
    if (truth.request.object) write_object_mask(files.mask, truth, legend);
}

}  // namespace hilcam
