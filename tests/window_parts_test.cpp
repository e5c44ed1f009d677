/// What the window computes: views, cameras as text, tones, and whether a scene has changed.
#include "output/film_image.h"
#include "render_support.h"
#include "scene/camera_json.h"
#include "shared_layers.h"
#include "window/picture.h"
#include "window/scene_watch.h"
#include "window/tone.h"
#include "window/view_camera.h"
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <random>
#include <unistd.h>

namespace vkpm {
namespace {

namespace fs = std::filesystem;

const View start{.origin = {1, 2, 5}, .target = {0.5f, 1, -1}, .up = {0.1f, 1, 0}, .fieldOfView = 0.7f};

double distanceOf(const View& v) { return glm::length(dvec3(v.target) - dvec3(v.origin)); }

TEST(ViewCamera, OrbitKeepsTargetAndDistance) {
    View view = start;
    for (int i = 0; i < 1000; i++) view = orbit(view, {0.3, 0.17 * (i % 3 - 1)});
    EXPECT_EQ(view.target, start.target);
    EXPECT_NEAR(distanceOf(view), distanceOf(start), 1e-4);
}

TEST(ViewCamera, OrbitToTheRightMovesTheEyeToTheLeft) {
    const View plain{.origin = {0, 0, 3}};
    EXPECT_LT(orbit(plain, {0.1, 0}).origin.x, -0.1f);
    EXPECT_GT(orbit(plain, {0, -0.1}).origin.y, 0.1f);
    EXPECT_GT(turn(plain, {0.1, 0}).target.x, 0.1f);
    EXPECT_GT(turn(plain, {0, 0.1}).target.y, 0.1f);
}

TEST(ViewCamera, NeverLooksAlongUp) {
    for (const double step : {-0.4, 0.4}) {
        View view = start;
        for (int i = 0; i < 50; i++) {
            view = orbit(view, {0, step});
            const auto right = [](const View& v) {
                return glm::normalize(glm::cross(dvec3(v.target) - dvec3(v.origin), dvec3(v.up)));
            };
            ASSERT_GT(glm::dot(right(view), right(start)), 0.99);
        }
        const dvec3 forward = glm::normalize(dvec3(view.target) - dvec3(view.origin));
        EXPECT_GT(glm::length(glm::cross(forward, glm::normalize(dvec3(view.up)))), 0.005);
        EXPECT_NEAR(distanceOf(view), distanceOf(start), 1e-4);
    }
}

TEST(ViewCamera, PanningByAHeightMovesThePictureByOne) {
    const View view = pan(start, {0, 1});
    EXPECT_NEAR(seenAt(view, {200, 100}, start.target)->place.y, 1.5, 1e-5);
    EXPECT_NEAR(seenAt(pan(start, {0.5, 0}), {200, 100}, start.target)->place.x, 0.25, 1e-5);
}

TEST(ViewCamera, DollyAndFlyGoAlongTheSight) {
    EXPECT_NEAR(distanceOf(dolly(start, 0.5)), distanceOf(start) / 2, 1e-5);
    EXPECT_EQ(dolly(start, 0.5).target, start.target);
    EXPECT_EQ(dolly(start, 1e-30).origin, start.origin); // not into the target
    EXPECT_NEAR(glm::distance(fly(start, {0, 0, 1}).origin, start.target), 0, 1e-5);
    EXPECT_NEAR(distanceOf(fly(start, {0.3, 2, 1})), distanceOf(start), 1e-5);
}

TEST(ViewCamera, PointsAreSeenWhereTheyAre) {
    for (const dvec2 place : {dvec2(0.1, 0.9), dvec2(0.5, 0.5), dvec2(0.99, 0.2)}) {
        const auto seen = seenAt(start, {300, 200}, pointAt(start, {300, 200}, place, 7));
        ASSERT_TRUE(seen);
        EXPECT_NEAR(glm::distance(seen->place, place), 0, 1e-5);
        EXPECT_NEAR(seen->depth, 7, 1e-5);
    }
    EXPECT_FALSE(seenAt(start, {300, 200}, 2.0f * start.origin - start.target));
    const vec3 point = pointAt(start, {300, 200}, {0.2, 0.3}, 4);
    EXPECT_EQ(focus(start, point).target, point);
    EXPECT_EQ(focus(start, start.origin + 3.0f * start.up).target, start.target); // it would look along up
}

// A scene that stands a million of its sizes away.
Scene farScene(const fs::path& file) {
    std::ofstream(file)
        << R"({"camera": {"origin": [2000000.5, 0, 7], "target": [2000000, 1, 0]}, "materials": {"m": {"type": "diffuse", "albedo": 1}},
        "shapes": [{"type": "sphere", "center": [2000000, 0, -300000], "radius": 1, "emission": 1, "material": "m"}]})";
    const Scene scene = loadScene(file);
    EXPECT_NE(scene.coordinates.origin.x, 0);
    return scene;
}

// The camera of a scene goes through text and the loader to the same bits.
TEST(CameraJson, IsReadBackBitForBit) {
    const fs::path file = fs::temp_directory_path() / fmt::format("vkpm_camera.{}.json", ::getpid());
    std::mt19937 random(5);
    std::uniform_real_distribution<float> number(-3, 3);
    Scene scene = shippedScene("diffuse_box");
    for (int i = 0; i < 200; i++) {
        if (i == 100) scene = farScene(file);
        View view{{number(random), number(random), number(random) * 1e-6f},
                  {number(random) * 1e5f, number(random), number(random)},
                  {0, 0, 1},
                  0};
        view.fieldOfView = glm::radians(60 + 15 * number(random));
        view.coordinates = scene.view.coordinates;
        view = inWorldDigits(view);
        std::ofstream(file) << withCamera(scene.text, view);
        EXPECT_TRUE(loadScene(file).view == view) << cameraJson(view);
    }
    fs::remove(file);
}

