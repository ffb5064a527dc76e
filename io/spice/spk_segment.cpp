#include "io/spice/spk_segment.h"

#include "io/spice/spk_types.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

SpkSummary spk_summary(const DafFile& file, const DafArray& array) {
    SpkSummary out;
    out.target = array.integers[0], out.center = array.integers[1];
    out.frame = array.integers[2], out.type = array.integers[3];
    out.start_et_s = array.doubles[0], out.stop_et_s = array.doubles[1];
    out.where = file.name() + ": segment " + std::to_string(&array - file.arrays().data() + 1) + " (" +
                in_quotes(array.name) + ", body " + std::to_string(out.target) + ", type " +
                std::to_string(out.type) + ")";
    if (out.stop_et_s < out.start_et_s)
        throw InputError(out.where + ": ends at " + plain(out.stop_et_s) + " s, before it begins at " +
                         plain(out.start_et_s) + " s");
    if (out.target == out.center) throw InputError(out.where + ": its centre is the body itself");
    return out;
}

std::unique_ptr<SpkSegment> load_spk_segment(const DafFile& file, const DafArray& array) {
    const SpkSummary about = spk_summary(file, array);
    switch (about.type) {
        case 2:
        case 3:
        case 14:
        case 20:
            return make_spk_chebyshev(about, file.words(array));
        case 5:
            return make_spk_two_body(about, file.words(array));
        case 8:
        case 9:
        case 12:
        case 13:
        case 18:
        case 19:
            return make_spk_discrete(about, file.words(array));
        case 10:
            return make_spk_two_line(about, file.words(array));
        case 15:
        case 17:
            return make_spk_elements(about, file.words(array));
        case 1:
        case 21:
            return make_spk_differences(about, file.words(array));
        default:
            throw InputError(about.where + ": found type " + std::to_string(about.type) +
                             "; accepted: 1, 2, 3, 5, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 20, 21");
    }
}

}  // namespace hilcam
