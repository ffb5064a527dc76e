#include "io/meshes/named_files.h"

#include <gmock/gmock.h>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class NamedFilesTest : public FilesTest {
  protected:
    void SetUp() override {
        FilesTest::SetUp();
        std::filesystem::create_directories(folder_ / "in/Maps");
        mesh_ = write("in/m.obj", "");
        write("in/Maps/Half.PNG", "");
        write("in/beside.png", "");
    }
    std::filesystem::path mesh_;

    // The way from the mesh's folder, "" where nothing is found.
    std::string found(NamedFiles& files, const std::string& name,
                      const std::vector<std::filesystem::path>& folders = {}) {
        const auto file = files.find({name, folders}, "texture 't'");
        return file ? file->lexically_normal().lexically_proximate(folder_ / "in").string() : "";
    }
};

TEST_F(NamedFilesTest, EachWayHasLessOfTheNameThanTheOneBefore) {
    NamedFiles files(mesh_);
    EXPECT_EQ(found(files, "Maps/Half.PNG"), "Maps/Half.PNG");
    EXPECT_EQ(found(files, "Maps\\Half.PNG"), "Maps/Half.PNG");
    EXPECT_EQ(found(files, "./Maps/../beside.png"), "beside.png");
    EXPECT_THAT(files.remarks(), IsEmpty());
    EXPECT_EQ(found(files, "maps\\half.png"), "Maps/Half.PNG");
    EXPECT_EQ(found(files, "C:\\Users\\someone\\BESIDE.png"), "beside.png");
    EXPECT_EQ(found(files, "/home/nobody/of/that/name/beside.png"), "beside.png");
    EXPECT_THAT(files.remarks(), ElementsAre("texture 't': no file of that name; taken: 'Maps/Half.PNG'",
                                             "texture 't': no file of that name; taken: 'beside.png'"));
    EXPECT_EQ(found(files, "half.png"), "");  // it lies below, and its name has no folder
    EXPECT_EQ(found(files, "Maps"), "");
    EXPECT_EQ(found(files, ""), "");
    EXPECT_EQ(found(files, "sub\\"), "");
    EXPECT_THAT(files.wanted(), IsEmpty());
}

TEST_F(NamedFilesTest, AFolderThatIsGivenComesBeforeTheMeshesOwn) {
    write("in/Maps/beside.png", "");
    NamedFiles files(mesh_);
    EXPECT_EQ(found(files, "beside.png", {folder_ / "in/Maps"}), "Maps/beside.png");
    EXPECT_EQ(found(files, "beside.png", {folder_ / "in/none"}), "beside.png");
    write("in/name with a \\ in it.png", "");
    EXPECT_EQ(found(files, "name with a \\ in it.png"), "name with a \\ in it.png");
}

TEST_F(NamedFilesTest, WhatLiesOutsideIsWantedAndReadOnceItIsGranted) {
    write("secret.txt", "secret");
    write("mark.ppm", "P6 1 1 255\n123");
    write("shared.mtl", "newmtl a\n");
    const std::vector<std::string> names = {"../mark.ppm", "../secret.txt", "..\\shared.mtl", "../none.png"};
    NamedFiles first(mesh_);
    for (const std::string& name : names)
        EXPECT_THAT(error_of([&] { found(first, name); }),
                    HasSubstr("texture 't' lies outside the mesh's folder"));
    ASSERT_EQ(first.wanted().size(), names.size());
    GrantedFiles granted;
    for (const FileName& name : first.wanted()) granted[name] = granted_file(mesh_, name);
    NamedFiles second(mesh_, granted);
    EXPECT_EQ(found(second, names[0]), "../mark.ppm");
    EXPECT_EQ(error_of([&] { found(second, names[1]); }),
              "texture 't' lies outside the mesh's folder, at " + (folder_ / "secret.txt").string() +
                  "; accepted there: a picture, materials (.mtl), a buffer (.bin)");
    EXPECT_EQ(found(second, names[2]), "../shared.mtl");
    EXPECT_EQ(found(second, names[3]), "");
    EXPECT_THAT(second.wanted(), IsEmpty());
}

// A link that leads out of the folder is as good as a path.
TEST_F(NamedFilesTest, LinksAreFollowed) {
    write("mark.ppm", "P6 1 1 255\n123");
    std::filesystem::create_symlink("../mark.ppm", folder_ / "in/link.ppm");
    std::filesystem::create_symlink("beside.png", folder_ / "in/inner.png");
    NamedFiles files(mesh_);
    EXPECT_EQ(found(files, "inner.png"), "inner.png");
    EXPECT_THAT(error_of([&] { found(files, "link.ppm"); }), HasSubstr("outside"));
    EXPECT_EQ(granted_file(mesh_, {"link.ppm", {}}).file, folder_ / "mark.ppm");
    EXPECT_EQ(granted_file(mesh_, {"link.ppm", {}}).refusal, "");
}

TEST(WithoutPercents, CodesAreBytes) {
    EXPECT_EQ(without_percents("quad%20%C3%BC.bin"), "quad \xC3\xBC.bin");
    EXPECT_EQ(without_percents("100%25.png"), "100%.png");
    EXPECT_EQ(without_percents("50%.png%2"), "50%.png%2");
    EXPECT_EQ(without_percents("%zz%4G"), "%zz%4G");
    EXPECT_EQ(without_percents(""), "");
}

}  // namespace
}  // namespace hilcam
