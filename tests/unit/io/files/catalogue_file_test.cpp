#include "io/files/catalogue_file.h"

#include <gmock/gmock.h>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class CatalogueFile : public FilesTest {
  protected:
    std::string refused(const std::string& text) {
        return error_of([&] { load_catalogue(write("c.csv", text)); });
    }
};

TEST_F(CatalogueFile, ShippedOneHasSiriusFirstAndVegaInItsPlace) {
    const StarCatalogue c = load_catalogue(HILCAM_SOURCE_DIR "/configs/stars/hipparcos.csv");
    EXPECT_GT(c.stars.size(), 40000u);
    EXPECT_EQ(c.stars[0].hip, 32349);
    EXPECT_EQ(c.stars[0].hd, 48915);
    // Hipparcos main catalogue, HIP 91262, J1991.25: 279.23410832 +38.78299311, 201.02 287.46 mas/yr, 128.93
    // mas, V 0.03.
    const auto vega =
        std::find_if(c.stars.begin(), c.stars.end(), [](const CatalogueStar& s) { return s.hip == 91262; });
    ASSERT_NE(vega, c.stars.end());
    EXPECT_EQ(vega->hd, 172167);
    const double years = vega->epoch_year - 1991.25;
    EXPECT_NEAR(vega->declination_rad / kDegree_rad, 38.78299311 + years * 0.28746 / 3600, 1e-6);
    EXPECT_NEAR(vega->right_ascension_rad / kDegree_rad,
                279.23410832 + years * 0.20102 / 3600 / std::cos(38.783 * kDegree_rad), 1e-6);
    // Motion: the new reduction's (van Leeuwen, A&A 474, 653, 2007).
    EXPECT_NEAR(vega->pm_dec_rad_yr / kArcsecond_rad, 0.28623, 2e-4);
    EXPECT_NEAR(vega->parallax_rad / kArcsecond_rad, 0.12893, 2e-3);
    EXPECT_NEAR(vega->magnitude_v, 0.03, 0.02);
}

TEST_F(CatalogueFile, ColumnsComeInAnyOrderAndSomeMayLack) {
    const StarCatalogue c = load_catalogue(write("c.csv",
                                                 "# made up\nv_mag,dec_deg,ra_deg,epoch_year,hip\r\n"
                                                 "5.5,-30,120,2016,7\r\n\n6,0,0,2000,0\n"));
    ASSERT_EQ(c.stars.size(), 2u);
    EXPECT_EQ(c.stars[0].hip, 7);
    EXPECT_EQ(c.stars[0].magnitude_v, 5.5);
    EXPECT_EQ(c.stars[0].epoch_year, 2016);
    EXPECT_NEAR(c.stars[0].right_ascension_rad / kDegree_rad, 120, 1e-12);
    EXPECT_EQ(c.stars[0].parallax_rad, 0);
    // A file of before there was a column for it.
    EXPECT_EQ(load_catalogue(write("old.csv",
                                   "hd,ra_deg,dec_deg,pm_ra_mas_yr,pm_dec_mas_yr,v_mag,b_v\n"
                                   "11,30,88.0,0,0,1,0.5\n"))
                  .stars[0]
                  .epoch_year,
              1991.25);
    // V-I of some of the stars.
    const StarCatalogue some =
        load_catalogue(write("v_i.csv", "ra_deg,dec_deg,v_mag,v_i\n1,1,1,\n2,2,2,-0.3\n"));
    EXPECT_FALSE(some.stars[0].color_v_i.has_value());
    EXPECT_EQ(some.stars[1].color_v_i, -0.3);
    // Without v_i the class gives it. V and Ic are 9.51 and 6.74 for Barnard's star (M4V), 11.13 and 7.41 for
    // Proxima (M5.5Ve), 7.34 and 5.32 for Lacaille 9352 (M2V) (Bessell, Astron. Astrophys. Suppl. 83, 357,
    // 1990; Jao et al., Astron. J. 147, 21, 2014). V-I of M0 and M5 giants is 1.65 and 2.80 (Pickles 1998, as
    // in PyGaia). A class is good to half a subclass.
    const StarCatalogue m = load_catalogue(
        write("m.csv",
              "spectral_type,ra_deg,dec_deg,v_mag,b_v,v_i\nM4V,1,1,9.51,1.73,\nM5.5Ve,1,1,11.13,1.82,\n"
              "dM2,1,1,7.34,1.5,\nM0III,1,1,3,1.56,\ngM5,1,1,4,1.6,\nM1-M2Ia-Iab,1,1,0.4,1.85,\n"
              "K5III,1,1,1,1.54,\nM4V,1,1,1,1.7,2.5\n"));
    for (const auto& [row, v_i] :
         {std::pair{0u, 2.77}, {1u, 3.72}, {2u, 2.02}, {3u, 1.65}, {4u, 2.80}, {5u, 2.16}})
        EXPECT_NEAR(m.stars[row].color_v_i.value_or(0), v_i, 0.3) << row;
    EXPECT_FALSE(m.stars[6].color_v_i.has_value());
    EXPECT_EQ(m.stars[7].color_v_i, 2.5);
    EXPECT_TRUE(m.tells_red_stars);
    // A measured parallax may come out below zero: such a star is far away.
    EXPECT_EQ(load_catalogue(write("p.csv", "ra_deg,dec_deg,v_mag,parallax_mas\n1,1,1,-0.5\n"))
                  .stars[0]
                  .parallax_rad,
              0);
}

