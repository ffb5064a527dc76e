#include "io/gige/device/gige_register_file.h"

#include <algorithm>
#include <bit>

#include "io/system/bytes.h"
#include "render/vocabulary/check.h"

namespace hilcam {

using gvcp::Status;

// --- the table

void GigeRegisterFile::add(Register r) {
    HILCAM_CHECK(r.address % 4 == 0 && r.bytes % 4 == 0 && r.bytes > 0);
    const auto after = registers_.lower_bound(r.address);
    HILCAM_CHECK(after == registers_.end() || r.address + r.bytes <= after->first);
    HILCAM_CHECK(!find(r.address));
    const std::uint32_t address = r.address;
    registers_.emplace(address, std::move(r));
}

void GigeRegisterFile::constant(std::uint32_t address, std::uint64_t value, std::uint32_t bytes) {
    add({.address = address, .bytes = bytes, .read = [value] { return value; }});
}
void GigeRegisterFile::number(std::uint32_t address, Read read, Write write, When when) {
    add({.address = address, .read = std::move(read), .write = std::move(write), .when = when});
}
void GigeRegisterFile::number64(std::uint32_t address, Read read, Write write) {
    add({.address = address, .bytes = 8, .read = std::move(read), .write = std::move(write)});
}
void GigeRegisterFile::real(std::uint32_t address, std::function<double()> read,
                            std::function<Status(double)> write, When when) {
    Write write_bits;
    if (write)
        write_bits = [write = std::move(write)](std::uint64_t bits) {
            return write(std::bit_cast<double>(bits));
        };
    add({.address = address,
         .bytes = 8,
         .read = [read = std::move(read)] { return std::bit_cast<std::uint64_t>(read()); },
         .write = std::move(write_bits),
         .when = when});
}
void GigeRegisterFile::variable(std::uint32_t address, std::uint32_t& value, Limits limits,
                                std::function<void()> changed, When when) {
    number(
        address, [&value] { return value; },
        [&value, limits, changed = std::move(changed)](std::uint64_t wanted) {
            if (wanted < limits.least || wanted > limits.most) return Status::kInvalidParameter;
            value = static_cast<std::uint32_t>(wanted);
            if (changed) changed();
            return Status::kSuccess;
        },
        when);
}
void GigeRegisterFile::command(std::uint32_t address, std::function<Status()> run) {
    number(
        address, [] { return 0u; },
        [run = std::move(run)](std::uint64_t value) { return value & 1 ? run() : Status::kSuccess; });
}
void GigeRegisterFile::text(std::uint32_t address, std::uint32_t bytes, const std::string& value,
                            bool writable) {
    add({.address = address, .bytes = bytes, .text_writable = writable});
    set_text(address, value);
}
void GigeRegisterFile::set_text(std::uint32_t address, const std::string& value) {
    Register& r = registers_.at(address);
    r.text = value.substr(0, r.bytes - 1);  // the last byte stays zero
}
std::string GigeRegisterFile::text_at(std::uint32_t address) const { return registers_.at(address).text; }

void GigeRegisterFile::memory(std::uint32_t address, std::span<const std::uint8_t> bytes) {
    memories_.push_back({address, bytes});
}

const GigeRegisterFile::Register* GigeRegisterFile::find(std::uint32_t address) const {
    auto after = registers_.upper_bound(address);
    if (after == registers_.begin()) return nullptr;
    const Register& r = std::prev(after)->second;
    return address - r.address < r.bytes ? &r : nullptr;
}

// --- access

namespace {

std::uint8_t byte_of(const GigeRegisterFile::Register& r, std::uint64_t number, std::uint32_t offset) {
    if (r.read) return static_cast<std::uint8_t>(number >> 8 * (r.bytes - 1 - offset));
    return offset < r.text.size() ? static_cast<std::uint8_t>(r.text[offset]) : std::uint8_t{0};
}

}  // namespace

Status GigeRegisterFile::read(std::uint32_t address, std::span<std::uint8_t> out) const {
    if (address % 4 != 0 || out.size() % 4 != 0) return Status::kBadAlignment;
    std::fill(out.begin(), out.end(), std::uint8_t{0});
    for (const Memory& m : memories_) {
        if (address < m.address || address - m.address >= m.bytes.size()) continue;
        // Clients read a description in pieces of fixed size; the part beyond its end reads as zeros.
        const auto from = m.bytes.subspan(address - m.address);
        std::copy_n(from.begin(), std::min(from.size(), out.size()), out.begin());
        return Status::kSuccess;
    }
    const std::uint64_t end = std::uint64_t{address} + out.size();
    const Register* first = find(address);
    auto at = first ? registers_.find(first->address) : registers_.lower_bound(address);
    if (at == registers_.end() || at->first >= end) return Status::kInvalidAddress;
    for (; at != registers_.end() && at->first < end; ++at) {
        const Register& r = at->second;
        const std::uint64_t number = r.read ? r.read() : 0;
        for (std::uint32_t i = 0; i < r.bytes; ++i) {
            const std::uint64_t place = std::uint64_t{r.address} + i;
            if (place >= address && place < end) out[place - address] = byte_of(r, number, i);
        }
    }
    return Status::kSuccess;
}

Status GigeRegisterFile::write(std::uint32_t address, std::span<const std::uint8_t> data, bool locked,
                               std::size_t& done) {
    done = 0;
    if (address % 4 != 0 || data.size() % 4 != 0) return Status::kBadAlignment;
    while (done < data.size()) {
        const std::uint64_t here = std::uint64_t{address} + done;
        for (const Memory& m : memories_)
            if (here >= m.address && here - m.address < m.bytes.size()) return Status::kWriteProtect;
        const Register* found = here <= 0xFFFFFFFF ? find(static_cast<std::uint32_t>(here)) : nullptr;
        if (!found) return Status::kInvalidAddress;
        const auto offset = static_cast<std::uint32_t>(here - found->address);
        const std::size_t bytes = std::min<std::size_t>(found->bytes - offset, data.size() - done);
        const Status status =
            write_one(registers_.at(found->address), offset, data.subspan(done, bytes), locked);
        if (status != Status::kSuccess) return status;
        done += bytes;
    }
    return Status::kSuccess;
}

Status GigeRegisterFile::write_one(Register& r, std::uint32_t offset, std::span<const std::uint8_t> data,
                                   bool locked) {
    if (r.text_writable) {
        std::string text = r.text;
        text.resize(r.bytes);
        std::copy(data.begin(), data.end(), text.begin() + offset);
        set_text(r.address, text.substr(0, text.find('\0')));
        return Status::kSuccess;
    }
    if (!r.write) return Status::kWriteProtect;
    if (r.when == When::kUnlocked && locked) return Status::kWriteProtect;
    // Part of a number has no meaning.
    if (data.size() != r.bytes) return Status::kInvalidParameter;
    ByteReader in(data);
    return r.write(r.bytes == 8 ? in.u64() : in.u32());
}

}  // namespace hilcam
