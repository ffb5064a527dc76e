#pragma once
// The commit that the program was built from, as `git describe` names it. cmake/write_commit.cmake writes the
// source file.

namespace hilcam {

// Returns the hash, as in "0123456789ab", with "-dirty" where the tree had changes; a phrase when the build
// had no git.
const char* program_commit();

}  // namespace hilcam
