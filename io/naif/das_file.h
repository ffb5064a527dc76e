#pragma once
// DAS, the container of SPICE's shape kernels: characters, doubles and integers, each kind numbered from 1
// over the whole file.
//
// NAIF, "Direct Access, Segregated (DAS) Required Reading". Records are 1024 bytes. The file record comes
// first, then reserved records and comments, which are skipped, then directories. A directory lists the
// clusters of records of one kind that follow it. Both byte orders and the transfer format (transfer_text.h)
// are read. The FTP string in the file record reveals a binary file that was damaged by a transfer as text.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/naif/naif_record.h"

namespace hilcam {

class DasFile {
  public:
    // Reads the directories. bytes: the whole file, which must outlive this. name: stands for the file in
    // messages. Throws InputError, one line that names the file, when it is not a DAS file of shapes or is
    // truncated.
    DasFile(std::string_view bytes, std::string name);

    // Return `count` numbers from address `first` on. They throw InputError when the file has no such
    // addresses.
    std::vector<std::int32_t> integers(std::int64_t first, std::int64_t count) const;
    std::vector<double> doubles(std::int64_t first, std::int64_t count) const;
    std::int64_t integer_count() const { return kinds_[2].last; }

    const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& what) const;

  private:
    // Consecutive records of one kind.
    struct Cluster {
        std::int64_t first = 1;  // address of its first number
        std::int64_t numbers = 0;
        std::uint64_t byte = 0;  // offset in the file
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
