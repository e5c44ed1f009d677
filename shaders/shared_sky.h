// A sky: what comes from far beyond the scene, as a picture in longitude and latitude. Each texel is of one radiance,
// and what is chosen by its flux is that radiance, never looked up again.
#ifndef SHARED_SKY_H
#define SHARED_SKY_H
#include "shared.h"

SHARED_BEGIN

struct SkyTexel {
    vec3 radiance;
    float cdf; // upper end of its part of its row, by luminance
};
BUFFER(SkyTexel)

struct Sky {
    ADDRESS(SkyTexel) texels; // row by row, the upper one first
    ADDRESS(float) rows;      // upper ends of their parts of the flux, the last is 1
    vec3 front;               // direction of the middle of the picture,
    vec3 up;                  // of its upper edge,
    vec3 right;               // and where columns go on from the middle
    uint width;
    uint height;
    float rowHeight; // twice the sine of half a row's angle: how much cosines differ within the row at the horizon
    float columnAngle;
    uint visible; // 0: not where the eye sees it directly
};
BUFFER(Sky)

SHARED_END
#endif
