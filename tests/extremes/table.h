#pragma once
// docs/extremes.md: written from what was measured, and read back to be compared with the suite.

#include <optional>
#include <string>
#include <vector>

#include "tests/extremes/group.h"

namespace hilcam::extremes {

// Of one case; empty: it was not measured.
using Measured = std::vector<Found>;

// What precedes the tables.
std::string preface();
// A table with its heading. measured: per case of the group.
std::string section(const Group& group, const std::vector<Measured>& measured);

// Headings of the document's tables.
std::vector<std::string> titles_in(const std::string& document);
// What the document says otherwise than the suite: values and limits must be the same, truths the same to a
// percent, and the document's errors within their limits. Errors may differ, as their last digits depend on
// the machine. Empty: nothing.
std::vector<std::string> differences(const std::string& document, const Group& group,
                                     const std::vector<Measured>& measured);

}  // namespace hilcam::extremes
