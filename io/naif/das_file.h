#pragma once
// DAS, the container of SPICE's shape kernels: characters, doubles and integers, each numbered from 1 over the whole
// file.
//
// NAIF, "Direct Access, Segregated (DAS) Required Reading": records of 1024 bytes; the first is the file record, then
// come reserved records and comments, which are passed over, then directories, each before the clusters of records of
// one kind that it lists. Both byte orders are read, and the transfer format (transfer_text.h); a binary file that was
// transferred as text, and so is damaged, is known by the file record's FTP string.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/naif/naif_record.h"

namespace hilcam {

class DasFile {
  public:
    // Reads the directories. `bytes` are the whole file and stay the caller's; `name` stands for the file in messages.
    // Throws InputError, one line that names the file, for what is no DAS file of shapes or is cut short.
    DasFile(std::string_view bytes, std::string name);

    // Returns so many numbers from an address on. Throws InputError where the file has no such addresses.
    std::vector<std::int32_t> integers(std::int64_t first, std::int64_t count) const;
    std::vector<double> doubles(std::int64_t first, std::int64_t count) const;
    std::int64_t integer_count() const { return kinds_[2].last; }

    const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& what) const;

  private:
    // Records of one kind, one behind the other.
    struct Cluster {
        std::int64_t first = 1;  // address of its first number
        std::int64_t numbers = 0;
        std::uint64_t byte = 0;  // where it begins in the file
    };
    struct Kind {
        std::vector<Cluster> clusters;
        std::int64_t last = 0;  // greatest address
    };
    std::string_view bytes_;
    std::string name_;
    NaifNumbers numbers_;
    std::array<Kind, 3> kinds_;  // characters, doubles, integers

    // The numbers of a file in transfer format.
    bool is_transfer_ = false;
    std::vector<double> decoded_doubles_;
    std::vector<std::int32_t> decoded_integers_;

    void read_transfer();
    template <class T>
    std::vector<T> decoded(const std::vector<T>& all, const char* what, std::int64_t first,
                           std::int64_t count) const;
    void read_directories(std::int64_t first_record);
    void add_clusters(const char* directory, std::int64_t record);
    const char* record_at(std::int64_t record, std::int64_t count) const;
    template <class T, class Take>
    std::vector<T> numbers(const Kind& kind, const char* what, std::int64_t first, std::int64_t count,
                           const Take& take) const;
};

}  // namespace hilcam
