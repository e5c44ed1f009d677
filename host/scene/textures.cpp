/// Reading of texture objects; images by the libraries of their formats.
#include "scene/textures.h"
#include "scene/text.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
namespace {

const std::uint64_t maxTexelWords = 1ull << 30; // of all images: 4 GiB

/// Coordinates of a scene file go up from the lower edge of an image, whose rows go down.
void readTransform(Reader transform, Texture& texture) {
    glm::dvec2 offset{0}, scale{1};
    if (const auto value = transform.find("offset")) offset = value->pair({-1e6f, 1e6f});
    if (const auto value = transform.find("scale")) scale = value->pair({-1e6f, 1e6f});
    const auto rotation = transform.find("rotation");
    const double angle = rotation ? glm::radians(double{rotation->number()}) : 0;
    transform.finish();
    const double c = angle == 0 ? 1 : std::cos(angle), s = angle == 0 ? 0 : std::sin(angle);
    texture.u = vec3{glm::dvec3{c * scale.x, -s * scale.y, offset.x}};
    texture.v = vec3{glm::dvec3{-s * scale.x, -c * scale.y, 1 - offset.y}};
}

uint readWrap(const Reader& reader) { return static_cast<uint>(reader.choice({"repeat", "mirror", "clamp"})); }

} // namespace

