/// The radix sort equals std::stable_sort, at and around every block size.
#include "judge.h"
#include "map.h"
#include "render/sort.h"
#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <numeric>

namespace vkpm {
namespace {

const std::vector<uint> sizes{0, 1, 63, 64, 65, 4095, 4096, 4097, (1u << 20) + 1};

uint mask(uint bits) { return bits == 32 ? 0xffffffffu : (1u << bits) - 1; }

// Values are indices, so a sort that is not stable shows.
void expectSorted(Sort& sort, const std::vector<uint>& keys, uint bits, const char* what) {
    const auto count = static_cast<uint>(keys.size());
    std::vector<uint> order(count);
    std::iota(order.begin(), order.end(), 0u);
    sort.reserve(std::max(count, 1u));
    sort.keys.upload(keys);
    sort.values.upload(order);
    Recording recording(testGpu());
    sort.sort(recording, count, bits);
    recording.submit();

    std::ranges::stable_sort(order, {}, [&](uint i) { return keys[i] & mask(bits); });
    std::vector<uint> sorted;
    for (const uint i : order) sorted.push_back(keys[i]);
    EXPECT_TRUE(sort.keys.download(count) == sorted) << what << ", " << count << " keys, " << bits << " bits";
    EXPECT_TRUE(sort.values.download(count) == order) << what << ", " << count << " values, " << bits << " bits";
}

void expectAllSorted(uint bits, const char* what, const std::function<uint(uint, uint)>& key) {
    Sort sort(testGpu());
    for (const uint size : sizes) {
        std::vector<uint> keys(size);
        for (uint i = 0; i < size; i++) keys[i] = key(i, size) & mask(bits);
        expectSorted(sort, keys, bits, what);
    }
}

TEST(Sort, RandomKeys) {
    for (const uint bits : {3u, 8u, 20u, 32u}) {
        Random random(bits);
        expectAllSorted(bits, "random", [&](uint, uint) { return random.bits(); });
    }
}

TEST(Sort, ConstantKeys) {
    for (const uint key : {0u, 0xffffffffu, 0x12345678u})
        expectAllSorted(32, "constant", [&](uint, uint) { return key; });
}

TEST(Sort, SortedAndReversedKeys) {
    expectAllSorted(20, "sorted", [](uint i, uint size) { return static_cast<uint>(i * 0xfffffull / size); });
    expectAllSorted(32, "sorted", [](uint i, uint) { return i << 11; });
    expectAllSorted(32, "reversed", [](uint i, uint size) { return size - i; });
}

// Whole digits are sorted: bits above the lowest ones may only order what is equal in them.
TEST(Sort, FewerBitsThanADigit) {
    Random random(1);
    Sort sort(testGpu());
    std::vector<uint> keys(5000);
    for (uint& key : keys) key = random.bits() & 7;
    expectSorted(sort, keys, 3, "three bits");
}

TEST(Sort, WhatLiesBehindTheCountStays) {
    Sort sort(testGpu());
    sort.reserve(200);
    std::vector<uint> keys(200);
    for (uint i = 0; i < 200; i++) keys[i] = 200 - i;
    sort.keys.upload(keys);
    sort.values.upload(keys);
    Recording recording(testGpu());
    sort.sort(recording, 100, 8);
    recording.submit();
    const auto sorted = sort.keys.download(100);
    for (uint i = 0; i < 100; i++) EXPECT_EQ(sorted[i], 101 + i);
}

// A sort for which nothing was ever reserved, as for a map without photons.
TEST(Sort, NothingReservedNothingSorted) {
    Sort sort(testGpu());
    Recording recording(testGpu());
    sort.reserve(0);
    sort.sort(recording, 0, 8);
    recording.submit();
}

} // namespace
} // namespace vkpm
