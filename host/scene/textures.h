/// Texture objects of scene files, and the images that they name.
#pragma once
#include "image/picture.h"
#include "scene/reader.h"
#include "scene/scene.h"
#include <map>

namespace vkpm {

/// What the numbers of an image stand for, where a texture does not say it.
enum class TexelSpace { byFile, srgb, linear };

const MaterialTextures noTextures{NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, 0};

/// What a number from 0 to 1 by the curve of sRGB stands for (IEC 61966-2-1).
double linearOfSrgb(double x);

/// Fills the textures and images of a scene; an image is read once.
class Textures {
public:
    explicit Textures(Scene& target) : scene{target} {}

    /// A colour, or a texture whose index goes to `slot`; then its factor.
    vec3 color(const Reader& value, Range range, uint& slot);
    /// A number, or a texture, whose index goes to `slot`; then the greatest number that it has. `channel` is the one
    /// it takes if it does not say it.
    float number(const Reader& value, Range range, uint& slot, uint channel = 0);

    /// The index of a normal map.
    uint normals(const Reader& value) { return read(value, Use::normal, 0); }

    /// Whether a value is a texture.
    static bool is(const Reader& value) { return value.isObject(); }

    /// Bytes of an image that texture objects may name in place of a file.
    void give(const std::string& name, std::string bytes) { given[name] = std::move(bytes); }
    bool knows(const std::string& name) const { return given.contains(name); }
    /// Makes known the roughness 1 - gloss x alpha of an image that was given; returns its name.
    std::string giveRoughness(const Reader& place, const std::string& name, float gloss);

    /// What Material.textures says of a material with these textures: 0 if it has none.
    uint place(const MaterialTextures& textures);
    /// A material of the scene that is another one but for the colours of vertices, by which its own is multiplied.
    uint coloredByVertices(uint material);

    /// The image of a file; `place` is where the scene names it.
    uint image(const Reader& place, const std::filesystem::path& file, TexelSpace space);
    /// Of bytes that are a file of that name.
    uint image(const Reader& place, const std::string& name, std::string_view bytes, TexelSpace space);
    uint add(const Texture& texture);

    Scene& scene;

private:
    struct Stored {
        TexelImage image;
        bool wide;
    };

    enum class Use { color, number, normal };

    uint read(Reader object, Use use, uint channel);
    Stored store(const Reader& place, const std::string& name, std::string_view bytes, TexelSpace space);
    Picture decoded(const Reader& place, const std::string& name, std::string_view bytes) const;
    std::vector<uint> tables() const;
    float greatest(const Texture& texture) const;

    std::map<uint, uint> colored; // materials by those that they were made of
    std::map<std::string, std::string> given;
    std::map<std::string, Picture> made;                       // of images that were given
    std::map<std::pair<std::string, TexelSpace>, uint> images; // by name
    std::map<std::string, TexelImage> narrow;                  // of 8 bits, which every space can read
};

/// The index of a texel along a side of an image, of one that may lie beyond it.
uint wrapped(std::int64_t i, std::int64_t size, uint wrap);

/// What a texel of an image holds, as kernels read it.
glm::dvec4 texelOf(const TextureArrays& arrays, const TexelImage& image, uint x, uint y);

/// The value of a texture at coordinates, as textureAt of texture.glsl has it.
glm::dvec4 textureAt(const TextureArrays& arrays, const Texture& texture, glm::dvec2 coordinates);

} // namespace vkpm
