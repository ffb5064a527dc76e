#pragma once
// Messages between hilcam and hilcam-read-map. A request and its answer are a struct each; lists and texts
// are in the shared memory. The first request is kOpen; kFind and kRead follow as often as needed.

#include <cstddef>
#include <cstdint>

namespace hilcam {

// The program's name, and the size of the shared memory.
inline constexpr const char* kMapProgram = "hilcam-read-map";
inline constexpr std::size_t kMapMemory_bytes = std::size_t{4} << 20;
// Limits of one request. Posts are written at kPosts_at, behind the places.
inline constexpr std::size_t kMaxMapPlaces = std::size_t{1} << 16, kPosts_at = std::size_t{2} << 20;
inline constexpr std::size_t kMaxMapValues = std::size_t{1} << 18;
inline constexpr std::size_t kMaxText_bytes = 4096;

struct MapRequest {
    enum class Kind : std::uint32_t { kOpen, kFind, kRead };
    Kind kind = Kind::kOpen;
    // kOpen: a GroundMapConfig and a MappedBody. Three texts are in the memory, one after the other.
    std::uint32_t file_bytes = 0, where_bytes = 0, body_bytes = 0;
    std::uint32_t ground_kind = 0, coding = 0, holes = 0, latitudes = 0, longitudes = 0;
    std::uint32_t bounds = 0;   // 0 or 4
    std::uint32_t no_data = 0;  // 0 to 4
    double bounds_deg[4] = {};
    double no_data_values[4] = {};
    double scale = 1, offset = 0;
    double equatorial_radius_m = 0, polar_radius_m = 0;
    // kFind: number of places in the memory (Vec3d); their posts (Vec2d) are to be written at kPosts_at.
    std::uint64_t places = 0;
    // kRead: the window; its values (float) are to be written at the beginning of the memory.
    std::int32_t level = 0, column = 0, row = 0, columns = 0, rows = 0;
};

struct MapAnswer {
    std::uint32_t refused_bytes = 0;  // length of the InputError's text in the memory; 0: success
    std::uint32_t failed = 0;         // kRead: something could not be read
    // kOpen: a GroundRaster::Shape.
    std::int32_t columns = 0, rows = 0, channels = 0, bands = 0;
    std::uint32_t has_overviews = 0, whole_turn = 0, pole_above_first_row = 0, pole_below_last_row = 0;
    // The kind of latitudes, and a GroundRaster::Reading as text in the memory: first the choices, then a
    // line for each doubt.
    std::uint32_t planetocentric = 0, reading_bytes = 0;
    double spacing_m = 0;
};

}  // namespace hilcam
