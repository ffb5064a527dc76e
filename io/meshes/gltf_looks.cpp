#include "io/meshes/gltf_looks.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/images/picture_file.h"
#include "io/meshes/mesh_precheck.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Json = GltfDocument::Json;

TextureWrap wrap_of(std::uint64_t word, const GltfDocument& document, const std::string& where) {
    // The values are WebGL's (glTF 2.0, section 5.26).
    if (word == 10497) return TextureWrap::kRepeat;
    if (word == 33071) return TextureWrap::kClamp;
    if (word == 33648) return TextureWrap::kMirror;
    document.refuse("does not parse: " + where + ": found wrap mode " + std::to_string(word) +
                    "; accepted: 10497, 33071, 33648");
}

Vec3f within_one(const float* rgb) {
    return {std::clamp(rgb[0], 0.0f, 1.0f), std::clamp(rgb[1], 0.0f, 1.0f), std::clamp(rgb[2], 0.0f, 1.0f)};
}

bool is_black(const Json& color) {
    return std::all_of(color.begin(), color.end(),
                       [](const Json& c) { return c.is_number() && c.get<double>() == 0; });
}

GltfBytes as_bytes(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

// Records what is wrong with a picture. A fault of the file itself, with a message that begins with the
// file's name, is thrown on.
template <class Read>
bool GltfLooks::is_read(const Read& read) {
    try {
        read();
        return true;
    } catch (const InputError& fault) {
        const std::string why = fault.what();
        if (why.starts_with(document_.file().string())) throw;
        if (std::find(unreadable.begin(), unreadable.end(), why) == unreadable.end())
            unreadable.push_back(why);
        return false;
    }
}

// The order is scale, rotation, offset; a positive angle rotates coordinates counterclockwise as the picture
// is seen (v down).
Vec2f GltfTexturePlace::of(Vec2f uv) const {
    const float x = scale.x * uv.x, y = scale.y * uv.y;
    const float c = std::cos(rotation_rad), s = std::sin(rotation_rad);
    return {c * x + s * y + offset.x, c * y - s * x + offset.y};
}

bool GltfTexturePlace::operator==(const GltfTexturePlace& o) const {
    return uv_set == o.uv_set && offset.x == o.offset.x && offset.y == o.offset.y && scale.x == o.scale.x &&
           scale.y == o.scale.y && rotation_rad == o.rotation_rad;
}

GltfLooks::GltfLooks(GltfDocument& document, const std::vector<Named>& named) : document_(document) {
    surfaces.resize(named.size() + 1);
    places.resize(named.size() + 1);
    // A material's default is white metal (glTF 2.0, section 5.19), also for a primitive without a material.
    for (MeshSurface& surface : surfaces) {
        surface.base_color = {1, 1, 1};
        surface.metallic = surface.roughness = 1;
    }
    for (std::size_t i = 0; i < named.size(); ++i) {
        const Json& json = document.at("materials", named[i].material);
        surface_of_material_[named[i].material] = i;
        surfaces[i].name = gltf_text(json, "name");
        read(json, i, named[i].has_triangles);
    }
}

std::size_t GltfLooks::surface_of(std::optional<std::uint64_t> material) const {
    return material ? surface_of_material_.at(*material) : surface_of_material_.size();
}

void GltfLooks::read(const Json& json, std::size_t surface, bool has_triangles) {
    if (!has_triangles) return;
    Material material{
        json, surfaces[surface].name, "material " + in_quotes(surfaces[surface].name), surface, {}, 1};
    if (const Json* const specular = gltf_extension(json, "KHR_materials_pbrSpecularGlossiness"))
        read_specular(material, *specular);
    else
        read_metal_rough(material);
    if (const Json* const ior = gltf_extension(json, "KHR_materials_ior")) {
        MeshSurface& s = surfaces[surface];
        document_.number(*ior, "ior", material.where, s.refractive_index);
        s.refractive_index = std::clamp(s.refractive_index, 1.0f, 4.0f);
    }
    read_sheet(material);
    cut_by_textures(material);
    name_the_rest(material);
}

void GltfLooks::read_metal_rough(Material& m) {
    const Json* const p = gltf_member(m.json, "pbrMetallicRoughness");
    if (!p) return;
    MeshSurface& s = surfaces[m.surface];
    std::array<float, 4> color{1, 1, 1, 1};
    document_.numbers(*p, "baseColorFactor", m.where, color);
    s.base_color = within_one(color.data());
    m.alpha = std::clamp(color[3], 0.0f, 1.0f);
    document_.number(*p, "metallicFactor", m.where, s.metallic);
    document_.number(*p, "roughnessFactor", m.where, s.roughness);
    s.metallic = std::clamp(s.metallic, 0.0f, 1.0f), s.roughness = std::clamp(s.roughness, 0.0f, 1.0f);
    set_colors(m, gltf_member(*p, "baseColorTexture"));
}

// Becomes a diffuse body below a layer that reflects `specularFactor` at normal incidence, or a metal where
// most of the light is specular. Khronos' own conversion draws the same line (the extension's appendix "Best
// practices").
void GltfLooks::read_specular(Material& m, const Json& given) {
    std::array<float, 4> diffuse{1, 1, 1, 1};
    std::array<float, 3> specular{1, 1, 1};
    float glossiness = 1;
    document_.numbers(given, "diffuseFactor", m.where, diffuse);
    document_.numbers(given, "specularFactor", m.where, specular);
    document_.number(given, "glossinessFactor", m.where, glossiness);
    // Perceived brightness (HSP colour model), as in that conversion.
    const auto brightness = [](Vec3f c) {
        return std::sqrt(0.299f * c.x * c.x + 0.587f * c.y * c.y + 0.114f * c.z * c.z);
    };
    const Vec3f d = within_one(diffuse.data()), f = within_one(specular.data());
    constexpr float kDielectric = 0.04f;
    const float most = std::max({f.x, f.y, f.z}), shine = brightness(f);
    float metallic = 0;
    if (shine >= kDielectric) {
        const float b = brightness(d) * (1 - most) / (1 - kDielectric) + shine - 2 * kDielectric,
                    c = kDielectric - shine;
        const float root = std::sqrt(std::max(0.0f, b * b - 4 * kDielectric * c));
        metallic = std::clamp((root - b) / (2 * kDielectric), 0.0f, 1.0f);
    }
    MeshSurface& s = surfaces[m.surface];
    s.metallic = metallic;
    s.base_color = metallic >= 0.5f ? f : d;
    s.roughness = std::clamp(1 - glossiness, 0.0f, 1.0f);
    // The Fresnel reflectance at normal incidence is ((n - 1) / (n + 1))^2.
    const float root = std::sqrt(std::min(most, 0.36f));
    s.refractive_index = std::clamp((1 + root) / (1 - root), 1.0f, 4.0f);
    m.alpha = std::clamp(diffuse[3], 0.0f, 1.0f);
    set_colors(m, gltf_member(given, "diffuseTexture"));
    if (gltf_member(given, "specularGlossinessTexture")) left_out.add("specular-glossiness texture", m.name);
}

void GltfLooks::set_colors(Material& m, const Json* texture) {
    m.colors = use_of(texture, m.where);
    if (!m.colors) return;
    places[m.surface] = m.colors->place;
    const auto picture = picture_of(m.colors->texture);
    if (picture) surfaces[m.surface].base_color_texture = texture_of(*picture, m);
}

// Alpha is coverage (glTF 2.0, section 3.9.4), transmission is light that passes through
// (KHR_materials_transmission).
void GltfLooks::read_sheet(const Material& m) {
    MeshSurface& s = surfaces[m.surface];
    if (gltf_text(m.json, "alphaMode") == "BLEND") s.opacity = m.alpha;
    const Json* const clear = gltf_extension(m.json, "KHR_materials_transmission");
    if (!clear) return;
    document_.number(*clear, "transmissionFactor", m.where, s.transmission);
    s.transmission = std::clamp(s.transmission, 0.0f, 1.0f);
    if (gltf_member(*clear, "transmissionTexture")) left_out.add("transmission texture", m.name);
    if (s.transmission > 0 && s.transmission < 0.5f) left_out.add("transmission below one half", m.name);
}

void GltfLooks::cut_by_textures(const Material& m) {
    SurfaceCut cut;
    cut.surface = static_cast<std::uint16_t>(m.surface);
    const bool has_metal = read_metal_texture(m, cut);
    const bool has_alpha = read_alpha(m, cut);
    if (has_metal || has_alpha) add_kinds(m, std::move(cut));
}

// Gives each kind a surface, the first one the material's own.
void GltfLooks::add_kinds(const Material& m, SurfaceCut cut) {
    cut.kinds = kinds_of(cut.source);
    cut.surface_of_kind = {SurfaceCut::kNothing, static_cast<std::int32_t>(m.surface)};
    for (std::size_t k = 0; k < cut.kinds.size(); ++k) {
        if (k > 0) {
            cut.surface_of_kind.push_back(static_cast<std::int32_t>(surfaces.size()));
            surfaces.push_back(surfaces[m.surface]);
            places.push_back(places[m.surface]);
        }
        MeshSurface& s = surfaces[static_cast<std::size_t>(cut.surface_of_kind[k + 1])];
        s.metallic = cut.kinds[k].metallic, s.roughness = cut.kinds[k].roughness;
    }
    if (surfaces.size() > 6 * kMaxMaterials) refuse_materials(surfaces.size(), document_.file().string());
    if (cut.kinds.size() > 1 || cut.source.cutoff > 0) cuts.push_back(std::move(cut));
}

// Reads the alpha channel of the colour picture, if it is used. False: the surface has no holes.
bool GltfLooks::read_alpha(const Material& m, SurfaceCut& cut) {
    const std::string mode = gltf_text(m.json, "alphaMode");
    cut.source.cutoff = 0;
    if (mode != "MASK" && mode != "BLEND") return false;
    float cutoff = 0.5f;
    if (mode == "MASK") document_.number(m.json, "alphaCutoff", m.where, cutoff);
    // With BLEND the factor belongs to the veil.
    const float factor = mode == "MASK" ? m.alpha : 1.0f;
    const auto picture = m.colors ? picture_of(m.colors->texture) : std::nullopt;
    if (const int number = surfaces[m.surface].base_color_texture; picture && number >= 0) {
        const Texture& colors = textures[static_cast<std::size_t>(number)];
        is_read([&] {
            cut.source.alpha = {
                colors.width, colors.height,
                decode_alpha(as_bytes(bytes_of(picture->image, m)), what_is(picture->image, m))};
        });
    }
    const bool textured = !cut.source.alpha.empty();
    if (!textured && (mode == "BLEND" || factor >= cutoff)) return false;
    if (mode == "BLEND")
        left_out.add("alpha of a texture between all and nothing (half is the border)", m.name);
    cut.source.cutoff = factor > 0 ? 255 * cutoff / factor : 1e9f;
    if (textured)
        cut.source.wrap = picture->wrap, cut.source.smooth = picture->smooth;
    else
        cut.source.alpha = {1, 1, {255}};
    return true;
}

// A texture that is placed differently from the colours is left out.
bool GltfLooks::read_metal_texture(const Material& m, SurfaceCut& cut) {
    const Json* const p = gltf_member(m.json, "pbrMetallicRoughness");
    const auto use = p ? use_of(gltf_member(*p, "metallicRoughnessTexture"), m.where) : std::nullopt;
    const auto picture = use ? picture_of(use->texture) : std::nullopt;
    if (!picture || gltf_extension(m.json, "KHR_materials_pbrSpecularGlossiness")) return false;
    const auto colors = m.colors ? picture_of(m.colors->texture) : std::nullopt;
    if (colors && (!(m.colors->place == use->place) || colors->wrap != picture->wrap)) {
        left_out.add("metallic-roughness texture, which lies otherwise than the colours,", m.name);
        return false;
    }
    places[m.surface] = use->place;
    Texture texture;
    if (!is_read([&] {
            texture = decode_texture(as_bytes(bytes_of(picture->image, m)), what_is(picture->image, m));
        }))
        return false;
    count_texels(texture);
    // Green is roughness, blue is metal; both are linear (glTF 2.0, section 5.22.5).
    cut.source.metallic = cut.source.roughness = {texture.width, texture.height, {}};
    for (const auto& texel : texture.texels) {
        cut.source.roughness.values.push_back(texel[1]);
        cut.source.metallic.values.push_back(texel[2]);
    }
    cut.source.metallic_factor = surfaces[m.surface].metallic;
    cut.source.roughness_factor = surfaces[m.surface].roughness;
    cut.source.wrap = picture->wrap, cut.source.smooth = picture->smooth;
    return true;
}

void GltfLooks::name_the_rest(const Material& m) {
    const Json* const emission = gltf_member(m.json, "emissiveFactor");
    if (emission && !is_black(*emission)) left_out.add("emission", m.name);
    if (gltf_member(m.json, "normalTexture")) left_out.add("normal map", m.name);
    if (gltf_member(m.json, "occlusionTexture")) left_out.add("occlusion map", m.name);
    constexpr std::array<std::string_view, 5> kTaken = {
        "KHR_materials_pbrSpecularGlossiness", "KHR_materials_ior", "KHR_materials_transmission",
        "KHR_materials_emissive_strength", "KHR_materials_variants"};
    const Json* const extensions = gltf_member(m.json, "extensions");
    if (!extensions || !extensions->is_object()) return;
    for (const auto& [name, value] : extensions->items())
        if (std::find(kTaken.begin(), kTaken.end(), name) == kTaken.end())
            left_out.add(shortened(name), m.name);
}

std::optional<GltfLooks::Use> GltfLooks::use_of(const Json* texture, const std::string& where) const {
    if (!texture || !texture->is_object()) return {};
    Use out;
    out.texture = document_.required_whole(*texture, "index", where);
    out.place.uv_set = document_.whole(*texture, "texCoord", where).value_or(0);
    if (const Json* const moved = gltf_extension(*texture, "KHR_texture_transform")) {
        std::array<float, 2> offset{0, 0}, scale{1, 1};
        document_.numbers(*moved, "offset", where, offset);
        document_.numbers(*moved, "scale", where, scale);
        document_.number(*moved, "rotation", where, out.place.rotation_rad);
        out.place.offset = {offset[0], offset[1]}, out.place.scale = {scale[0], scale[1]};
        out.place.uv_set = document_.whole(*moved, "texCoord", where).value_or(out.place.uv_set);
    }
    return out;
}

std::optional<GltfLooks::Picture> GltfLooks::picture_of(std::uint64_t index) const {
    const std::string where = "textures[" + std::to_string(index) + "]";
    const Json& texture = document_.at("textures", index);
    Picture out;
    auto image = document_.whole(texture, "source", where);
    const Json* const webp = gltf_extension(texture, "EXT_texture_webp");
    if (!image && webp) image = document_.whole(*webp, "source", where);
    if (!image) {
        const Json* const others = gltf_member(texture, "extensions");
        if (!others || !others->is_object() || others->empty()) return {};
        document_.refuse(where + ": found a picture for " + in_quotes(others->begin().key()) +
                         " alone; accepted: one without an extension, or EXT_texture_webp");
    }
    out.image = *image;
    const auto sampler = document_.whole(texture, "sampler", where);
    if (!sampler) return out;
    const Json& s = document_.at("samplers", *sampler);
    out.wrap = {wrap_of(document_.whole(s, "wrapS", where).value_or(10497), document_, where),
                wrap_of(document_.whole(s, "wrapT", where).value_or(10497), document_, where)};
    constexpr std::uint64_t kNearest = 9728;
    out.smooth = document_.whole(s, "magFilter", where).value_or(0) != kNearest;
    return out;
}

std::string GltfLooks::what_is(std::uint64_t image, const Material& m) {
    return "texture images[" + std::to_string(image) + "] of material " + in_quotes(m.name);
}

std::string GltfLooks::bytes_of(std::uint64_t index, const Material& m) {
    const Json& image = document_.at("images", index);
    if (const std::string uri = gltf_text(image, "uri"); !uri.empty())
        return document_.bytes_at(uri, picture_kind(), what_is(index, m));
    const GltfBytes bytes = document_.view(document_.required_whole(image, "bufferView", what_is(index, m)));
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void GltfLooks::count_texels(const Texture& texture) {
    texels_ += texture.texels.size();
    if (texels_ > kMaxTexels)
        document_.refuse("its textures have more than " + std::to_string(kMaxTexels) + " pixels together");
}

int GltfLooks::texture_of(const Picture& picture, const Material& m) {
    // Colours are interpolated linearly between texels, whatever the sampler says.
    Picture key = picture;
    key.smooth = true;
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    Texture texture;
    if (!is_read([&] {
            texture = decode_texture(as_bytes(bytes_of(picture.image, m)), what_is(picture.image, m));
        }))
        return known_[key] = -1;
    count_texels(texture);
    texture.name = "images[" + std::to_string(picture.image) + "]";
    texture.wrap = picture.wrap;
    textures.push_back(std::move(texture));
    return known_[key] = static_cast<int>(textures.size()) - 1;
}

}  // namespace hilcam
