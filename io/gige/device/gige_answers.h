#pragma once
// Keeps answers: those to the latest requests that change something, for repeated requests, and those that a
// fault delays.

#include <array>
#include <cstdint>
#include <span>

#include "io/gige/device/gvcp.h"
#include "io/gige/stream/gige_stream.h"

namespace hilcam {

class GigeAnswers {
  public:
    // Tells whether a request was seen before (the same bytes from the same application, not long ago), and
    // the size of its answer; 0: it got none.
    struct Found {
        bool known = false;
        std::size_t bytes = 0;
    };
    Found find(std::span<const std::uint8_t> request, const Endpoint& from, std::int64_t now_ns,
               std::span<std::uint8_t> out) const;
    void keep(std::span<const std::uint8_t> request, const Endpoint& from, std::int64_t now_ns,
              std::span<const std::uint8_t> answer);

    // --- Delayed answers.
    //
    // Holds an answer until it is due. False: too many wait already.
    bool hold(const Endpoint& to, std::span<const std::uint8_t> answer, std::int64_t due_ns);
    // Returns when the request's answer is due; 0: none waits.
    std::int64_t held_until_ns(const Endpoint& to, std::uint16_t request_id) const;
    // Returns an answer that is due, once; empty: none. Valid until the next call.
    std::span<const std::uint8_t> take_due(std::int64_t now_ns, Endpoint& to);
    std::int64_t deadline_ns() const;  // INT64_MAX: none
    void forget();

  private:
    static constexpr std::size_t kKept = 16, kHeld = 16;
    // Aravis gives up after 2.5 s; ids recur much later.
    static constexpr std::int64_t kMemory_ns = 10'000'000'000;
    struct Entry {
        bool used = false;
        Endpoint from;
        std::uint64_t request_hash = 0;
        std::int64_t time_ns = 0;  // kept: of the request; held: due
        std::size_t bytes = 0;
        std::array<std::uint8_t, gvcp::kMaxDatagramBytes> answer{};

        std::span<const std::uint8_t> view() const { return std::span(answer).first(bytes); }
    };
    static void fill(Entry& entry, const Endpoint& from, std::int64_t time_ns,
                     std::span<const std::uint8_t> answer);

    std::array<Entry, kKept> kept_;
    std::array<Entry, kHeld> held_;
    std::size_t next_ = 0;
};

}  // namespace hilcam
