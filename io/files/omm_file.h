#pragma once
// Reads Orbit Mean-elements Messages (OMM) with elements for SGP4: CCSDS 502.0-B-3 section 4, versions 2.0
// and 3.0, in the forms that CelesTrak and Space-Track publish. Satellites with numbers of six digits or more
// come only in this form.
//
// A file holds one message or several: KVN (each begins with CCSDS_OMM_VERS), XML (one <omm>, or an <ndm> of
// them), CSV (a line of keywords, then a line of values per satellite), JSON (an object, or an array of them;
// values are numbers or texts). The axes are TEME, the time system UTC, the centre the Earth; CSV and JSON
// omit them. A set made for another theory (SGP4-XP, DSST...) is kept with its refusal, which
// choose_element_set() reports when it is selected.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/element_set.h"

namespace hilcam {

enum class OmmForm { kKvn, kXml, kCsv, kJson };
// Returns the form, found from a text's first characters; nothing when it is not such a message.
std::optional<OmmForm> omm_form_of(std::string_view text);

// Returns all sets in order. Throws InputError with the place of what is missing, damaged or no orbit.
std::vector<ElementSet> read_omm(std::string_view text, const std::string& name, OmmForm form);

}  // namespace hilcam
