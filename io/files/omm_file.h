#pragma once
// Orbit Mean-elements Messages (OMM) with elements for SGP4: CCSDS 502.0-B-3 section 4, versions 2.0 and 3.0, in the forms in
// which CelesTrak and Space-Track publish them. They are the form of satellites whose numbers have six digits or more.
//
// A file holds one message or many: KVN (each from its CCSDS_OMM_VERS on), XML (one <omm>, or an <ndm> of them), CSV (a line
// of keywords, then one of values for each satellite), JSON (an object, or an array of them; values are numbers or texts).
// Axes TEME, UTC, the Earth; CSV and JSON leave them out. A set that another theory made (SGP4-XP, DSST...) is kept with its
// refusal: it is refused when it is asked for (choose_element_set).

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/element_set.h"

namespace hilcam {

enum class OmmForm { kKvn, kXml, kCsv, kJson };
// The form by a text's first characters; nothing for what is no such message.
std::optional<OmmForm> omm_form_of(std::string_view text);

// Returns all sets in their order. Throws InputError with the place of what is missing, damaged or no orbit.
std::vector<ElementSet> read_omm(std::string_view text, const std::string& name, OmmForm form);

}  // namespace hilcam
