/// Owen-scrambled Sobol points: nets, scrambling, hashes, and sequences that know nothing of each other.
#include "judge.h"
#include "map.h"
#include "shared_paths.h"
#include <algorithm>
#include <bit>
#include <gtest/gtest.h>
#include <set>

namespace vkpm {
namespace {

using glm::uvec3, glm::uvec4;

const std::vector<uint> seeds{0, 1, 2, 12345, 0xdeadbeef};

std::vector<vec2> points(uint first, uint count, uint seed, uint dimension) {
    std::vector<uvec3> xs;
    for (uint i = first; i < first + count; i++) xs.push_back({i, seed, dimension});
    return map<vec2>("sobol_points", xs);
}

// Whether each elementary interval 2^-j by 2^(j-m) holds one of the 2^m points.
bool isNet(std::span<const vec2> net, uint m) {
    for (uint j = 0; j <= m; j++) {
        std::vector<uint> counts(net.size());
        for (const vec2 p : net) {
            const auto column = static_cast<uint>(p.x * float(1u << j)),
                       row = static_cast<uint>(p.y * float(1u << (m - j)));
            counts[column + (row << j)]++;
        }
        for (const uint count : counts)
            if (count != 1) return false;
    }
    return true;
}

TEST(Random, SobolPointsAreNets) {
    for (const uint seed : seeds)
        for (const uint dimension : {0u, 1u, 5u, 77u}) {
            const auto all = points(0, 2048, seed, dimension);
            for (uint m = 0; m <= 10; m++)
                for (std::size_t first = 0; first + (1u << m) <= all.size(); first += 1u << m)
                    ASSERT_TRUE(isNet(std::span(all).subspan(first, 1u << m), m))
                        << seed << " " << dimension << " " << m << " " << first;
        }
}

TEST(Random, SobolPointsDoNotDependOnHowManyFollow) {
    const auto few = points(0, 100, 7, 3), many = points(0, 1000, 7, 3);
    for (std::size_t i = 0; i < few.size(); i++) EXPECT_EQ(few[i], many[i]);
}

TEST(Random, SobolSecondIsTheRecurrenceOfDirectionNumbers) {
    // Primitive polynomial x + 1: m(k) = 2 m(k - 1) xor m(k - 1).
    uint directions[32];
    for (uint k = 0, m = 1; k < 32; k++, m ^= m << 1) directions[k] = m << (31 - k);
    std::vector<uint> xs;
    for (uint i = 0; i < 4096; i++) xs.push_back(i);
    for (uint bit = 0; bit < 32; bit++) xs.push_back(1u << bit);
    xs.push_back(0xffffffff);
    const auto ys = map<uint>("sobol_second", xs);
    for (std::size_t i = 0; i < xs.size(); i++) {
        uint expected = 0;
        for (uint k = 0; k < 32; k++)
            if (xs[i] >> k & 1) expected ^= directions[k];
        ASSERT_EQ(ys[i], expected) << xs[i];
    }
}

double correlation(const std::vector<vec2>& a, const std::vector<vec2>& b, int i, int j) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); k++) sum += (double{a[k][i]} - 0.5) * (double{b[k][j]} - 0.5);
    return 12 * sum / double(a.size());
}

// The correlation of 4096 independent pairs has a standard deviation of 1/64.
TEST(Random, DimensionsAndSeedsAreUncorrelated) {
    const uint count = 4096;
    std::vector<std::vector<vec2>> sequences;
    for (const uint seed : {0u, 1u, 2u, 3u})
        for (const uint dimension : {0u, 1u, 2u, 3u}) sequences.push_back(points(0, count, seed, dimension));
    for (std::size_t a = 0; a < sequences.size(); a++)
        for (std::size_t b = a; b < sequences.size(); b++)
            for (int i = 0; i < 2; i++)
                for (int j = a == b ? i + 1 : 0; j < 2; j++)
                    EXPECT_LT(std::abs(correlation(sequences[a], sequences[b], i, j)), 5.0 / 64)
                        << a << " " << b << " " << i << j;
}