TEST_F(CatalogueFile, WhatIsNoCatalogueIsNamedByItsLine) {
    const std::string head = "ra_deg,dec_deg,v_mag\n";
    EXPECT_THAT(refused("hd,ra_deg\n1,2,3\n"), HasSubstr("c.csv:1: found 'hd,ra_deg'; accepted: the names"));
    EXPECT_THAT(refused("ra_deg,dec_deg,v_mag,colour\n"), HasSubstr("c.csv:1: found"));
    EXPECT_THAT(refused("ra_deg,ra_deg,dec_deg,v_mag\n"), HasSubstr("c.csv:1: found"));
    EXPECT_THAT(refused("1,2,3\n"), HasSubstr("c.csv:1: found '1,2,3'"));
    EXPECT_THAT(refused("# only\n"), HasSubstr("holds no star"));
    EXPECT_THAT(refused(head), HasSubstr("holds no star"));
    for (const char* row : {"1,2", "1,2,3,4"})
        EXPECT_THAT(refused(head + "1,2,3\n" + row + "\n"),
                    testing::MatchesRegex(".*c.csv:3: found [24] values in '" + std::string(row) +
                                          "'; accepted: 3: ra_deg,dec_deg,v_mag"));
    for (const auto& [row, name, found, accepted] :
         std::vector<std::array<const char*, 4>>{{"400,0,1", "ra_deg", "400", "0 to 360"},
                                                 {"1,91,3", "dec_deg", "91", "-90 to 90"},
                                                 {"1,2,x", "v_mag", "x", "-3 to 30"},
                                                 {"1,2,", "v_mag", "", "-3 to 30"},
                                                 {"1,2,nan", "v_mag", "nan", "-3 to 30"},
                                                 {"1,2,-4", "v_mag", "-4", "-3 to 30"},
                                                 {"1,2,3 ", "v_mag", "3 ", "-3 to 30"}})
        EXPECT_THAT(refused(head + "1,2,3\n" + row + "\n"),
                    HasSubstr("c.csv:3: " + std::string(name) + ": found '" + found + "' in '" + row +
                              "'; accepted: a number, " + accepted))
            << row;
    EXPECT_THAT(refused("ra_deg,dec_deg,v_mag,v_i\n1,2,3,\n1,2,3,16\n"),
                HasSubstr("c.csv:3: v_i: found '16'"));
}

}  // namespace
}  // namespace hilcam
