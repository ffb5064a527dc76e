#include "io/gige/device/genicam_xml.h"

#include <cctype>
#include <cmath>
#include <cstdio>

namespace hilcam {
namespace {

using Kind = Feature::Kind;

std::string hex(std::uint32_t value) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%X", value);
    return text;
}
std::string number(double value) {
    char text[40];
    if (value == std::floor(value) && std::abs(value) < 1e19)
        std::snprintf(text, sizeof text, "%.0f", value);
    else
        std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}
std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}
std::string tag(const char* name, const std::string& value) {
    return std::string("  <") + name + ">" + escaped(value) + "</" + name + ">\n";
}
std::string optional_tag(const char* name, const std::string& value) {
    return value.empty() ? "" : tag(name, value);
}
std::string node(const char* type, const std::string& name, const std::string& content) {
    return std::string("<") + type + " Name=\"" + name + "\">\n" + content + "</" + type + ">\n";
}
// Returns an identifier, as the schema requires for names.
std::string identifier(const std::string& text) {
    std::string out;
    for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    if (out.empty() || !std::isalpha(static_cast<unsigned char>(out[0]))) out = "M" + out;
    return out;
}

const char* access_of(const Feature& f) {
    if (f.access == Feature::Access::kRead) return "RO";
    return f.access == Feature::Access::kWrite ? "WO" : "RW";
}

// Elements in these functions are in the schema's order.
std::string head_of(const Feature& f) {
    return optional_tag("ToolTip", f.meaning) + optional_tag("Visibility", f.visibility) +
           optional_tag("pIsLocked", f.lock) + (f.is_constant ? tag("ImposedAccessMode", "RO") : "");
}
std::string place_of(const Feature& f) {
    return tag("Address", hex(f.address)) + optional_tag("pAddress", f.address_feature) +
           tag("Length", std::to_string(f.bytes)) + tag("AccessMode", access_of(f)) + tag("pPort", f.port) +
           // Commands, other clients and the camera itself change values, so what was read is outdated at
           // once.
           (f.port == "Device" ? tag("Cachable", "NoCache") : "");
}
std::string bound_tag(const char* name, const Bound& bound) {
    return bound.feature.empty() ? tag(name, number(bound.number))
                                 : tag((std::string("p") + name).c_str(), bound.feature);
}
std::string selected_tags(const Feature& f) {
    std::string out;
    for (const std::string& name : f.selected) out += tag("pSelected", name);
    return out;
}

std::string register_node(const Feature& f) {
    if (f.is_constant || f.kind == Kind::kString) return "";
    const std::string name = f.name + "Reg";
    if (f.kind == Kind::kFloat) return node("FloatReg", name, place_of(f) + tag("Endianess", "BigEndian"));
    const std::string integer =
        tag("Sign", f.is_signed ? "Signed" : "Unsigned") + tag("Endianess", "BigEndian");
    if (f.high_bit < 0) return node("IntReg", name, place_of(f) + integer);
    // In a big-endian register bit 0 is the most significant.
    const int last = static_cast<int>(8 * f.bytes) - 1;
    const std::string bits = f.high_bit == f.low_bit ? tag("Bit", std::to_string(last - f.low_bit))
                                                     : tag("LSB", std::to_string(last - f.low_bit)) +
                                                           tag("MSB", std::to_string(last - f.high_bit));
    return node("MaskedIntReg", name, place_of(f) + bits + integer);
}

std::string entries_of(const Feature& f) {
    std::string out;
    for (const EnumEntry& entry : f.entries)
        out += "<EnumEntry Name=\"" + entry.name + "\">\n" + tag("Value", std::to_string(entry.value)) +
               "</EnumEntry>\n";
    return out;
}

