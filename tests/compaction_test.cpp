/// Compaction: the lists of each kind equal a reference on the host.
#include "judge.h"
#include "map.h"
#include "render/compaction.h"
#include <gtest/gtest.h>
#include <numeric>

namespace vkpm {
namespace {

using Lists = std::vector<std::vector<uint>>;

// The lists that the queues point to.
Lists readLists(const Compaction& compaction, uint kinds) {
    const auto all = compaction.list.download();
    const auto queues = compaction.queues.download();
    Lists lists;
    for (uint kind = 0; kind < kinds; kind++) {
        const Queue& q = queues[kind];
        const uint groups = (q.count + GROUP - 1) / GROUP;
        EXPECT_EQ(q.groupsX * q.groupsY, groups);
        EXPECT_EQ(q.groupsZ, 1u);
        lists.emplace_back(all.begin() + q.first, all.begin() + q.first + q.count);
    }
    return lists;
}

Lists step(Compaction& compaction, const std::vector<uint>& flags, uint kinds) {
    std::vector<uint> sums(COMPACTION_SUMS);
    for (std::size_t i = 0; i < flags.size(); i++)
        for (uint kind = 0; kind < kinds; kind++)
            sums[kind * MAX_COMPACTION_BLOCKS + i / COMPACTION_BLOCK] += flags[i] >> kind & 1;
    compaction.flags.upload(sums);
    compaction.flags.upload(flags, COMPACTION_SUMS);
    Recording recording(testGpu());
    compaction.compact(recording);
    recording.submit();
    return readLists(compaction, kinds);
}

Lists reference(const std::vector<uint>& list, const std::vector<uint>& flags, uint kinds) {
    Lists lists(kinds);
    for (std::size_t i = 0; i < list.size(); i++)
        for (uint kind = 0; kind < kinds; kind++)
            if (flags[i] >> kind & 1) lists[kind].push_back(list[i]);
    return lists;
}

std::vector<uint> randomFlags(Random& random, std::size_t count, uint kinds) {
    std::vector<uint> flags(count);
    for (uint& flag : flags) flag = random.bits() & ((1u << kinds) - 1);
    return flags;
}

// An arbitrary permutation of 0 .. count - 1 as the first list.
std::vector<uint> begin(Compaction& compaction, uint count) {
    std::vector<uint> list(count);
    for (uint i = 0; i < count; i++) list[i] = count - 1 - i;
    compaction.list.upload(list);
    Recording recording(testGpu());
    compaction.start(recording, count);
    recording.submit();
    return list;
}

class CompactionTest : public testing::TestWithParam<uint> {};

TEST_P(CompactionTest, ListsEqualAReference) {
    Random random(GetParam());
    for (const uint kinds : {PHOTON_QUEUES, EYE_QUEUES}) {
        Compaction compaction(testGpu(), "test", 100'001, kinds);
        const uint count = GetParam(), all = (1u << kinds) - 1;
        for (const auto& flags :
             {randomFlags(random, count, kinds), std::vector<uint>(count, 0), std::vector<uint>(count, all)}) {
            const auto list = begin(compaction, count);
            EXPECT_EQ(step(compaction, flags, kinds), reference(list, flags, kinds)) << count << " " << kinds;
        }
    }
}

// Several rounds until nothing is left, each of which shortens the first queue; twice, to see that starting again
// works.
TEST_P(CompactionTest, BasesAddUpOverRounds) {
    Random random(GetParam());
    const uint kinds = EYE_QUEUES;
    Compaction compaction(testGpu(), "test", std::max(GetParam(), 1u), kinds);
    for (int repeat = 0; repeat < 2; repeat++) {
        auto list = begin(compaction, GetParam());
        std::vector<uint> bases(kinds);
        std::vector<std::size_t> counts(kinds);
        counts[0] = list.size();
        for (int round = 0; round < 25; round++) {
            const auto flags = randomFlags(random, list.size(), kinds);
            const auto expected = reference(list, flags, kinds);
            ASSERT_EQ(step(compaction, flags, kinds), expected);
            const auto queues = compaction.queues.download();
            for (uint kind = 0; kind < kinds; kind++) {
                bases[kind] += static_cast<uint>(counts[kind]);
                ASSERT_EQ(queues[kind].base, bases[kind]) << kind << " in round " << round;
                counts[kind] = expected[kind].size();
            }
            list = expected[0];
        }
        EXPECT_TRUE(list.empty());
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, CompactionTest, testing::Values(0, 1, 63, 64, 65, 4097, 100'001));

} // namespace
} // namespace vkpm
