// A kernel that applies one function to an array: MAP(In, Out, f(x)).
#include "common.glsl"
#include "map_args.h"

ARGS(MapArgs)

#define MAP(In, Out, expression)                                                                                       \
    layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Inputs { In at[]; };                  \
    layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Outputs { Out at[]; };               \
    Out apply(In x) { return expression; }                                                                             \
    void main() {                                                                                                      \
        uint i = threadIndex();                                                                                        \
        if (i < args.count) Outputs(args.ys).at[i] = apply(Inputs(args.xs).at[i]);                                     \
    }
