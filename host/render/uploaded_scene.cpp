/// Upload of a scene.
#include "render/uploaded_scene.h"
#include "scene/lights.h"
#include "shared_scene.h"
#include <algorithm>
#include <stdexcept>

namespace vkpm {

static_assert(sizeof(Leaf) == sizeof(LeafNumbers));

template <class T> static Buffer<T> uploaded(Gpu& gpu, const char* name, const std::vector<T>& data) {
    return Buffer<T>(gpu, name, std::span<const T>(data));
}

static std::vector<Material> withFresnel(std::vector<Material> materials, bool schlick) {
    for (Material& material : materials) material.schlick = schlick;
    return materials;
}

UploadedScene::UploadedScene(Gpu& gpu, const Scene& scene, const Settings& settings)
    : media(scene), nodes(uploaded(gpu, "scene nodes", scene.nodes)),
      leaves(uploaded(gpu, "scene leaves", scene.leaves)),
      primitives(uploaded(gpu, "scene primitives", scene.primitives)),
      normals(uploaded(gpu, "scene normals", scene.normals)),
      materials(uploaded(gpu, "scene materials", withFresnel(scene.materials, settings.schlick))),
      rests(uploaded(gpu, "scene rests", scene.rests)), lights(uploaded(gpu, "scene lights", scene.lights)),
      lightCdf(uploaded(gpu, "scene light cdf", scene.lightCdf)),
      directCdf(uploaded(gpu, "scene direct cdf", scene.lightCdf)),
      targets(uploaded(gpu, "scene targets", scene.targets)),
      targetWeights(uploaded(gpu, "scene target weights", scene.targetWeights)),
      mediaBuffer(uploaded(gpu, "scene media", scene.media)),
      lightMedia(uploaded(gpu, "scene light media", scene.lightMedia)),
      touching(uploaded(gpu, "scene touching", scene.touching)),
      skyTexels(uploaded(gpu, "sky texels", scene.skyTexels)), skyRows(uploaded(gpu, "sky rows", scene.skyRows)),
      materialTextures(uploaded(gpu, "scene material textures", scene.textured.materials)),
      lightTextures(uploaded(gpu, "scene light textures", scene.textured.lights)),
      textures(uploaded(gpu, "scene textures", scene.textured.textures)),
      images(uploaded(gpu, "scene images", scene.textured.images)),
      texels(uploaded(gpu, "scene texels", scene.textured.texels)),
      coordinates(uploaded(gpu, "scene texture coordinates", scene.textured.coordinates)),
      colors(uploaded(gpu, "scene vertex colours", scene.textured.colors)),
      tangents(uploaded(gpu, "scene tangents", scene.textured.tangents)),
      missing(uploaded(gpu, "scene missing", std::vector<uint>{0, 0})),
      overflows(uploaded(gpu, "scene media overflows", std::vector<uint>{0})) {
    if (!scene.skyTexels.empty()) {
        Sky withTables = scene.sky;
        withTables.texels = skyTexels;
        withTables.rows = skyRows;
        sky = uploaded(gpu, "sky", std::vector{withTables});
    }
    device = {.nodes = nodes,
              .leaves = leaves,
              .primitives = primitives,
              .normals = normals,
              .materials = materials,
              .lights = lights,
              .lightCdf = lightCdf,
              .directCdf = directCdf,
              .targets = targets,
              .targetWeights = targetWeights,
              .rests = rests,
              .media = mediaBuffer,
              .lightMedia = lightMedia,
              .touching = touching,
              .sky = sky,
              .materialTextures = materialTextures,
              .lightTextures = lightTextures,
              .textures = textures,
              .images = images,
              .texels = texels,
              .coordinates = coordinates,
              .colors = colors,
              .tangents = tangents,
              .missing = missing,
              .overflows = overflows,
              .lit = scene.lit,
              .near = scene.near,
              .middle = scene.middle,
              .triangleCount = scene.triangleCount,
              .lightCount = static_cast<uint>(scene.lights.size()),
              .endlessCount = static_cast<uint>(std::ranges::count_if(scene.lights, isEndless)),
              .discCount = scene.discCount,
              .targetCount = static_cast<uint>(scene.targets.size()),
              .coordinateSets = scene.textured.sets,
              .unit = static_cast<float>(scene.coordinates.unit)};
    address = Buffer<DeviceScene>(gpu, "scene", 1);
    setView(scene.view, settings.size);
}

void UploadedScene::chooseLights(Gpu& gpu, std::span<const float> cdf) {
    if (cdf.size() != directCdf.size()) directCdf = Buffer<float>(gpu, "scene direct cdf", cdf);
    else directCdf.upload(cdf);
    device.directCdf = directCdf;
    address.upload(std::span(&device, 1));
}

void UploadedScene::guideLights(Gpu& gpu, std::span<const GuideNode> nodes) {
    lightGuide = Buffer<GuideNode>(gpu, "light guide", nodes);
    device.lightGuide = lightGuide;
    address.upload(std::span(&device, 1));
}

void UploadedScene::setView(const View& view, uvec2 size) {
    device.camera = pinholeCamera(view, size);
    device.cameraMedia = media.at(glm::dvec3{view.origin});
    address.upload(std::span(&device, 1));
}

void UploadedScene::requireNothingMissing() const {
    const std::vector<uint> bits = missing.download();
    std::string names;
#define X(id, type, name, value) names += bits[id / 32] >> id % 32 & 1 ? " " #name : "";
    FEATURES(X)
#undef X
    if (!names.empty()) throw std::logic_error("features were left out that the scene needs:" + names);
}

} // namespace vkpm
