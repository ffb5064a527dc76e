// What a cache gives back, what it makes anew, whom it trusts and what it drops.

#include "io/cache/cache.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <map>

#include "io/cache/cache_room.h"
#include "io/cache/generated_mesh.h"
#include "io/cache/glb_seal.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

const std::string kName = "levels_1.bin";

// Holds variables of the environment for a test.
class Environment {
  public:
    ~Environment() {
        for (const auto& [name, value] : before_)
            value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
    }
    void set(const std::string& name, const char* value) {
        const char* const was = std::getenv(name.c_str());
        before_.try_emplace(name, was ? std::optional<std::string>(was) : std::nullopt);
        value ? setenv(name.c_str(), value, 1) : unsetenv(name.c_str());
    }

  private:
    std::map<std::string, std::optional<std::string>> before_;
};

class CacheTest : public FilesTest {
  protected:
    std::filesystem::path cache_folder_ = folder_ / "cache";
    std::vector<std::string> log_;
    std::vector<double> values_ = {1, 2.5, -3};

    Cache cache(std::uint64_t bound_bytes = 1'000'000, bool writes = true) {
        return Cache(
            {cache_folder_, bound_bytes, writes, [this](const std::string& line) { log_.push_back(line); }});
    }
    void keep(const Cache& cache, const std::string& name = kName) const {
        cache.write(name, [&](CacheWriter& out) { out(std::uint32_t{7}), out(values_); });
    }
    static std::optional<std::vector<double>> found(const Cache& cache, const std::string& name = kName) {
        std::uint32_t head = 0;
        std::vector<double> values;
        if (!cache.read(name, [&](CacheReader& in) { return in(head), in(values), true; })) return {};
        return head == 7 ? std::optional(values) : std::nullopt;
    }
    std::string bytes_of(const std::filesystem::path& file) const {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    // The names in the cache's folder.
    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const auto& entry : std::filesystem::directory_iterator(cache_folder_))
            out.push_back(entry.path().filename().string());
        return out;
    }
    // Says that a file was used so many hours ago.
    void age(const std::string& name, int hours) const {
        std::filesystem::last_write_time(
            cache_folder_ / name, std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
    }
};

TEST_F(CacheTest, WhatWasWrittenComesBack) {
    EXPECT_FALSE(found(cache()));
    keep(cache());
    EXPECT_EQ(found(cache()), values_);
    EXPECT_THAT(names(), testing::ElementsAre(kName));
    EXPECT_THAT(log_, testing::IsEmpty());
}

// Lists without values have no memory of their own.
TEST_F(CacheTest, EmptyListsComeBackToo) {
    values_.clear();
    keep(cache());
    EXPECT_EQ(found(cache()), values_);
    EXPECT_THAT(log_, testing::IsEmpty());
}

TEST_F(CacheTest, NoBitMayDiffer) {
    keep(cache());
    const std::string whole = bytes_of(cache_folder_ / kName);
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::string broken = whole;
        broken[bit / 8] = static_cast<char>(broken[bit / 8] ^ 1 << bit % 8);
        write("cache/" + kName, broken);
        ASSERT_FALSE(found(cache())) << bit;
    }
    EXPECT_EQ(log_.size(), 8 * whole.size());
    EXPECT_THAT(log_.front(), HasSubstr(kName + " is damaged, or of another version: it is made anew"));
    keep(cache());
    EXPECT_EQ(found(cache()), values_);
}

TEST_F(CacheTest, WhatIsCutOrGrownOrEmptiedIsNotTaken) {
    keep(cache());
    const std::string whole = bytes_of(cache_folder_ / kName);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        write("cache/" + kName, whole.substr(0, size));
        ASSERT_FALSE(found(cache())) << size;
        const std::string emptied = whole.substr(0, size) + std::string(whole.size() - size, '\0');
        write("cache/" + kName, emptied);
        ASSERT_EQ(found(cache()).has_value(), emptied == whole) << size;
    }
    write("cache/" + kName, whole + std::string(4096, '\0'));
    EXPECT_FALSE(found(cache()));
    write("cache/" + kName, "garbage");
    EXPECT_FALSE(found(cache()));
}

