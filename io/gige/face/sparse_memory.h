#pragma once
// A memory of 32-bit addresses of which little is used: it reads as zeros where nothing was written. One
// thread.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>

namespace hilcam {

class SparseMemory {
  public:
    // Both may run past the last address, and then go on at 0.
    void read(std::uint32_t address, std::span<std::uint8_t> out) const {
        each_page(address, out.size(),
                  [&](std::uint32_t page, std::size_t at, std::size_t from, std::size_t bytes) {
                      const auto found = pages_.find(page);
                      if (found == pages_.end())
                          std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(from), bytes,
                                      std::uint8_t{0});
                      else
                          std::copy_n(found->second.begin() + static_cast<std::ptrdiff_t>(at), bytes,
                                      out.begin() + static_cast<std::ptrdiff_t>(from));
                  });
    }
    void write(std::uint32_t address, std::span<const std::uint8_t> data) {
        each_page(address, data.size(),
                  [&](std::uint32_t page, std::size_t at, std::size_t from, std::size_t bytes) {
                      std::copy_n(data.begin() + static_cast<std::ptrdiff_t>(from), bytes,
                                  pages_[page].begin() + static_cast<std::ptrdiff_t>(at));
                  });
    }
    std::size_t pages() const { return pages_.size(); }

  private:
    static constexpr std::uint32_t kPageBytes = 4096;
    template <class Visit>
    static void each_page(std::uint32_t address, std::size_t bytes, const Visit& visit) {
        for (std::size_t done = 0; done < bytes;) {
            const auto here = address + static_cast<std::uint32_t>(done);
            const std::size_t at = here % kPageBytes, now = std::min(bytes - done, kPageBytes - at);
            visit(here / kPageBytes, at, done, now);
            done += now;
        }
    }
    std::map<std::uint32_t, std::array<std::uint8_t, kPageBytes>> pages_;
};

}  // namespace hilcam
