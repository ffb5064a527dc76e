#include "io/preview/preview_assets.h"

namespace hilcam {
namespace {

// String literals made by CMake.
constexpr std::string_view kPageHtml =
#include "page.html.inc"
    ;
constexpr std::string_view kPageCss =
#include "page.css.inc"
    ;
constexpr std::string_view kFaultsJs =
#include "faults.js.inc"
    ;
constexpr std::string_view kOverlayJs =
#include "overlay.js.inc"
    ;
constexpr std::string_view kPageJs =
#include "page.js.inc"
    ;
constexpr std::string_view kPictureJs =
#include "picture.js.inc"
    ;
constexpr std::string_view kPlotsJs =
#include "plots.js.inc"
    ;
constexpr std::string_view kProfileJs =
#include "profile.js.inc"
    ;
constexpr std::string_view kSaveJs =
#include "save.js.inc"
    ;
constexpr std::string_view kViewStateJs =
#include "view_state.js.inc"
    ;

constexpr const char* kScript = "text/javascript; charset=utf-8";
constexpr PreviewAsset kAssets[] = {
    {"/", kPageHtml, "text/html; charset=utf-8"},
    {"/page.css", kPageCss, "text/css; charset=utf-8"},
    {"/faults.js", kFaultsJs, kScript},
    {"/overlay.js", kOverlayJs, kScript},
    {"/page.js", kPageJs, kScript},
    {"/picture.js", kPictureJs, kScript},
    {"/plots.js", kPlotsJs, kScript},
    {"/profile.js", kProfileJs, kScript},
    {"/save.js", kSaveJs, kScript},
    {"/view_state.js", kViewStateJs, kScript},
};

}  // namespace

std::span<const PreviewAsset> preview_assets() { return kAssets; }

}  // namespace hilcam
