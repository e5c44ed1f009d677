/// The loader of scene files: camera, film, settings and materials, then the shapes and what follows from them.
#include "scene/box.h"
#include "scene/bvh.h"
#include "scene/hash.h"
#include "scene/import.h"
#include "scene/lamps.h"
#include "scene/lights.h"
#include "scene/materials.h"
#include "scene/media.h"
#include "scene/reader.h"
#include "scene/scene.h"
#include "scene/shapes.h"
#include "scene/sky.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
using glm::dvec3;

namespace {

constexpr std::size_t manyShapes = 10'000'000;

/// By its radius, or as photographers say it.
Lens readLens(Reader& camera, double unit) {
    const auto aperture = camera.find("aperture"), focus = camera.find("focusDistance"), stop = camera.find("fStop"),
               length = camera.find("focalLength"), meters = camera.find("unit");
    double radius = aperture ? double{aperture->number(notNegative)} : 0;
    if (stop || length || meters) {
        if (aperture) aperture->fail("found \"aperture\" beside \"fStop\"", "give one of them");
        if (!stop || !length)
            (stop     ? *stop
             : length ? *length
                      : *meters)
                .fail("found one of \"fStop\", \"focalLength\" and \"unit\" without the others",
                      "give \"fStop\" and \"focalLength\" (mm), and \"unit\" if a world unit is no meter");
        const double perUnit = meters ? double{meters->number(positive)} : 1;
        radius = double{length->number(positive)} / 1000 / perUnit / (2 * double{stop->number(positive)});
    }
    const Lens lens{static_cast<float>(radius / unit),
                    focus ? static_cast<float>(double{focus->number(positive)} / unit) : 0.0f};
    if (!std::isfinite(lens.aperture)) camera.fail("the aperture overflows", "give a smaller one");
    return lens;
}

View readView(Reader camera, const Coordinates& coordinates) {
    View view{.coordinates = coordinates};
    view.origin = vec3{coordinates.inside(camera.at("origin").place())};
    const Reader targetReader = camera.at("target");
    view.target = vec3{coordinates.inside(targetReader.place())};
    const auto up = camera.find("up");
    if (up) view.up = up->vector();
    if (const auto degrees = camera.find("fieldOfView"))
        view.fieldOfView = glm::radians(degrees->number({0, 179, true}));
    view.lens = readLens(camera, coordinates.unit);
    camera.finish();

    if (view.target == view.origin) targetReader.fail("the target is the origin", "let the camera look somewhere else");
    const dvec3 forward = glm::normalize(dvec3{view.target} - dvec3{view.origin});
    const double upLength = glm::length(dvec3{view.up});
    if (!(glm::length(glm::cross(forward, dvec3{view.up})) > 1e-6 * upLength))
        (up ? *up : targetReader)
            .fail("up has length 0 or points along the view", "give an \"up\" that leans away from it");
    return view;
}

void readFilm(Reader film, Settings& settings) {
    if (const auto size = film.find("size")) {
        const std::vector<Reader> sides = size->elements(2, 2, "an array of 2 integers, [width, height]");
        settings.size = {sides[0].integer(1, maxSide), sides[1].integer(1, maxSide)};
        if (std::uint64_t{settings.size.x} * settings.size.y > maxPixels)
            size->fail(fmt::format("found {} x {} pixels", settings.size.x, settings.size.y),
                       "allowed are 2^28 in all");
    }
    if (const auto exposure = film.find("exposure")) {
        settings.autoExposure = exposure->isText();
        if (settings.autoExposure) (void)exposure->choice({"auto"});
        else settings.exposure = exposure->number({-100, 100});
    }
    film.finish();
}

void readSettings(Reader reader, Settings& settings) {
    constexpr uint many = 100'000'000;
    if (const auto passes = reader.find("passes")) settings.passes = passes->integer(1, 1'000'000);
    if (const auto photons = reader.find("photons")) settings.photons = photons->integer(0, many);
    if (const auto photons = reader.find("causticPhotons")) settings.causticPhotons = photons->integer(0, many);
    if (const auto radius = reader.find("radius")) settings.radius = radius->number(positive);
    if (const auto radius = reader.find("causticRadius")) settings.causticRadius = radius->number(positive);
    if (const auto paths = reader.find("pixelSamples")) settings.pixelSamples = paths->integer(1, maxPixelSamples);
    if (const auto rays = reader.find("gatherRays")) settings.gatherRays = rays->integer(1, maxGatherRays);
    if (const auto nearest = reader.find("nearest")) settings.nearest = nearest->integer(0, 1'000'000);
    if (const auto alpha = reader.find("alpha")) settings.alpha = alpha->number({0, 1, true});
    if (const auto kernel = reader.find("kernel"))
        settings.kernel = static_cast<uint>(kernel->choice({kernelNames.begin(), kernelNames.end()}));
    if (const auto fresnel = reader.find("fresnel"))
        settings.schlick = fresnel->choice({fresnelNames.begin(), fresnelNames.end()}) == 1;
    if (const auto layers = reader.find("layers")) {
        settings.layers = 0;
        for (const Reader& layer : layers->elements(1, layerNames.size(), "an array of 1 to 10 names of layers"))
            settings.layers |= 1u << layer.choice({layerNames.begin(), layerNames.end()});
    }
    if (const auto seed = reader.find("seed")) settings.seed = seed->integer(0, std::numeric_limits<uint>::max());
    reader.finish();
}
static_assert(DENSITY_KERNEL_CONSTANT == 0 && DENSITY_KERNEL_CONE == 1 && DENSITY_KERNEL_GAUSS == 2 &&
              DENSITY_KERNEL_EPANECHNIKOV == 3);

std::map<std::string, uint> readMaterials(Reader reader, Scene& scene, Textures& textures) {
    std::map<std::string, uint> indices;
    for (const std::string& name : reader.keys()) {
        const Material material = readMaterial(reader.at(name), textures);
        indices[name] = static_cast<uint>(scene.materials.size());
        scene.materials.push_back(material);
    }
    return indices;
}

/// Areas and squared distances must not leave the range of float on the device.
void checkExtent(const Scene& scene, const std::filesystem::path& file) {
    const dvec3 sides = dvec3{scene.bounds.high} - dvec3{scene.bounds.low};
    const double extent = scene.coordinates.unit * std::max({sides.x, sides.y, sides.z});
    const double reach = scene.coordinates.unit * reachOf(scene.bounds);
    if (!(extent >= 1e-9 && reach <= 1e12))
        refuseFile(
            file, ": /shapes",
            fmt::format("the shapes extend over {:.3g} and reach as far as {:.3g} from their middle", extent, reach),
            "allowed are at least 1e-9 and at most 1e12");
}

/// The camera of an import, whose proportions the film takes if it has no size of its own.
Reader importedCamera(Import& import, std::optional<Reader> film, Settings& settings) {
    const Reader camera = import.camera();
    if (import.aspect() && !(film && film->find("size"))) {
        const float ratio = *import.aspect(), longer = static_cast<float>(std::max(settings.size.x, settings.size.y));
        const vec2 size = longer * vec2{std::min(ratio, 1.0f), std::min(1 / ratio, 1.0f)};
        settings.size = uvec2{glm::max(glm::round(size), vec2{1})};
    }
    return camera;
}

/// What a part of an import is made of: a material of the scene by the same name, or that of the file.
ShapeLoader::Surface importedSurface(Import& import, const ImportedPart& part, Scene& scene, Textures& textures,
                                     const std::map<std::string, uint>& ofScene) {
    const GltfMaterial imported = import.material(part.material, textures);
    const auto own = ofScene.find(import.materialName(part.material));
    ShapeLoader::Surface surface{own != ofScene.end() ? own->second : NONE, imported.radiance, imported.twoSided};
    if (!imported.emission.is_null())
        surface.radiance =
            textures.color(Reader{scene.files.front(), imported.emission}, notNegative, surface.emission);
    if (own == ofScene.end()) {
        const Material material = readMaterial(Reader{scene.files.front(), imported.material}, textures);
        surface.material = static_cast<uint>(scene.materials.size());
        scene.materials.push_back(material);
    }
    noteFiles(scene, import.files()); // with those of images
    return surface;
}

/// Adds what an import has. Materials of the scene go before its own, whose names shapes of the scene may use.
void addImport(Import& import, Scene& scene, Textures& textures, std::map<std::string, uint>& indices,
               ShapeLoader& loader) {
    const std::map<std::string, uint> ofScene = indices;
    std::map<uint, ShapeLoader::Surface> surfaces;
    for (const ImportedInstance& instance : import.instances())
        for (std::size_t i = instance.firstPart; i < instance.endPart; ++i) {
            const ImportedPart& part = import.parts()[i];
            if (!surfaces.contains(part.material)) {
                surfaces[part.material] = importedSurface(import, part, scene, textures, ofScene);
                indices.try_emplace(import.materialName(part.material), surfaces[part.material].material);
            }
            if (loader.add(part.place, part.mesh, instance.transform, surfaces[part.material]) > 0)
                import.lose(part.place, "triangles without an area are left out");
        }
    addLamps(import.lamps(), scene, loader);
}

void readScene(Reader root, Scene& scene) {
    if (const auto about = root.find("about")) (void)about->text();
    if (const auto schema = root.find("$schema")) (void)schema->text();
    const auto importReader = root.find("import");
    auto camera = importReader ? root.find("camera") : root.at("camera");
    const auto film = root.find("film");
    const auto settings = root.find("settings");
    const auto materials = root.find("materials");
    const auto environment = root.find("environment");
    const auto lights = root.find("lights");
    const auto shapes = importReader ? root.find("shapes") : root.at("shapes");
    root.finish();

    // What brings light of any strength is shown at its own, unless the scene says how.
    scene.settings.autoExposure = importReader || environment || lights;
    if (camera) (void)readView(*camera, {}); // what is wrong with it comes first
    if (film) readFilm(*film, scene.settings);
    if (settings) readSettings(*settings, scene.settings);
    std::map<std::string, uint> indices;
    Textures textures{scene};
    if (materials) indices = readMaterials(*materials, scene, textures);

    if (environment) readEnvironment(*environment, scene);
    if (environment && scene.sky.visible == 0) {
        scene.settings.coverage = true;
        scene.settings.layers |= 1u << ASK_DEPTH; // which knows what is covered
    }
    if (lights) addSuns(*lights, scene);
    std::optional<Import> import;
    if (importReader) {
        noteFiles(scene, import.emplace(*importReader).files());
        addSuns(import->lamps(), scene);
    }
    if (!camera) camera = importedCamera(*import, film, scene.settings);
    ShapeLoader loader{textures, indices};
    const std::size_t count = shapes ? shapes->count(1, manyShapes, "an array of shapes, at least one") : 0;
    std::vector<dvec3> places; // not the camera's, which may move while the scene stays where it is
    if (import) places = import->somePlaces();
    for (std::size_t i = 0; i < count; ++i)
        for (const dvec3& place : loader.somePlaces(shapes->element(i))) places.push_back(place);
    scene.coordinates = chooseCoordinates(places);
    scene.view = readView(*camera, scene.coordinates);
    if (import) addImport(*import, scene, textures, indices, loader);
    for (std::size_t i = 0; i < count; ++i) loader.add(shapes->element(i));
    if (lights) addLamps(*lights, scene, loader);
    if (import && scene.lights.empty()) {
        import->loseLight();
        addConstantSky(scene, vec3{1});
    }
    if (import) import->tellLosses(scene.warnings);
    loader.finish();
}

} // namespace

Scene loadScene(const std::filesystem::path& file, float wideAlpha) {
    const std::string problem = fileProblem(file);
    if (!problem.empty())
        throw InputError(fmt::format("{}: {}; give a scene file", printable(file.string(), 4096), problem));
    Scene scene;
    scene.name = file.stem().string();
    scene.wideAlpha = wideAlpha;
    scene.files.push_back(file);
    if (isGltfName(file)) scene.text = nlohmann::json{{"import", file.filename().string()}}.dump();
    else scene.text = readText(file, maxSceneBytes, "give a scene file; its meshes belong into files of their own");
    if (scene.text.find_first_not_of(" \t\r\n") == std::string::npos)
        refuseFile(file, ":1:1", "the file is empty", "give a scene, {\"camera\": ..., \"shapes\": ...}");

    const nlohmann::json json = parseJson(file, scene.text);
    readScene(Reader{file, json}, scene);
    checkExtent(scene, file);
    scene.lit = sphereOfLit(scene);
    measureEndless(scene);
    chooseLights(scene, file);
    findMedia(scene, file);
    chooseWide(scene);
    scene.near = sphereOfNear(scene);
    findMiddle(scene);

    addBvh(scene);
    return scene;
}

} // namespace vkpm
