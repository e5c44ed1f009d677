// Prefix sums and the radix sort.
#ifndef SHARED_SORT_H
#define SHARED_SORT_H
#include "shared.h"
#include "shared_paths.h"

SHARED_BEGIN

const uint SCAN_BLOCK = 4096u; // values of a long array that a group takes

struct ScanArgs {
    PTR(uint) values;     // become their exclusive prefix sums, with the total behind them,
    ADDRESS(uint) sums;   // or stay, and the sums of blocks go here
    ADDRESS(uint) before; // sums that blocks begin with; 0: none
    ADDRESS(uint) total;  // also goes here, if anyone asks
    uint count;
    uint blockSize;
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
