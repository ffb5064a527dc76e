#include "emulator/zoo/surface_words.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace hilcam {
namespace {

struct Word {
    std::string_view part, material;
};
// A longer word comes before a shorter one that occurs in the same names: the back of a panel is not a panel,
// and black foil is not gold.
constexpr std::array kSurfaceWords = std::to_array<Word>({
    {"panel_back", "cfrp"},
    {"panelback", "cfrp"},
    {"baffle", "black_anodised"},
    {"black", "black_paint"},
    {"osr", "osr"},
    {"silver", "mli_silvered"},
    {"kapton", "mli_kapton"},
    {"mli", "mli_kapton"},
    {"foil", "mli_kapton"},
    {"blanket", "mli_kapton"},
    {"gold", "mli_kapton"},
    {"solar", "solar_cell"},
    {"cell", "solar_cell"},
    {"panel", "solar_cell"},
    {"photovolt", "solar_cell"},
    {"white", "white_paint"},
    {"paint", "white_paint"},
    {"antenna", "white_paint"},
    {"dish", "white_paint"},
    {"anodi", "anodised_clear"},
    {"truss", "anodised_clear"},
    {"cfrp", "cfrp"},
    {"carbon", "cfrp"},
    {"glass", "cover_glass"},
    {"window", "cover_glass"},
    {"alumin", "aluminium_bare"},
    {"metal", "aluminium_bare"},
    {"steel", "aluminium_bare"},
    {"titan", "aluminium_bare"},
    {"nozzle", "aluminium_bare"},
    {"thruster", "aluminium_bare"},
    {"tube", "aluminium_bare"},
    {"comet", "asteroid_c"},
    {"asteroid", "asteroid_s"},
    {"regolith", "lunar_regolith"},
});
// A metallic factor of 0 is a dielectric, and 1 is a metal (glTF 2.0, section 3.9.2). From this value on a
// surface counts as metal.
constexpr float kMetal = 0.5f;

}  // namespace

std::string_view shipped_material_for(const MeshSurface& surface) {
    std::string name = surface.name;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const Word& word : kSurfaceWords)
        if (name.find(word.part) != std::string::npos) return word.material;
    return surface.metallic >= kMetal ? "aluminium_bare" : "white_paint";
}

}  // namespace hilcam