std::string feature_node(const Feature& f) {
    const std::string head = head_of(f);
    const std::string value =
        f.is_constant ? tag("Value", std::to_string(f.value)) : tag("pValue", f.name + "Reg");
    const std::string limits =
        f.limited ? bound_tag("Min", f.least) + bound_tag("Max", f.most) : std::string();
    const std::string unit = optional_tag("Unit", f.unit_name);
    const std::string look = optional_tag("Representation", f.representation);
    switch (f.kind) {
        case Kind::kString:
            return node("StringReg", f.name, head + place_of(f));
        case Kind::kInteger:
            return node("Integer", f.name,
                        head + value + limits + (f.limited ? tag("Inc", number(f.step)) : "") + unit + look +
                            selected_tags(f));
        case Kind::kFloat:
            return node("Float", f.name, head + value + limits + unit + look);
        case Kind::kBoolean:
            return node("Boolean", f.name, head + value + tag("OnValue", "1") + tag("OffValue", "0"));
        case Kind::kCommand:
            return node("Command", f.name, head + value + tag("CommandValue", "1"));
        case Kind::kEnumeration:
            return node("Enumeration", f.name, head + entries_of(f) + value + selected_tags(f));
    }
    return "";
}

std::string category_node(const std::string& name, const std::string& content) {
    return "<Category Name=\"" + name + "\" NameSpace=\"Standard\">\n" + content + "</Category>\n";
}

std::string categories(const FeatureTable& table) {
    std::vector<std::pair<std::string, std::string>> found;  // in the table's order
    for (const Feature& f : table.features) {
        if (f.category.empty()) continue;
        auto at = found.begin();
        while (at != found.end() && at->first != f.category) ++at;
        if (at == found.end()) at = found.insert(at, {f.category, ""});
        at->second += tag("pFeature", f.name);
    }
    std::string root, out;
    for (const auto& [name, content] : found) {
        root += tag("pFeature", name);
        out += category_node(name, content);
    }
    return category_node("Root", root) + out;
}

std::string formula_node(const FeatureFormula& f) {
    return node("IntSwissKnife", f.name,
                "  <pVariable Name=\"" + f.variable + "\">" + f.feature + "</pVariable>\n" +
                    tag("Formula", f.formula));
}

std::string port_node(const FeaturePort& port) {
    // An even number of digits, without 0x.
    char id[16];
    if (port.chunk != 0)
        std::snprintf(id, sizeof id, "%08X", port.chunk);
    else
        std::snprintf(id, sizeof id, "%04X", port.event);
    return node("Port", port.name, tag(port.chunk != 0 ? "ChunkID" : "EventID", id));
}

}  // namespace

std::string genicam_xml(const FeatureTable& table, const std::string& model) {
    std::string out =
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
        "<RegisterDescription ModelName=\"" +
        identifier(model) +
        "\" VendorName=\"hilcam\" ToolTip=\"hardware-in-the-loop camera\" StandardNameSpace=\"GEV\" "
        "SchemaMajorVersion=\"1\" SchemaMinorVersion=\"1\" SchemaSubMinorVersion=\"0\" "
        "MajorVersion=\"2\" MinorVersion=\"0\" SubMinorVersion=\"0\" "
        "ProductGuid=\"6E2B6D0C-6D5C-4A59-8E0A-9C1B7C6E1D01\" "
        "VersionGuid=\"6E2B6D0C-6D5C-4A59-8E0A-9C1B7C6E1D03\" "
        "xmlns=\"http://www.genicam.org/GenApi/Version_1_1\" "
        "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xsi:schemaLocation=\"http://www.genicam.org/GenApi/Version_1_1 "
        "http://www.genicam.org/GenApi/GenApiSchema_Version_1_1.xsd\">\n";
    out += categories(table);
    for (const Feature& f : table.features) out += feature_node(f) + register_node(f);
    for (const FeatureFormula& f : table.formulas) out += formula_node(f);
    out += "<Port Name=\"Device\" NameSpace=\"Standard\">\n</Port>\n";
    for (const FeaturePort& port : table.ports) out += port_node(port);
    return out + "</RegisterDescription>\n";
}

}  // namespace hilcam
