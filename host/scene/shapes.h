/// Shapes of a scene file, baked into primitives, lights and targets in world space.
#pragma once
#include "scene/glass.h"
#include "scene/mesh.h"
#include "scene/reader.h"
#include "scene/scene.h"
#include "scene/textures.h"
#include "scene/transform.h"
#include "shared_scene.h"
#include <map>
#include <span>

namespace vkpm {

/// The steps that bring a shape into the world.
Transform readTransform(Reader& shape);

/// Area of the parallelogram of two edges; 0 if it is so thin or small that its normal would drown in rounding.
double soundArea(vec3 u, vec3 v);

/// Fills the primitives, normals, lights and targets of a scene, shape by shape.
class ShapeLoader {
public:
    struct Surface {
        uint material = 0;
        vec3 radiance{0}; // or its factor
        bool twoSided = false;
        uint emission = NONE; // texture of what it emits
    };

    /// `indices` maps names to indices into `scene.materials`.
    ShapeLoader(Textures& images, const std::map<std::string, uint>& indices)
        : scene{images.scene}, textures{images}, materials{indices} {}

    /// Two places at opposite ends of a shape, in world units; none if the shape is wrong, which add() tells.
    std::vector<glm::dvec3> somePlaces(Reader shape);
    /// Adds one element of "shapes", in the scene's coordinates. Throws InputError.
    void add(Reader shape);
    /// Adds a triangle mesh that no element of "shapes" brings; what is wrong with it is told of `place`. Returns how
    /// many of its triangles have no area, and were left out. `part` takes those of one material of the file alone.
    std::size_t add(const Reader& place, const Mesh& mesh, const Transform& transform, Surface surface,
                    std::optional<uint> part = {});
    /// Appends the spheres, which follow all triangles, and warns of glass that is not the boundary of a solid.
    void finish();

private:
    Surface readSurface(Reader& shape, bool mayLackMaterial = false);
    uint materialNamed(const Reader& reader) const;
    uint blackMaterial();
    const Mesh& meshOf(Reader& shape);
    void addSphere(Reader& shape);
    void addRectangle(Reader& shape);
    void addMesh(Reader& shape);
    std::size_t addParts(Reader& shape, Reader& byName, const Mesh& mesh, const Transform& transform,
                         const Surface& surface);
    void addTriangle(const Reader& shape, const Mesh& mesh, std::size_t index, const Transform& transform,
                     const Surface& surface, const Tangents* tangents);
    void addCoordinates(const Reader& shape, const Surface& surface, const TexturePlaces& first,
                        const TexturePlaces& second = {});
    void requireCoordinates(const Reader& shape, const Mesh& mesh, const Surface& surface);
    void warnOfFlatCoordinates(const Reader& shape, const Surface& surface, std::size_t first);
    bool isTextured(const Surface& surface) const;
    uint normalMapOf(const Surface& surface) const;
    std::vector<Tangents> tangentsFor(const Mesh& mesh, const Surface& surface) const;

    void requireRoom(const Reader& shape) const;
    vec3 place(const Transform& transform, glm::dvec3 point) const;
    void extendBounds(const Reader& shape, vec3 low, vec3 high);
    void addFlat(const Reader& shape, const Primitive& triangle);
    uint addLight(const Surface& surface, uint kind, vec3 a, vec3 u, vec3 v, double area,
                  const TexturePlaces& coordinates = {});
    void addRectanglePart(const Reader& shape, const Surface& surface, const std::array<vec3, 4>& corners, vec3 u,
                          vec3 v, const std::array<vec2, 4>& places);
    uint addNormals(const Primitive& primitive, const std::array<vec3, 3>& normals, const Transform& transform);
    void addTarget(const Surface& surface, const Target& target);
    bool isNarrow(const Surface& surface) const;
    void noteGlass(const Reader& shape, const Surface& surface, std::size_t first);

    Scene& scene;
    Textures& textures;
    const std::map<std::string, uint>& materials;
    std::map<std::pair<std::filesystem::path, Smoothness>, Mesh> meshes; // by file, each loaded once
    std::vector<TexturePlaces> coordinates[2]; // of triangles up to the last one that needs some
    std::vector<Primitive> spheres;
    std::vector<std::pair<Reader, GlassShape>> glass; // what is made of it, but for spheres
    uint black = NONE;
};

} // namespace vkpm
