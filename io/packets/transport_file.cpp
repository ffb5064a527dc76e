// Packets as files: one of all packets, or one a frame. A frame that cannot be written whole leaves nothing:
// the one file is cut back to the frame before, a frame's own file is removed. The next frame is tried all the
// same, because space may be freed.

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "io/packets/packet_transport.h"
#include "io/packets/packets_config.h"
#include "io/system/fd.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kWriteBytes = 256 * 1024;

class FileTransport : public PacketTransport {
  public:
    explicit FileTransport(const PacketsConfig& c)
        : PacketTransport((c.transport == PacketsConfig::Transport::kFile ? "file " : "files ") +
                          c.folder.string()),
          folder_(run_folder(c)),
          one_file_(c.transport == PacketsConfig::Transport::kFile) {
        require_unused(folder_);
    }

    void open() override {
        claim(folder_);
        if (one_file_) open_file(folder_.folder / kPacketsFile);
    }
    bool begin_frame(std::uint64_t frame) override {
        waiting_.clear();
        if (!one_file_) open_file(folder_.folder / packets_file_of(frame));
        return true;
    }
    bool send(std::span<const std::uint8_t> bytes) override {
        waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
        if (waiting_.size() >= kWriteBytes) write_out();
        return true;
    }
    Outcome end_frame() override {
        write_out();
        good_bytes_ = written_bytes_;
        if (!one_file_) close();
        return Outcome::kDelivered;
    }
    void close() noexcept override { file_.reset(); }

  private:
    void open_file(const std::filesystem::path& path) {
        path_ = path;
        written_bytes_ = good_bytes_ = 0;
        file_ = Fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
        if (!file_) fail();
    }
    void write_out() {
        std::span<const std::uint8_t> left = waiting_;
        while (!left.empty()) {
            const ssize_t put = ::write(file_.get(), left.data(), left.size());
            if (put < 0 && errno == EINTR) continue;
            if (put <= 0) fail();
            written_bytes_ += put;
            left = left.subspan(static_cast<std::size_t>(put));
        }
        waiting_.clear();
    }
    [[noreturn]] void fail() {
        const std::string reason = std::strerror(errno);
        waiting_.clear();
        if (one_file_ && file_) {
            [[maybe_unused]] const int cut = ftruncate(file_.get(), good_bytes_);
            lseek(file_.get(), good_bytes_, SEEK_SET);
            written_bytes_ = good_bytes_;
        } else if (file_) {
            close();
            unlink(path_.c_str());
        }
        throw DeviceError("outputs.packets: " + path_.string() + " cannot be written: " + reason);
    }

    RunFolder folder_;
    bool one_file_;
    std::filesystem::path path_;
    Fd file_;
    std::vector<std::uint8_t> waiting_;
    off_t written_bytes_ = 0;  // the file's size
    off_t good_bytes_ = 0;     // its size after the last whole frame
};

}  // namespace

std::unique_ptr<PacketTransport> make_file_transport(const PacketsConfig& config) {
    return std::make_unique<FileTransport>(config);
}

}  // namespace hilcam
