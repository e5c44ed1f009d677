/// Coarse pictures while the camera moves.
#pragma once
#include "render/renderer.h"
#include "window/picture.h"

namespace vkpm {

/// A second, small renderer of the scene, whose photon maps are made once: a frame takes camera paths alone. Its size
/// follows the time that frames take.
class Preview {
public:
    Preview(Gpu& gpu, const Scene& scene, const Settings& settings);

    /// A picture of a view for a film of `size`, of a pixel for many.
    Picture render(const View& view, uvec2 size);

private:
    double scale; // of the film's sides
    Renderer renderer;
};

} // namespace vkpm
