#pragma once
// CCSDS messages in XML (505.0-B, NDM/XML): their elements as the lines of the KVN form, which one reader reads then.
//
// A file holds one message, or an <ndm> of several, of which those of the wanted kind are taken in their order. An
// element's name is its keyword; data become lines of an epoch and numbers, or of keywords (OMM). Comments, covariances
// and parameters of the user's own are passed over. No entities or document types are expanded.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

enum class NdmKind { kOem, kAem, kOmm };

struct NdmText {
    std::string text;
    std::vector<int> lines;  // for each of its lines, that of the file
};

inline constexpr std::size_t kMaxNdmXmlBytes = std::size_t{128} << 20;

// True when a text's first character that is no blank begins an element.
bool is_xml(std::string_view text);
// Throws InputError, one line with the file's, for what is not well formed, larger than 128 MiB, has no such message, or a
// number in another unit than the standard's.
NdmText kvn_of_xml(std::string_view xml, const std::string& name, NdmKind kind);

// The unit of a keyword's number by 502.0-B-3 tables 3-3, 4-3, 5-3 and 504.0-B-2 tables 3-3, 4-3; empty: it has none.
std::string_view unit_of_keyword(std::string_view key);
// True when a unit is that one; case does not count ("REV/DAY").
bool is_unit(std::string_view found, std::string_view unit);

}  // namespace hilcam
