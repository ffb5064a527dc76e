#pragma once
// Turns error messages of libraries into words that help a user.

#include <exception>
#include <string>

namespace hilcam {

// Returns what() without the library's own marks: nlohmann's name and number go, and of a text that is not
// JSON only the place of the error stays; of std::filesystem the path and the system's reason stay.
std::string plain_words(const std::exception& problem);
// Returns a library's message without the reason "Success", which it reads from an errno that nothing had
// set.
std::string without_success(std::string message);

}  // namespace hilcam