TEST_F(CacheTest, WhatIsNoFileIsNotThere) {
    std::filesystem::create_directories(cache_folder_ / "levels_2.bin");
    ASSERT_EQ(mkfifo((cache_folder_ / "levels_3.bin").c_str(), 0600), 0);
    EXPECT_FALSE(found(cache(), "levels_2.bin"));
    EXPECT_FALSE(found(cache(), "levels_3.bin"));
    // It cannot take the place of a folder, and leaves nothing behind.
    keep(cache(), "levels_2.bin");
    EXPECT_THAT(log_, testing::ElementsAre(HasSubstr("levels_2.bin cannot be written")));
    EXPECT_EQ(names().size(), 2u);
}

// Names of unfinished files cannot be foreseen, and a link in a file's place is not followed.
TEST_F(CacheTest, NothingIsWrittenThroughALink) {
    const auto victim = write("victim.txt", "untouched");
    std::filesystem::create_directories(cache_folder_);
    std::filesystem::create_symlink(victim, cache_folder_ / (kName + "." + std::to_string(getpid())));
    std::filesystem::create_symlink(victim, cache_folder_ / kName);
    keep(cache());
    EXPECT_EQ(bytes_of(victim), "untouched");
    EXPECT_FALSE(std::filesystem::is_symlink(cache_folder_ / kName));
    EXPECT_EQ(found(cache()), values_);
}

TEST_F(CacheTest, AFolderThatOthersMayWriteIsRefused) {
    keep(cache());
    struct stat about {};
    ASSERT_EQ(stat(cache_folder_.c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777u, 0700u);
    ASSERT_EQ(chmod(cache_folder_.c_str(), 0707), 0);
    const std::string refusal = error_of([&] { found(cache()); });
    EXPECT_THAT(refusal, HasSubstr("others may write there; accepted: one that they may not write "
                                   "(chmod go-w), or another folder in HILCAM_CACHE"));
    EXPECT_EQ(error_of([&] { clear_cache(cache_folder_); }), refusal);
    EXPECT_THAT(error_of([&] { cache().glb("hilcam-a_1.glb", [](const auto&) {}); }), refusal);
    // One's own group may.
    ASSERT_EQ(chmod(cache_folder_.c_str(), 0775), 0);
    EXPECT_EQ(mistrust_of(cache_folder_), "");
    EXPECT_EQ(found(cache()), values_);
}

TEST_F(CacheTest, AFolderOfAnotherUserIsRefused) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder away";
    keep(cache());
    ASSERT_EQ(chown(cache_folder_.c_str(), 12345, getegid()), 0);
    EXPECT_THAT(error_of([&] { found(cache()); }), HasSubstr("belongs to user 12345"));
    ASSERT_EQ(chown(cache_folder_.c_str(), 0, 12345), 0);
    ASSERT_EQ(chmod(cache_folder_.c_str(), 0770), 0);
    EXPECT_THAT(error_of([&] { found(cache()); }), HasSubstr("others may write there"));
}

TEST_F(CacheTest, WithoutAHomeThereIsNone) {
    Environment environment;
    for (const char* name : {"HILCAM_CACHE", "XDG_CACHE_HOME", "HOME"}) environment.set(name, nullptr);
    EXPECT_EQ(cache_folder(), "");
    const Cache none{CacheSettings{}};
    EXPECT_FALSE(none.writes());
    keep(none);
    EXPECT_FALSE(found(none));
    environment.set("HOME", "/home/a");
    EXPECT_EQ(cache_folder(), "/home/a/.cache/hilcam");
    environment.set("XDG_CACHE_HOME", "/x");
    EXPECT_EQ(cache_folder(), "/x/hilcam");
    environment.set("HILCAM_CACHE", "/own");
    EXPECT_EQ(cache_folder(), "/own");
}

