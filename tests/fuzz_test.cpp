/// Tens of thousands of damaged scenes, meshes and models: each is loaded whole, or refused by name and place, at once
/// and in little memory.
#include "allocations.h"
#include "draw.h"
#include "gltf_text.h"
#include "mutate.h"
#include "packed_models.h"
#include "ply_text.h"
#include "refusal.h"
#include "render/explain.h"
#include "render/features.h"
#include "render/radius.h"
#include "scene/identity.h"
#include "scene_text.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include <chrono>
#include <csignal>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

#ifdef NDEBUG
constexpr double maxSeconds = 1;
const std::uint64_t inputsByDefault = isNightly() ? 100'000 : isThorough() ? 50'000 : 20'000;
#else
constexpr double maxSeconds = 10; // sanitizers, and other work on the machine
constexpr std::uint64_t inputsByDefault = 5'000;
#endif
// A number of two bytes becomes a JSON value of 16, a corner of a face a part of a triangle; Embree has some memory by
// itself.
constexpr std::size_t bytesPerByte = 64, bytesAtLeast = 1 << 20;

std::uint64_t setting(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// A mesh of 8 quads, with a pentagon, normals and texture coordinates.
const char* const objMesh =
    "# a mesh\nmtllib none.mtl\no sheet\nv 0 0 0\nv 1 0 0\nv 2 0 0.5\nv 0 1 0\nv 1 1 0.25\nv 2 1 0\nv 0 2 1e-1\nv 1 2 "
    "0\nv 2 2 0\nvt 0 0\nvn 0 0 1\nvn 0 1 0\n"
    "usemtl a\ns 1\nf 1/1/1 2/1/1 5/1/2 4/1/1\nf 2//1 3//1 6//2 5//1\nf 4 5 8 7\nf -5 -4 -1 -2\nf 1 2 6 9 4\nf 1 2 5\n";

/// What inputs are made from: the shipped scenes, whose meshes are small here, a scene with everything in it, and
/// meshes.
struct Corpus {
    fs::path folder = writeScene("", "x").parent_path();
    std::vector<json> scenes;
    std::vector<GltfText> models{fullModel(), fullModel(), packedModel(Packing::dracoSequential),
                                 packedModel(Packing::dracoEdgebreaker), packedModel(Packing::meshopt)};
    std::vector<std::string> plies{asciiPly(), binaryPly<std::endian::little>(), binaryPly<std::endian::big>()};
    std::vector<std::string> meshes{objMesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"};

    Corpus() {
        for (const char* name : {"knot.obj", "ring.obj", "water.obj", "ball.obj"}) writeScene(objMesh, name);
        for (const char* name : {"box", "diffuse_box", "glass", "ring", "pool"})
            scenes.push_back(json::parse(read(fs::path{VKPM_SCENES} / (std::string{name} + ".json"))));
        scenes.push_back(smallScene());
        scenes.push_back(smallScene());
        scenes.back()["shapes"].push_back(
            {{"type", "mesh"}, {"file", "ball.obj"}, {"material", "water"}, {"smooth", true}, {"emission", 0}});
        for (const char* name : {"cube.obj", "plain_cube.obj", "flat_triangle.obj"})
            meshes.push_back(read(fs::path{VKPM_TEST_DATA} / name));
    }
    static std::string read(const fs::path& file) {
        std::ifstream stream{file, std::ios::binary};
        return {std::istreambuf_iterator<char>(stream), {}};
    }
};

/// One damaged input: the scene file, and the mesh beside it that the scene names.
struct Input {
    fs::path scene;
    std::size_t bytes = 0;
};

class Inputs {
public:
    /// Writes input `index` of a seed.
    Input make(std::uint64_t seed, std::uint64_t index) {
        Mutator mutator(static_cast<uint>(seed * 1'000'003 + index));
        const std::size_t kind = mutator.below(20);
        if (kind < 3) return mesh("damaged.obj", damagedMesh(mutator));
        if (kind < 6) return mesh("damaged.ply", damagedPly(mutator));
        if (kind < 8) return mesh("damaged.glb", damagedModel(mutator));
        if (kind < 12) return model(damagedModel(mutator));
        const std::string text = damagedScene(mutator);
        return {writeScene(text), text.size() + 8 * std::strlen(objMesh)};
    }

private:
    Input mesh(const std::string& name, const std::string& damaged) {
        writeScene(damaged, name);
        return {writeScene(sceneOfMesh(name).dump(), name + ".json"), damaged.size()};
    }

    Input model(const std::string& damaged) { return {writeScene(damaged, "model.glb"), damaged.size()}; }

    static json sceneOfMesh(const std::string& file) {
        json scene = smallScene();
        scene["shapes"].push_back(
            {{"type", "mesh"}, {"file", file}, {"material", "grey"}, {"smooth", true}, {"emission", 1}});
        return scene;
    }

    std::string damagedScene(Mutator& mutator) {
        json scene = mutator.oneOf(corpus.scenes);
        const bool values = mutator.below(10) < 7;
        for (std::size_t i = values ? 1 + mutator.below(4) : 0; i > 0; i--) mutator.changeValue(scene);
        std::string text = scene.dump(mutator.below(2) == 0 ? 1 : -1, ' ', false, json::error_handler_t::replace);
        if (mutator.below(5) == 0) mutator.changeJsonText(text);
        for (std::size_t i = values ? 0 : 1 + mutator.below(4); i > 0; i--) mutator.changeBytes(text);
        return text;
    }

    std::string damagedMesh(Mutator& mutator) {
        std::string text = mutator.oneOf(corpus.meshes);
        for (std::size_t i = 1 + mutator.below(4); i > 0; i--)
            if (mutator.below(3) == 0) mutator.changeBytes(text);
            else mutator.changeMesh(text);
        return text;
    }

    std::string damagedPly(Mutator& mutator) {
        std::string text = mutator.oneOf(corpus.plies);
        for (std::size_t i = 1 + mutator.below(3); i > 0; i--)
            if (mutator.below(2) == 0) mutator.changeBytes(text);
            else mutator.changePly(text);
        return text;
    }

    /// Values of the JSON, bytes that it refers to, or bytes of the file.
    std::string damagedModel(Mutator& mutator) {
        GltfText damaged = mutator.oneOf(corpus.models);
        const bool values = mutator.below(10) < 7;
        for (std::size_t i = values ? 1 + mutator.below(4) : 0; i > 0; i--) mutator.changeValue(damaged.json);
        if (!damaged.json.is_object()) damaged.json = json::object();
        if (mutator.below(4) == 0) mutator.changeBytes(damaged.bytes);
        std::string text = damaged.glb();
        for (std::size_t i = values ? 0 : 1 + mutator.below(4); i > 0; i--) mutator.changeBytes(text);
        return text;
    }

    Corpus corpus;
};

template <class T> bool allFinite(const std::vector<T>& items, std::size_t floats) {
    for (const T& item : items) {
        float values[sizeof(T) / 4];
        std::memcpy(values, &item, sizeof(T));
        for (std::size_t i = 0; i < floats; i++)
            if (!std::isfinite(values[i])) return false;
    }
    return true;
}

/// Whether the hierarchy is a tree over all primitives, no deeper than it says.
std::string faultOfTree(const Scene& scene) {
    std::vector<bool> reached(scene.primitives.size());
    std::vector<std::pair<uint, uint>> stack{{0, 1}};
    std::size_t visited = 0;
    while (!stack.empty()) {
        const auto [index, depth] = stack.back();
        stack.pop_back();
        if (index >= scene.nodes.size() || ++visited > scene.nodes.size()) return "nodes do not form a tree";
        if (depth > scene.stackSize) return "the tree is deeper than its stack";
        for (const uint child : {scene.nodes[index].left, scene.nodes[index].right}) {
            if ((child & LEAF) == 0) {
                stack.push_back({child, depth + 1});
                continue;
            }
            for (uint i = 0; i <= (child & ~LEAF) >> LEAF_SHIFT; i++) {
                const std::size_t leaf = (child & LEAF_FIRST) + i;
                if (leaf >= scene.leaves.size() || scene.leaves[leaf].id >= reached.size())
                    return "a leaf lies outside";
                reached[scene.leaves[leaf].id] = true;
            }
        }
    }
    return std::ranges::all_of(reached, std::identity{}) ? "" : "a primitive is in no leaf";
}

/// What is wrong with a scene that was accepted, for what kernels make of it; empty if nothing is.
std::string faultOf(const Scene& scene) {
    if (scene.primitives.empty() || scene.lights.empty()) return "no primitive or no light";
    if (!allFinite(scene.primitives, 9)) return "a primitive is not finite";
    if (!allFinite(scene.normals, 9)) return "a normal is not finite";
    if (!allFinite(scene.targets, 4)) return "a target is not finite";
    if (!allFinite(scene.lights, 12)) return "a light is not finite";
    if (!allFinite(scene.nodes, 12) && scene.nodes.size() > 1) return "a node is not finite";
    if (!std::ranges::is_sorted(scene.lightCdf) || scene.lightCdf.back() != 1 || scene.lightCdf.front() < 0)
        return "the lights' CDF";
    for (const Primitive& p : scene.primitives)
        if (p.material >= scene.materials.size() || (p.light != NONE && p.light >= scene.lights.size()) ||
            (p.normals != NONE && p.normals >= scene.normals.size()))
            return "an index of a primitive";
    return faultOfTree(scene);
}

/// What the host makes of a scene before the first pass.
std::string faultOfPlan(const Scene& scene) {
    const Settings& settings = scene.settings;
    const std::vector<Camera> cameras{pinholeCamera(scene.view, settings.size)};
    if (!allFinite(cameras, sizeof(Camera) / 4)) return "the camera is not finite";
    const Extent extent = extentOf(scene);
    const float radius = settings.radius.value_or(widestRadius(extent, settings.photons, settings.nearest));
    if (!(radius > 0) || !std::isfinite(radius)) return "the gather radius";
    if (maxLevels(extent, radius) > MAX_LEVELS) return "levels of the grid";
    if (!(radiusFactor(settings.passes, settings.alpha) > 0)) return "the radius schedule";
    const Features features = sceneFeatures(scene, settings);
    if (explainFeatures(features, settings).empty() || identityOf(scene, settings).empty()) return "features";
    return "";
}

struct Outcome {
    bool accepted = false;
    std::string fault;
};

Outcome load(const fs::path& file) {
    try {
        const Scene scene = loadScene(file);
        const std::string fault = faultOf(scene);
        return {true, fault.empty() ? faultOfPlan(scene) : fault};
    } catch (const InputError& error) {
        return {false, faultOfRefusal(error.what(), file.parent_path().string() + "/")};
    } catch (const std::exception& error) {
        return {false, fmt::format("another exception: {}", error.what())};
    }
}

// The input under way and its seed, for a message when the program dies or hangs.
volatile std::uint64_t current = 0, currentSeed = 0;

void onSignal(int signal) {
    std::fprintf(stderr, "input %llu: signal %d; VKPM_FUZZ_SEED=%llu VKPM_FUZZ_FIRST=%llu repeats it\n",
                 static_cast<unsigned long long>(current), signal, static_cast<unsigned long long>(currentSeed),
                 static_cast<unsigned long long>(current));
    std::_Exit(1);
}

/// The worst of all inputs.
struct Worst {
    double seconds = 0;
    double bytesOver = 0; // bytesAtLeast, per byte of input
};

/// What went wrong with one input; empty if nothing did.
std::string run(const Input& input, bool& accepted, Worst& worst) {
    heapPeak = heapBytes.load();
    const std::size_t before = heapBytes, allowed = bytesAtLeast + bytesPerByte * input.bytes;
    heapLimit = before + 64 * allowed; // far above what counts as too much, and far below what would stop the machine
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = load(input.scene);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    heapLimit = SIZE_MAX;
    accepted = outcome.accepted;
    const double used = double(heapPeak - before);
    worst.seconds = std::max(worst.seconds, seconds);
    worst.bytesOver = std::max(worst.bytesOver, (used - bytesAtLeast) / double(input.bytes));
    if (!outcome.fault.empty()) return outcome.fault;
    if (heapPeak - before > allowed)
        return fmt::format("{} bytes of memory for {} of input", heapPeak - before, input.bytes);
    if (seconds > maxSeconds) return fmt::format("took {:.2f} s", seconds);
    return "";
}

TEST(Fuzz, DamagedScenesAreLoadedWholeOrRefusedByPlace) {
    const std::uint64_t count = setting("VKPM_FUZZ_INPUTS", inputsByDefault), seed = setting("VKPM_FUZZ_SEED", 1),
                        first = setting("VKPM_FUZZ_FIRST", 0);
    currentSeed = seed;
    for (const int signal : {SIGALRM, SIGSEGV, SIGABRT, SIGFPE}) std::signal(signal, onSignal);
    Inputs inputs;
    std::uint64_t accepted = 0, faults = 0;
    Worst worst;
    for (std::uint64_t index = first; index < first + count && faults < 20; index++) {
        current = index;
        const Input input = inputs.make(seed, index);
        ::alarm(static_cast<unsigned>(10 * maxSeconds));
        bool loaded = false;
        const std::string fault = run(input, loaded, worst);
        accepted += loaded;
        if (fault.empty()) continue;
        faults++;
        const fs::path kept = fs::temp_directory_path() / fmt::format("vkpm-fuzz-{}-{}", seed, index);
        const fs::path damaged = input.scene.parent_path() / input.scene.stem(); // of a mesh
        fs::copy(fs::exists(damaged) ? damaged : input.scene, kept, fs::copy_options::overwrite_existing);
        ADD_FAILURE() << fault << "\n  input " << index << " of seed " << seed << ", kept as " << kept;
    }
    ::alarm(0);
    for (const int signal : {SIGALRM, SIGSEGV, SIGABRT, SIGFPE}) std::signal(signal, SIG_DFL);
    fmt::print("{} inputs, {} accepted; the slowest took {:.3f} s, the largest {:.0f} bytes of memory per byte beyond "
               "{} MiB\n",
               current + 1 - first, accepted, worst.seconds, std::max(worst.bytesOver, 0.0), bytesAtLeast >> 20);
    if (count >= 10'000) { // both ways are walked
        EXPECT_GT(accepted, count / 20);
        EXPECT_LT(accepted, count - count / 20);
    }
}

} // namespace
} // namespace vkpm
