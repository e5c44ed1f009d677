/// A glTF file as part of a scene: its meshes, materials, camera and lamps.
#pragma once
#include "scene/gltf_file.h"
#include "scene/gltf_material.h"
#include "scene/gltf_nodes.h"
#include "scene/mesh.h"
#include "scene/transform.h"
#include <memory>

namespace vkpm {

/// A triangle mesh with one material, in its own coordinates.
struct ImportedPart {
    Mesh mesh;
    Reader place;
    uint material; // of the file, or NONE
};

/// Parts that a node places in the world.
struct ImportedInstance {
    Transform transform;
    std::size_t firstPart, endPart;
};

class Import {
public:
    /// Reads the file that the value of a scene's "import" names: the name alone, or an object with it. Throws
    /// InputError.
    explicit Import(Reader import);
    Import(const Import&) = delete; // readers point into it
    Import& operator=(const Import&) = delete;

    const std::vector<ImportedPart>& parts() const { return all; }
    const std::vector<ImportedInstance>& instances() const { return placed; }
    /// Two places at opposite ends of each part of each instance, in world units.
    std::vector<glm::dvec3> somePlaces() const;

    /// A material of the file as an element of "materials", and its name there; NONE has glTF's default values.
    GltfMaterial material(uint index, Textures& textures);
    std::string materialName(uint index) const;

    /// As a scene file says it: the camera that was asked for, else the first, else one that sees all from the front.
    Reader camera();
    /// Width over height of that camera, if it says so.
    std::optional<float> aspect() const { return cameraAspect; }
    /// Lamps as the "lights" of a scene file, likewise.
    Reader lamps();
    /// Says that a white sky lights the whole.
    void loseLight() { losses.add(file->root(), "no light: a white sky of radiance 1 lights the whole"); }

    const std::vector<FileRead>& files() const { return file->files(); }
    void lose(const Reader& where, std::string_view what) { losses.add(where, what); }
    void tellLosses(std::vector<std::string>& warnings) const { losses.tell(warnings); }

private:
    /// What numbers of the file are in W/sr and W/m^2: by 683 lm/W, as glTF's standard has it, or as Blender can write.
    struct Units {
        double intensity = 1 / 683.0, irradiance = 1 / 683.0;
    };

    void readOptions(Reader& object);
    void readParts();
    void findSphere();
    void noteExtensions();
    bool isWanted(const GltfPlaced& camera) const;
    bool useCamera(const GltfPlaced& camera);
    void standInFront();
    void addLamp(const GltfPlaced& lamp);
    void addCones(Reader& light, glm::dvec3 direction, nlohmann::json& spot) const;

    std::filesystem::path path;
    std::unique_ptr<GltfFile> file;
    GltfNodes nodes;
    Losses losses;
    Transform outer;
    Units units;
    std::optional<float> lampRadius;
    GltfGlass glass = GltfGlass::automatic;
    std::optional<Reader> cameraWanted;
    std::vector<ImportedPart> all;
    std::vector<ImportedInstance> placed;
    glm::dvec3 center{0}; // of a sphere about all parts, in world units
    double radius = 0;
    nlohmann::json cameraJson, lampsJson;
    std::optional<float> cameraAspect;
};

} // namespace vkpm