// One point of each of many sequences; chi-square below 5 standard deviations (p about 1e-6).
TEST(Random, FirstPointsOfManySequencesAreUniform) {
    for (const uint index : {0u, 1u, 1000u}) {
        std::vector<uvec4> pixels;
        for (uint i = 0; i < 65'536; i++) pixels.push_back({i, index, 0, SAMPLES_EYE});
        std::vector<uvec3> xs;
        for (const uvec2 s : map<uvec2>("pixel_sampler", pixels)) xs.push_back({s.x, s.y, 2});
        Histogram histogram(16, 16), neighbours(16, 16);
        const auto ys = map<vec2>("sobol_points", xs);
        for (std::size_t i = 0; i < ys.size(); i++) {
            histogram.add(ys[i].x, ys[i].y);
            if (i % 2) neighbours.add(ys[i].x, ys[i - 1].x);
        }
        EXPECT_LT(histogram.deviation(), 5) << index;
        EXPECT_LT(neighbours.deviation(), 5) << index;
    }
}

TEST(Random, SequencesOfPixelsAndPhotonsDiffer) {
    std::vector<uvec4> pixels, photons;
    for (uint i = 0; i < 1024; i++)
        for (const uint seed : {0u, 1u, 2u}) {
            for (const uint sequence : {SAMPLES_EYE, SAMPLES_GATHER}) pixels.push_back({i, 5, seed, sequence});
            for (const uint kind : {0u, 1u}) photons.push_back({17, i, seed, kind});
        }
    std::set<uint> found;
    for (const uvec2 s : map<uvec2>("pixel_sampler", pixels)) {
        EXPECT_EQ(s.x, 5u);
        found.insert(s.y);
    }
    for (const uvec2 s : map<uvec2>("photon_sampler", photons)) {
        EXPECT_EQ(s.x, 17u);
        found.insert(s.y);
    }
    // 9216 random words collide 0.01 times.
    EXPECT_GE(found.size() + 1, pixels.size() + photons.size());
}

TEST(Random, UnitFloatIsBelowOne) {
    const auto ys = map<float>("unit_float", std::vector<uint>{0, 0xff, 0x100, 0x80000000, 0xffffff00, 0xffffffff});
    EXPECT_EQ(ys, (std::vector<float>{0, 0, 0x1p-24f, 0.5f, 1 - 0x1p-24f, 1 - 0x1p-24f}));
}

uint leadingEqual(uint a, uint b) { return a == b ? 32 : static_cast<uint>(std::countl_zero(a ^ b)); }

// Two words part at the same bit before and after; the bit that parts them is flipped in half of the cases.
TEST(Random, OwenScramblingIsNested) {
    Random random(1);
    std::vector<uvec2> xs;
    for (uint i = 0; i < 100'000; i++) {
        const uint seed = random.bits(), a = random.bits();
        xs.push_back({a, seed});
        xs.push_back({a ^ (0x80000000u >> i % 32) ^ (i % 32 == 31 ? 0 : random.bits() >> (i % 32 + 1)), seed});
    }
    const auto ys = map<uint>("owen_scramble", xs);
    std::vector<int> flips(32);
    for (std::size_t i = 0; i < xs.size(); i += 2) {
        const uint parting = leadingEqual(xs[i].x, xs[i + 1].x);
        ASSERT_EQ(leadingEqual(ys[i], ys[i + 1]), parting);
        flips[parting] += (xs[i].x ^ ys[i]) >> (31 - parting) & 1;
    }
    // 3125 cases a bit: a standard deviation of 28.
    for (uint bit = 0; bit < 32; bit++) EXPECT_NEAR(flips[bit], 1562, 5 * 28) << bit;
}

// 2^16 words; a flipped bit changes each bit of the hash in half of the cases, with a standard deviation of 1/256.
TEST(Random, HashMixesAllBits) {
    Random random(2);
    for (uint bit = 0; bit < 32; bit++) {
        std::vector<uint> xs;
        for (uint i = 0; i < 65'536; i++) {
            xs.push_back(random.bits());
            xs.push_back(xs.back() ^ 1u << bit);
        }
        const auto ys = map<uint>("hash_word", xs);
        for (uint out = 0; out < 32; out++) {
            double changed = 0;
            for (std::size_t i = 0; i < ys.size(); i += 2) changed += (ys[i] ^ ys[i + 1]) >> out & 1;
            // Measured bias of the function: up to 0.01.
            EXPECT_NEAR(changed / 65'536, 0.5, 5.0 / 512 + 0.01) << bit << " " << out;
        }
    }
}

TEST(Random, HashesOfDifferentWordsDiffer) {
    std::vector<uint> xs;
    std::vector<uvec2> pairs;
    for (uint i = 0; i < 1u << 20; i++) xs.push_back(i);
    for (uint i = 0; i < 256; i++)
        for (uint j = 0; j < 256; j++) pairs.push_back({i, j});
    auto words = map<uint>("hash_word", xs);
    std::ranges::sort(words);
    EXPECT_EQ(std::ranges::adjacent_find(words), words.end());
    // 2^16 random words collide 0.5 times.
    const auto hashes = map<uint>("hash_pair", pairs);
    EXPECT_GE(std::set<uint>(hashes.begin(), hashes.end()).size(), pairs.size() - 6);
}

} // namespace
} // namespace vkpm
