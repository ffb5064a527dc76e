#include "io/gige/face/face_table.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/gige/face/face_json.h"
#include "io/system/crc32.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::uint32_t kFaceVersion = 1, kMaxChunkBytes = 1024;
constexpr std::size_t kMaxPoints = 2048, kMaxName = 64;

RegisterField field_of(const FaceJson& j) {
    RegisterField f;
    f.address = j.at("address").address();
    f.bytes = static_cast<std::uint32_t>(j.at("bytes").whole(1, 8));
    f.little_endian = j.at("endian").one_of({"big", "little"}) == 1;
    f.low = static_cast<int>(j.at("low").whole(0, 63));
    f.high = static_cast<int>(j.at("high").whole(0, 63));
    f.kind = static_cast<RegisterField::Kind>(j.at("kind").one_of({"unsigned", "signed", "float"}));
    if (f.high < f.low || f.high >= static_cast<int>(8 * f.bytes))
        throw j.refuse("bits " + std::to_string(f.low) + " to " + std::to_string(f.high),
                       "bits of a register of " + std::to_string(f.bytes) + " bytes");
    const bool whole = f.low == 0 && f.bits() == static_cast<int>(8 * f.bytes);
    if (f.kind == RegisterField::Kind::kFloat && !(whole && (f.bytes == 4 || f.bytes == 8)))
        throw j.refuse("a float of " + std::to_string(f.bits()) + " bits", "32 or 64 bits");
    if (f.bytes - 1 > 0xFFFFFFFFu - f.address)
        throw j.refuse("a register past the last address", "0x00000000 to 0xffffffff");
    return f;
}

RegisterFormula formula_of(const FaceJson& j) {
    RegisterFormula f;
    f.kind = static_cast<RegisterFormula::Kind>(
        j.at("kind").one_of({"linear", "reciprocal", "logarithm", "points"}));
    if (f.kind != RegisterFormula::Kind::kPoints) {
        f.scale = j.at("scale").number();
        f.offset = j.at("offset").number();
        if (f.scale == 0) throw j.at("scale").refuse("0", "a number other than 0");
        return f;
    }
    const FaceJson points = j.at("points");
    for (std::size_t i = 0; i < points.size(2, kMaxPoints); ++i)
        f.points.emplace_back(points.at(i).at(std::size_t{0}).number(), points.at(i).at(1).number());
    const bool rises = f.points[1].second > f.points[0].second;
    for (std::size_t i = 1; i < f.points.size(); ++i)
        if (f.points[i].first <= f.points[i - 1].first ||
            (rises ? f.points[i].second <= f.points[i - 1].second
                   : f.points[i].second >= f.points[i - 1].second))
            throw points.at(i).refuse("a point that goes back",
                                      "numbers that rise, with values that rise or fall all along");
    return f;
}

std::vector<FaceValue> values_of(const FaceJson& j) {
    std::vector<FaceValue> values;
    for (std::size_t i = 0; i < j.size(1, 4096); ++i) {
        FaceValue& value = values.emplace_back();
        value.raw = j.at(i).at(std::size_t{0}).bits();
        const FaceJson target = j.at(i).at(1);
        if (target.is_text())
            value.entry = target.text(kMaxName);
        else
            value.number = target.number();
    }
    return values;
}

FaceRow row_of(const FaceJson& j) {
    FaceRow row;
    row.feature = j.at("feature").text(kMaxName);
    row.field = field_of(j.at("at"));
    if (j.has("of"))
        row.of = j.at("of").one_of({"min", "max"}) == 0 ? FaceRow::Of::kLeast : FaceRow::Of::kMost;
    if (j.has("command")) {
        row.of = FaceRow::Of::kCommand;
        row.command = j.at("command").bits();
    } else if (j.has("values")) {
        row.values = values_of(j.at("values"));
    } else {
        row.formula = formula_of(j.at("formula"));
    }
    if (j.has("when"))
        for (std::size_t i = 0; i < j.at("when").size(0, 8); ++i)
            row.when.push_back({field_of(j.at("when").at(i).at("at")), j.at("when").at(i).at("is").bits()});
    if (j.has("select")) {
        const auto [selector, entry] = j.at("select").pair(kMaxName);
        row.selector = selector, row.selected = entry;
    }
    return row;
}

void read_chunks(const FaceJson& j, FaceTable& table) {
    table.image_chunk_id = j.at("image").address();
    const FaceJson parts = j.at("parts");
    for (std::size_t i = 0; i < parts.size(0, 256); ++i) {
        const FaceJson part = parts.at(i);
        FaceChunk& chunk = table.chunks.emplace_back();
        chunk.id = part.at("id").address();
        chunk.bytes = static_cast<std::uint32_t>(part.at("bytes").whole(4, kMaxChunkBytes)) & ~3u;
        for (std::size_t k = 0; k < part.at("fields").size(1, 64); ++k) {
            const FaceJson f = part.at("fields").at(k);
            FaceChunkField& field = chunk.fields.emplace_back();
            field.chunk = f.at("chunk").text(kMaxName);
            field.field = field_of(f.at("at"));
            if (f.has("values"))
                field.values = values_of(f.at("values"));
            else
                field.formula = formula_of(f.at("formula"));
            if (std::uint64_t{field.field.address} + field.field.bytes > chunk.bytes)
                throw f.refuse("a field past the chunk's end",
                               "at most " + std::to_string(chunk.bytes) + " bytes");
        }
    }
}

