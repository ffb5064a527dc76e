#pragma once
// Collects one object's segments of an OEM or AEM in time order, for the readers of both.

#include <string>
#include <utility>
#include <vector>

#include "io/files/ccsds_message.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time.h"

namespace hilcam {

// Keeps a segment when it is the object's, by name or number; every segment when `object` is empty. Throws
// InputError for a second object when `object` is empty, and for a segment that begins before the previous
// one ends.
template <class Segment>
void keep_segment(const KvnLines& lines, std::vector<Segment>& kept, Segment&& segment,
                  const std::string& object) {
    if (!object.empty() && !is_word(segment.object_name, object) && !is_word(segment.object_id, object))
        return;
    if (!kept.empty()) {
        const Segment& before = kept.back();
        if (object.empty() && before.object_id != segment.object_id)
            lines.fail("has objects " + in_quotes(before.object_id) + " and " + in_quotes(segment.object_id) +
                           "; accepted: one of them by 'object'",
                       segment.line);
        if (segment.usable_start < before.usable_stop)
            lines.fail("the segment that begins here is usable from " + format_utc(segment.usable_start) +
                           ", before the one of line " + std::to_string(before.line) + " ends (" +
                           format_utc(before.usable_stop) + ")",
                       segment.line);
    }
    kept.push_back(std::move(segment));
}

// Returns the kept segments and passes on the lines' notes. Throws InputError when the object has no segment.
template <class Segment>
std::vector<Segment> kept_segments(const KvnLines& lines, std::vector<Segment>&& kept,
                                   const std::string& name, const std::string& object,
                                   std::vector<std::string>* notes) {
    if (notes) notes->insert(notes->end(), lines.notes().begin(), lines.notes().end());
    if (kept.empty())
        throw InputError(name + ": has no object " + in_quotes(object) +
                         "; accepted: an OBJECT_NAME or OBJECT_ID");
    return std::move(kept);
}

}  // namespace hilcam
