// Runs a fuzz target without libFuzzer: over every file of a corpus and over damaged copies of them.
//
//   replay CORPUS_FOLDER COPIES [CHAIN [SEED]]
//
// An input is CHAIN damaged copies one after the other (1), each of a file taken at random when there are
// several. A target that knows its format damages it itself (LLVMFuzzerCustomMutator): every other time, and
// always in a chain, which a wrong length would break.
// The damage comes from SEED (1), so that a failure comes back. The input about to be tried is written to the
// working folder as TARGET.last and removed at the end: it is what a crash leaves. Prints the memory it took
// after a tenth of the inputs and at the end: a leak stands between them.

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t most, unsigned seed);

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

constexpr std::size_t kMaxGrowth = 4096;

Bytes damaged(Bytes bytes, bool in_chain, std::mt19937& random) {
    if (LLVMFuzzerCustomMutator && (in_chain || random() % 2)) {
        const std::size_t size = bytes.size();
        bytes.resize(size + kMaxGrowth);
        bytes.resize(
            LLVMFuzzerCustomMutator(bytes.data(), size, bytes.size(), static_cast<unsigned>(random())));
    } else {
        damage(bytes, random);
    }
    return bytes;
}

// What the process holds in memory, of /proc/self/status.
long resident_kib() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmRSS:")) return std::strtol(line.c_str() + 6, nullptr, 10);
    return 0;
}

// The file that holds the input about to be tried.
class LastInput {
  public:
    explicit LastInput(std::string name) : name_(std::move(name)), file_(std::fopen(name_.c_str(), "wb")) {
        if (!file_) std::perror(name_.c_str()), std::exit(1);
    }
    ~LastInput() {
        std::fclose(file_);
        std::filesystem::remove(name_);
    }
    LastInput(const LastInput&) = delete;
    LastInput& operator=(const LastInput&) = delete;

    void keep(const Bytes& bytes) {
        const auto size = static_cast<off_t>(bytes.size());
        if (pwrite(fileno(file_), bytes.data(), bytes.size(), 0) != size ||
            ftruncate(fileno(file_), size) != 0)
            std::perror(name_.c_str()), std::exit(1);
    }

  private:
    std::string name_;
    std::FILE* file_;
};

void try_one(const Bytes& bytes, LastInput& last) {
    last.keep(bytes);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 5) {
        std::fprintf(stderr, "usage: %s CORPUS_FOLDER COPIES [CHAIN [SEED]]\n", argv[0]);
        return 2;
    }
    const long copies = std::atol(argv[2]), chain = argc > 3 ? std::atol(argv[3]) : 1;
    std::mt19937 random(argc > 4 ? static_cast<unsigned>(std::atol(argv[4])) : 1);
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        std::fprintf(stderr, "%s: no corpus\n", argv[1]);
        return 1;
    }
    LastInput last(std::filesystem::path(argv[0]).filename().string() + ".last");
    std::vector<Bytes> corpus;
    for (const auto& file : files) {
        std::ifstream in(file, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
        try_one(corpus.back(), last);
    }
    const long inputs = copies * static_cast<long>(corpus.size());
    for (long i = 0; i < inputs; ++i) {
        Bytes bytes = damaged(corpus[static_cast<std::size_t>(i / copies)], chain > 1, random);
        for (long link = 1; link < chain; ++link) {
            const Bytes next = damaged(corpus[random() % corpus.size()], true, random);
            bytes.insert(bytes.end(), next.begin(), next.end());
        }
        try_one(bytes, last);
        if (i == inputs / 10) std::printf("%ld inputs, %ld KiB resident\n", i, resident_kib());
    }
    std::printf("%zu files, %ld inputs of %ld damaged copies each, %ld KiB resident\n", files.size(), inputs,
                chain, resident_kib());
    return 0;
}