TEST(CameraJson, TakesTheValueOfTheTopmostKeyAlone) {
    const std::string text =
        R"({"about": "\"camera\": {", "a": [{"camera": {"x": 1}}], "camera" : {"up": "}", "b": {}} , "c": 2})";
    const std::string expected =
        R"({"about": "\"camera\": {", "a": [{"camera": {"x": 1}}], "camera" : )" + cameraJson(start) + R"( , "c": 2})";
    EXPECT_EQ(withCamera(text, start), expected);
    EXPECT_EQ(withCamera(R"({"import": "a.glb"})", start),
              R"({"camera": )" + cameraJson(start) + R"(, "import": "a.glb"})");
}

std::vector<Pixel> pixelsOf(const std::vector<vec3>& colors) {
    std::vector<Pixel> pixels(colors.size(), Pixel{});
    for (std::size_t i = 0; i < colors.size(); i++) {
        pixels[i].mean.layers[LAYER_EMISSION] = 0.25f * colors[i];
        pixels[i].mean.layers[LAYER_INDIRECT] = 0.75f * colors[i];
    }
    return pixels;
}

// Every value where the byte changes, its neighbours, and what is no colour.
TEST(Tone, LinearIsThePng) {
    std::vector<vec3> colors{{-1, 0, 2}, {INFINITY, -INFINITY, 1e-30f}};
    for (uint bits = 0x38000000; bits <= 0x3f800000; bits += 0x101) {
        const float x = std::bit_cast<float>(bits);
        colors.push_back({x, std::nextafter(x, 2.0f), std::nextafter(x, 0.0f)});
    }
    const std::vector<Pixel> pixels = pixelsOf(colors);
    for (const float exposure : {0.0f, -2.3f, 5.0f})
        EXPECT_TRUE(toneMap(pixels, {.exposure = exposure}) == develop(pixels, exposure));
}

TEST(Tone, CurvesGoFromBlackToWhite) {
    for (const ToneCurve curve : {ToneCurve::linear, ToneCurve::reinhard, ToneCurve::filmic}) {
        std::vector<vec3> greys;
        for (int i = 0; i <= 400; i++) greys.push_back(vec3(0.01f * float(i)));
        const std::vector<uint> bytes = toneMap(pixelsOf(greys), {.curve = curve});
        EXPECT_EQ(bytes[0], 0xff000000u);
        EXPECT_TRUE(std::ranges::is_sorted(bytes));
        EXPECT_GE(bytes[400] & 255, 240u);
    }
    EXPECT_EQ(toneMap(pixelsOf({vec3(4)}), {.curve = ToneCurve::reinhard})[0], 0xffffffffu);
}

TEST(Tone, LayersAreWhatTheyAreCalled) {
    Pixel pixel{};
    for (uint layer = 0; layer < LAYER_COUNT; layer++) pixel.mean.layers[layer][layer % 3] = 1;
    pixel.mean.albedo = {1, 0, 1};
    pixel.mean.normal = {1, 0, -1};
    pixel.noise = vec3(1 / errorGain, 0, 0);
    pixel.mean.bias = vec3(0, -1 / errorGain, 0);
    const uint red = 0xff0000ff, green = 0xff00ff00, blue = 0xffff0000;
    const uint expected[]{0xffffffff, red, green, blue, red, green, red | blue, 0xff0080ff, red, green};
    for (uint layer = 0; layer < shownLayers.size(); layer++)
        EXPECT_EQ(toneMap(std::vector{pixel}, {.layer = layer})[0], expected[layer]) << shownLayers[layer];
    EXPECT_EQ(toneMap(std::vector{pixel}, {.layer = SHOW_ALBEDO, .exposure = -8})[0], red | blue);
}

TEST(SceneWatch, SeesTheSceneAndItsMeshes) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("vkpm_watch.{}", ::getpid());
    fs::create_directories(folder);
    const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
    write("a.obj", "1");
    write("s.json", R"({"shapes": [{"type": "mesh", "file": "a.obj"}]})");
    SceneWatch watch(folder / "s.json");
    EXPECT_FALSE(watch.changed());
    write("a.obj", "12");
    EXPECT_TRUE(watch.changed());
    EXPECT_FALSE(watch.changed());
    fs::remove(folder / "s.json");
    EXPECT_FALSE(watch.changed());
    write("s.json", "{ broken");
    EXPECT_TRUE(watch.changed());
    write("a.obj", "123");
    EXPECT_TRUE(watch.changed());
    write("s.json", R"({"shapes": [{"type": "mesh", "file": "b.obj"}]})");
    EXPECT_TRUE(watch.changed());
    write("b.obj", "1");
    EXPECT_TRUE(watch.changed());
    write("m.gltf", R"({"buffers": [{"uri": "m.bin"}, {"uri": "data:;base64,AA"}]})");
    write("s.json", R"({"import": {"file": "m.gltf"}})");
    EXPECT_TRUE(watch.changed());
    write("m.bin", "1");
    EXPECT_TRUE(watch.changed());
    EXPECT_FALSE(watch.changed());
    fs::remove_all(folder);
}

} // namespace
} // namespace vkpm
