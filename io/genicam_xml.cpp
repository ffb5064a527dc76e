#include "io/genicam_xml.h"

#include <cmath>
#include <cstdio>
#include <map>

namespace hilcam {
namespace {

std::string hex(std::uint32_t value) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%X", value);
    return text;
}
std::string number(double value) {
    char text[40];
    if (value == std::floor(value) && std::abs(value) < 1e15)
        std::snprintf(text, sizeof text, "%.0f", value);
    else
        std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}
std::string tag(const char* name, const std::string& value) {
    return std::string("<") + name + ">" + value + "</" + name + ">\n";
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

const char* access_of(const Feature& f) {
    if (f.access == Feature::Access::kRead) return "RO";
    return f.access == Feature::Access::kWrite ? "WO" : "RW";
}

std::string register_node(const Feature& f) {
    const std::string name = std::string(f.name) + "Reg";
    const std::string place = tag("Address", hex(f.address)) + tag("Length", std::to_string(f.bytes)) +
                              tag("AccessMode", access_of(f)) + tag("pPort", "Device");
    if (f.kind == Feature::Kind::kFloat)
        return "<FloatReg Name=\"" + name + "\">\n" + place + tag("Endianess", "BigEndian") + "</FloatReg>\n";
    const std::string integer = tag("Sign", "Unsigned") + tag("Endianess", "BigEndian");
    if (f.lsb < 0) return "<IntReg Name=\"" + name + "\">\n" + place + integer + "</IntReg>\n";
    // Several features share such a register and one of them triggers: no caching.
    return "<MaskedIntReg Name=\"" + name + "\">\n" + place + tag("Cachable", "NoCache") +
           tag("LSB", std::to_string(f.lsb)) + tag("MSB", std::to_string(f.msb)) + integer +
           "</MaskedIntReg>\n";
}

std::string feature_node(const Feature& f) {
    const std::string name = f.name;
    const std::string value = tag("pValue", name + "Reg");
    const std::string lock = f.locked_while_streaming ? tag("pIsLocked", "TLParamsLocked") : "";
    const std::string unit = f.unit.empty() ? "" : tag("Unit", f.unit);
    switch (f.kind) {
        case Feature::Kind::kString:
            return "<StringReg Name=\"" + name + "\">\n" + tag("Address", hex(f.address)) +
                   tag("Length", std::to_string(f.bytes)) + tag("AccessMode", access_of(f)) +
                   tag("pPort", "Device") + "</StringReg>\n";
        case Feature::Kind::kInteger:
            return "<Integer Name=\"" + name + "\">\n" + lock + value + tag("Min", number(f.least)) +
                   tag("Max", number(f.most)) + tag("Inc", number(f.step)) + unit + "</Integer>\n" +
                   register_node(f);
        case Feature::Kind::kFloat:
            return "<Float Name=\"" + name + "\">\n" + lock + value + tag("Min", number(f.least)) +
                   tag("Max", number(f.most)) + unit + "</Float>\n" + register_node(f);
        case Feature::Kind::kBoolean:
            return "<Boolean Name=\"" + name + "\">\n" + lock + value + tag("OnValue", "1") +
                   tag("OffValue", "0") + "</Boolean>\n" + register_node(f);
        case Feature::Kind::kCommand:
            return "<Command Name=\"" + name + "\">\n" + value + tag("CommandValue", "1") + "</Command>\n" +
                   register_node(f);
        case Feature::Kind::kEnumeration: {
            std::string out = "<Enumeration Name=\"" + name + "\">\n" + lock;
            for (const EnumEntry& entry : f.entries)
                out += "<EnumEntry Name=\"" + entry.name + "\">\n" +
                       tag("Value", std::to_string(entry.value)) + "</EnumEntry>\n";
            return out + value + "</Enumeration>\n" + register_node(f);
        }
    }
    return "";
}

}  // namespace

std::string genicam_xml(const std::vector<Feature>& features, const std::string& model) {
    std::string out =
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
        "<RegisterDescription ModelName=\"" +
        escaped(model) +
        "\" VendorName=\"hilcam\" ToolTip=\"hardware-in-the-loop camera\" StandardNameSpace=\"GEV\" "
        "SchemaMajorVersion=\"1\" SchemaMinorVersion=\"1\" SchemaSubMinorVersion=\"0\" "
        "MajorVersion=\"1\" MinorVersion=\"0\" SubMinorVersion=\"0\" "
        "ProductGuid=\"6E2B6D0C-6D5C-4A59-8E0A-9C1B7C6E1D01\" "
        "VersionGuid=\"6E2B6D0C-6D5C-4A59-8E0A-9C1B7C6E1D02\" "
        "xmlns=\"http://www.genicam.org/GenApi/Version_1_1\" "
        "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xsi:schemaLocation=\"http://www.genicam.org/GenApi/Version_1_1 "
        "http://www.genicam.org/GenApi/GenApiSchema_Version_1_1.xsd\">\n";
    std::map<std::string, std::string> categories;
    for (const Feature& f : features) categories[f.category] += tag("pFeature", f.name);
    out += "<Category Name=\"Root\" NameSpace=\"Standard\">\n";
    for (const auto& [category, content] : categories) out += tag("pFeature", category);
    out += "</Category>\n";
    for (const auto& [category, content] : categories)
        out += "<Category Name=\"" + category + "\" NameSpace=\"Standard\">\n" + content + "</Category>\n";
    for (const Feature& f : features) out += feature_node(f);
    return out + "<Port Name=\"Device\" NameSpace=\"Standard\">\n</Port>\n</RegisterDescription>\n";
}

}  // namespace hilcam
