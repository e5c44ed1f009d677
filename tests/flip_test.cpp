/// HDR-FLIP against values of the Python package flip-evaluator, and where that has none.
#include "measure/flip.h"
#include <algorithm>
#include <functional>
#include <gmock/gmock.h>
#include <limits>
#include <numeric>

namespace vkpm {
namespace {

using testing::Each;

/// A colour image whose values are a function of x, y and the channel.
struct Picture {
    using Value = std::function<float(uint x, uint y, uint channel)>;

    Picture(uvec2 size, const Value& value) : image{.size = size} {
        for (uint c : {0u, 1u, 2u}) {
            std::vector<float> values;
            for (uint i = 0; i < size.x * size.y; ++i) values.push_back(value(i % size.x, i / size.x, c));
            image.channels.push_back({std::string(1, "RGB"[c]), std::move(values)});
        }
    }

    std::vector<float> flipOf(const Picture& reference) const {
        return flipMap(imageLayers(image).at(0), imageLayers(reference.image).at(0));
    }

    Image image;
};

/// A number from 0 to 1 that a hash makes of another, the same as in flip_test.py.
float noise(uint i) {
    i = (i ^ i >> 16) * 0x7feb352d;
    i = (i ^ i >> 15) * 0x846ca68b;
    return static_cast<float>((i ^ i >> 16) >> 8) * 0x1p-24f;
}

float noiseAt(uint x, uint y, uint channel, uint seed) {
    return noise(x + 1000 * y + 1000000 * channel + 10000000 * seed);
}

/// Squares of eight pixels, each of a colour of its own.
float squares(uint x, uint y, uint channel) { return noiseAt(x / 8, y / 8, channel, 3); }

Picture::Value noises(uint seed) {
    return [=](uint x, uint y, uint c) { return noiseAt(x, y, c, seed); };
}

/// Few bright pixels among many dark ones.
Picture::Value wide(uint seed) {
    const auto square = [](float u) { return u * u; };
    return [=](uint x, uint y, uint c) { return 5000 * square(square(square(noiseAt(x, y, c, seed)))); };
}

/// Black but for a corner.
Picture::Value corner(uint width) {
    return [=](uint x, uint y, uint c) { return x < width && y < 10 ? noiseAt(x, y, c, 7) : 0; };
}

Picture::Value even(float value) {
    return [=](uint, uint, uint) { return value; };
}

float noisySquares(uint x, uint y, uint c) { return squares(x, y, c) + 0.25f * noiseAt(x, y, c, 4); }

float brighterSquares(uint x, uint y, uint c) { return 1.0078125f * squares(x, y, c); }

float hazyCorner(uint x, uint y, uint c) { return corner(18)(x, y, c) + 0x1p-28f; }

float red(uint, uint, uint c) { return c == 0 ? 0.75f : 0.25f; }

/// Images that flip_test.py makes as well, and what it found. `tests/flip_test.py --print`, run by tools/environment,
/// prints mean and greatest of FLIP.
struct Case {
    const char* name;
    uvec2 size;
    Picture::Value image, reference;
    double mean, greatest;
};

const std::vector<Case> CASES{
    {"noise", {37, 23}, noises(1), noises(2), 0.3612580, 0.833744},
    {"noise over squares, several tiles", {131, 70}, noisySquares, squares, 0.4195268, 0.977384},
    {"nearly alike", {65, 64}, brighterSquares, squares, 0.0168937, 0.026077},
    {"a wide range", {50, 41}, wide(5), wide(6), 0.6008324, 0.981413},
    {"a reference that is black but for a corner", {40, 30}, corner(20), corner(18), 0.0531430, 0.975003},
    {"the same under a faint haze", {40, 30}, hazyCorner, corner(18), 0.3945132, 0.509713},
    {"a row", {90, 1}, noises(8), squares, 0.6937183, 0.984052},
    {"a column", {1, 90}, noises(9), squares, 0.7165398, 0.979788},
    {"a pixel", {1, 1}, red, even(0.5f), 0.3699893, 0.369989},
    {"constant", {9, 8}, even(0.75f), even(0.5f), 0.1091820, 0.109182},
    {"a black image", {20, 20}, even(0), squares, 0.9807792, 0.990294},
};

/// The package's roundings come out larger where nothing but them is under a root: of a pixel 1.3e-5.
TEST(Flip, AgreesWithFlipEvaluator) {
    for (const Case& c : CASES) {
        const std::vector<float> map = Picture(c.size, c.image).flipOf(Picture(c.size, c.reference));
        ASSERT_EQ(map.size(), size_t(c.size.x) * c.size.y);
        EXPECT_NEAR(std::accumulate(map.begin(), map.end(), 0.0) / double(map.size()), c.mean, 3e-5) << c.name;
        EXPECT_NEAR(*std::ranges::max_element(map), c.greatest, 1e-4) << c.name;
    }
}

TEST(Flip, IsZeroForWhatIsAlike) {
    const Picture picture({70, 5}, squares), black({3, 3}, even(0));
    EXPECT_THAT(picture.flipOf(picture), Each(0.0f));
    EXPECT_THAT(black.flipOf(black), Each(0.0f));
}

TEST(Flip, SeesLightWhereAllShouldBeBlack) {
    const uvec2 size(30, 20);
    const Picture black(size, even(0));
    const std::vector<float> map =
        Picture(size, [](uint x, uint y, uint) { return x == 3 && y == 4 ? 1.0f : 0.0f; }).flipOf(black);
    EXPECT_GT(map[4 * 30 + 3], 0.8f);
    EXPECT_EQ(map[19 * 30 + 29], 0.0f);
}

/// A value in a channel of one pixel of a picture, and another in the pixel's other channels.
Picture::Value with(uvec2 place, uint channel, float value, float otherwise, const Picture::Value& picture) {
    return [=](uint x, uint y, uint c) {
        return uvec2(x, y) != place ? picture(x, y, c) : c == channel ? value : otherwise;
    };
}

TEST(Flip, TakesWhatIsNotFiniteForAlike) {
    constexpr float INFINITE = std::numeric_limits<float>::infinity(), NOT = std::numeric_limits<float>::quiet_NaN();
    const uvec2 size(40, 40), middle(20, 20), edge(0, 39);
    const Picture plain(size, squares), image(size, noises(1));
    EXPECT_THAT(Picture(size, with(middle, 1, NOT, 5, squares)).flipOf(plain), Each(0.0f));
    EXPECT_THAT(Picture(size, with(edge, 2, -INFINITE, 5, squares)).flipOf(plain), Each(0.0f));
    const Picture infinite(size, with(middle, 0, INFINITE, 5, squares));
    EXPECT_THAT(Picture(size, with(middle, 0, NOT, 7, squares)).flipOf(infinite), Each(0.0f));
    const Picture black(size, with(middle, 0, 0, 0, squares)), imageWithBlack(size, with(middle, 0, 0, 0, noises(1)));
    EXPECT_EQ(image.flipOf(infinite), imageWithBlack.flipOf(black));
}

TEST(Flip, KeepsItsRangeWithTheGreatestFloats) {
    const uvec2 size(12, 12), place(5, 5);
    constexpr float GREATEST = std::numeric_limits<float>::max();
    const Picture plain(size, squares), bright(size, even(GREATEST));
    const Picture firefly(size, with(place, 1, GREATEST, -GREATEST, squares));
    for (const auto& map : {firefly.flipOf(bright), bright.flipOf(firefly), plain.flipOf(firefly)})
        for (const float flip : map) EXPECT_TRUE(flip >= 0 && flip <= 1) << flip;
    EXPECT_EQ(bright.flipOf(plain), Picture(size, even(1e9f)).flipOf(plain));
}

} // namespace
} // namespace vkpm
