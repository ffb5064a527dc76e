#include "emulator/campaign/slurm_script.h"

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace hilcam
