/// A scene as arrays of the structs that kernels read, and the loader that fills them from a JSON file.
#pragma once
#include "error.h"
#include "scene/coordinates.h"
#include "scene/settings.h"
#include "scene/text.h"
#include "shared_scene.h"
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace vkpm {

struct Bounds {
    vec3 low{std::numeric_limits<float>::infinity()};
    vec3 high{-std::numeric_limits<float>::infinity()};
};

/// Primitives first .. end - 1 of a scene, which are one shape of glass.
struct GlassShape {
    std::size_t first;
    std::size_t end;
    Bounds box{};
};

/// A lens in the unit of length of the scene; none of radius 0.
struct Lens {
    float aperture = 0; // radius
    float focus = 0;    // distance along the axis; 0: that of the target

    bool operator==(const Lens&) const = default;
};

/// Where the camera stands and looks; the field of view is vertical, in radians.
struct View {
    vec3 origin{0, 0, 1};
    vec3 target{0};
    vec3 up{0, 1, 0};
    float fieldOfView = glm::radians(40.0f);
    Coordinates coordinates{}; // of origin and target
    Lens lens{};

    bool operator==(const View&) const = default;
};

/// Textures, see shared_textures.h; all are empty where nothing has one.
struct TextureArrays {
    std::vector<MaterialTextures> materials;
    std::vector<LightTexture> lights;
    std::vector<Texture> textures;
    std::vector<TexelImage> images;
    std::vector<uint> texels;
    std::vector<TexturePlaces> coordinates; // of all triangles, one set after the other
    std::vector<VertexColors> colors;       // of all triangles
    std::vector<Tangents> tangents;         // likewise
    uint sets = 0;
};

struct Scene {
    Coordinates coordinates{};                     // of all places and lengths here and on the device
    std::string name;                              // the file's name without folder and extension
    std::string text;                              // the scene file as read
    std::vector<std::filesystem::path> files;      // that were read: the scene file first, then meshes and imports
    std::map<std::string, std::string> fileHashes; // of the files after the first, by name relative to it
    std::vector<Node> nodes;
    std::vector<Leaf> leaves;
    std::vector<Primitive> primitives; // triangles, then spheres
    std::vector<Normals> normals;
    std::vector<Material> materials;
    float wideAlpha = WIDE_ALPHA; // from which on glossy lobes have the label W
    std::vector<float> rests;     // see DeviceScene
    std::vector<Medium> media;    // likewise; empty if paths need not know what they are in
    std::vector<uint> lightMedia; // likewise
    std::vector<uint> touching;   // likewise
    std::vector<GlassShape> glass;
    TextureArrays textured;
    std::vector<Light> lights;       // endlessly far ones first
    Sky sky{};                       // but for its addresses
    std::vector<SkyTexel> skyTexels; // none: there is no sky
    std::vector<float> skyRows;
    std::vector<float> lightCdf;
    std::vector<Target> targets;
    std::vector<float> targetWeights; // see DeviceScene
    Target lit{vec3{0}, 0};           // about all that light falls upon
    Target near{vec3{0}, 0};          // about all but far lights
    Target middle{vec3{0}, 0};        // see DeviceScene
    uint discCount = 1;               // likewise
    uint triangleCount = 0;
    uint stackSize = 0; // entries that a traversal of `nodes` needs at most
    vec3 flux{0};       // of all lights, W over the square of the unit of length
    Bounds bounds;
    View view;
    Settings settings;
    std::vector<std::string> warnings; // what was put right or looks wrong, each with its place
};

/// The scene of a JSON file; meshes are found relative to the file. A glTF file is a scene that imports it. Throws
/// InputError. Which label glossy lobes have, by their alpha, changes what is noisy, and no mean.
Scene loadScene(const std::filesystem::path& file, float wideAlpha = WIDE_ALPHA);

/// Adds files to those that were read, each once, for those who ask later what has changed.
void noteFiles(Scene& scene, const std::vector<FileRead>& files);

/// The camera of a view for a film of `size` pixels.
Camera pinholeCamera(const View& view, uvec2 size);

} // namespace vkpm
