#pragma once
// DAF, the container of SPICE's binary kernels (SPK, CK, binary PCK): arrays of doubles, each with a summary
// and a name.
//
// NAIF, "Double Precision Array Files (DAF) Required Reading". Records are 1024 bytes. The file record comes
// first, then reserved records with comments, which are skipped, then doubly linked summary records, each
// followed by a record of names, and the arrays. Words are numbered from 1. Both byte orders and the transfer
// format (transfer_text.h) are read. The FTP string in the file record reveals a binary file that was damaged
// by a transfer as text.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/naif/naif_record.h"
#include "io/naif/transfer_text.h"
#include "io/system/input_file.h"

namespace hilcam {

// The summary of an array.
struct DafArray {
    std::string name;                    // without trailing blanks
    std::array<double, 2> doubles{};     // start and stop, in all kernels
    std::vector<std::int32_t> integers;  // without the last two, the addresses `first` and `last`
    std::uint64_t first = 0, last = 0;
    std::uint64_t size() const { return last - first + 1; }
};

class DafFile {
  public:
    // Opens a file and reads its summaries. Throws InputError, one line that names the file, when it is not a
    // DAF, is truncated, or has arrays that overlap: reading these one by one would take more memory than the
    // file. Owner thread.
    explicit DafFile(const std::filesystem::path& file);
    // Reads the same from memory. name: stands for the file in messages.
    DafFile(std::string bytes, std::string name);

    // Returns SPK, CK or PCK.
    const std::string& kind() const { return kind_; }
    const std::string& name() const { return name_; }
    const std::vector<DafArray>& arrays() const { return arrays_; }
    // Reads an array. Throws InputError for numbers that are not finite.
    std::vector<double> words(const DafArray& array) const;

  private:
    std::string name_, kind_;
    std::optional<InputFile> file_;  // none: the file is in bytes_
    std::string bytes_;
    std::uint64_t size_ = 0;
    NaifNumbers numbers_;
    std::vector<DafArray> arrays_;
    // All words of a file in transfer format; empty for a binary one.
    std::vector<double> decoded_;

    void open();
    void require_kind(std::int64_t doubles, std::int64_t integers) const;
    void read_transfer();
    void read_transfer_array(TransferText& text, std::size_t integers);
    void read(std::uint64_t from, char* to, std::size_t size) const;
    void read_summaries(std::int32_t first_record, std::size_t integers);
    DafArray array_of(const char* summary, const char* name, std::size_t integers) const;
    [[noreturn]] void fail(const std::string& what) const;
};

}  // namespace hilcam
