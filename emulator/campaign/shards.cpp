// Shards for WebDataset (github.com/webdataset/webdataset, "The WebDataset Format"): tar files numbered
// SPLIT-000000.tar. The files of a sample are consecutive and have the same name up to the first dot. The tar
// files are ustar (POSIX.1-2017, pax, "ustar Interchange Format"), without times or owners, so the same
// samples give the same bytes.

#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <vector>

#include "emulator/campaign/label_writer.h"
#include "emulator/campaign/picture_case.h"
#include "io/system/durable_file.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kBlock = 512;

// Makes a header with ustar's offsets and widths of fields.
std::array<char, kBlock> ustar_header(const std::string& name, std::uint64_t size) {
    std::array<char, kBlock> h{};
    HILCAM_CHECK(name.size() < 100 && size < (1ull << 33));
    std::memcpy(h.data(), name.data(), name.size());
    const auto octal = [&](std::size_t at, std::size_t digits, std::uint64_t value) {
        for (std::size_t i = digits; i-- > 0; value >>= 3) h[at + i] = static_cast<char>('0' + (value & 7));
    };
    octal(100, 7, 0644), octal(108, 7, 0), octal(116, 7, 0), octal(124, 11, size), octal(136, 11, 0);
    std::memset(h.data() + 148, ' ', 8);
    h[156] = '0';
    std::memcpy(h.data() + 257,
                "ustar\0"
                "00",
                8);
    unsigned sum = 0;
    for (const char c : h) sum += static_cast<unsigned char>(c);
    octal(148, 6, sum);
    h[155] = ' ';
    return h;
}

class TarFile {
  public:
    explicit TarFile(const std::filesystem::path& file)
        : file_(file), out_(files_.begin(file), std::ios::binary) {}

    void add(const std::string& name, const std::string& bytes) {
        const auto header = ustar_header(name, bytes.size());
        out_.write(header.data(), kBlock);
        out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        pad(bytes.size());
    }
    void finish() {
        const std::array<char, 2 * kBlock> end{};
        out_.write(end.data(), end.size());
        if (!out_.flush()) throw DeviceError(file_.string() + " cannot be written; is the disk full?");
        out_.close();
        files_.commit();
    }

  private:
    std::filesystem::path file_;
    DurableFiles files_;
    std::ofstream out_;

    void pad(std::size_t size) {
        const std::array<char, kBlock> zeros{};
        if (size % kBlock != 0)
            out_.write(zeros.data(), static_cast<std::streamsize>(kBlock - size % kBlock));
    }
};

class Shards : public LabelWriter {
  public:
    explicit Shards(const LabelContext& context) : context_(context) {}

    void add(const CaseRecord& record) override {
        for (std::size_t i = 0; i < record.frames.size(); ++i) {
            Open& open = open_[split_of(record)];
            if (!open.file)
                open.file = std::make_unique<TarFile>(
                    context_.folder / "shards" / (split_of(record) + "-" + case_name(open.number) + ".tar"));
            add_sample(*open.file, record, i);
            if (++open.samples < context_.campaign.shard_samples) continue;
            open.file->finish();
            open.file.reset();
            open.samples = 0, ++open.number;
        }
    }

    void finish() override {
        for (auto& [split, open] : open_)
            if (open.file) open.file->finish();
    }

  private:
    struct Open {
        std::unique_ptr<TarFile> file;
        std::int64_t samples = 0;
        std::uint64_t number = 0;
    };
    LabelContext context_;
    std::map<std::string, Open> open_;

    void add_sample(TarFile& tar, const CaseRecord& record, std::size_t index) const {
        const PictureNames names =
            picture_names(context_.campaign, record.plan.number, static_cast<std::int64_t>(index));
        const auto add_file = [&](const std::filesystem::path& file, const std::string& ending) {
            std::error_code error;
            if (std::filesystem::exists(context_.folder / file, error))
                tar.add(names.stem + ending,
                        read_input_file(context_.folder / file, {1ull << 32, "a file of a sample"}));
        };
        tar.add(names.stem + ".json", record.frames[index].dump());
        add_file(names.frame, names.frame.extension().string());
        add_file(names.view, ".view.png");
        add_file(names.layers, ".layers.exr");
        add_file(names.depth, ".depth.png");
        add_file(names.flow, ".flow.exr");
        add_file(names.variance, ".variance.exr");
    }
};

}  // namespace

std::unique_ptr<LabelWriter> make_shards(const LabelContext& context) {
    return std::make_unique<Shards>(context);
}

}  // namespace hilcam
