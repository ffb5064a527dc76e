#pragma once
// The commit that the program was built from, as `git describe` names it; cmake/write_commit.cmake writes the
// source of it.

namespace hilcam {

// "0123456789ab", with "-dirty" where the tree had changes; words when there was no git.
const char* program_commit();

}  // namespace hilcam