double linearOfSrgb(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

vec3 Textures::color(const Reader& value, Range range, uint& slot) {
    if (!is(value)) return value.color(range);
    slot = read(value, Use::color, 0);
    return scene.textured.textures[slot].factor;
}

float Textures::number(const Reader& value, Range range, uint& slot, uint channel) {
    if (!is(value)) return value.number(range);
    slot = read(value, Use::number, channel);
    return std::min(greatest(scene.textured.textures[slot]), range.high);
}

uint Textures::place(const MaterialTextures& textures) {
    if ((textures.color & textures.metallic & textures.roughness & textures.opacity & textures.normal &
         textures.specular & textures.specularColor & textures.transmission) == NONE)
        return 0;
    scene.textured.materials.push_back(textures);
    return static_cast<uint>(scene.textured.materials.size());
}

uint Textures::coloredByVertices(uint material) {
    const auto [known, isNew] = colored.try_emplace(material, static_cast<uint>(scene.materials.size()));
    if (!isNew) return known->second;
    Material copy = scene.materials[material];
    MaterialTextures slots = copy.textures != 0 ? scene.textured.materials[copy.textures - 1] : noTextures;
    slots.colors = 1;
    scene.textured.materials.push_back(slots);
    copy.textures = static_cast<uint>(scene.textured.materials.size());
    scene.materials.push_back(copy);
    if (copy.base != 0) scene.materials[known->second].base = 1 + coloredByVertices(copy.base - 1);
    return known->second;
}

uint Textures::add(const Texture& texture) {
    scene.textured.textures.push_back(texture);
    return static_cast<uint>(scene.textured.textures.size() - 1);
}

uint Textures::read(Reader object, Use use, uint channel) {
    const bool isColor = use == Use::color;
    Texture texture{.channel = channel, .factor = vec3{1}, .u = {1, 0, 0}, .v = {0, -1, 1}};
    const Reader file = object.at("texture");
    const auto space = object.find("space"), wrap = object.find("wrap"), filter = object.find("filter"),
               transform = object.find("transform"), set = object.find("uv");
    const bool isNormal = use == Use::normal; // which has a strength in place of a factor and a channel
    const auto factor = isNormal ? std::nullopt : object.find("factor"),
               channelReader = isNormal ? std::nullopt : object.find("channel"),
               strength = isNormal ? object.find("strength") : std::nullopt;
    TexelSpace kind = isColor ? TexelSpace::byFile : TexelSpace::linear;
    if (space) kind = space->choice({"srgb", "linear"}) == 0 ? TexelSpace::srgb : TexelSpace::linear;
    if (factor) texture.factor = isColor ? factor->color({0, 1e12f}) : vec3{factor->number({0, 1e12f})};
    if (strength) texture.factor.x = texture.factor.y = strength->number({-1000, 1000});
    if (channelReader) {
        if (isColor) channelReader->fail("found the channel of a colour", "allowed where a number is meant");
        texture.channel = static_cast<uint>(channelReader->choice({"r", "g", "b", "a"}));
    }
    if (wrap && wrap->isText()) texture.wrapU = texture.wrapV = readWrap(*wrap);
    else if (wrap) {
        const auto both = wrap->elements(2, 2, "\"repeat\", \"mirror\" or \"clamp\", or an array of 2 of these");
        texture.wrapU = readWrap(both[0]);
        texture.wrapV = readWrap(both[1]);
    }
    if (filter) texture.nearest = filter->choice({"linear", "nearest"}) == 1;
    if (transform) readTransform(*transform, texture);
    if (set) texture.set = set->integer(0, 1);
    object.finish();
    const auto own = given.find(file.text());
    texture.image = own != given.end() ? image(file, own->first, own->second, kind)
                                       : image(file, object.path().parent_path() / file.text(), kind);
    return add(texture);
}

uint Textures::image(const Reader& place, const std::filesystem::path& file, TexelSpace space) {
    const auto known = images.find({file.string(), space});
    if (known != images.end()) return known->second;
    if (const std::string problem = fileProblem(file, true); !problem.empty())
        place.fail(fmt::format("{}: {}", printable(file.string(), 4096), problem),
                   "give a PNG, JPEG, OpenEXR or Radiance image, relative to the scene file");
    FileRead read;
    const std::string bytes = readBytes(file, maxMeshBytes, "make the image smaller", &read);
    noteFiles(scene, {read});
    return image(place, file.string(), bytes, space);
}

uint Textures::image(const Reader& place, const std::string& name, std::string_view bytes, TexelSpace space) {
    const auto known = images.find({name, space});
    if (known != images.end()) return known->second;
    const Stored stored = store(place, name, bytes, space);
    scene.textured.images.push_back(stored.image);
    const auto index = static_cast<uint>(scene.textured.images.size() - 1);
    images[{name, space}] = index;
    return index;
}

std::vector<uint> Textures::tables() const {
    std::vector<uint> words;
    for (const bool srgb : {true, false})
        for (uint i = 0; i < TEXEL_TABLE; i++) {
            const double x = i / 255.0;
            words.push_back(std::bit_cast<uint>(static_cast<float>(srgb ? linearOfSrgb(x) : x)));
        }
    return words;
}

Picture Textures::decoded(const Reader& place, const std::string& name, std::string_view bytes) const try {
    const auto ready = made.find(name);
    return ready != made.end() ? ready->second : decodePicture(bytes);
} catch (const InputError& error) {
    place.fail(fmt::format("{}: {}", printable(name, 4096), error.what()), "give another image");
}

std::string Textures::giveRoughness(const Reader& place, const std::string& name, float gloss) {
    std::string result = fmt::format("{}: 1 - {} x alpha", name, gloss);
    if (knows(result)) return result;
    Picture picture = decoded(place, name, given.at(name));
    for (uint& texel : picture.bytes)
        texel = 0x01010101u * static_cast<uint>(std::lround(255 - gloss * static_cast<float>(texel >> 24)));
    for (vec4& texel : picture.floats) texel = vec4{1 - gloss * texel.w};
    made[result] = std::move(picture);
    give(result, "");
    return result;
}

Textures::Stored Textures::store(const Reader& place, const std::string& name, std::string_view bytes,
                                 TexelSpace space) {
    std::vector<uint>& texels = scene.textured.texels;
    if (texels.empty()) texels = tables();
    const auto format = space == TexelSpace::linear ? TEXELS_LINEAR : TEXELS_SRGB;
    if (const auto known = narrow.find(name); known != narrow.end()) {
        TexelImage image = known->second;
        image.format = format;
        return {image, false};
    }
    const Picture picture = decoded(place, name, bytes);
    TexelImage image{static_cast<uint>(texels.size()), picture.width, picture.height, format};
    const std::uint64_t words = std::uint64_t{picture.width} * picture.height * (picture.bytes.empty() ? 4 : 1);
    if (texels.size() + words > maxTexelWords)
        place.fail(fmt::format("{}: found {} x {} texels, with which all images take {} MiB", printable(name, 4096),
                               picture.width, picture.height, (texels.size() + words) >> 18),
                   fmt::format("allowed are {} MiB", maxTexelWords >> 18));
    if (!picture.bytes.empty()) {
        texels.insert(texels.end(), picture.bytes.begin(), picture.bytes.end());
        narrow[name] = image;
        return {image, false};
    }
    image.format = TEXELS_FLOAT;
    texels.reserve(texels.size() + words);
    for (const vec4& texel : picture.floats)
        for (int c = 0; c < 4; c++) {
            const double x{texel[c]};
            const bool curved = space == TexelSpace::srgb && c < 3;
            texels.push_back(std::bit_cast<uint>(static_cast<float>(curved ? linearOfSrgb(x) : x)));
        }
    return {image, true};
}

float Textures::greatest(const Texture& texture) const {
    const TexelImage& image = scene.textured.images[texture.image];
    double most = 0;
    for (uint y = 0; y < image.height; y++)
        for (uint x = 0; x < image.width; x++)
            most = std::max(most, texelOf(scene.textured, image, x, y)[static_cast<int>(texture.channel)]);
    return static_cast<float>(most * double{texture.factor.x});
}

glm::dvec4 texelOf(const TextureArrays& arrays, const TexelImage& image, uint x, uint y) {
    const std::size_t index = std::size_t{y} * image.width + x;
    const auto number = [&](std::size_t word) { return double{std::bit_cast<float>(arrays.texels[word])}; };
    glm::dvec4 result;
    for (int c = 0; c < 4; c++) {
        const bool curved = image.format == TEXELS_SRGB && c < 3;
        result[c] = image.format == TEXELS_FLOAT
                        ? number(image.first + 4 * index + std::size_t(c))
                        : number((curved ? 0 : TEXEL_TABLE) + (arrays.texels[image.first + index] >> 8 * c & 255));
    }
    return result;
}

static double folded(double x, uint wrap) {
    if (wrap == WRAP_CLAMP) return std::clamp(x, 0.0, 1.0);
    const double period = wrap == WRAP_MIRROR ? 2 : 1;
    return x - period * std::floor(x / period);
}

uint wrapped(std::int64_t i, std::int64_t size, uint wrap) {
    if (wrap == WRAP_CLAMP) return static_cast<uint>(std::clamp<std::int64_t>(i, 0, size - 1));
    const std::int64_t period = wrap == WRAP_MIRROR ? 2 * size : size, k = (i % period + period) % period;
    return static_cast<uint>(std::min(k, 2 * size - 1 - k));
}

glm::dvec4 textureAt(const TextureArrays& arrays, const Texture& t, glm::dvec2 coordinates) {
    const TexelImage& image = arrays.images[t.image];
    const glm::dvec3 place{coordinates, 1};
    const double x = folded(glm::dot(glm::dvec3{t.u}, place), t.wrapU) * image.width,
                 y = folded(glm::dot(glm::dvec3{t.v}, place), t.wrapV) * image.height;
    const auto texel = [&](double i, double j) {
        return texelOf(arrays, image, wrapped(std::int64_t(i), image.width, t.wrapU),
                       wrapped(std::int64_t(j), image.height, t.wrapV));
    };
    if (t.nearest != 0) return texel(std::floor(x), std::floor(y));
    const double i = std::floor(x - 0.5), j = std::floor(y - 0.5);
    return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), x - 0.5 - i),
                    glm::mix(texel(i, j + 1), texel(i + 1, j + 1), x - 0.5 - i), y - 0.5 - j);
}

} // namespace vkpm
