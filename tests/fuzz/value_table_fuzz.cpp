// Any text is a table whose rows are all as long as its first line, or refused in one line.

#include <cstdint>
#include <string_view>

#include "io/files/value_table_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    try {
        const ValueTable table =
            parse_value_table(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz");
        HILCAM_CHECK(!table.rows.empty() && table.rows.size() == table.lines.size());
        for (const auto& row : table.rows) HILCAM_CHECK(row.size() == table.columns.size());
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
