/// The camera of a view, and the list of files.
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace vkpm {
using glm::dvec3;

void noteFiles(Scene& scene, const std::vector<FileRead>& files) {
    for (const auto& [file, hash] : files) {
        if (std::ranges::find(scene.files, file) != scene.files.end()) continue;
        scene.files.push_back(file);
        const auto name = file.lexically_relative(scene.files.front().parent_path());
        scene.fileHashes[(name.empty() ? file : name).generic_string()] = hash;
    }
}

Camera pinholeCamera(const View& view, uvec2 size) {
    const double tangent = std::tan(double{view.fieldOfView} / 2);
    const double aspect = double(size.x) / double(size.y);
    const dvec3 forward = glm::normalize(dvec3{view.target} - dvec3{view.origin});
    const dvec3 right = glm::normalize(glm::cross(forward, glm::normalize(dvec3{view.up})));
    const dvec3 up = glm::cross(right, forward);
    const double focus =
        view.lens.focus > 0 ? double{view.lens.focus} : glm::distance(dvec3{view.target}, dvec3{view.origin});
    return {view.origin,        vec3{forward},      vec3{right * (tangent * aspect)},
            vec3{up * tangent}, view.lens.aperture, static_cast<float>(focus)};
}

} // namespace vkpm
