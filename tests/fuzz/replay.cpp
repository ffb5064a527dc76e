// Runs a fuzz target without libFuzzer: over every file of a corpus and over damaged copies of them.
//
//   replay CORPUS_FOLDER COPIES
//
// The damage comes from a fixed seed, so that a failure comes back. The input about to be tried is written to
// the working folder as TARGET.last and removed at the end: it is what a crash leaves.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

void damage(Bytes& bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return random() % std::max<std::size_t>(n, 1); };
    for (std::size_t count = 1 + below(6); count > 0; --count) {
        const std::size_t at = below(bytes.size());
        switch (below(5)) {
            case 0:
                if (!bytes.empty()) bytes[at] = static_cast<std::uint8_t>(random());
                break;
            case 1:
                if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1u << below(8));
                break;
            case 2:
                bytes.resize(at);
                break;
            case 3: {  // a piece once more, somewhere else
                const std::size_t length = std::min(below(64), bytes.size() - std::min(at, bytes.size()));
                const Bytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                  bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
                const auto to = static_cast<std::ptrdiff_t>(below(bytes.size() + 1));
                bytes.insert(bytes.begin() + to, piece.begin(), piece.end());
                break;
            }
            default: {  // a piece less
                const std::size_t length = std::min(below(16), bytes.size() - std::min(at, bytes.size()));
                bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                            bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
            }
        }
    }
}

// The file of the last input: open all the time, as opening it for each would take longer than most targets
// do.
class LastInput {
  public:
    explicit LastInput(const std::string& file)
        : file_(file), fd_(open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {}
    ~LastInput() { close(fd_); }
    LastInput(const LastInput&) = delete;
    LastInput& operator=(const LastInput&) = delete;

    // Written to the kernel before the target runs: it outlives a crash of this process.
    bool keep(const Bytes& bytes) {
        const auto size = static_cast<ssize_t>(bytes.size());
        if (pwrite(fd_, bytes.data(), bytes.size(), 0) != size) return false;
        if (size < size_ && ftruncate(fd_, size) != 0) return false;
        size_ = size;
        return true;
    }
    void remove() const { std::filesystem::remove(file_); }

  private:
    std::string file_;
    int fd_;
    ssize_t size_ = 0;
};

void try_one(const Bytes& bytes, LastInput& last) {
    if (!last.keep(bytes)) {
        std::perror("the input cannot be kept");
        std::exit(1);
    }
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: %s CORPUS_FOLDER COPIES\n", argv[0]);
        return 2;
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        std::fprintf(stderr, "%s: no corpus\n", argv[1]);
        return 1;
    }
    LastInput last(std::filesystem::path(argv[0]).filename().string() + ".last");
    std::mt19937 random(1);
    const int copies = std::atoi(argv[2]);
    for (const auto& file : files) {
        std::ifstream in(file, std::ios::binary);
        const Bytes whole{std::istreambuf_iterator<char>(in), {}};
        try_one(whole, last);
        for (int i = 0; i < copies; ++i) {
            Bytes bytes = whole;
            damage(bytes, random);
            try_one(bytes, last);
        }
    }
    last.remove();
    std::printf("%zu files, %d damaged copies of each\n", files.size(), copies);
    return 0;
}
