// Layers of a picture, in Heckbert's notation.
#ifndef SHARED_LAYERS_H
#define SHARED_LAYERS_H
#include "shared.h"

SHARED_BEGIN

const uint LAYER_EMISSION = 0u; // L E
const uint LAYER_DIRECT = 1u;   // L D E
const uint LAYER_SPECULAR = 2u; // all of the others seen through S+
const uint LAYER_CAUSTIC = 3u;  // L S+ D E
const uint LAYER_INDIRECT = 4u; // L (S|D)* D S* D E
const uint LAYER_COUNT = 5u;

SHARED_END
#endif
