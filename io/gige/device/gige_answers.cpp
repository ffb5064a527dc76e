#include "io/gige/device/gige_answers.h"

#include <algorithm>
#include <limits>

#include "render/vocabulary/fnv.h"

namespace hilcam {
namespace {

std::uint64_t hash_of(std::span<const std::uint8_t> bytes) {
    Fnv1a hash;
    hash.take_bytes(bytes);
    return hash.value();
}

}  // namespace

void GigeAnswers::fill(Entry& entry, const Endpoint& from, std::int64_t time_ns,
                       std::span<const std::uint8_t> answer) {
    entry.used = true;
    entry.from = from;
    entry.time_ns = time_ns;
    entry.bytes = std::min(answer.size(), entry.answer.size());
    std::copy_n(answer.begin(), entry.bytes, entry.answer.begin());
}

GigeAnswers::Found GigeAnswers::find(std::span<const std::uint8_t> request, const Endpoint& from,
                                     std::int64_t now_ns, std::span<std::uint8_t> out) const {
    const std::uint64_t hash = hash_of(request);
    for (const Entry& e : kept_) {
        if (!e.used || e.request_hash != hash || !(e.from == from) || now_ns - e.time_ns > kMemory_ns)
            continue;
        std::copy_n(e.answer.begin(), e.bytes, out.begin());
        return {true, e.bytes};
    }
    return {};
}

void GigeAnswers::keep(std::span<const std::uint8_t> request, const Endpoint& from, std::int64_t now_ns,
                       std::span<const std::uint8_t> answer) {
    Entry& entry = kept_[next_];
    next_ = (next_ + 1) % kKept;
    fill(entry, from, now_ns, answer);
    entry.request_hash = hash_of(request);
}

bool GigeAnswers::hold(const Endpoint& to, std::span<const std::uint8_t> answer, std::int64_t due_ns) {
    const auto free = std::find_if(held_.begin(), held_.end(), [](const Entry& e) { return !e.used; });
    if (free == held_.end()) return false;
    fill(*free, to, due_ns, answer);
    return true;
}

std::int64_t GigeAnswers::held_until_ns(const Endpoint& to, std::uint16_t request_id) const {
    for (const Entry& e : held_) {
        if (!e.used || !(e.from == to)) continue;
        const auto header = gvcp::read_answer_header(e.view());
        if (header && header->request_id == request_id) return e.time_ns;
    }
    return 0;
}

std::span<const std::uint8_t> GigeAnswers::take_due(std::int64_t now_ns, Endpoint& to) {
    Entry* first = nullptr;
    for (Entry& e : held_)
        if (e.used && e.time_ns <= now_ns && (!first || e.time_ns < first->time_ns)) first = &e;
    if (!first) return {};
    first->used = false;
    to = first->from;
    return first->view();
}

std::int64_t GigeAnswers::deadline_ns() const {
    std::int64_t next_ns = std::numeric_limits<std::int64_t>::max();
    for (const Entry& e : held_)
        if (e.used) next_ns = std::min(next_ns, e.time_ns);
    return next_ns;
}

void GigeAnswers::forget() {
    for (Entry& e : kept_) e.used = false;
    for (Entry& e : held_) e.used = false;
}

}  // namespace hilcam
