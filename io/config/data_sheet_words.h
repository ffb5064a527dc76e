#pragma once
// The words of sensors' and cameras' data sheets that are none of ours, and the key that each of them is here.

#include <string_view>

namespace hilcam {

struct DataSheetWord {
    std::string_view key;  // "camera.full_well_e"; empty: it follows from others, which `how` names
    std::string_view how;  // from the sheet's figure to the key's
};

// Returns what a key of a data sheet is here; null: it is no such word. Capitals, spaces, hyphens and a unit at
// its end do not matter: "Full-Well Capacity", "full_well_capacity_ke".
const DataSheetWord* data_sheet_word(std::string_view key);

}  // namespace hilcam
