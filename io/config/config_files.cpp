#include "io/config/config_files.h"

#include <system_error>
#include <vector>

#include "io/config/config_advice.h"
#include "io/system/program_files.h"
#include "io/system/shipped_parts.h"

namespace hilcam {

std::filesystem::path file_named_from(const std::filesystem::path& folder, const std::string& name,
                                      const std::string& key) {
    std::filesystem::path own = folder / name;
    std::error_code error;
    if (std::filesystem::exists(own, error)) return own;
    std::filesystem::path shipped = shipped_file(name);
    if (!shipped.empty()) return shipped;
    if (const ShippedKind* const kind = kind_of_key(key)) shipped = shipped_part(*kind, name);
    if (!shipped.empty()) return shipped;
    return is_shipped(folder) ? std::filesystem::current_path() / name : own;
}

std::string shipped_advice(const std::string& key, const std::string& found) {
    const ShippedKind* const kind = kind_of_key(key);
    if (!kind) return {};
    const std::vector<std::string> names = shipped_names(*kind);
    const std::string nearest = nearest_of(found, names);
    return ", or the name of a shipped one ('hilcam list " + std::string(kind->words) + "')" +
           (nearest.empty() ? "" : "; nearest: " + nearest);
}

}  // namespace hilcam
