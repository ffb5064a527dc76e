#include "io/gige/device/camera_face.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/system/bytes.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

using gvcp::Status;

namespace {

constexpr std::uint32_t kCommandValue = 1;

// Features that not every camera of hilcam's has.
bool may_be_absent(const std::string& name) {
    return name.starts_with("Reverse") || name.starts_with("Ptp") || name.starts_with("Binning");
}

std::uint64_t mask_of(const Feature& f) {
    const int bits = f.high_bit - f.low_bit + 1;
    return (std::uint64_t{1} << bits) - 1;
}

}  // namespace

CameraFace::CameraFace(const CameraFaceFiles& files, GigeRegisterFile& own, const FeatureTable& features,
                       std::uint32_t xml_place, std::size_t xml_bytes)
    : files_(files), own_(own), features_(features), xml_place_(xml_place), xml_bytes_(xml_bytes) {
    const FaceTable& table = files.table;
    check_camera(table, features.limits.width, features.limits.height);
    reset();
    for (const FaceRange& range : table.registers)
        if (range.read_only) {
            std::uint32_t& end = read_only_[range.address];
            end = std::max(end, range.address + range.bytes);
        }
    for (const FaceRow& row : table.rows) add_row(row);
    for (std::size_t i = 0; i < table.self_clearing.size(); ++i) {
        const RegisterField& f = table.self_clearing[i].field;
        for (std::uint32_t word = f.address / 4; word <= (f.address + (f.bytes - 1)) / 4; ++word)
            clearing_.emplace(word, i);
    }
    settle_choices();
}

// Recorded registers are the real camera's; the table has what was missing.
void CameraFace::reset() {
    memory_ = {};
    for (const RegisterRun& run : files_.table.memory) memory_.write(run.address, run.bytes);
    for (const RegisterRun& run : files_.recorded) memory_.write(run.address, run.bytes);
    settle_choices();
}

// True if the register shows what its feature is: always, but for a choice without an entry for it.
bool CameraFace::shows(const Row& row) const {
    if (row.values.empty()) return true;
    const double now = number_of_feature(*row.feature);
    return std::any_of(row.values.begin(), row.values.end(), [&](const auto& v) { return v.second == now; });
}

// A feature may hold what no register of the description has a number for, such as a pixel format. It then
// gets what its register says, so that no client reads one thing and receives another.
void CameraFace::settle_choices() {
    const auto is_value = [&](const Row& row) { return row.face->of == FaceRow::Of::kValue && holds(row); };
    for (const Row& row : rows_) {
        if (!is_value(row) || row.feature->access == Feature::Access::kRead) continue;
        select(row);
        const bool shown = std::any_of(rows_.begin(), rows_.end(), [&](const Row& other) {
            return other.feature == row.feature && is_value(other) && shows(other);
        });
        // What can't be set, because of another feature, stays.
        if (!shown) static_cast<void>(set_row(row, stored_bits(row.face->field), false));
    }
}

const Feature* CameraFace::feature_of(const std::string& name, bool must_be) const {
    for (const Feature& f : features_.features)
        if (f.name == name) return &f;
    if (must_be)
        throw InputError("face_file: rows: found the feature " + in_quotes(name) +
                         "; accepted: one of docs/genicam.md");
    return nullptr;
}

void CameraFace::add_row(const FaceRow& face) {
    Row row{.face = &face, .feature = feature_of(face.feature, !may_be_absent(face.feature))};
    if (!row.feature || row.feature->is_constant) return;
    if (!face.selector.empty()) {
        row.selector = feature_of(face.selector, true);
        const auto& entries = row.selector->entries;
        const auto entry = std::find_if(entries.begin(), entries.end(),
                                        [&](const EnumEntry& e) { return e.name == face.selected; });
        if (entry == entries.end()) return;  // this camera has no such
        row.selected = entry->value;
    }
    for (const FaceValue& value : face.values) {
        if (value.entry.empty()) {
            row.values.emplace_back(value.raw, value.number);
            continue;
        }
        for (const EnumEntry& entry : row.feature->entries)
            if (entry.name == value.entry)
                row.values.emplace_back(value.raw, static_cast<double>(entry.value));
    }
    const RegisterField& f = face.field;
    // The standard's register of the same feature is hilcam's already.
    if (f.address < kFirstOfDevice && row.feature->address == f.address) return;
    for (std::uint32_t word = f.address / 4; word <= (f.address + (f.bytes - 1)) / 4; ++word)
        words_.emplace(word, rows_.size());
    rows_.push_back(std::move(row));
}

