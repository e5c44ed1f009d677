/// A scene on the device.
#pragma once
#include "gpu/buffer.h"
#include "scene/media.h"
#include "scene/scene.h"
#include "shared_scene.h"

namespace vkpm {

/// Uploads the arrays of a scene once; kernels read them through `address`.
class UploadedScene {
public:
    /// The camera is that of the scene's view for the film's size; glass reflects as the settings say.
    UploadedScene(Gpu& gpu, const Scene& scene, const Settings& settings);

    /// Takes the camera of another view.
    void setView(const View& view, uvec2 size);
    Camera camera() const { return device.camera; }

    /// Light samples choose lights by these upper ends, the last of which is 1; at first they are those of photons.
    /// Those of a guide's regions may follow.
    void chooseLights(Gpu& gpu, std::span<const float> cdf);
    /// Light samples follow a guide, see light_guide.glsl; none: the same everywhere.
    void guideLights(Gpu& gpu, std::span<const GuideNode> nodes);
    bool guidesLights() const { return lightGuide.size() > 0; }

    /// Throws std::logic_error if kernels met anything that the features are without; see Features::checksFeatures.
    void requireNothingMissing() const;

    /// How often a path was in more media than it can tell apart.
    uint mediaOverflows() const { return overflows.download()[0]; }

    Buffer<DeviceScene> address;

private:
    DeviceScene device{};
    MediaLocator media;
    Buffer<Node> nodes;
    Buffer<Leaf> leaves;
    Buffer<Primitive> primitives;
    Buffer<Normals> normals;
    Buffer<Material> materials;
    Buffer<float> rests;
    Buffer<Light> lights;
    Buffer<float> lightCdf;
    Buffer<float> directCdf;
    Buffer<GuideNode> lightGuide;
    Buffer<Target> targets;
    Buffer<float> targetWeights;
    Buffer<Medium> mediaBuffer;
    Buffer<uint> lightMedia;
    Buffer<uint> touching;
    Buffer<SkyTexel> skyTexels;
    Buffer<float> skyRows;
    Buffer<Sky> sky;
    Buffer<MaterialTextures> materialTextures;
    Buffer<LightTexture> lightTextures;
    Buffer<Texture> textures;
    Buffer<TexelImage> images;
    Buffer<uint> texels;
    Buffer<TexturePlaces> coordinates;
    Buffer<VertexColors> colors;
    Buffer<Tangents> tangents;
    Buffer<uint> missing;
    Buffer<uint> overflows;
};

} // namespace vkpm
