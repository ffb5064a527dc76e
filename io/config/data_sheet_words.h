#pragma once
// Words of sensors' and cameras' data sheets that are not keys here, and the keys that correspond to them.

#include <string_view>

namespace hilcam {

struct DataSheetWord {
    std::string_view key;  // "camera.full_well_e"; empty: it follows from others, which `how` names
    std::string_view how;  // from the sheet's figure to the key's
};

// Returns the key for a data sheet's word; null when the word is unknown. Case, spaces, hyphens and a unit at
// the end do not matter: "Full-Well Capacity", "full_well_capacity_ke".
const DataSheetWord* data_sheet_word(std::string_view key);

}  // namespace hilcam