// --- places

bool CameraFace::is_standard(std::uint32_t address) const {
    return address < kFirstOfDevice && own_.find(address);
}

bool CameraFace::is_read_only(std::uint32_t address) const {
    const auto after = read_only_.upper_bound(address);
    return after != read_only_.begin() && address < std::prev(after)->second;
}

std::vector<std::size_t> CameraFace::rows_in(const Words& words, std::uint32_t address,
                                             std::size_t bytes) const {
    std::vector<std::size_t> found;
    const auto end = words.upper_bound(static_cast<std::uint32_t>((address + std::uint64_t{bytes} - 1) / 4));
    for (auto at = words.lower_bound(address / 4); at != end; ++at) found.push_back(at->second);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::uint64_t CameraFace::stored_bits(const RegisterField& field) const {
    std::array<std::uint8_t, 8> bytes{};
    memory_.read(field.address, std::span(bytes).first(field.bytes));
    return bits_in(field, bytes);
}

bool CameraFace::holds(const Row& row) const {
    return std::all_of(row.face->when.begin(), row.face->when.end(),
                       [this](const FaceGuard& guard) { return stored_bits(guard.field) == guard.is; });
}

// --- hilcam's features

double CameraFace::number_of_feature(const Feature& f) const {
    std::array<std::uint8_t, 8> bytes{};
    const auto out = std::span(bytes).first(f.bytes);
    if (f.is_constant) return static_cast<double>(f.value);
    own_.read(f.address, out);
    ByteReader in(out);
    const std::uint64_t bits = f.bytes == 8 ? in.u64() : in.u32();
    if (f.kind == Feature::Kind::kFloat) return std::bit_cast<double>(bits);
    if (f.high_bit >= 0) return static_cast<double>(bits >> f.low_bit & mask_of(f));
    return f.is_signed ? static_cast<double>(static_cast<std::int64_t>(bits)) : static_cast<double>(bits);
}

double CameraFace::limit_of(const Feature& f, FaceRow::Of of) const {
    const Bound& bound = of == FaceRow::Of::kLeast ? f.least : f.most;
    if (bound.feature.empty()) return bound.number;
    const Feature* const other = feature_of(bound.feature, false);
    return other ? number_of_feature(*other) : bound.number;
}

void CameraFace::select(const Row& row) {
    if (row.selector) write_own(row.selector->address, row.selected, row.selector->bytes, false);
}

Status CameraFace::write_own(std::uint32_t address, std::uint64_t number, std::uint32_t bytes, bool locked) {
    std::array<std::uint8_t, 8> data{};
    ByteWriter out(data);
    bytes == 8 ? out.u64(number) : out.u32(number);
    std::size_t done = 0;
    return own_.write(address, std::span(data).first(bytes), locked, done);
}

Status CameraFace::set_feature(const Row& row, double number, bool locked) {
    const Feature& f = *row.feature;
    select(row);
    if (f.kind == Feature::Kind::kFloat)
        return write_own(f.address, std::bit_cast<std::uint64_t>(number), f.bytes, locked);
    const double most = f.bytes == 8 ? 9e18 : 4294967295.0;
    if (!(number > -0.5) || number > most) return Status::kInvalidParameter;
    auto whole = static_cast<std::uint64_t>(std::llround(number));
    if (f.high_bit >= 0) {  // the register has other features, too
        std::array<std::uint8_t, 8> bytes{};
        own_.read(f.address, std::span(bytes).first(f.bytes));
        const std::span<const std::uint8_t> register_bytes = std::span(bytes).first(f.bytes);
        ByteReader in(register_bytes);
        const std::uint64_t before = f.bytes == 8 ? in.u64() : in.u32(), mask = mask_of(f) << f.low_bit;
        whole = (before & ~mask) | (whole << f.low_bit & mask);
    }
    return write_own(f.address, whole, f.bytes, locked);
}

// --- rows

// Returns the bits that a row's register shows.
std::uint64_t CameraFace::live_bits(const Row& row) {
    const FaceRow& face = *row.face;
    if (face.of == FaceRow::Of::kLeast || face.of == FaceRow::Of::kMost)
        return bits_of(face.field, face.formula.raw(limit_of(*row.feature, face.of)));
    select(row);
    const double number = number_of_feature(*row.feature);
    if (face.values.empty()) return bits_of(face.field, face.formula.raw(number));
    // Several numbers may mean the same: the one that was written stays.
    const std::uint64_t stored = stored_bits(face.field);
    std::optional<std::uint64_t> first;
    for (const auto& [raw, value] : row.values) {
        if (value != number) continue;
        if (raw == stored) return stored;
        if (!first) first = raw;
    }
    return first.value_or(stored);
}

// Returns the feature's number for its register's. A limit's number in the register is that limit, although the
// register's steps and the formula's rounding give a little more or less.
double CameraFace::number_in(const Row& row, std::uint64_t bits) const {
    const FaceRow& face = *row.face;
    for (const FaceRow::Of of : {FaceRow::Of::kLeast, FaceRow::Of::kMost})
        if (const double limit = limit_of(*row.feature, of);
            row.feature->kind == Feature::Kind::kFloat &&
            bits_of(face.field, face.formula.raw(limit)) == bits)
            return limit;
    const double number = face.formula.value(number_of(face.field, bits));
    // Aravis writes 0 to the offsets before it sets a window, also to cameras that count pixels from 1.
    return face.feature == "OffsetX" || face.feature == "OffsetY" ? std::max(number, 0.0) : number;
}

Status CameraFace::set_row(const Row& row, std::uint64_t bits, bool locked) {
    const FaceRow& face = *row.face;
    if (face.of == FaceRow::Of::kCommand) return set_feature(row, kCommandValue, locked);
    if (face.of != FaceRow::Of::kValue || row.feature->access == Feature::Access::kRead)
        return Status::kWriteProtect;
    if (face.values.empty()) return set_feature(row, number_in(row, bits), locked);
    for (const auto& [raw, value] : row.values)
        if (raw == bits) return set_feature(row, value, locked);
    return Status::kInvalidParameter;
}

// --- access

// Fills in what registers show: memory, over it the standard's registers, over these the rows.
void CameraFace::compose(std::uint32_t address, std::span<std::uint8_t> out) {
    memory_.read(address, out);
    for (std::size_t at = 0; at < out.size(); at += 4) {
        const std::uint64_t here = std::uint64_t{address} + at;
        if (here >= kFirstOfDevice) break;
        if (is_standard(static_cast<std::uint32_t>(here)))
            own_.read(static_cast<std::uint32_t>(here), out.subspan(at, 4));
    }
    for (const std::size_t i : rows_in(words_, address, out.size())) {
        const Row& row = rows_[i];
        const RegisterField& f = row.face->field;
        if (row.face->of == FaceRow::Of::kCommand || !holds(row)) continue;
        std::array<std::uint8_t, 8> bytes{};
        const auto whole = std::span(bytes).first(f.bytes);
        // The other bits of the register are those that are there already.
        const auto each = [&](const auto& copy) {
            for (std::uint32_t k = f.first_byte(); k < f.end_byte(); ++k) {
                const std::uint64_t place = std::uint64_t{f.address} + k;
                if (place >= address && place - address < out.size()) copy(bytes[k], out[place - address]);
            }
        };
        each([](std::uint8_t& inside, const std::uint8_t& outside) { inside = outside; });
        put_bits(f, live_bits(row), whole);
        each([](const std::uint8_t& inside, std::uint8_t& outside) { outside = inside; });
    }
}

Status CameraFace::read(std::uint32_t address, std::span<std::uint8_t> out) {
    if (address % 4 != 0 || out.size() % 4 != 0) return Status::kBadAlignment;
    if (address >= xml_place_ && address - xml_place_ < xml_bytes_) return own_.read(address, out);
    compose(address, out);
    return Status::kSuccess;
}

Status CameraFace::write(std::uint32_t address, std::span<const std::uint8_t> data, bool locked,
                         std::size_t& done) {
    done = 0;
    if (address % 4 != 0 || data.size() % 4 != 0) return Status::kBadAlignment;
    if (address >= xml_place_ && address - xml_place_ < xml_bytes_) return Status::kWriteProtect;
    if (!data.empty() && data.size() - 1 > 0xFFFFFFFFu - address) return Status::kInvalidAddress;
    // The standard's registers know their own sizes.
    while (done < data.size()) {
        const std::uint32_t here = address + static_cast<std::uint32_t>(done);
        const GigeRegisterFile::Register* const standard = here < kFirstOfDevice ? own_.find(here) : nullptr;
        std::size_t bytes = 0;
        if (standard) {
            bytes = std::min<std::size_t>(standard->bytes - (here - standard->address), data.size() - done);
        } else {
            for (; done + bytes < data.size(); bytes += 4) {
                const std::uint32_t word = here + static_cast<std::uint32_t>(bytes);
                if (is_standard(word)) break;
                if (is_read_only(word)) return Status::kWriteProtect;
            }
        }
        const Status status = write_words(here, data.subspan(done, bytes), locked);
        if (status != Status::kSuccess) return status;
        done += bytes;
    }
    return Status::kSuccess;
}

Status CameraFace::write_words(std::uint32_t address, std::span<const std::uint8_t> data, bool locked) {
    std::vector<std::uint8_t> before(data.size());
    compose(address, before);
    std::vector<std::uint8_t> kept(data.begin(), data.end());  // contents of the memory afterwards
    const auto part = [&](const RegisterField& f, std::span<const std::uint8_t> bytes) {
        std::array<std::uint8_t, 8> whole{};
        for (std::uint32_t k = f.first_byte(); k < f.end_byte(); ++k)
            whole[k] = bytes[f.address + k - address];
        return bits_in(f, whole);
    };
    const auto put_back = [&](const RegisterField& f, std::uint64_t bits) {
        std::array<std::uint8_t, 8> whole{};
        for (std::uint32_t k = f.first_byte(); k < f.end_byte(); ++k)
            whole[k] = kept[f.address + k - address];
        put_bits(f, bits, whole);
        for (std::uint32_t k = f.first_byte(); k < f.end_byte(); ++k)
            kept[f.address + k - address] = whole[k];
    };
    // 1: only part of its bytes is written.
    const auto covered = [&](const RegisterField& f) {
        const std::uint64_t begin = std::uint64_t{f.address} + f.first_byte(),
                            end = std::uint64_t{f.address} + f.end_byte();
        const std::uint64_t last = std::uint64_t{address} + data.size();
        if (end <= address || begin >= last) return 0;
        return begin >= address && end <= last ? 2 : 1;
    };
    const std::vector<std::size_t> rows = rows_in(words_, address, data.size());
    for (const bool commands : {false, true})
        for (const std::size_t i : rows) {
            const Row& row = rows_[i];
            const RegisterField& f = row.face->field;
            const bool is_command = row.face->of == FaceRow::Of::kCommand;
            const int how = covered(f);
            if (is_command != commands || how == 0 || !holds(row)) continue;
            if (how == 1) return Status::kInvalidParameter;  // part of a number has no meaning
            const std::uint64_t wanted = part(f, data);
            if (is_command ? wanted != row.face->command : wanted == part(f, before)) continue;
            if (const Status status = set_row(row, wanted, locked); status != Status::kSuccess) return status;
            if (is_command) {
                put_back(f, stored_bits(f));
                settle_choices();  // the command may have loaded a user set
            }
        }
    for (const std::size_t i : rows_in(clearing_, address, data.size())) {
        const FaceCommand& command = files_.table.self_clearing[i];
        if (covered(command.field) == 2 && part(command.field, data) == command.command)
            put_back(command.field, stored_bits(command.field));
    }
    if (is_standard(address)) {
        if (const Status status = write_standard(address, data, locked); status != Status::kSuccess)
            return status;
    }
    memory_.write(address, kept);
    return Status::kSuccess;
}

// Gives a standard's register what is written, without the bits of rows, which are the vendor's own.
Status CameraFace::write_standard(std::uint32_t address, std::span<const std::uint8_t> data, bool locked) {
    std::vector<std::uint8_t> mine(data.begin(), data.end()), own(data.size());
    bool other = false;
    for (const std::size_t i : rows_in(words_, address, data.size())) {
        const RegisterField& f = rows_[i].face->field;
        if (f.address != address || f.bytes > data.size()) continue;
        own_.read(address, own);
        put_bits(f, bits_in(f, own), mine);
        other = true;
    }
    // A write that was only for the vendor's bits is done.
    if (other) {
        own_.read(address, own);
        if (mine == own) return Status::kSuccess;
    }
    std::size_t done = 0;
    return own_.write(address, mine, locked, done);
}

}  // namespace hilcam
