// Keys of the cells of points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "grid.glsl"

MAP(vec3, uint,
    cellKey(cellOf(x, args.photons.cellsPerUnit, args.photons.levels), args.photons.levels) & args.photons.cellMask)
