// Any text is a table whose rows are all as long as its first line, or refused in one line. So is the list of
// a sensor's defects, which is such a table and can be written again.

#include <cstdint>
#include <string_view>

#include "io/files/defect_list.h"
#include "io/files/value_table_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    try {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        const ValueTable table = parse_value_table(text, "fuzz");
        HILCAM_CHECK(!table.rows.empty() && table.rows.size() == table.lines.size());
        for (const auto& row : table.rows) HILCAM_CHECK(row.size() == table.columns.size());
        const std::vector<ListedDefect> defects = parse_defect_list(text, "fuzz");
        HILCAM_CHECK(defects.size() == table.rows.size());
        const std::vector<ListedDefect> again = parse_defect_list(defect_list_text(defects), "again");
        for (std::size_t i = 0; i < defects.size(); ++i)
            HILCAM_CHECK(again[i].kind == defects[i].kind && again[i].x == defects[i].x &&
                         again[i].y == defects[i].y);
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
