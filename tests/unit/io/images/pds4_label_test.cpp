#include "io/images/pds4_label.h"

#include <gtest/gtest.h>

#include <regex>

#include "io/images/fits_file.h"

namespace hilcam {
namespace {

// The text of the first element of that name, with or without attributes.
std::string element(const std::string& label, const std::string& name) {
    std::smatch found;
    return std::regex_search(label, found, std::regex("<" + name + "[^>]*>([^<]*)</" + name + ">"))
               ? found[1].str()
               : "";
}

TEST(Pds4Label, FindsEachNumberWhereTheFileHasIt) {
    DnImage frame(5, 3);
    for (std::size_t i = 0; i < frame.all().size(); ++i)
        frame.all()[i] = static_cast<std::uint16_t>(4001 * i);
    const FitsHeader header{{{"scenario", "SCENARIO", std::string("a < b & c"), ""},
                             {"time_tai_ns", "TAI_NS", (parse_utc("2026-03-20T06:00:00Z")).ns, ""},
                             {"exposure_s", "EXPTIME", 0.5, ""}},
                            "adu",
                            {}};
    const std::string file = encode_fits(frame, header);
    const std::string label = pds4_label(
        header.notes, {"Frame 1.fits", frame.width(), frame.height(), fits_header_bytes(file), file.size()});
    EXPECT_EQ(label.rfind("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Product_Observational ", 0), 0u);
    EXPECT_EQ(element(label, "file_name"), "Frame 1.fits");
    EXPECT_EQ(element(label, "logical_identifier"), "urn:hilcam:simulated:frames:frame_1");
    EXPECT_EQ(element(label, "title"), "Simulated picture, a &lt; b &amp; c, frame ");
    EXPECT_EQ(element(label, "file_size"), std::to_string(file.size()));
    EXPECT_EQ(element(label, "start_date_time"), "2026-03-20T05:59:59.750000Z");
    EXPECT_EQ(element(label, "stop_date_time"), "2026-03-20T06:00:00.250000Z");
    // A reader that knows the label alone.
    const std::string image = label.substr(label.find("<Array_2D_Image>"));
    const auto offset = static_cast<std::size_t>(std::stoul(element(image, "offset")));
    EXPECT_EQ(element(label, "object_length"), std::to_string(offset));
    EXPECT_EQ(element(image, "data_type"), "SignedMSB2");
    EXPECT_EQ(element(image, "axis_index_order"), "Last Index Fastest");
    const std::size_t lines = std::stoul(element(image, "elements"));
    const std::size_t samples =
        std::stoul(element(image.substr(image.find("<axis_name>Sample")), "elements"));
    ASSERT_EQ(lines, 3u);
    ASSERT_EQ(samples, 5u);
    const int value_offset = std::stoi(element(image, "value_offset"));
    for (std::size_t y = 0; y < lines; ++y)
        for (std::size_t x = 0; x < samples; ++x) {
            const std::size_t at = offset + 2 * (y * samples + x);
            const auto word = static_cast<std::int16_t>(static_cast<unsigned char>(file[at]) << 8 |
                                                        static_cast<unsigned char>(file[at + 1]));
            EXPECT_EQ(word + value_offset, frame.all()[y * samples + x]);
        }
}

}  // namespace
}  // namespace hilcam
