#pragma once
// Makes small glTF files, one thing at a time: buffers as base64 in the JSON, a quad, textures as PNG.

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/images/picture_codecs.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

inline std::string base64_of(const std::string& bytes) {
    constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? kLetters[word >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

// A square picture whose left half is of one colour and whose right half is of another.
inline std::string half_picture(std::array<std::uint8_t, 3> left, std::array<std::uint8_t, 3> right,
                                int size = 8) {
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (const std::uint8_t v : 2 * x < size ? left : right) rgb.push_back(v);
    return encode_png({rgb, size, size, SampleKind::kRgb8});
}

// A square PNG of red, green, blue and alpha (W3C, PNG 1.2, chapters 3 to 5).
inline std::string png_with_alpha(const std::vector<std::uint8_t>& rgba, int size) {
    const auto big = [](std::uint32_t v) {
        return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                           static_cast<char>(v)};
    };
    const auto bytes_of_text = [](const std::string& text) {
        return reinterpret_cast<const Bytef*>(text.data());
    };
    const auto chunk = [&](const std::string& typed) {
        const uLong sum = crc32(0, bytes_of_text(typed), static_cast<uInt>(typed.size()));
        return big(static_cast<std::uint32_t>(typed.size()) - 4) + typed +
               big(static_cast<std::uint32_t>(sum));
    };
    std::string rows;
    const auto row_bytes = static_cast<std::size_t>(4 * size);
    for (std::size_t at = 0; at < rgba.size(); at += row_bytes)
        rows += '\0', rows.append(reinterpret_cast<const char*>(rgba.data()) + at, row_bytes);
    uLongf packed = compressBound(rows.size());
    std::string data(packed, '\0');
    compress(reinterpret_cast<Bytef*>(data.data()), &packed, bytes_of_text(rows), rows.size());
    data.resize(packed);
    const auto side = static_cast<std::uint32_t>(size);
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR" + big(side) + big(side) + std::string{8, 6, 0, 0, 0}) +
           chunk("IDAT" + data) + chunk("IEND");
}

class GltfWriter {
  public:
    using Json = nlohmann::json;

    Json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},  {"nodes", {{{"mesh", 0}, {"name", "quad"}}}},
                 {"accessors", Json::array()},    {"bufferViews", Json::array()}};

    // Adds bytes as a view; returns its number.
    std::size_t view(const std::string& bytes) {
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
        bytes_ += bytes;
        return root["bufferViews"].size() - 1;
    }
    // Adds numbers as an accessor; returns its number.
    template <class T>
    std::size_t accessor(const std::vector<T>& values, const char* type, int component, std::size_t width) {
        std::string bytes(values.size() * sizeof(T), '\0');
        if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
        const std::size_t at = view(bytes);
        root["accessors"].push_back({{"bufferView", at},
                                     {"componentType", component},
                                     {"type", type},
                                     {"count", values.size() / width}});
        return root["accessors"].size() - 1;
    }
    std::size_t floats(const std::vector<float>& values, std::size_t width) {
        const char* const type = width == 1   ? "SCALAR"
                                 : width == 2 ? "VEC2"
                                 : width == 3 ? "VEC3"
                                 : width == 4 ? "VEC4"
                                              : "MAT4";
        return accessor(values, type, 5126, width);
    }
    // A primitive: a square of side 2 about the origin that faces +z; attributes come to it.
    Json quad() {
        const std::size_t places = floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, 3);
        const std::size_t corners = accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 5123, 1);
        return {{"attributes", {{"POSITION", places}}}, {"indices", corners}};
    }
    // The same with the whole picture on it, upright.
    Json pictured_quad() {
        Json out = quad();
        out["attributes"]["TEXCOORD_0"] = floats({0, 1, 1, 1, 1, 0, 0, 0}, 2);
        return out;
    }
    void show(const Json& primitive) { root["meshes"] = {{{"primitives", {primitive}}}}; }
    // Makes the first texture of a picture, with a way to go on beyond its edges.
    void picture(const std::string& png, int wrap = 10497) {
        root["images"] = {{{"uri", "data:image/png;base64," + base64_of(png)}}};
        root["samplers"] = {{{"wrapS", wrap}, {"wrapT", wrap}, {"magFilter", 9728}}};
        root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    }
    std::string text() {
        root["buffers"] = {{{"byteLength", bytes_.size()},
                            {"uri", "data:application/octet-stream;base64," + base64_of(bytes_)}}};
        return root.dump();
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

}  // namespace hilcam
