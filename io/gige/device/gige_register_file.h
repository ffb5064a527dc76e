#pragma once
// A device's address space as a table: what is at an address, which clients may write it, and what reading
// and writing do. Numbers are big-endian. One thread.

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/gige/device/gvcp.h"

namespace hilcam {

class GigeRegisterFile {
  public:
    using Status = gvcp::Status;
    using Read = std::function<std::uint64_t()>;
    using Write = std::function<Status(std::uint64_t)>;
    // The times at which a register can be written; kUnlocked: unless the geometry is locked.
    enum class When { kAlways, kUnlocked };

    struct Register {
        std::uint32_t address = 0, bytes = 4;
        Read read{};    // reads a number; empty: `text`
        Write write{};  // empty: read only
        When when = When::kAlways;
        bool open = false;  // readable also under exclusive control
        std::string text{};
        bool text_writable = false;
    };

    // --- The table. Addresses must not overlap.
    void add(Register r);
    void constant(std::uint32_t address, std::uint64_t value, std::uint32_t bytes = 4);
    void number(std::uint32_t address, Read read, Write write = {}, When when = When::kAlways);
    void number64(std::uint32_t address, Read read, Write write = {});
    void real(std::uint32_t address, std::function<double()> read, std::function<Status(double)> write = {},
              When when = When::kAlways);
    // Adds a number with limits and no other rule; `changed` may be empty.
    struct Limits {
        std::uint32_t least = 0, most = 0xFFFFFFFF;
    };
    void variable(std::uint32_t address, std::uint32_t& value, Limits limits,
                  std::function<void()> changed = {}, When when = When::kAlways);
    // Adds a command: it reads as 0, and writing an odd number runs it.
    void command(std::uint32_t address, std::function<Status()> run);
    void text(std::uint32_t address, std::uint32_t bytes, const std::string& value, bool writable = false);
    void set_text(std::uint32_t address, const std::string& value);
    std::string text_at(std::uint32_t address) const;
    // Adds read-only memory.
    void memory(std::uint32_t address, std::span<const std::uint8_t> bytes);

    // --- Access. Addresses and sizes must be multiples of 4 (BAD_ALIGNMENT).
    //
    // Gaps between the registers of a range read as zeros; a range without any register gives
    // INVALID_ADDRESS.
    Status read(std::uint32_t address, std::span<std::uint8_t> out) const;
    // Writes register by register and stops at the first that refuses. done: number of bytes written. Numbers
    // are written whole; texts may be written in part.
    Status write(std::uint32_t address, std::span<const std::uint8_t> data, bool locked, std::size_t& done);
    const Register* find(std::uint32_t address) const;  // the one that covers the address

  private:
    Status write_one(Register& r, std::uint32_t offset, std::span<const std::uint8_t> data, bool locked);

    std::map<std::uint32_t, Register> registers_;  // by address
    struct Memory {
        std::uint32_t address;
        std::span<const std::uint8_t> bytes;
    };
    std::vector<Memory> memories_;
};

}  // namespace hilcam
