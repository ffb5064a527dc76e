#include "emulator/campaign/slurm_script.h"

#include <gmock/gmock.h>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(SlurmScript, ChunksTakeAboutWhatATaskShall) {
    EXPECT_EQ(chunk_of(0.5, 900), 1800u);
    EXPECT_EQ(chunk_of(2000, 900), 1u);
    EXPECT_EQ(chunk_of(0, 900), 900000u);
}

TEST(SlurmScript, OnlyTasksWithMissingCasesAreInTheArray) {
    EXPECT_THAT(tasks_of({1, 2, 10, 11, 31, 45}, 10), ElementsAre(0, 1, 3, 4));
    SlurmPlan plan{"night set", "/opt/it's/hilcam", "/shared/set.yaml", "/shared/out", {"count=60"}, 60,
                   10,          {0, 1, 3, 5}};
    const std::string script = array_script(plan);
    EXPECT_THAT(script, HasSubstr("#SBATCH --array=0-1,3,5\n"));
    EXPECT_THAT(script, HasSubstr("#SBATCH --job-name=hilcam-night-set\n"));
    EXPECT_THAT(script, HasSubstr("first=$((SLURM_ARRAY_TASK_ID * 10 + 1))\n"));
    EXPECT_THAT(script, HasSubstr("[ $last -gt 60 ] && last=60\n"));
    EXPECT_THAT(script, HasSubstr("exec '/opt/it'\\''s/hilcam' campaign '/shared/set.yaml' --out "
                                  "'/shared/out' --set 'count=60' --cases "));
    EXPECT_THAT(merge_script(plan), HasSubstr(" --merge\n"));
}

// sbatch reads the lines before the first command itself: words end at blanks, and %a is the task's number.
TEST(SlurmScript, TheFoldersNameIsOneWordWithoutPatterns) {
    SlurmPlan plan{"a", "/opt/hilcam", "/set.yaml", "/x/a b/%a/it's", {}, 60, 10, {0}};
    EXPECT_THAT(array_script(plan), HasSubstr("#SBATCH --output='/x/a b/%%a/it'\\''s/slurm/task-%a.log'\n"));
    EXPECT_THAT(merge_script(plan), HasSubstr("#SBATCH --output='/x/a b/%%a/it'\\''s/slurm/merge.log'\n"));
}

struct SlurmFolder : FilesTest {};

TEST_F(SlurmFolder, ANameThatEndsALineIsRefusedBeforeAnythingIsWritten) {
    for (const char* name : {"a\ntouch owned", "a\tb", "a\rb", "a\x7F", "a\\b"}) {
        const SlurmPlan plan{"a", "/opt/hilcam", "/set.yaml", folder_ / name, {}, 60, 10, {0}};
        const std::string refusal = error_of([&] { submit_campaign(plan, false); });
        EXPECT_THAT(refusal,
                    HasSubstr("accepted with --slurm: a folder whose name has no control characters"));
        EXPECT_EQ(refusal.find('\n'), std::string::npos);
        EXPECT_TRUE(std::filesystem::is_empty(folder_));
    }
}

}  // namespace
}  // namespace hilcam
