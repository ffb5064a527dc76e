#pragma once
// A shared library that is loaded when it is needed, so that hilcam starts without it.

#include <string>
#include <type_traits>

namespace hilcam {

class LoadedLibrary {
  public:
    // file: "libaec.so.0". why: what needs it, for the message ("outputs.packets.payload: ccsds_121").
    // package: Debian's name of the package that has it. Throws InputError. The library is never closed, as
    // code of it may still run.
    LoadedLibrary(const std::string& file, const std::string& why, const std::string& package);

    // Sets a pointer to the function of that name. Throws InputError when the library has none.
    template <class Function>
    void find(Function*& function, const char* name) const {
        static_assert(std::is_function_v<Function>);
        function = reinterpret_cast<Function*>(address_of(name));
    }

  private:
    void* address_of(const char* name) const;

    std::string file_;
    void* handle_;
};

}  // namespace hilcam
