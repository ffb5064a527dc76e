#pragma once
// Writes binary SPICE kernels from what NAIF's "DAF Required Reading" says of the container, with nothing of the readers.

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/byte_order.h"

namespace hilcam {

struct WrittenArray {
    std::string name;
    double start = 0, stop = 0;
    std::vector<std::int32_t> integers;  // 4 of an SPK or CK, 3 of a binary PCK
    std::vector<double> words;
};

class SpiceWriter {
  public:
    explicit SpiceWriter(std::string kind, bool big_endian = false)
        : kind_(std::move(kind)), big_endian_(big_endian) {}

    SpiceWriter& add(WrittenArray array) {
        arrays_.push_back(std::move(array));
        return *this;
    }

    // The whole file: file record, a record of comments, one record of summaries and one of names for each 25 arrays, words.
    std::string bytes() const {
        const std::size_t integers = kind_ == "PCK" ? 5 : 6,
                          blocks = std::max<std::size_t>(1, (arrays_.size() + 24) / 25);
        std::int32_t word = static_cast<std::int32_t>((2 + 2 * blocks) * 128 + 1);
        std::string summaries, data;
        for (std::size_t b = 0; b < blocks; ++b) {
            const std::size_t first = 25 * b, end = std::min(arrays_.size(), first + 25);
            std::string record = number(b + 1 < blocks ? static_cast<double>(3 + 2 * (b + 1)) : 0) +
                                 number(b > 0 ? static_cast<double>(3 + 2 * (b - 1)) : 0) +
                                 number(static_cast<double>(end - first));
            std::string names;
            for (std::size_t i = first; i < end; ++i) {
                const WrittenArray& a = arrays_[i];
                std::string summary = number(a.start) + number(a.stop);
                for (const std::int32_t n : a.integers) summary += integer(n);
                summary += integer(word) + integer(word + static_cast<std::int32_t>(a.words.size()) - 1);
                summary.resize(40, '\0');
                record += summary;
                std::string name = a.name;
                name.resize(40, ' ');
                names += name;
                word += static_cast<std::int32_t>(a.words.size());
                for (const double w : a.words) data += number(w);
            }
            record.resize(1024, '\0'), names.resize(1024, ' ');
            summaries += record + names;
        }
        std::string head = "DAF/" + kind_;
        head.resize(8, ' ');
        head += integer(2) + integer(static_cast<std::int32_t>(integers)) + std::string(60, ' ') +
                integer(3) + integer(static_cast<std::int32_t>(1 + 2 * blocks)) + integer(word) +
                (big_endian_ ? "BIG-IEEE" : "LTL-IEEE");
        head.resize(699, '\0');
        head += std::string("FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xce:ENDFTP", 28);
        head.resize(1024, '\0');
        std::string comments = "what this is for\x04";
        comments.resize(1024, '\0');
        data.resize((data.size() + 1023) / 1024 * 1024, '\0');
        return head + comments + summaries + data;
    }

  private:
    std::string kind_;
    bool big_endian_;
    std::vector<WrittenArray> arrays_;

    std::string number(double value) const { return ordered(value, big_endian_); }
    std::string integer(std::int32_t value) const { return ordered(value, big_endian_); }
};

}  // namespace hilcam
