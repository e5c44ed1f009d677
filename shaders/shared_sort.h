// Prefix sums and the radix sort.
#ifndef SHARED_SORT_H
#define SHARED_SORT_H
#include "shared.h"
#include "shared_paths.h"

SHARED_BEGIN

struct ScanArgs {
    PTR(uint) values; // becomes its exclusive prefix sum, with the total behind it
    PTR(Queue) queue;
    ADDRESS(uint) before; // a sum to begin with, which becomes the total; 0: none
    uint kinds;
    uint blockSize; // values per kind: the queue's count over this, rounded up
};

const uint SORT_BITS = 8u;
const uint SORT_BLOCK = 4096u; // elements that a group sorts

struct SortCountArgs {
    PTR(uint) keys;
    PTR(uint) sums; // [digit][block]
    uint count;
    uint shift;
};

struct SortScatterArgs {
    PTR(uint) keys;
    PTR(uint) values;
    PTR(uint) sortedKeys;
    PTR(uint) sortedValues;
    PTR(uint) sums;
    uint count;
    uint shift;
};

SHARED_END
#endif
