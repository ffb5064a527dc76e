#pragma once
// Turns CCSDS messages in XML (505.0-B, NDM/XML) into lines of KVN, so that one reader reads both.
//
// A file holds one message, or an <ndm> of several; those of the wanted kind are used in order. An element's
// name is its keyword. Data become lines of an epoch and numbers, or of keywords (OMM). Comments, covariances
// and user-defined parameters are skipped. Entities and document types are not expanded.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

enum class NdmKind { kOem, kAem, kOmm };

struct NdmText {
    std::string text;
    std::vector<int> lines;  // for each line of `text`, the line in the file
};

inline constexpr std::size_t kMaxNdmXmlBytes = std::size_t{128} << 20;

// True when the first character that is not blank begins an element.
bool is_xml(std::string_view text);
// Throws InputError, one line with the file's line, for a text that is malformed, larger than 128 MiB,
// without such a message, or with a number in another unit than the standard's.
NdmText kvn_of_xml(std::string_view xml, const std::string& name, NdmKind kind);

// Returns the unit of a keyword's number by 502.0-B-3 tables 3-3, 4-3, 5-3 and 504.0-B-2 tables 3-3, 4-3;
// empty: it has none.
std::string_view unit_of_keyword(std::string_view key);
// True when the two units are the same, in any case ("REV/DAY").
bool is_unit(std::string_view found, std::string_view unit);

}  // namespace hilcam
