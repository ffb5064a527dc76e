#pragma once
// Puts what libraries say of a mistake into words that a user can do something with.

#include <exception>
#include <string>

namespace hilcam {

// Returns what() without a library's own marks: of nlohmann's JSON without its name and number, and of a text that is no
// JSON only where it ceases to be; of std::filesystem the path and the system's reason.
std::string plain_words(const std::exception& problem);
// Returns a library's message without the reason "Success" that it took from an errno which nobody had set.
std::string without_success(std::string message);

}  // namespace hilcam
