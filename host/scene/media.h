/// What glass is filled with, and which of it a point is in.
#pragma once
#include "scene/box.h"
#include "scene/scene.h"
#include <filesystem>
#include <vector>

namespace vkpm {

constexpr uint maxPriority = 1'000'000;

/// Gives glass its medium and, if the index outside is not 1, that of the medium outside. Both are added to
/// Scene::media if they are not there yet.
void fillGlass(Scene& scene, Material& material, const Medium& medium, float exteriorIor);

/// Decides whether paths have to know what they are in: if glass takes light away, has colours apart, priorities, or
/// lies in other glass without an index outside of its own. If so, media get the order in which they count where they
/// overlap, by priority, and of equals the smaller one first, and lights get the media that they are in; if not, there
/// are no media. Throws InputError, naming `file`, if there are more than paths can tell apart.
void findMedia(Scene& scene, const std::filesystem::path& file);

/// The walls of all glass in a scene, to find out which media a point is in.
class MediaLocator {
public:
    MediaLocator() = default;
    explicit MediaLocator(const Scene& scene);

    /// As Path::media, of a point in the scene's coordinates: by winding numbers, for walls of any shape.
    uint at(glm::dvec3 point) const;

private:
    struct Wall {
        Primitive primitive;
        bool isSphere;
        double sign; // 1: the medium is on the inner side
    };
    struct Inside {
        std::vector<Wall> walls;
        Bounds box;
        uint priority = 0;
    };
    std::vector<Inside> media;
};

} // namespace vkpm