bool same_guards(const FaceRow& a, const FaceRow& b) {
    if (a.when.size() != b.when.size()) return false;
    for (std::size_t i = 0; i < a.when.size(); ++i)
        if (a.when[i].field.address != b.when[i].field.address || a.when[i].is != b.when[i].is) return false;
    return true;
}

bool share_bits(const RegisterField& a, const RegisterField& b) {
    if (a.address == b.address && a.bytes == b.bytes && a.little_endian == b.little_endian)
        return a.low <= b.high && b.low <= a.high;
    return std::uint64_t{a.address} + a.first_byte() < std::uint64_t{b.address} + b.end_byte() &&
           std::uint64_t{b.address} + b.first_byte() < std::uint64_t{a.address} + a.end_byte();
}

// Commands may share bits: a start and a stop.
void check_overlaps(const FaceTable& table, const std::string& name) {
    const auto is_command = [](const FaceRow& row) { return row.of == FaceRow::Of::kCommand; };
    for (std::size_t i = 0; i < table.rows.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const FaceRow &a = table.rows[k], &b = table.rows[i];
            if (is_command(a) || is_command(b) || !share_bits(a.field, b.field) || !same_guards(a, b))
                continue;
            char at[16];
            std::snprintf(at, sizeof at, "0x%08x", b.field.address);
            throw InputError(name + ": rows[" + std::to_string(i) + "]: " + b.feature + " at " + at +
                             " overlaps with " + a.feature + ", rows[" + std::to_string(k) + "]");
        }
}

}  // namespace

FaceTable face_table_of(const std::string& text, const std::string& name) {
    const nlohmann::json document = parsed_face_json(text, name);
    const FaceJson j(document, name);
    if (!j.has("hilcam_face"))
        throw InputError(name +
                         ": has no hilcam_face; accepted: the table that hilcam-camera-face bind writes");
    j.at("hilcam_face").whole(kFaceVersion, kFaceVersion);
    FaceTable table;
    table.description_crc32 = j.at("description").at("crc32").address();
    table.description_bytes = static_cast<std::uint32_t>(j.at("description").at("bytes").whole(1, 1u << 30));
    const FaceJson identity = j.at("identity");
    table.vendor = identity.at("vendor").text(kMaxName);
    table.model = identity.at("model").text(kMaxName);
    if (identity.has("version")) table.version = identity.at("version").text(kMaxName);
    table.width_px = static_cast<int>(j.at("camera").at("width_px").whole(1, 65536));
    table.height_px = static_cast<int>(j.at("camera").at("height_px").whole(1, 65536));
    const FaceJson rows = j.at("rows");
    for (std::size_t i = 0; i < rows.size(0, 4096); ++i) table.rows.push_back(row_of(rows.at(i)));
    const FaceJson commands = j.at("self_clearing");
    for (std::size_t i = 0; i < commands.size(0, 4096); ++i)
        table.self_clearing.push_back(
            {field_of(commands.at(i).at("at")), commands.at(i).at("command").bits()});
    if (j.has("chunks")) read_chunks(j.at("chunks"), table);
    const FaceJson registers = j.at("registers");
    for (std::size_t i = 0; i < registers.size(0, 65536); ++i)
        table.registers.push_back({registers.at(i).at(std::size_t{0}).address(),
                                   static_cast<std::uint32_t>(registers.at(i).at(1).whole(1, 1 << 20)),
                                   registers.at(i).at(2).one_of({"RO", "RW"}) == 0});
    const FaceJson memory = j.at("memory");
    for (std::size_t i = 0; i < memory.size(0, 65536); ++i) {
        RegisterRun& run = table.memory.emplace_back();
        run.address = memory.at(i).at(std::size_t{0}).address();
        run.bytes = bytes_of_hex(memory.at(i).at(1).text(kMaxFaceBytes));
        if (run.bytes.empty() || run.bytes.size() - 1 > 0xFFFFFFFFu - run.address)
            throw memory.at(i).refuse("other bytes", "an address and bytes in hexadecimal");
    }
    check_overlaps(table, name);
    return table;
}

void check_description(const FaceTable& table, const std::string& xml, const std::string& table_name,
                       const std::string& xml_name) {
    const std::uint32_t sum = crc32_of({reinterpret_cast<const std::uint8_t*>(xml.data()), xml.size()});
    if (sum == table.description_crc32 && xml.size() == table.description_bytes) return;
    char text[160];
    std::snprintf(text, sizeof text, ": was made of another description (CRC-32 %08x, %u bytes) than ",
                  table.description_crc32, table.description_bytes);
    std::string message = table_name + text + xml_name;
    std::snprintf(text, sizeof text, " (%08x, %zu bytes); run hilcam-camera-face bind again", sum,
                  xml.size());
    throw InputError(message + text);
}

}  // namespace hilcam
