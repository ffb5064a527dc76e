#include "io/images/pds4_label.h"

#include <cctype>

#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

// Escapes text for XML 1.0, section 2.4; control characters are not allowed in it.
std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : harmless(text)) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else
            out += c;
    }
    return out;
}

// Logical identifiers have lower case, digits, dots, dashes and underscores.
std::string identifier(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        out += std::isalnum(byte) || c == '.' || c == '-' ? static_cast<char>(std::tolower(byte)) : '_';
    }
    return out;
}

class Xml {
  public:
    Xml& open(const std::string& name) {
        line("<" + name + ">");
        open_.push_back(name.substr(0, name.find(' ')));
        return *this;
    }
    Xml& close() {
        const std::string name = open_.back();
        open_.pop_back();
        return line("</" + name + ">");
    }
    // name may have attributes.
    Xml& item(const std::string& name, std::string_view value) {
        return line("<" + name + ">" + escaped(value) + "</" + name.substr(0, name.find(' ')) + ">");
    }
    Xml& item(const std::string& name, std::size_t value) { return item(name, std::to_string(value)); }
    Xml& line(const std::string& text) {
        text_ += std::string(2 * open_.size(), ' ') + text + "\n";
        return *this;
    }
    const std::string& text() const { return text_; }

  private:
    std::string text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    std::vector<std::string> open_;
};

std::string text_note(const PictureNotes& notes, std::string_view key) {
    const PictureNote* const note = find_note(notes, key);
    return note ? text_of(*note) : std::string();
}

void put_times(const PictureNotes& notes, Xml& xml) {
    const PictureNote* const middle = find_note(notes, "time_tai_ns");
    const PictureNote* const exposure = find_note(notes, "exposure_s");
    if (!middle || !exposure) return;
    const TimeTai time{std::get<std::int64_t>(middle->value)};
    const std::int64_t half_ns = to_ns(std::get<double>(exposure->value) / 2);
    xml.open("Time_Coordinates")
        .item("start_date_time", format_utc(time + -half_ns, 6))
        .item("stop_date_time", format_utc(time + half_ns, 6))
        .close();
}

void put_image(const LabelledFile& file, Xml& xml) {
    xml.open("Array_2D_Image")
        .item("local_identifier", "image")
        .item("offset unit=\"byte\"", file.header_bytes)
        .item("axes", 2)
        .item("axis_index_order", "Last Index Fastest");
    // FITS stores unsigned numbers as signed ones with BZERO.
    xml.open("Element_Array")
        .item("data_type", "SignedMSB2")
        .item("unit", "DN")
        .item("scaling_factor", 1)
        .item("value_offset", 32768)
        .close();
    const auto axis = [&](const char* name, int elements, std::size_t number) {
        xml.open("Axis_Array")
            .item("axis_name", name)
            .item("elements", static_cast<std::size_t>(elements))
            .item("sequence_number", number)
            .close();
    };
    axis("Line", file.height, 1);
    axis("Sample", file.width, 2);
    xml.close();
}

void put_display(Xml& xml) {
    xml.open("Discipline_Area").open("disp:Display_Settings");
    xml.open("Local_Internal_Reference")
        .item("local_identifier_reference", "image")
        .item("local_reference_type", "display_settings_to_array")
        .close();
    xml.open("disp:Display_Direction")
        .item("disp:horizontal_display_axis", "Sample")
        .item("disp:horizontal_display_direction", "Left to Right")
        .item("disp:vertical_display_axis", "Line")
        .item("disp:vertical_display_direction", "Top to Bottom")
        .close();
    xml.close().close();
}

}  // namespace

std::string pds4_label(const PictureNotes& notes, const LabelledFile& file) {
    Xml xml;
    const std::string stem = file.name.substr(0, file.name.rfind('.'));
    xml.open(
        "Product_Observational xmlns=\"http://pds.nasa.gov/pds4/pds/v1\" "
        "xmlns:disp=\"http://pds.nasa.gov/pds4/disp/v1\"");
    xml.open("Identification_Area")
        .item("logical_identifier", "urn:hilcam:simulated:frames:" + identifier(stem))
        .item("version_id", "1.0")
        .item("title",
              "Simulated picture, " + text_note(notes, "scenario") + ", frame " + text_note(notes, "frame"))
        .item("information_model_version", "1.16.0.0")
        .item("product_class", "Product_Observational")
        .close();
    xml.open("Observation_Area");
    put_times(notes, xml);
    xml.open("Investigation_Area")
        .item("name", text_note(notes, "software"))
        .item("type", "Other Investigation");
    xml.open("Internal_Reference")
        .item("lid_reference", "urn:hilcam:context:investigation:simulation")
        .item("reference_type", "data_to_investigation")
        .close()
        .close();
    xml.open("Observing_System")
        .open("Observing_System_Component")
        .item("name", text_note(notes, "camera_name"))
        .item("type", "Instrument")
        .close()
        .close();
    xml.open("Target_Identification")
        .item("name", text_note(notes, "scenario"))
        .item("type", "Calibration")
        .close();
    put_display(xml);
    xml.close();
    xml.open("File_Area_Observational");
    xml.open("File").item("file_name", file.name).item("file_size unit=\"byte\"", file.bytes).close();
    xml.open("Header")
        .item("offset unit=\"byte\"", 0)
        .item("object_length unit=\"byte\"", file.header_bytes)
        .item("parsing_standard_id", "FITS 4.0")
        .close();
    put_image(file, xml);
    xml.close().close();
    return xml.text();
}

}  // namespace hilcam