TEST_F(CacheTest, TheBoundIsAWholeNumberOfMegabytes) {
    Environment environment;
    environment.set("HILCAM_CACHE_MB", nullptr);
    EXPECT_EQ(cache_bound_bytes(), 4'096'000'000u);
    environment.set("HILCAM_CACHE_MB", "20");
    EXPECT_EQ(cache_bound_bytes(), 20'000'000u);
    for (const char* text : {"-1", "1.5", "many", "99999999999999999999", "20 MB"}) {
        environment.set("HILCAM_CACHE_MB", text);
        EXPECT_THAT(error_of([] { cache_bound_bytes(); }),
                    HasSubstr(std::string("HILCAM_CACHE_MB: found '") + text));
    }
}

TEST_F(CacheTest, WhatWasUsedLongestAgoGoesFirst) {
    for (const char* name : {"levels_1.bin", "levels_2.bin", "levels_3.bin"}) keep(cache(), name);
    const auto each = std::filesystem::file_size(cache_folder_ / "levels_1.bin");
    write("cache/notes.txt", std::string(10'000, 'x'));
    age("levels_1.bin", 3), age("levels_2.bin", 2), age("levels_3.bin", 1);
    EXPECT_TRUE(found(cache(), "levels_1.bin"));  // used now
    keep(cache(3 * each), "levels_4.bin");
    EXPECT_THAT(names(),
                testing::UnorderedElementsAre("levels_1.bin", "levels_3.bin", "levels_4.bin", "notes.txt"));
    keep(cache(each), "levels_5.bin");
    EXPECT_THAT(names(), testing::UnorderedElementsAre("levels_5.bin", "notes.txt"));
    EXPECT_THAT(log_, testing::IsEmpty());
}

TEST_F(CacheTest, WhatIsLargerThanTheBoundIsNotKeptAndDrivesNothingOut) {
    keep(cache());
    values_.resize(1000);
    keep(cache(1000), "levels_2.bin");
    EXPECT_THAT(names(), testing::ElementsAre(kName));
    EXPECT_THAT(log_, testing::ElementsAre(HasSubstr("levels_2.bin is not kept")));
    // 0: what is there is found.
    values_.resize(3);
    keep(cache(0), "levels_2.bin");
    EXPECT_THAT(names(), testing::ElementsAre(kName));
    EXPECT_TRUE(found(cache(0)));
    keep(cache(1000, false), "levels_2.bin");
    EXPECT_THAT(names(), testing::ElementsAre(kName));
}

TEST_F(CacheTest, WhatAKilledProgramLeftGoesAfterADay) {
    keep(cache());
    for (const char* name : {"levels_2.bin.part-Ab3dE6", "levels_3.bin.part-Ab3dE6"})
        write(std::string("cache/") + name, "half");
    age("levels_2.bin.part-Ab3dE6", 25);
    keep(cache());
    EXPECT_THAT(names(), testing::UnorderedElementsAre(kName, "levels_3.bin.part-Ab3dE6"));
}

// Four processes write and read the same few files in too small a folder: whoever reads one reads it whole.
TEST_F(CacheTest, SeveralProcessesMayUseItAtOnce) {
    values_.assign(2000, 1.5);
    keep(cache());
    const auto each = std::filesystem::file_size(cache_folder_ / kName);
    std::vector<pid_t> children;
    for (int child = 0; child < 4; ++child) {
        const pid_t process = fork();
        if (process == 0) {
            int wrong = 0;
            for (int i = 0; i < 200; ++i) {
                const std::string name = "levels_" + std::to_string((i * 7 + child) % 5) + ".bin";
                const auto there = found(cache(3 * each), name);
                if (there && *there != values_) ++wrong;
                if (!there) keep(cache(3 * each), name);
            }
            _exit(wrong == 0 && log_.empty() ? 0 : 1);
        }
        children.push_back(process);
    }
    for (const pid_t process : children) {
        int status = 0;
        ASSERT_EQ(waitpid(process, &status, 0), process);
        EXPECT_EQ(status, 0);
    }
    // One that writes sees no other's file before that has its place.
    EXPECT_LE(cache_size(cache_folder_).bytes, 6 * each);
    for (const std::string& name : names()) EXPECT_EQ(name.find(kUnfinished), std::string::npos) << name;
}

// --- meshes

// A binary glTF of one chunk.
std::string glb() {
    std::string bytes("glTF\x02\0\0\0\x18\0\0\0\x04\0\0\0JSON{}  ", 24);
    return bytes;
}

class CachedMesh : public CacheTest {
  protected:
    int made_ = 0;
    static constexpr const char* kMesh = "hilcam-make-a_triangles_5_v2.glb";

    HeldFile mesh(const Cache& cache) {
        return cache.glb(kMesh, [&](const std::filesystem::path& file) {
            ++made_;
            std::ofstream(file, std::ios::binary) << glb();
        });
    }
};

TEST_F(CachedMesh, IsMadeOnceAndIsStillAGlb) {
    const std::filesystem::path file = mesh(cache()).path();
    EXPECT_EQ(file, cache_folder_ / kMesh);
    mesh(cache());
    EXPECT_EQ(made_, 1);
    // The header's length is the file's; the last chunk is the checksum's.
    const std::string bytes = bytes_of(file);
    ASSERT_EQ(bytes.size(), glb().size() + 12);
    EXPECT_EQ(bytes.substr(8, 4), std::string("\x24\0\0\0", 4));
    EXPECT_EQ(bytes.substr(12, 12), glb().substr(12));
    EXPECT_EQ(bytes.substr(24, 8), std::string("\x04\0\0\0HCRC", 8));
    EXPECT_THAT(names(), testing::ElementsAre(kMesh));
    EXPECT_THAT(log_, testing::IsEmpty());
}

TEST_F(CachedMesh, IsMadeAnewWhereItIsDamaged) {
    mesh(cache());
    const std::string whole = bytes_of(cache_folder_ / kMesh);
    int expected = 1;
    const auto is_made_anew = [&](const std::string& bytes) {
        write(std::string("cache/") + kMesh, bytes);
        mesh(cache());
        return made_ == ++expected && bytes_of(cache_folder_ / kMesh) == whole;
    };
    for (std::size_t size = 0; size < whole.size(); ++size)
        ASSERT_TRUE(is_made_anew(whole.substr(0, size))) << size;
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::string broken = whole;
        broken[bit / 8] = static_cast<char>(broken[bit / 8] ^ 1 << bit % 8);
        ASSERT_TRUE(is_made_anew(broken)) << bit;
    }
    EXPECT_TRUE(is_made_anew(glb()));  // as an older version left it
    EXPECT_TRUE(is_made_anew("garbage"));
    EXPECT_TRUE(is_made_anew(std::string(whole.size(), '\0')));
    EXPECT_EQ(log_.size(), static_cast<std::size_t>(made_) - 1);
}

TEST_F(CachedMesh, WhoLoadsItDoesNotLoseIt) {
    {
        const HeldFile held = mesh(cache());
        make_room(cache_folder_, 0, "");
        EXPECT_EQ(clear_cache(cache_folder_).files, 0u);
        EXPECT_TRUE(std::filesystem::exists(held.path()));
    }
    EXPECT_EQ(clear_cache(cache_folder_).files, 1u);
}

TEST_F(CachedMesh, WithoutAFolderItGoesWithItsUse) {
    std::filesystem::path file;
    for (const Cache& none : {Cache(), cache(0), cache(1000, false)}) {
        {
            const HeldFile held = mesh(none);
            file = held.path();
            EXPECT_EQ(bytes_of(file), glb());
        }
        EXPECT_FALSE(std::filesystem::exists(file.parent_path())) << file;
    }
    EXPECT_EQ(made_, 3);
    EXPECT_FALSE(std::filesystem::exists(cache_folder_));
}

TEST_F(CachedMesh, AFolderThatCannotBeWrittenIsNoFailure) {
    const Cache nowhere({write("plain", "no folder") / "cache", 1000, true,
                         [this](const std::string& line) { log_.push_back(line); }});
    EXPECT_EQ(bytes_of(mesh(nowhere).path()), glb());
    EXPECT_THAT(log_, testing::ElementsAre(HasSubstr("what is made is not kept")));
}

TEST_F(CachedMesh, AGeneratorThatMakesNothingLeavesNothing) {
    EXPECT_THROW(cache().glb(kMesh, [](const auto&) {}), DeviceError);
    EXPECT_THROW(cache().glb(kMesh, [](const auto&) { throw InputError("no"); }), InputError);
    EXPECT_THAT(names(), testing::IsEmpty());
}

TEST_F(CachedMesh, HasANameThatTellsItsArguments) {
    EXPECT_EQ(generated_mesh_name("hilcam-make-a", {"--triangles", "5", "--angle=-2.50"}),
              "hilcam-make-a_triangles_5_angle--2.50_v2.glb");
    EXPECT_THAT(error_of([] { generated_mesh_name("../sh", {}); }),
                HasSubstr("mesh generator '../sh': accepted: the name of a program beside hilcam"));
}

}  // namespace
}  // namespace hilcam
